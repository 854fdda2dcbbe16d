"""Output of `tribolab info` on a raw file: a run, a scan, or results."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.app.info.excerpt import Excerpt, write_excerpt
from tribolab.app.info.scan_info import areal_lines, roughness_lines, stated_lines
from tribolab.app.quick import importing, plain_arrays_only
from tribolab.app.ranges import range_of
from tribolab.arrays.reversals import reversals
from tribolab.campaign.engine.stage import Stage
from tribolab.core.attributes import RunAttributes
from tribolab.core.errors import ReadError, TribolabError, message_for, shown
from tribolab.core.wording import Count, explain
from tribolab.reading import cures
from tribolab.reading.dialect.find import known_dialects, load_dialect
from tribolab.reading.interpret.missing import missing_inputs
from tribolab.reading.kinds import kind_of
from tribolab.reading.lexicon.lexicon import normalise_label, part_pattern
from tribolab.reading.moduli import is_modulus_file, read_modulus_table
from tribolab.reading.raw.opening import MissingLibraryError, RefusedError
from tribolab.reading.raw.source import check_regular
from tribolab.reading.runs.file_facts import (
    CompanionFacts,
    FileFacts,
    describe_companion,
    file_facts,
    has_companion,
)
from tribolab.reading.runs.force_ratio import doubt_about, doubt_about_coefficient
from tribolab.reading.runs.read_run import read_log as known_log
from tribolab.reading.text.cells import split_name
from tribolab.reading.text.first_bytes import peek
from tribolab.reading.unknown_run import draft_of, is_run_file, read_log
from tribolab.units.quantities import quantity

if TYPE_CHECKING:
    import numpy as np

_PROVENANCE = {"source", "source_sha256", "tribolab_version", "history", "Conventions"}
_PROVENANCE |= {"drafted_layout"}
_MAX_TEXT = 300  # characters of a file's own text
_SHOWN_ABOVE = {"instrument", "pitch_m", "length_m", "x_origin_m"}
_SHOWN_OF_SCAN = {"tip_radius_m", "stated_length_m", "stated_pitch_m", "stated_points", "doubtful"}
_INSTALL = "install it: pip install 'tribolab[formats]'"
_OF_MOTION = {"sliding_velocity", "position", "rotation_speed", "step", "set_speed"}
_UNIT_END = re.compile(r"_(m_s|m_per_s|s|m|N|Hz|K|Pa|rad|kg)$")
_UNITS = {"m_s": "m/s", "m_per_s": "m/s"}
_WORDS = {
    "speed_from": "sliding speed from",
    "time_origin_s": "first time",
    "time_source": "time from",
}
# attributes that say nothing beyond the lines above
_USUAL = {"speed_from": ("column", "none"), "time_origin_s": (0.0,), "time_source": ("recorded",)}
_ROUNDING = 1e-6  # share of a step: positions with smaller deviations are evenly spaced


def file_lines(path: Path, instrument: str | Path | None = None) -> list[str]:
    """Return how a raw file is interpreted: a run, a scan, or a roughness tester's results.

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
        return run_lines(facts) + (more or missing_lines(facts, log.columns)) + _doubts(log.columns)
    with importing():
        plain_arrays_only()
    return _results_lines(path) if kind == "results" else _scan_lines(path, instrument)


def _excerpt_lines(part: Excerpt, path: Path, instrument: str | Path | None) -> list[str]:
    """Return how a long run is interpreted, from an excerpt; empty if that does not suffice."""
    try:
        kind = kind_of(path, instrument)
        drafted = kind == "unknown" and is_run_file(path)
        if not drafted and (kind != "run" or has_companion(path, instrument)):
            return []
        log = read_log(path, instrument, part.file)
    except ReadError:  # the whole file gives the error, or is not cut without one
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
    return lines + (more or missing_lines(facts, log.columns)) + _doubts(log.columns)


def _modulus_lines(path: Path) -> list[str]:
    """Return lines on a table of storage and loss modulus, and how to use it in a campaign."""
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
    """File, its description in lines, and the reason why it could not be read."""

    file: Path
    lines: tuple[str, ...] = ()
    error: str = ""


