"""Read a run: one raw file, the two logs of a run, or the files of its cycles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TypedDict

import numpy as np
import pandas as pd
import xarray as xr
from xarray.indexes import PandasIndex

from tribolab.errors import ReadError, shown
from tribolab.io import cures
from tribolab.io.clocks.clock import join_clocks, mended_time, recorded_at, set_time
from tribolab.io.content.model import Content
from tribolab.io.content.newest_first import oldest_first
from tribolab.io.content.read import read_content
from tribolab.io.content.values import single_values, step_values
from tribolab.io.derived import add_derived
from tribolab.io.dialects.column_rule import FRICTION
from tribolab.io.dialects.find import (
    Dialect,
    Instrument,
    is_scan,
    known_dialects,
    load_dialect,
    recognise,
)
from tribolab.io.dialects.signature import peek
from tribolab.io.logs import PathLike, companion_name, companion_path
from tribolab.io.row_counts import (
    ROW_ATTRIBUTES,
    row_attributes,
    rows_in_words,
    with_companion_rows,
)
from tribolab.io.speed import add_speed, keep_settings
from tribolab.io.two_rates import sampled_together
from tribolab.io.zero_reading import take_zeros
from tribolab.pieces import chosen, concatenated
from tribolab.provenance import CONVENTIONS, as_text, history_line
from tribolab.quantities import QUANTITIES
from tribolab.stamping import stamp
from tribolab.units import positive, to_si
from tribolab.untyped import Json

Logs = list[tuple[Path, Dialect]]


class Reading(TypedDict, total=False):
    """What may be said of reading a run, besides its files and instrument; see `tribolab.read`."""

    pair: bool
    clock_shift: str | float | None
    zero: str | None
    moving_mass: str | float | None


def read_run(
    path: PathLike | Sequence[PathLike],
    instrument: Instrument | None = None,
    *,
    pair: bool = True,
    clock_shift: str | float | None = None,
    zero: str | None = None,
    moving_mass: str | float | None = None,
) -> xr.Dataset:
    """Read one run from its raw file or files, whose names are taken as they are.

    Parameters
    ----------
    path, instrument, pair, clock_shift, zero, moving_mass
        As for `tribolab.read`, but for patterns.

    Returns
    -------
    xarray.Dataset
        As from `tribolab.read`.

    Raises
    ------
    ReadError
        If the file cannot be read; the message says what, where and how to mend it.
    ConfigError
        If there is no such instrument.
    """
    paths = [Path(path)] if isinstance(path, str | Path) else [Path(p) for p in path]
    if not paths:
        raise ReadError("no file is given")
    shift = None if clock_shift is None else to_si(clock_shift, "s", "clock_shift")
    other = instrument is not None and load_dialect(instrument).format in ("hdf5", "binary")
    if len(paths) == 1 and not other and peek(paths[0]).format == "netcdf":
        from tribolab.io.own_run import read_own_run

        return read_own_run(paths[0])
    dialects = _dialects(paths, instrument)
    for file, dialect in zip(paths, dialects, strict=True):
        if is_scan(dialect):
            what = f"this looks like a profile ({shown(dialect.title)})"
            raise ReadError(what, where=file, cure=cures.PROFILE)
    main, companions = _sorted_out(paths, dialects)
    if pair and len(main) == 1 and not companions:
        companions = _companion(*main[0])
    run = _run(main, zero)
    mass = main[0][1].moving_mass if moving_mass is None else moving_mass
    if len(companions) > 1:
        raise ReadError(f"{companions[0][0]}: more than one companion log is given")
    if companions:
        return _without_inertia(_joined(run, companions, shift), mass)
    if pair and (expected := companion_name(*main[0])):
        run.attrs["companion_missing"] = expected
    return _without_inertia(run, mass)


def with_companion(run: xr.Dataset, path: Path, dialect: Dialect) -> xr.Dataset:
    """Return a run together with its second log, whose clock is matched by the signals.

    Parameters
    ----------
    run
        The main log (time).
    path
        The second log.
    dialect
        That of the main log, which names that of the second.

    Raises
    ------
    ReadError
        If the second log cannot be read, or does not belong to the run.
    """
    assert dialect.pair is not None  # whoever asks has found the second log by it
    return _joined(run, [(path, load_dialect(dialect.pair.instrument))], None)


def _joined(run: xr.Dataset, companions: Logs, shift: float | None) -> xr.Dataset:
    from tribolab.io.clocks.merge import merge

    motion = _run(companions)
    return with_companion_rows(merge(run, motion, shift), run, motion)


def _without_inertia(run: xr.Dataset, mass: str | float | None) -> xr.Dataset:
    """Take the inertia of a mass out, if one is stated."""
    if mass is None:
        return run
    from tribolab.io.inertia import take_inertia

    where = str(run.attrs["source"])
    return take_inertia(
        run, positive(mass, "kg", "moving_mass"), where, moving_mass_source="stated"
    )


class ColumnFacts(TypedDict):
    """What a quantity was called, and between which values it lies, in SI."""

    label: str
    unit: str
    minimum: float
    maximum: float


class FileFacts(TypedDict):
    """What was understood of a raw file; see `describe`."""

    file: str
    instrument: str
    title: str
    columns: dict[str, ColumnFacts]
    not_used: list[str]
    rows: int
    duration_s: float
    interval_s: float | None
    longest_interval_s: float | None
    steps: int | None
    left_out: str
    metadata: dict[str, object]


def describe(path: PathLike, instrument: Instrument | None = None) -> FileFacts:
    """Say what was understood of one raw file.

    Parameters
    ----------
    path
        The file.
    instrument
        As for `read_run`.

    Returns
    -------
    dict
        ``file``, ``instrument``, ``title``, ``columns`` (quantity -> label, unit, minimum and
        maximum in SI), ``not_used``, ``rows``, ``duration_s``, ``interval_s`` (median),
        ``longest_interval_s``, ``steps``, ``left_out`` (rows of the file that are not in the run,
        and why; empty if all are) and ``metadata``.

    Raises
    ------
    ReadError
        If the file cannot be read.
    """
    return facts_of(read_run(path, instrument, pair=False), path, instrument)


def facts_of(run: xr.Dataset, path: PathLike, instrument: Instrument | None = None) -> FileFacts:
    """Say what was understood of one raw file that is read already; see `describe`.

    Parameters
    ----------
    run
        The run (time).
    path, instrument
        As for `describe`.
    """
    time = run["time"].to_numpy()
    gaps = np.diff(time)
    labels = run.attrs.get("columns_used", {})
    columns: dict[str, ColumnFacts] = {
        str(name): {
            "label": labels.get(str(name), ""),
            "unit": run[name].attrs.get("units", ""),
            "minimum": float(run[name].min()),
            "maximum": float(run[name].max()),
        }
        for name in run.data_vars
        if run[name].dtype.kind in "fiu"
    }
    name = str(run.attrs.get("instrument", ""))
    known = known_dialects()
    title = load_dialect(instrument or name).title if instrument or name in known else ""
    known_attrs = {"source", "source_sha256", "tribolab_version", "history", "Conventions"}
    known_attrs |= {"columns_not_used", "columns_used", "instrument", *ROW_ATTRIBUTES}
    unused = str(run.attrs.get("columns_not_used", ""))
    return {
        "file": str(path),
        "instrument": name,
        "title": title,
        "columns": columns,
        "not_used": unused.split("; ") if unused else [],
        "rows": len(time),
        "duration_s": float(time[-1]) if len(time) else 0.0,
        "interval_s": float(np.median(gaps)) if len(gaps) else None,
        "longest_interval_s": float(gaps.max()) if len(gaps) else None,
        "steps": int(np.unique(run["step"]).size) if "step" in run else None,
        "left_out": rows_in_words(run.attrs),
        "metadata": {k: v for k, v in run.attrs.items() if k not in known_attrs},
    }


def _dialects(paths: list[Path], instrument: Instrument | None) -> list[Dialect]:
    """Dialect of each file; a companion log has its own, told by the ending of its name."""
    if instrument is None:
        return [recognise(path) for path in paths]
    dialect = load_dialect(instrument)
    rule = dialect.pair
    return [
        load_dialect(rule.instrument) if rule and path.stem.endswith(rule.other) else dialect
        for path in paths
    ]


def _sorted_out(paths: list[Path], dialects: list[Dialect]) -> tuple[Logs, Logs]:
    """Separate main logs from companions."""
    logs = list(zip(paths, dialects, strict=True))
    second = {dialect.pair.instrument for dialect in dialects if dialect.pair}
    main = [log for log in logs if log[1].name not in second]
    companions = [log for log in logs if log[1].name in second]
    names = {dialect.name for _, dialect in main}
    if len(names) > 1:
        raise ReadError(
            f"{paths[0]}: the files of one run come from different instruments: "
            f"{', '.join(sorted(names))}; read them one by one"
        )
    return main, companions


def _companion(path: Path, dialect: Dialect) -> Logs:
    """Return the companion log, if the instrument writes one and it lies beside the file."""
    other = companion_path(path, dialect)
    if other is None or dialect.pair is None or not other.is_file():
        return []
    return [(other, load_dialect(dialect.pair.instrument))]


def _run(logs: Logs, zero: str | None = None) -> xr.Dataset:
    """Make one run of the files of one instrument."""
    dialect = logs[0][1]
    size = sum(peek(path).size for path, _ in logs) if len(logs) > 1 else 0
    contents = [read_content(path, dialect, size) for path, _ in logs]
    for content in contents:
        set_time(content, dialect)
    contents = [oldest_first(content) for content in contents]
    starts = [content.pieces[0].started for content in contents]
    dated = [(start, content) for start, content in zip(starts, contents, strict=True) if start]
    if len(dated) == len(contents):
        contents = [content for _, content in sorted(dated, key=lambda pair: pair[0])]
    joined = join_clocks(contents, dialect)
    columns = _columns(contents, dialect)
    if "part" in joined and "step" not in columns:
        columns["step"] = np.asarray(joined["part"])
    more, step_attrs = step_values(contents, dialect)
    columns |= more
    attrs = single_values(contents[0], dialect) | step_attrs
    where = "; ".join(str(content.path) for content in contents)
    mended = mended_time(columns.pop("time"), where, dialect)
    time = mended.time
    if mended.keep is not None:
        time = chosen(time, mended.keep)
        for name in columns:  # one by one, so that what is left out does not stay in memory
            columns[name] = chosen(columns[name], mended.keep)
    rows = len(time)
    time, columns, together = sampled_together(columns, time)
    origin = float(time[0])
    time -= origin
    rules = {column.key: column.zero for column in dialect.column if column.zero}
    if zero is not None:
        rules |= {name: zero for name in FRICTION if name in columns}

    def blank(name: str) -> Mapping[str, np.ndarray]:
        return _blank(contents[0].path.parent / name, dialect)

    attrs |= take_zeros(columns, time, rules, blank, where)
    keep_settings(columns, _symbols(contents, dialect), attrs, where, dialect)
    add_derived(columns, _symbols(contents, dialect), attrs, time.size, where, dialect)
    add_speed(columns, attrs, time, where, dialect)
    _check_normal_force(columns, contents[0], where, dialect)
    attrs |= _attributes(contents, dialect, origin)
    attrs |= row_attributes(rows, contents, mended, dialect) | together
    if "joined" in joined:
        attrs["clock_joined"] = str(joined["joined"])
    data = xr.Dataset(
        {name: ("time", values) for name, values in columns.items()},
        coords=xr.Coordinates.from_xindex(PandasIndex(pd.Index(time, copy=False), "time")),
        attrs=attrs,
    )
    return stamp(data)


def _blank(path: Path, dialect: Dialect) -> dict[str, np.ndarray]:
    """Return the columns of a blank run."""
    content = read_content(path, dialect)
    set_time(content, dialect)
    return _columns([content], dialect)


def _symbols(contents: list[Content], dialect: Dialect) -> dict[str, str]:
    """SI units of what is no quantity, and there for formulas only."""
    of_steps = {
        value.name: value.si_unit
        for value in dialect.value
        if value.source == "step" and value.unit is not None and value.name not in QUANTITIES
    }
    return of_steps | {k: v for content in contents for k, v in content.symbols.items()}


def _columns(contents: list[Content], dialect: Dialect) -> dict[str, np.ndarray]:
    """Arrays of the whole run, with ``step`` and ``cycle`` where there are several."""
    pieces = [piece for content in contents for piece in content.pieces]
    lengths = [len(piece.columns["time"]) for piece in pieces]
    names = dict.fromkeys(name for piece in pieces for name in piece.columns)
    if len(pieces) == 1:
        columns = dict(pieces[0].columns)
    else:
        columns = {
            name: concatenated(
                [
                    piece.columns.get(name, np.full(length, np.nan))
                    for piece, length in zip(pieces, lengths, strict=True)
                ]
            )
            for name in names
        }
    if pieces[0].step is not None and "step" not in columns:
        columns["step"] = np.repeat([piece.step for piece in pieces], lengths).astype(np.int32)
    if len(contents) > 1:
        numbers = [n for n, content in enumerate(contents, 1) for _ in content.pieces]
        columns["cycle"] = np.repeat(numbers, lengths).astype(np.int32)
    return columns


def _check_normal_force(
    columns: dict[str, np.ndarray], content: Content, where: str, dialect: Dialect
) -> None:
    force = columns.get("normal_force")
    if force is None or np.nanmax(force) > 0:
        return
    raise ReadError(
        f"{where}: the normal force ('{shown(content.labels['normal_force'])}') is nowhere above "
        f"zero (greatest {np.nanmax(force):.4g} N); if the instrument counts pressing as negative, "
        f"say sign = -1 for the column in the dialect '{dialect.name}'"
    )


_TIME_FROM = {
    "column": "recorded",
    "period": "recorded",
    "rate": "sample rate",
    "none": "row number",
}


def _speed_from(dialect: Dialect) -> str:
    by_formula = any(rule.quantity == "sliding_velocity" for rule in dialect.derived)
    return "formula" if by_formula else dialect.speed.source


def _attributes(contents: list[Content], dialect: Dialect, origin: float) -> Json:
    """Provenance, and what else the run should know of its files."""
    from tribolab.version import __version__

    labels = {name: label for content in contents for name, label in content.labels.items()}
    unused = dict.fromkeys(name for content in contents for name in content.not_used)
    attrs: Json = {
        "source": "; ".join(as_text(content.path.name) for content in contents),
        "source_sha256": "; ".join(content.sha256 for content in contents),
        "tribolab_version": __version__,
        "history": history_line(f"read as {dialect.name}"),
        "Conventions": CONVENTIONS,
        "instrument": dialect.name,
        "columns_used": labels,
        "columns_not_used": "; ".join(unused),
        "time_origin_s": origin,
        "time_source": _TIME_FROM[dialect.time.source],
        "speed_from": _speed_from(dialect),
    }
    recorded = recorded_at(contents[0].pieces[0].started, origin, dialect)
    if recorded is not None:
        attrs["recorded_at"] = recorded.isoformat()
    for column in dialect.column:
        if column.key in labels:
            attrs.update(column.attributes)
    if stated := dialect.uncertainty.plain():
        attrs["uncertainty"] = stated
    for content in contents:
        attrs.update(content.notes)
    return attrs
