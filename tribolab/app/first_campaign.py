"""The first campaign file of raw files that have none: `tribolab run` on the files themselves."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Sequence
from pathlib import Path

from tribolab.draft.dialect.tables import quoted
from tribolab.draft.on_the_fly import holds_run
from tribolab.errors import ConfigError, TribolabError
from tribolab.io.kinds import kind_of
from tribolab.io.logs import group_files

NAME = "campaign.toml"
_ABOUT = (
    "# Written for these files by `tribolab run`. Say what was measured (surface, medium,\n"
    "# normal_force, instrument ...) and run it again; README and CAMPAIGN.md list every key.\n"
)


def campaign_file(paths: Sequence[Path], folder: Path) -> tuple[Path, bool]:
    """Return the campaign file that is meant; of raw files, one that is written for them.

    Parameters
    ----------
    paths
        A campaign file, the folder that holds it, or raw files: runs and scans, in any folders.
    folder
        Where a new one is written; one there that says the same is taken as it is.

    Returns
    -------
    tuple
        The file or folder, and whether it was written.

    Raises
    ------
    ConfigError
        If another campaign file stands there, or several are named.
    """
    if len(paths) == 1 and (not paths[0].is_file() or _is_campaign(paths[0])):
        return paths[0], False
    for path in paths:
        if not path.is_file() or _is_campaign(path):
            what = "there is no such file" if not path.exists() else "it is no raw file"
            raise ConfigError(
                f"{path}: {what}", cure="name one campaign file or folder, or raw files alone"
            )
    text = _campaign_of([path.resolve() for path in paths], folder.resolve())
    file = folder / NAME
    try:
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        if file.read_bytes() != text.encode():
            raise ConfigError(
                f"{file} stands here already, and says something else",
                cure="add the files to it ([[run]] files = ..., [[surface]] scans = ...) and run "
                "that, or go to another folder",
            ) from None
        return file, False
    except OSError as error:
        raise ConfigError(f"{file}: the campaign file cannot be written: {error}") from error
    return file, True


def _is_campaign(path: Path) -> bool:
    if path.suffix.lower() == ".toml":
        return True
    try:
        told = tomllib.loads(path.read_text("utf-8")) if path.stat().st_size < 1 << 20 else {}
    except (OSError, ValueError, RecursionError):
        return False
    return bool({"campaign", "run", "surface"} & told.keys())


def _campaign_of(paths: Sequence[Path], folder: Path) -> str:
    raw = Path(os.path.commonpath([path.parent for path in paths]))
    where = os.path.relpath(raw, folder) if raw.is_relative_to(folder) else str(raw)
    name = paths[0].stem if len(paths) == 1 else raw.name
    groups = [[Path(path) for path in group] for group in group_files(paths)]
    runs = [group for group in groups if len(group) > 1 or _holds_run(group[0])]
    lines = [_ABOUT, "[campaign]", f"name = {quoted(name)}", f"raw = {quoted(where)}"]
    if runs:
        files = ",\n    ".join(quoted(str(path.relative_to(raw))) for run in runs for path in run)
        lines += ["", "[[run]]", f"files = [\n    {files},\n]"]
    for (path,) in (group for group in groups if group not in runs):
        scans = quoted(str(path.relative_to(raw)))
        lines += ["", "[[surface]]", f"name = {quoted(path.stem)}", f"scans = {scans}"]
    return "\n".join(lines) + "\n"


def _holds_run(path: Path) -> bool:
    try:
        kind = kind_of(path)
        return kind == "run" or (kind == "unknown" and holds_run(path, by_name=False))
    except TribolabError:
        return True  # the run says what is wrong with it