class Descriptions(Stage[tuple[Path, "str | Path | None"], Described, Described]):
    """Stage of `tribolab info`: files and their interpretation."""

    name = "files"

    def __init__(self, files: Sequence[Path], instrument: str | Path | None) -> None:
        self._files = files
        self._instrument = instrument

    def plan(self) -> list[tuple[Path, str | Path | None]]:
        """Return the files with their instrument."""
        return [(file, self._instrument) for file in self._files]

    @staticmethod
    def work(task: tuple[Path, str | Path | None]) -> Described:
        """Describe one file."""
        return Described(task[0], tuple(file_lines(*task)))

    def failed(self, task: tuple[Path, str | Path | None], error: BaseException) -> Described:
        """Return why a file could not be described; raise for a wrong instrument."""
        if isinstance(error, TribolabError) and not isinstance(error, ReadError):
            raise error
        read = isinstance(error, ReadError)  # other files are still described
        return Described(
            task[0], error=message_for(error, "terminal") if read else explain(error)[0]
        )

    def keep(
        self, task: tuple[Path, str | Path | None], place: int, record: Described
    ) -> Described:
        """Return the record; nothing is stored."""
        return record


def read_scan(path: Path, instrument: str | Path | None = None) -> dict[Path, Any]:
    """Read the traces of a scan; a file that is no scan gives the error of a run."""
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
            # a map or profile that lacks units only
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
    """Whether an error explains completely what is wrong with a scan."""
    # imported late for a quick start
    from tribolab.reading.scans.extent import RefusedScanError
    from tribolab.reading.scans.formats.undescribed import is_own_text
    from tribolab.reading.unknown.proposal.questions import GuessedError, questions

    if isinstance(error, RefusedError):
        return True
    if isinstance(error, GuessedError | RefusedScanError):
        return isinstance(error, RefusedScanError)  # other errors are explained again
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
    return lines + _attribute_lines(attrs, path)


def _results_lines(path: Path) -> list[str]:
    # imported late for a quick start
    from tribolab.reading.scans.results import read_tester_results

    results = read_tester_results(path)
    lines = [f"{path}: results of a roughness tester, without a profile"]
    for name, values in results.data_vars.items():
        unit = quantity(str(name)).unit
        lines.append(f"  {name}  {float(values):.6g}{'' if unit == '1' else f' {unit}'}")
    return lines + _attribute_lines(results.attrs, path)


def _attribute_lines(attrs: Mapping[str, Any], path: str | Path) -> list[str]:
    others = {key: value for key, value in attrs.items() if key not in _PROVENANCE | _SHOWN_ABOVE}
    if float(others.get("x_unevenness", 1.0)) < _ROUNDING:
        del others["x_unevenness"]
    if "to_keep_it" in others:  # to be typed where `info` was
        # imported late for a quick start
        from tribolab.reading.unknown.proposal.questions import how_to_keep

        others["to_keep_it"] = how_to_keep(str(path))
    return [
        f"  {_key_words(key)}: {shown(_value_text(value) + _unit_of(key, value), _MAX_TEXT)}"
        for key, value in others.items()
        if value not in _USUAL.get(key, ())
    ]


def _unit_of(key: str, value: object) -> str:
    """Return the unit of a number, from the end of its key.

    Examples
    --------
    >>> _unit_of("track_radius_m", 0.02), _unit_of("set_speed_m_s", 0.01), _unit_of("step_m", "a")
    (' m', ' m/s', '')
    """
    end = _UNIT_END.search(key)
    known = end is not None and isinstance(value, float)
    return f" {_UNITS.get(end[1], end[1])}" if end is not None and known else ""


def _key_words(key: str) -> str:
    """Return the key of an attribute in words.

    Examples
    --------
    >>> _key_words("track_radius_m"), _key_words("speed_from"), _key_words("recorded_at")
    ('track radius', 'sliding speed from', 'recorded at')
    """
    return _WORDS.get(key) or _UNIT_END.sub("", key).replace("_", " ")


def _value_text(value: object) -> str:
    if isinstance(value, Mapping):
        return "; ".join(f"{name} = {text}" for name, text in value.items())
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _title_of(name: str, instrument: str | Path | None) -> str:
    """Return a dialect's name with its title; the bare name if another library read the file."""
    known = instrument or (name if name in known_dialects() else None)
    return f"{name} ({load_dialect(known).title})" if known else name


