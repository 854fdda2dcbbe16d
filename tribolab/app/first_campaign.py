"""The campaign file that `tribolab run` writes for raw files that have none."""

from __future__ import annotations

import os
import shutil
import tomllib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tribolab.app.questions.stated import Stated, describe_with
from tribolab.app.raw_folder import as_pattern, files_in, is_results_folder, sorted_by_content
from tribolab.campaign.settings.files import scan_files
from tribolab.campaign.settings.load import load_and_plan
from tribolab.campaign.settings.naming.files_named import pattern_of_names
from tribolab.campaign.settings.naming.run_names import common_name, distinct, safe_name
from tribolab.campaign.store.ledger import Ledger
from tribolab.core.errors import ConfigError, TribolabError
from tribolab.reading.folder_content import may_hold_data
from tribolab.reading.kinds import repeats_by_name
from tribolab.reading.moduli import read_modulus_table
from tribolab.reading.runs.logs import group_files

NAME, RESULTS = "campaign.toml", "results"
_ABOUT = (
    "# Written by `tribolab run`. Correct it, add what you know (surface, medium, normal_force,\n"
    "# [contact]) and run again. CAMPAIGN.md lists every key.\n"
)


def campaign_file(
    paths: Sequence[Path], folder: Path, instrument: str | None = None, stated: Stated | None = None
) -> tuple[Path, bool]:
    """Return the campaign file that the paths name; for raw files, write one first.

    Parameters
    ----------
    paths
        A campaign file; a folder with a campaign file or raw files; or raw files (runs and scans)
        in any folders. If empty, the current folder.
    folder
        Folder for a new campaign file, unless `paths` is a folder. If it has an equal campaign
        file, that is reused. One written for the same raw files, but without their instrument, is
        replaced. If it has one for other raw files, the new campaign file and its results are named
        after the first raw file.
    instrument
        Instrument of the raw files: a name, or the file of a dialect.
    stated
        Amounts stated on the command line.

    Returns
    -------
    tuple
        The campaign file or its folder, and whether it was written now.

    Raises
    ------
    ConfigError
        If another campaign file of that name exists, several are given, the instrument does not
        exist, or a folder has no raw files.
    """
    stated = stated or Stated()
    paths = paths or [Path()]
    paths, folder, known = _raw_files(paths, folder)
    if known is not None:
        if instrument is not None or not stated.is_empty:
            option = "--instrument is" if instrument is not None else "--load and the like are"
            raise ConfigError(
                f"{option} for raw files",
                cure="in a campaign file state it in a [[run]]: instrument, normal_force, "
                "sliding_speed",
            )
        return known, False
    described = instrument is None
    instrument = instrument or describe_with(stated, paths, folder)
    described = described and instrument is not None
    whole = [path.resolve() for path in paths]
    file = folder / NAME
    if file.exists() and not _names(file, whole):  # the existing file is for other raw files
        file = folder / f"campaign_{safe_name(paths[0].stem)}.toml"
    results = results_of(file)
    lines = stated.run_lines(described=described)
    text = campaign_text(whole, folder.resolve(), results, instrument, lines)
    try:
        before = campaign_text(whole, folder.resolve(), results)
        if (instrument is not None or lines) and _has_text(file, before):
            file.unlink()  # an earlier attempt wrote it, and nobody has edited it
        with file.open("x", encoding="utf-8") as new:
            new.write(text)
    except FileExistsError:
        if not _has_text(file, text):
            raise ConfigError(
                f"{file} already exists, with other settings for these files",
                cure=f"to use it: tribolab run {file}. If an earlier `tribolab run` of raw files "
                "wrote it, delete it; or work in another folder",
            ) from None
        return file, False
    except OSError as error:
        raise ConfigError(f"{file}: the campaign file cannot be written: {error}") from error
    return file, True


