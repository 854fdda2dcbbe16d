"""Output of `tribolab info` on a raw file: a run, a scan, a modulus, or a tester's results."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.app.info.excerpt import Excerpt, write_excerpt
from tribolab.app.info.scan_info import areal_lines, roughness_lines, stated_lines
from tribolab.app.quick import importing, plain_arrays_only
from tribolab.app.ranges import range_of
from tribolab.campaign.engine.stage import Stage
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ReadError, TribolabError, message_for, shown
from tribolab.core.wording import Count, explain
from tribolab.reading import cures
from tribolab.reading.dialect.find import known_dialects, load_dialect
from tribolab.reading.kinds import kind_of
from tribolab.reading.moduli import is_modulus_file, read_modulus_table
from tribolab.reading.raw.opening import MissingLibraryError, RefusedError
from tribolab.reading.raw.source import check_regular
from tribolab.reading.runs.file_facts import describe_companion, file_facts, has_companion
from tribolab.reading.runs.read_run import read_log as known_log
from tribolab.reading.text.first_bytes import peek
from tribolab.reading.unknown_run import draft_of, is_run_file, read_log
from tribolab.units.quantities import quantity

if TYPE_CHECKING:
    pass
from tribolab.app.info.metadata_lines import metadata_lines
from tribolab.app.info.run_info import companion_lines, doubt_lines, missing_lines, run_lines

_SHOWN_OF_SCAN = {"tip_radius_m", "stated_length_m", "stated_pitch_m", "stated_points", "doubtful"}
_INSTALL = "install it: pip install 'tribolab[formats]'"


def file_lines(path: Path, instrument: str | Path | None = None) -> list[str]:
    """Return lines on how a raw file is read: as a run, a scan, a modulus or tester's results.

    Raises
    ------
    ReadError
        If the file cannot be read.
    ConfigError
        If the instrument does not exist.
    """
    with tempfile.TemporaryDirectory() as folder:
        part = write_excerpt(path, Path(folder))
        if part is not None and (lines := _excerpt_lines(part, path, instrument)):
            return lines
    kind = kind_of(path, instrument)
    if kind == "unknown" and is_modulus_file(path):
        return _modulus_lines(path)
    drafted = kind == "unknown" and is_run_file(path)
    if drafted or kind == "run":
        log = read_log(path, instrument)
        facts = file_facts(log, path, instrument)
        more = [] if drafted else companion_lines(describe_companion(path, instrument, log))
        more = more or missing_lines(facts, log.columns)
        return run_lines(facts) + more + doubt_lines(log.columns)
    with importing():
        plain_arrays_only()
    return _results_lines(path) if kind == "results" else _scan_lines(path, instrument)


def _excerpt_lines(part: Excerpt, path: Path, instrument: str | Path | None) -> list[str]:
    """Return lines on how a long run is read, from an excerpt; empty if this does not suffice."""
    try:
        kind = kind_of(path, instrument)
        drafted = kind == "unknown" and is_run_file(path)
        if not drafted and (kind != "run" or has_companion(path, instrument)):
            return []
        log = read_log(path, instrument, part.file)
    except ReadError:  # perhaps caused by the gaps of the excerpt: the whole file is read instead
        return []
    facts = file_facts(log, path, instrument)
    whole = facts["left_out"] or facts["are_points"] or facts["steps"]
    if whole or RunAttributes.from_attrs(log.attrs).time_source != "recorded":
        return []
    header = part.lines - facts["rows"]
    rows = part.lines_of_whole - header
    facts["rows"], facts["longest_interval_s"] = round(rows, 3 - len(str(rows))), None
    lines = run_lines(facts)
    share = part.file.stat().st_size / path.stat().st_size
    lines.insert(
        2,
        f"  only {share:.1%} of the file was read: the number of rows is an estimate, and ranges "
        "refer to that part (`tribolab check` reads all)",
    )
    more = [] if drafted else companion_lines(describe_companion(path, instrument, log))
    return lines + (more or missing_lines(facts, log.columns)) + doubt_lines(log.columns)


def _modulus_lines(path: Path) -> list[str]:
    """Return lines on a table of storage and loss modulus, and on its use in a campaign file."""
    name = f'name it as modulus_file = "{shown(path.name)}" in [contact] of a campaign file'
    try:
        table = read_modulus_table(path)
    except ReadError as error:
        what = f"a modulus over frequency: {error.what}"
        raise ReadError(what, where=error.where, cure=error.cure) from error
    omega = table.angular_frequency
    warm = f" at {table.temperature:.3g} C" if table.temperature == table.temperature else ""
    lines = [
        f"{path}: storage and loss modulus over frequency",
        f"  {omega.size} rows, {range_of(f'{omega[0]:.3g}', f'{omega[-1]:.3g}')} rad/s{warm}",
        f"  storage  {range_of(f'{table.storage.min():.3g}', f'{table.storage.max():.3g}')} Pa",
        f"  loss     {range_of(f'{table.loss.min():.3g}', f'{table.loss.max():.3g}')} Pa",
    ]
    return [*lines, *(f"  {remark}" for remark in table.remarks), f"  {name}"]


@dataclass(frozen=True)
class Described:
    """A raw file with its description in lines, or with the reason why it could not be read."""

    file: Path
    lines: tuple[str, ...] = ()
    error: str = ""


class Descriptions(Stage[tuple[Path, "str | Path | None"], Described, Described]):
    """Tasks of `tribolab info`: each raw file is read and described in lines."""

    name = "files"

    def __init__(self, files: Sequence[Path], instrument: str | Path | None) -> None:
        self._files = files
        self._instrument = instrument

    def plan(self) -> list[tuple[Path, str | Path | None]]:
        """Return a task for each file: the file and its instrument."""
        return [(file, self._instrument) for file in self._files]

    @staticmethod
    def work(task: tuple[Path, str | Path | None]) -> Described:
        """Return the description of one file."""
        return Described(task[0], tuple(file_lines(*task)))

    def failed(self, task: tuple[Path, str | Path | None], error: BaseException) -> Described:
        """Return the reason why a file could not be read; raise if the instrument is wrong."""
        if isinstance(error, TribolabError) and not isinstance(error, ReadError):
            raise error
        read = isinstance(error, ReadError)  # any other error is unexpected
        return Described(
            task[0], error=message_for(error, "terminal") if read else explain(error)[0]
        )

    def keep(
        self, task: tuple[Path, str | Path | None], place: int, record: Described
    ) -> Described:
        """Return the description of a file unchanged, because nothing is stored."""
        return record


def read_scan(path: Path, instrument: str | Path | None = None) -> dict[Path, Any]:
    """Return the traces of a scan by file; if it is no scan, raise the error as for a run."""
    # imported late for a quick start
    from tribolab.reading.scan_files import read_traces
    from tribolab.reading.scans.formats.profilometers import MissingUnitError
    from tribolab.reading.unknown.proposal.questions import GuessedError

    try:
        return read_traces(path, instrument)
    except ReadError as error:
        if _is_explained(path, error):
            raise
        if instrument is None and kind_of(path) == "unknown" and _is_text(path):
            # only the units of a map or profile are missing
            bare = isinstance(error, MissingUnitError) and not is_run_file(path, by_name=False)
            draft = draft_of(path)
            named = draft is not None and draft.kind == "table"
            try:
                known_log(path) if bare and not named else read_log(path)  # raises a specific error
            except ReadError as as_run:
                if bare:
                    known = "no known instrument writes such a file" if named else as_run.what
                    what = f"{known}; treated as a profile or map: {error.what}"
                    general = error.cure in ("", cures.MEND_UNITS, cures.SIZE)
                    name, drafts = cures.NAME_COLUMNS, cures.unknown_instrument(path, "")
                    ways = name if named else cures.either(name, drafts)  # a table has no draft
                    cure = ways if general else error.cure
                    raise ReadError(what, where=as_run.where, cure=cure) from error
                asks = isinstance(as_run, GuessedError)
                if isinstance(error, MissingLibraryError) and not asks:
                    what = f"{as_run.what}; profiles in such formats need SurfaceTopography"
                    raise ReadError(what, where=as_run.where, cure=_INSTALL) from error
                raise
        raise


def _is_explained(path: Path, error: ReadError) -> bool:
    """Whether the error of reading a scan is final, so that the file is not tried as a run."""
    # imported late for a quick start
    from tribolab.reading.scans.extent import RefusedScanError
    from tribolab.reading.scans.formats.undescribed import is_own_text
    from tribolab.reading.unknown.proposal.questions import GuessedError, questions

    if isinstance(error, RefusedError):
        return True
    if isinstance(error, GuessedError | RefusedScanError):
        return isinstance(error, RefusedScanError)  # with a guess, the file is also tried as a run
    try:
        check_regular(path)
        if is_own_text(path):
            return True
    except ReadError:  # the error explains it
        return True
    except OSError:
        return False
    draft = draft_of(path)
    return draft is not None and draft.kind == "scan" and draft.named and not questions(draft)


def _is_text(path: Path) -> bool:
    try:
        return peek(path).format == "text"
    except ReadError:
        return not path.is_file() or path.stat().st_size == 0


def _scan_lines(path: Path, instrument: str | Path | None) -> list[str]:
    # imported late for a quick start
    from tribolab.reading.scans.extent import doubt_about_heights

    traces = list(read_scan(path, instrument).values())
    scan = traces[0]
    name = RunAttributes.from_attrs(scan.attrs).instrument
    axes = [axis for axis in ("x", "y") if scan.sizes.get(axis, 1) > 1]
    lines = [
        f"{path}: {_title_of(name, instrument)}",
        f"  {'profile' if axes == ['x'] else 'map'} of "
        f"{' x '.join(str(scan.sizes[axis]) for axis in axes)} points",
    ]
    if len(traces) > 1:
        lines.append(f"  {len(traces)} traces in the file; data of the first:")
    for axis in axes:
        values = scan[axis].values
        length = float(values[-1] - values[0])
        pitch = length / (values.size - 1)
        lines.append(f"  {axis}       {1e3 * length:.6g} mm, one point every {1e6 * pitch:.4g} um")
    low, high = float(scan["height"].min()), float(scan["height"].max())
    lines.append(f"  height  {1e6 * low:.6g} to {1e6 * high:.6g} um")
    if missing := int(scan["height"].isnull().sum()):
        lines.append(f"  {Count(missing):point|points} without a height")
    lines += stated_lines(scan.attrs)
    lines += areal_lines(scan) if "y" in axes else []
    lines += roughness_lines(scan)
    if doubt := doubt_about_heights(scan):
        lines.append(f"  doubtful: {doubt}")
    attrs = {key: value for key, value in scan.attrs.items() if key not in _SHOWN_OF_SCAN}
    return lines + metadata_lines(attrs, path)


def _results_lines(path: Path) -> list[str]:
    # imported late for a quick start
    from tribolab.reading.scans.results import read_tester_results

    results = read_tester_results(path)
    lines = [f"{path}: results of a roughness tester, without a profile"]
    for name, values in results.data_vars.items():
        unit = quantity(str(name)).unit
        lines.append(f"  {name}  {float(values):.6g}{'' if unit == '1' else f' {unit}'}")
    return lines + metadata_lines(results.attrs, path)


def _title_of(name: str, instrument: str | Path | None) -> str:
    """Return the instrument's name and title; the name alone if another library read the file."""
    known = instrument or (name if name in known_dialects() else None)
    return f"{name} ({load_dialect(known).title})" if known else name