def run_lines(facts: FileFacts) -> list[str]:
    """Return how the raw file of a run is interpreted.

    Parameters
    ----------
    facts
        From `tribolab.reading.runs.file_facts.file_facts`.
    """
    title = f" ({facts['title']})" if facts["title"] else ""
    lines = [f"{facts['file']}: {facts['instrument'] or 'netCDF'}{title}"]
    sampling = f"  {Count(facts['rows']):row|rows} over {facts['duration_s']:.6g} s"
    if facts["are_points"]:
        sampling = (
            f"  {Count(facts['rows']):result|results}, each at one speed: its error is unknown"
        )
    elif facts["interval_s"] is not None:
        sampling += f", one every {facts['interval_s']:.3g} s"
        if facts["longest_interval_s"] is not None:
            sampling += f", at most {facts['longest_interval_s']:.3g} s"
    lines.append(sampling + (f", {Count(facts['steps']):step|steps}" if facts["steps"] else ""))
    if facts["left_out"]:
        lines.append(f"  left out: {facts['left_out']}")
    width = max((len(name) for name in facts["columns"]), default=0)
    for name, column in facts["columns"].items():
        span = range_of(f"{column['minimum']:.6g}", f"{column['maximum']:.6g}")
        span += f" {column['unit']}" if column["unit"] != "1" else ""
        label = f"   from '{shown(column['label'])}'" if column["label"] else ""
        lines.append(f"  {name:<{width}}  {span}{label}")
    if facts["not_used"]:
        lines.append(f"  not used: {', '.join(map(shown, facts['not_used']))}")
    lines += _attribute_lines(facts["metadata"], facts["file"])
    return lines


def missing_lines(facts: FileFacts, columns: Mapping[str, np.ndarray]) -> list[str]:
    """Return which inputs a run with a force lacks for friction over sliding speed.

    Parameters
    ----------
    facts
        From `tribolab.reading.runs.file_facts.file_facts`.
    columns
        Signals by quantity.
    """
    names = set(facts["columns"])
    forces = {"friction_force", "friction_coefficient", "shear_stress", "normal_force"}
    if not names & forces and names & _OF_MOTION:
        return []  # a motion log needs nothing else
    if "set_speed_m_s" in facts["metadata"]:
        names.add("set_speed")
    if facts["not_used"] and not names & {"sliding_velocity", "position", "set_speed"}:
        # imported late for a quick start
        from tribolab.reading.interpret.names import is_stroke_frequency

        if any(is_stroke_frequency(*split_name(label)) for label in facts["not_used"]):
            names.add("frequency")
    turned = any(part_pattern("sine").search(normalise_label(x)) for x in facts["not_used"])
    rig = {"crank"} if "drive" in facts["metadata"] or turned else set()  # if a crank turns
    if "friction_force" in columns and reversals(columns["friction_force"]):
        rig.add("reversals")
    lacks = missing_inputs(names, rig)
    return [f"  missing: {f'{x.what}: {x.option}' if x.option else x}" for x in lacks]


def _doubts(signals: Mapping[str, np.ndarray]) -> list[str]:
    """Return a line on forces or coefficients that are physically implausible."""
    doubt = ""
    if "friction_coefficient" in signals and "friction_force" not in signals:
        doubt = doubt_about_coefficient(signals["friction_coefficient"])
    elif {"friction_force", "normal_force"} <= set(signals):
        doubt = doubt_about(signals["friction_force"], signals["normal_force"])
    return [f"  doubtful: {doubt}"] if doubt else []


def companion_lines(facts: CompanionFacts) -> list[str]:
    """Return whether a run's second log was found, and how its clock was matched.

    Parameters
    ----------
    facts
        From `tribolab.reading.runs.file_facts.describe_companion`.
    """
    if "missing" in facts:
        return [f"  companion log: {facts['missing']} does not exist"]
    if "ways" not in facts:
        return [f"  companion log: refused: {facts['refused']}"] if facts else []
    lines = [f"  companion log: found ({facts['instrument']})"]
    if "refused" in facts:
        lines.append(
            f"  clock shift: cannot be determined from the signals ({facts['refused']}); state "
            "clock_shift in [[run]] of a campaign file"
        )
    else:
        lines.append(
            f"  clock shift: {facts['shift_s']:.6g} s, standard uncertainty "
            f"{facts['uncertainty_s']:.2g} s, {facts['source']}"
        )
    return lines + [
        f"    from {_WAYS.get(name, name)}: {way}" for name, way in facts["ways"].items()
    ]


_WAYS = {
    "classes": "classes of velocity",
    "starts": "the starts of motion",
    "motion": "a fit by distance, speed and acceleration",
}
