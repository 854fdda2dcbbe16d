"""The first campaign file of raw files that have none: `tribolab run` on the files themselves."""

from __future__ import annotations

import os
import shutil
import tomllib
from collections.abc import Sequence
from pathlib import Path

from tribolab.campaign.settings.files import scan_files
from tribolab.campaign.settings.load import load_and_plan
from tribolab.campaign.settings.run_names import safe_name
from tribolab.campaign.store.ledger import Ledger
from tribolab.errors import ConfigError, TribolabError
from tribolab.reading.kinds import kind_of
from tribolab.reading.moduli import holds_modulus
from tribolab.reading.runs.logs import group_files

NAME, RESULTS = "campaign.toml", "results"
_ABOUT = (
    "# Written for these files by `tribolab run`. Say what was measured (surface, medium,\n"
    "# normal_force, instrument ...) and run it again; README and CAMPAIGN.md list every key.\n"
)


def campaign_file(
    paths: Sequence[Path], folder: Path, instrument: str | None = None
) -> tuple[Path, bool]:
    """Return the campaign file that is meant; of raw files, one that is written for them.

    Parameters
    ----------
    paths
        A campaign file, the folder that holds it, or raw files: runs and scans, in any folders.
    folder
        Where a new one is written; one there that says the same is taken as it is, one that was
        written for the same files without their instrument is written anew. Beside one of other
        files it is named by its first file, as are its results.
    instrument
        What the raw files are from: a name, or the file of a dialect.

    Returns
    -------
    tuple
        The file or folder, and whether it was written.

    Raises
    ------
    ConfigError
        If another campaign file of that name stands there, or several are named, or there is no
        such instrument.
    """
    if len(paths) == 1 and (not paths[0].is_file() or _is_campaign(paths[0])):
        if instrument is not None:
            raise ConfigError(
                "--instrument is for raw files",
                cure="in a campaign file it is said in a [[run]] or [[surface]]: instrument = ...",
            )
        return paths[0], False
    for path in paths:
        if not path.is_file() or _is_campaign(path):
            what = "there is no such file" if not path.exists() else "it is no raw file"
            raise ConfigError(
                f"{path}: {what}", cure="name one campaign file or folder, or raw files alone"
            )
        if instrument is None and _holds_modulus(path):
            raise ConfigError(
                f"{path}: it holds a modulus over frequency, no run and no scan",
                cure=f'name it as modulus_file = "{path.name}" in [contact] of a campaign file; '
                f"`tribolab info {path.name}` shows how it is read",
            )
    whole = [path.resolve() for path in paths]
    file = folder / NAME
    if file.exists() and not _names(file, whole):  # it is of other files
        file = folder / f"campaign_{safe_name(paths[0].stem)}.toml"
    results = results_of(file)
    text = _campaign_of(whole, folder.resolve(), results, instrument)
    try:
        if instrument is not None and _says(file, _campaign_of(whole, folder.resolve(), results)):
            file.unlink()  # ours, of a try before; nobody has completed it
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        if not _says(file, text):
            raise ConfigError(
                f"{file} stands here already, and says something else of these files",
                cure=f"run it, if it was completed: tribolab run {file}; delete it, if it is of an "
                "earlier `tribolab run` of raw files; or go to another folder",
            ) from None
        return file, False
    except OSError as error:
        raise ConfigError(f"{file}: the campaign file cannot be written: {error}") from error
    return file, True


def results_of(file: Path) -> str:
    """Return the results folder of a campaign file that is written here, relative to it.

    >>> results_of(Path("campaign.toml")), results_of(Path("campaign_disc_7.toml"))
    ('results', 'results_disc_7')
    """
    return file.stem.replace("campaign", RESULTS, 1)


def _names(file: Path, paths: Sequence[Path]) -> bool:
    """Whether a campaign file names any of the files; of one that cannot be read it is taken so."""
    try:
        campaign, runs = load_and_plan(file)
        named = [path for run in runs for path in run.files] + scan_files(campaign)
    except TribolabError:
        return True
    return not {path.resolve() for path in named}.isdisjoint(paths)