def _raw_files(paths: Sequence[Path], folder: Path) -> tuple[list[Path], Path, Path | None]:
    """Return the raw files and a folder for their campaign file, or the named campaign file."""
    if len(paths) == 1 and paths[0].is_dir() and not (paths[0] / NAME).exists():
        found = files_in(paths[0])
        if not found:
            raise ConfigError(
                f"{paths[0]}: no raw file and no {NAME} in this folder",
                cure="name a folder of raw files, or see `tribolab demo`",
            )
        return found, paths[0], None
    if len(paths) == 1 and (not paths[0].is_file() or _is_campaign(paths[0])):
        return [], folder, paths[0]
    left = [path for path in paths if not (path.is_dir() and is_results_folder(path))]
    ours = [path for path in left if _is_campaign(path)]
    raw = [path for path in left if path not in ours]
    whole = [path.resolve() for path in raw if may_hold_data(path)]
    own = [path for path in ours if path.suffix != ".toml" or _names_all(path, whole)]
    if raw and len(own) == 1 and ours:  # `tribolab run *.*` again: its campaign file exists
        return [], folder, own[0]
    for path in left:
        if not path.is_file() or path in ours:
            what = "there is no such file" if not path.exists() else "it is not a raw file"
            raise ConfigError(
                f"{path}: {what}", cure="name one campaign file or folder, or raw files alone"
            )
    return raw, folder, None


def _names_all(file: Path, paths: Sequence[Path]) -> bool:
    """Whether a campaign file names all of these files."""
    try:
        campaign, runs = load_and_plan(file)
    except TribolabError:
        return False
    named = {path.resolve() for run in runs for path in run.files}
    named |= {path.resolve() for path in scan_files(campaign)}
    return bool(paths) and named.issuperset(paths)


def results_of(file: Path) -> str:
    """Return the name of the results folder for a campaign file with a given name.

    >>> results_of(Path("campaign.toml")), results_of(Path("campaign_disc_7.toml"))
    ('results', 'results_disc_7')
    """
    return file.stem.replace("campaign", RESULTS, 1)


def _names(file: Path, paths: Sequence[Path]) -> bool:
    """Whether a campaign file names any of these raw files, or cannot be read."""
    try:
        campaign, runs = load_and_plan(file)
        named = [path for run in runs for path in run.files] + scan_files(campaign)
    except TribolabError:
        return True
    return not {path.resolve() for path in named}.isdisjoint(paths)


def withdraw(file: Path, results: Path | None = None) -> None:
    """Remove a new campaign file and its results, because no raw file could be read.

    Parameters
    ----------
    file
        Campaign file that `campaign_file` wrote.
    results
        Folder of its results; it is kept if it contains other files.
    """
    file.unlink(missing_ok=True)
    if results is not None and results.is_dir() and not Ledger.read(results).foreign():
        shutil.rmtree(results)


def why_unread(paths: Sequence[Path], instrument: str | None = None) -> list[str]:
    """Return the reason for each raw file that cannot be read; empty if any can be read.

    Parameters
    ----------
    paths, instrument
        As for `campaign_file`.
    """
    # imported late for a quick start
    from tribolab.app.info.file_info import file_lines

    reasons = []
    paths = [file for path in paths for file in (files_in(path) if path.is_dir() else [path])]
    for path in paths:
        try:
            file_lines(path, instrument)
        except TribolabError as error:
            reasons.append(error.message_for("terminal"))
    return reasons if len(reasons) == len(paths) else []


def _has_text(file: Path, text: str) -> bool:
    return file.is_file() and file.read_bytes() == text.encode()


def _is_campaign(path: Path) -> bool:
    if path.suffix.lower() == ".toml":
        return True
    try:
        content = tomllib.loads(path.read_text("utf-8")) if path.stat().st_size < 1 << 20 else {}
    except (OSError, ValueError, RecursionError):
        return False
    return bool({"campaign", "run", "surface"} & content.keys())


