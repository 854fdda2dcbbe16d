"""Reading of runs from files with named columns: HDF5, MAT, TDMS, Parquet, workbooks, records."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.core.provenance import sha256_of_file
from tribolab.reading.dialect.column_rule import FRICTION_SIGNALS
from tribolab.reading.dialect.columns import AGAIN, ReadColumn, resolve, scales_of, symbols
from tribolab.reading.dialect.containers import name_and_unit, open_as, table_of
from tribolab.reading.dialect.file_layout import Marks
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.raw.clocks import OneClock, on_one_clock
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable, text_of
from tribolab.reading.si_tables.model import Content, Piece
from tribolab.reading.si_tables.steps import started
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.reading.text.cells import split_name
from tribolab.units.conversion import conversion


def read_columns(path: Path, dialect: Dialect) -> Content:
    """Read a run from a file with named columns, such as HDF5, TDMS or a workbook.

    Parameters
    ----------
    path
        The file.
    dialect
        Format of the file, and the quantity of each column.

    Raises
    ------
    ReadError
        If the file is damaged, a column is missing or not numeric, or columns differ in length.
    """
    file = _opened(path, dialect)
    table = table_of(file, dialect)
    signals, not_used = _resolved(path, table, dialect)
    clocks = _one_clock(path, table, signals) if dialect.time.rate_pattern else None
    columns = _in_si(path, table, signals, clocks)
    notes = dict(file.notes)
    if clocks is not None and clocks.others:
        notes["interpolated"] = _interpolated(signals, clocks)
    before = text_of([clocks.setting, *table.settings] if clocks else table.settings)
    if dialect.marks is not None:
        columns["step"], more = _marked_steps(path, file, columns["time"], dialect.marks)
        notes |= more
    piece = Piece(columns, None, started(before, path, dialect), before)
    labels = {s.quantity: f"{s.label} [{s.unit}]" for s in signals}
    unused, own = tuple(dict.fromkeys(not_used)), symbols(signals, dialect)
    sha256, scales = sha256_of_file(path), scales_of(signals)
    return Content(path, sha256, [piece], labels, unused, {}, notes, own, scales)


def _opened(path: Path, dialect: Dialect) -> RawFile:
    try:
        return open_as(path, dialect)
    except (ReadError, ImportError):
        raise
    except Exception as error:  # each of these libraries reports damage differently
        what = f"this {dialect.format} file cannot be read: {shown(str(error), 200)}"
        raise ReadError(what, where=path) from error


def _resolved(path: Path, table: RawTable, dialect: Dialect) -> tuple[list[ReadColumn], list[str]]:
    named = [name_and_unit(column) for column in table.columns]
    names, units = [name for name, _ in named], [unit for _, unit in named]
    return resolve(str(path), names, units, len(names), dialect)


def _one_clock(path: Path, table: RawTable, signals: list[ReadColumn]) -> OneClock | None:
    """Return the signals at the times of the friction signal, or else of the fastest signal."""
    names = [signal.quantity.split(AGAIN)[0] for signal in signals]
    lead = next((names.index(name) for name in FRICTION_SIGNALS if name in names), None)
    try:
        return on_one_clock([table.columns[signal.place] for signal in signals], lead)
    except ReadError as error:
        raise ReadError(error, where=path) from error


def _interpolated(signals: list[ReadColumn], clocks: OneClock) -> str:
    return "; ".join(
        f"{signals[place].quantity}: a value every {clock.interval:.6g} s, the first "
        f"{clock.start - clocks.clock.start:.6g} s from the first of the run"
        for place, clock in clocks.others.items()
    )


def _in_si(
    path: Path, table: RawTable, signals: list[ReadColumn], clocks: OneClock | None
) -> dict[str, np.ndarray]:
    raw = [table.columns[s.place].values for s in signals] if clocks is None else clocks.values
    columns = {s.quantity: _scaled(path, s, x) for s, x in zip(signals, raw, strict=True)}
    lengths = sorted({len(column) for column in columns.values()})
    if len(lengths) > 1:
        whose = f" of '{shown(table.name, 40)}'" if table.name else ""
        raise ReadError(f"the columns{whose} differ in length: {lengths}", where=path)
    return columns


def _scaled(path: Path, signal: ReadColumn, values: np.ndarray) -> np.ndarray:
    if values.dtype.kind in "Mm":
        values = seconds_of(values)
    if values.dtype.kind not in "fiub":
        odd = f": '{shown(str(values[0]), 40)}' is not one" if values.size else ""
        raise ReadError(f"column '{shown(signal.label)}' holds no numbers{odd}", where=path)
    with np.errstate(over="ignore", invalid="ignore"):  # damaged files may contain any number
        return np.asarray(values, dtype=float) * signal.scale + signal.offset


def seconds_of(values: np.ndarray) -> np.ndarray:
    """Return moments as seconds since 1970, and durations as seconds; NaT becomes NaN.

    >>> seconds_of(np.array(["1970-01-01T00:01:00.5", "NaT"], dtype="datetime64[ms]")).tolist()
    [60.5, nan]
    """
    known = ~np.isnat(values)
    since = values.astype("datetime64[ns]" if values.dtype.kind == "M" else "timedelta64[ns]")
    return np.where(known, since.astype(np.int64) / 1e9, np.nan)


def _marked_steps(
    path: Path, file: RawFile, time: np.ndarray, marks: Marks
) -> tuple[np.ndarray, dict[str, str]]:
    """Return the step number of each row, and notes; step k lasts from mark k to mark k + 1."""
    table = next((table for table in file.tables if table.name == marks.group), None)
    clocks: list[RawColumn] = [] if table is None else list(table.columns)
    clocks = [column for column in clocks if split_name(column.label)[0] == marks.time]
    if table is None or not clocks:
        raise ReadError(
            f"there is no channel '{shown(marks.time)}' in a group '{shown(marks.group)}'",
            where=path,
        )
    unit = marks.unit or name_and_unit(clocks[0])[1]
    if unit is None:
        raise ReadError(
            "the marks' time has no unit; give it in the dialect: [marks] unit", where=path
        )
    at = np.sort(np.asarray(clocks[0].values, dtype=float) * conversion(unit, "s")[0])
    pattern = guarded(marks.labels) if marks.labels else None
    texts = [s.text for s in table.settings if pattern is not None and pattern.search(s.key)]
    notes = {"step_labels": "; ".join(texts)} if texts else {}
    return np.searchsorted(at, time, side="right").astype(float), notes