def withdraw(file: Path, results: Path | None = None) -> None:
    """Take back a campaign file that was written for files of which none could be read.

    Parameters
    ----------
    file
        From `campaign_file`.
    results
        Folder that was made for its results, with nothing but what failed in it.
    """
    file.unlink(missing_ok=True)
    if results is not None and results.is_dir() and not Ledger.read(results).foreign():
        shutil.rmtree(results)


def why_unread(paths: Sequence[Path], instrument: str | None = None) -> list[str]:
    """Say why raw files cannot be read, in words for the command line; none where one can be.

    Parameters
    ----------
    paths, instrument
        As for `campaign_file`.
    """
    # late: starting stays quick
    from tribolab.app.file_info import file_lines

    said = []
    for path in paths:
        try:
            file_lines(path, instrument)
        except TribolabError as error:
            said.append(error.told("terminal"))
    return said if len(said) == len(paths) else []


def _says(file: Path, text: str) -> bool:
    return file.is_file() and file.read_bytes() == text.encode()


def _is_campaign(path: Path) -> bool:
    if path.suffix.lower() == ".toml":
        return True
    try:
        told = tomllib.loads(path.read_text("utf-8")) if path.stat().st_size < 1 << 20 else {}
    except (OSError, ValueError, RecursionError):
        return False
    return bool({"campaign", "run", "surface"} & told.keys())


def _campaign_of(
    paths: Sequence[Path], folder: Path, results: str, instrument: str | None = None
) -> str:
    from tribolab.reading.dialect.write import quoted  # late: starting stays quick

    raw = Path(os.path.commonpath([path.parent for path in paths]))
    where = os.path.relpath(raw, folder) if raw.is_relative_to(folder) else str(raw)
    name = paths[0].stem if len(paths) == 1 else raw.name
    groups = [[Path(path) for path in group] for group in group_files(paths)]
    runs = [group for group in groups if len(group) > 1 or _holds_run(group[0], instrument)]
    lines = [_ABOUT, "[campaign]", f"name = {quoted(name)}", f"raw = {quoted(where)}"]
    lines += [f"output = {quoted(results)}"] if results != RESULTS else []
    if runs:
        files = ",\n    ".join(quoted(str(path.relative_to(raw))) for run in runs for path in run)
        lines += ["", "[[run]]", f"files = [\n    {files},\n]", *_said(instrument, folder)]
    for (path,) in (group for group in groups if group not in runs):
        scans = quoted(str(path.relative_to(raw)))
        lines += ["", "[[surface]]", f"name = {quoted(path.stem)}", f"scans = {scans}"]
        lines += _said(instrument, folder)
    return "\n".join(lines) + "\n"


def _said(instrument: str | None, folder: Path) -> list[str]:
    """Return the line that names an instrument; the file of a dialect relative to the campaign."""
    if instrument is None:
        return []
    from tribolab.reading.dialect.write import quoted  # late: starting stays quick

    file = Path(instrument)
    if file.suffix == ".toml":
        whole = file.resolve()
        inside = whole.is_relative_to(folder)
        instrument = (whole.relative_to(folder) if inside else whole).as_posix()
    return [f"instrument = {quoted(instrument)}"]


def _holds_modulus(path: Path) -> bool:
    try:
        return kind_of(path) == "unknown" and holds_modulus(path)
    except TribolabError:
        return False  # the run says what is wrong with it


def _holds_run(path: Path, instrument: str | None) -> bool:
    if instrument is not None:
        return kind_of(path, instrument) == "run"
    from tribolab.reading.unknown_run import holds_run  # late: starting stays quick

    try:
        kind = kind_of(path)
        return kind == "run" or (kind == "unknown" and holds_run(path, by_name=False))
    except TribolabError:
        return True  # the run says what is wrong with it