def campaign_text(
    paths: Sequence[Path],
    folder: Path,
    results: str,
    instrument: str | None = None,
    stated: Sequence[str] = (),
) -> str:
    """Return the text of a campaign file for raw files.

    Parameters
    ----------
    paths
        Raw files, absolute.
    folder
        Absolute folder of the campaign file.
    results
        Results folder, relative to it.
    instrument, stated
        Instrument of the raw files, and further lines of their [[run]].
    """
    from tribolab.reading.dialect.write import quoted  # imported late for a quick start

    raw = Path(os.path.commonpath([path.parent for path in paths]))
    where = os.path.relpath(raw, folder) if raw.is_relative_to(folder) else str(raw)
    name = paths[0].stem if len(paths) == 1 else raw.name
    runs, kinds = sorted_by_content(group_files(paths), instrument)
    if kinds.moduli and not (kinds.runs or kinds.scans):
        read_modulus_table(kinds.moduli[0])  # raises if it is a sweep at one frequency
        raise ConfigError(
            f"{kinds.moduli[0]}: it contains a modulus over frequency, not a run or scan",
            cure=f'name it as modulus_file = "{kinds.moduli[0].name}" in [contact] of a campaign '
            f"file; `tribolab info {kinds.moduli[0].name}` shows how it is read",
        )
    if kinds.results and not (kinds.runs or kinds.scans or kinds.moduli):
        from tribolab.app.info.file_info import file_lines  # imported late for a quick start

        file_lines(kinds.results[0])  # raises an error that names the test if it is another test
        raise ConfigError(f"{kinds.results[0]}: it holds results, no run and no scan")
    lines = [_ABOUT, "[campaign]", f"name = {quoted(name)}", f"raw = {quoted(where)}"]
    lines += [f"output = {quoted(results)}"] if results != RESULTS else []
    pattern = pattern_of_names([common_name(files) for files in runs])
    if pattern and (len(runs) > 1 or pattern != "{surface}_{repeat}"):
        lines += [f"files_named = {quoted(pattern)}"]
    if len(kinds.moduli) == 1:
        modulus = kinds.moduli[0].relative_to(raw).as_posix()
        lines += ["", "[contact]", f"modulus_file = {quoted(modulus)}"]
    if runs:
        named = as_pattern(kinds.runs, [path for path in paths if path not in kinds.runs], raw)
        files = ",\n    ".join(map(quoted, named))
        lines += ["", "[[run]]", f"files = [\n    {files},\n]", *stated]
        lines += _instrument_line(instrument, folder)
    groups = repeats_by_name(kinds.scans)
    for group, title in zip(groups, surface_names(groups), strict=True):
        scans = [quoted(path.relative_to(raw).as_posix()) for path in group]
        shown = scans[0] if len(scans) == 1 else f"[{', '.join(scans)}]"
        lines += ["", "[[surface]]", f"name = {quoted(title)}", f"scans = {shown}"]
        lines += _instrument_line(instrument, folder)
    return "\n".join(lines) + "\n"


def surface_names(groups: Sequence[Sequence[Path]]) -> list[str]:
    """Return a name for each group of scans of one surface: the common part of the file names.

    Equal names are extended by their folder, else by their suffix, else by a number.

    >>> surface_names([[Path("sb-r_1.csv"), Path("sb-r_2.csv")], [Path("roller.txt")]])
    ['sb-r', 'roller']
    >>> surface_names([[Path("new/a_1.csv")], [Path("worn/a_1.csv")]])
    ['new a_1', 'worn a_1']
    """
    names = [common_name(scans) if len(scans) > 1 else scans[0].stem for scans in groups]
    firsts = [scans[0] for scans in groups]
    for more in ([file.parent.name for file in firsts], [file.suffix[1:] for file in firsts]):
        taken = Counter(name.casefold() for name in names)
        names = [
            f"{word} {name}".strip() if taken[name.casefold()] > 1 else name
            for word, name in zip(more, names, strict=True)
        ]
    return distinct(names)


def _instrument_line(instrument: str | None, folder: Path) -> list[str]:
    """Return the line that names the instrument; the path of a dialect is relative to `folder`."""
    if instrument is None:
        return []
    from tribolab.reading.dialect.write import quoted  # imported late for a quick start

    file = Path(instrument)
    if file.suffix == ".toml":
        whole = file.resolve()
        inside = whole.is_relative_to(folder)
        instrument = (whole.relative_to(folder) if inside else whole).as_posix()
    return [f"instrument = {quoted(instrument)}"]
