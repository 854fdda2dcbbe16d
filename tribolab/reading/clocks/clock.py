"""Clock of a run: joining of parts that restart, and repair of times that do not increase.

Time has to increase strictly from row to row; otherwise the run is refused with the row, unless
the dialect states a remedy. ``[time] restart = "continue"`` joins steps, files and parts of one
table whose clock restarts: by their start times if the file states them, else each part begins one
interval after the end of the previous one. A decrease by the range of a counter (65.536 s,
``wrap``) is a wrap: exactly that much is added. ``on_repeat = "drop"`` leaves out rows that are not
later than all rows before them, ``"interpolate"`` keeps them with evenly interpolated times. Rows
left out are counted by reason.
"""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import pieces
from tribolab.arrays.medians import median
from tribolab.arrays.scratch import room
from tribolab.core.errors import ReadError
from tribolab.reading.clocks.faults import Faults, find_faults, first_fault, rows_at_fault
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.si_tables.model import Content, Piece
from tribolab.reading.si_tables.steps import stated_interval, stated_pace
from tribolab.reading.text.dates import date_of, has_day, has_zone
from tribolab.units.conversion import to_si


class Mended(NamedTuple):
    """Strictly increasing time, mask of the rows kept (None: all), and the repairs."""

    time: np.ndarray
    keep: np.ndarray | None = None
    left_out: Mapping[str, int] = {}
    interpolated: int = 0


def set_time(content: Content, dialect: Dialect) -> None:
    """Set the time of each table from intervals, a rate, position and speed, or row numbers."""
    if dialect.time.source == "column":
        return
    if dialect.time.source == "period":
        _accumulate_intervals(content, dialect)
        return
    if dialect.time.source == "position":
        _set_time_from_position(content, dialect)
        return
    steps = [stated_interval(content, dialect, piece) for piece in content.pieces]
    start = 0.0
    for piece, step, following in zip(content.pieces, steps, [*steps[1:], 1.0], strict=True):
        rows = len(next(iter(piece.columns.values())))
        piece.columns["time"] = _even(start, rows, step)
        if dialect.time.restart == "error":
            start = (start + rows) * (step / following)


def recorded_at(started: dt.datetime | None, origin: float, dialect: Dialect) -> dt.datetime | None:
    """Return the start time of a run: from the file, or from a clock that counts from a date.

    Parameters
    ----------
    started
        Start time stated before the table.
    origin
        First time of the clock [s].
    dialect
        The dialect.
    """
    clock = dialect.time
    if started is not None or not (clock.epoch or (clock.format and has_day(clock.format))):
        return started
    try:
        moment = date_of(clock.epoch or "unix", origin)
    except OverflowError:
        return None
    if clock.format and not has_zone(clock.format):
        return moment.replace(tzinfo=None)
    return moment


def _accumulate_intervals(content: Content, dialect: Dialect) -> None:
    """Convert intervals to times; each row states the time since the row before."""
    past = 0.0
    for piece in content.pieces:
        time = piece.columns["time"]
        for first, last in pieces(0, len(time)):
            part = time[first:last]
            if (bad := ~(part >= 0)).any():
                row = first + int(np.argmax(bad)) + 1
                what = f"the interval of row {row} is {part[row - first - 1]:.9g} s"
                raise ReadError(
                    f"{what}; it has to be a number and not negative (instrument "
                    f"'{dialect.name}', time.source = 'period')",
                    where=content.path,
                )
            np.cumsum(part, out=part)
            part += past
            past = float(part[-1])
        if dialect.time.restart == "continue":
            past = 0.0


def _set_time_from_position(content: Content, dialect: Dialect) -> None:
    """Compute time from a position and the stated speed; each piece starts at zero."""
    pace = stated_pace(content, dialect)
    for piece in content.pieces:
        position = piece.columns["position"]
        piece.columns["time"] = np.abs(position - position[0]) / pace


def _even(start: float, rows: int, step: float) -> np.ndarray:
    time = room(rows)
    for first, last in pieces(0, rows):
        time[first:last] = (start + np.arange(first, last)) * step
    return time


def join_clocks(contents: list[Content], dialect: Dialect) -> dict[str, np.ndarray | str]:
    """Shift times so that tables and parts of tables follow each other, if the dialect says so.

    Returns
    -------
    dict
        ``part``: number of the part, from 1, of each row of the run, if a clock restarts inside a
        table; ``joined``: restarts and wraps in words. Empty without any.
    """
    wrap = _wrap(dialect)
    pieces = [piece for content in contents for piece in content.pieces]
    if dialect.time.restart != "continue" and not wrap:
        return {}
    parts, texts = [], []
    for piece in pieces:
        time = piece.columns["time"]
        part = np.zeros(len(time), dtype=np.int32)
        if first_fault(time) is not None:
            starts = find_faults(time, wrap)
            if dialect.time.restart != "continue":
                kept = tuple(start for start in starts.starts if start.period)
                starts = starts._replace(starts=kept)
            time += starts.offsets()
            part[[start.row for start in starts.starts if not start.period]] = 1
            texts += _in_words(starts, time)
        parts.append(np.cumsum(part, dtype=np.int32))
    if dialect.time.restart == "continue" and len(pieces) > 1:
        _join_pieces(pieces, dialect)
    restarts = any(part[-1] for part in parts if part.size)
    columns: dict[str, np.ndarray | str] = {"joined": "; ".join(texts)} if texts else {}
    if restarts:
        before = np.cumsum([0, *(part[-1] + 1 if part.size else 0 for part in parts[:-1])])
        numbers = [part + first + 1 for part, first in zip(parts, before, strict=True)]
        columns["part"] = np.concatenate(numbers).astype(np.int32)
    return columns


def _wrap(dialect: Dialect) -> float:
    return to_si(dialect.time.wrap, "s", "time.wrap") if dialect.time.wrap else 0.0


def _in_words(faults: Faults, time: np.ndarray) -> list[str]:
    texts = []
    restarts = [start.row + 1 for start in faults.starts if not start.period]
    if restarts:
        rows = ", ".join(str(row) for row in restarts[:5]) + (" ..." if len(restarts) > 5 else "")
        texts.append(f"the clock restarts within the table, {_times(len(restarts))}, at row {rows}")
    periods = [start.period for start in faults.starts if start.period]
    if periods:
        texts.append(f"the clock wraps after {periods[0]:.9g} s, {_times(len(periods))}")
    return texts


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _join_pieces(pieces: list[Piece], dialect: Dialect) -> None:
    """Join tables in time: by their start times, else each after the end of the previous one."""
    stamps = [piece.started for piece in pieces]
    times = [piece.columns["time"] for piece in pieces]
    ends = zip(times, times[1:], strict=False)
    dated = None not in stamps
    if not dated and all(later[0] > earlier[-1] for earlier, later in ends):
        return  # the clock is continuous
    first, end = stamps[0], None
    for time, stamp in zip(times, stamps, strict=True):
        if dated and first is not None and stamp is not None:
            time += (stamp - first).total_seconds()
            if end is not None and 0 <= end - time[0] <= _resolution(stamp, dialect):
                time += end - time[0] + _interval(time)
        elif end is not None:
            time += end if time[0] > 0 else end - time[0] + _interval(time)
        end = time[-1]


def _resolution(stamp: dt.datetime, dialect: Dialect) -> float:
    """Return the resolution [s] of start times, which are often rounded to seconds."""
    form = dialect.time.start_format or ""
    return 1.0 if any(code in form for code in ("%S", "%T", "%X", "%c")) else 60.0


def _interval(time: np.ndarray) -> float:
    return float(median(np.diff(time))) if len(time) > 1 else 1.0


def mended_time(time: np.ndarray, where: str, dialect: Dialect) -> Mended:
    """Return strictly increasing times, repaired as the dialect states.

    Parameters
    ----------
    time
        Time [s] (time), after parts have been joined.
    where
        The file, for messages.
    dialect
        The dialect.

    Raises
    ------
    ReadError
        If time does not increase and the dialect states no remedy.
    """
    row = first_fault(time)
    if row is None:
        return Mended(time)
    faults = find_faults(time, _wrap(dialect))
    if dialect.time.on_repeat == "error" or (
        dialect.time.on_repeat == "interpolate" and faults.starts
    ):
        raise ReadError(_refusal(time, row, faults, where, dialect))
    good = ~rows_at_fault(time, faults)
    if not good.any():
        raise ReadError(f"{where}: not one time is a finite number")
    if dialect.time.on_repeat == "interpolate":
        return Mended(_interpolated(time, good), interpolated=int((~good).sum()))
    return Mended(time, good, _reasons(time, good, faults))


def _interpolated(time: np.ndarray, good: np.ndarray) -> np.ndarray:
    """Interpolate the times of bad rows evenly between those of good rows."""
    rows = np.flatnonzero(good)
    if rows.size < 2:
        return time[rows[0]] + np.arange(len(time)) - rows[0]
    result = np.interp(np.arange(len(time)), rows, time[rows])
    step = float(median(np.diff(time[rows]) / np.diff(rows)))
    first, last = rows[0], rows[-1]
    result[:first] = time[first] - step * np.arange(first, 0, -1)
    result[last + 1 :] = time[last] + step * np.arange(1, len(time) - last)
    return result


def _reasons(time: np.ndarray, good: np.ndarray, faults: Faults) -> dict[str, int]:
    """Return the number of rows left out, by reason."""
    lost = ~good
    counts = {"without a time": int(np.count_nonzero(lost & faults.missing))}
    lost &= ~faults.missing
    if faults.starts:
        later = lost & (np.arange(len(time)) >= faults.starts[0].row)
        counts["after the clock restarted (restart = 'continue' would keep them)"] = int(
            np.count_nonzero(later)
        )
        lost &= ~later
    counts["whose time is not later than before (on_repeat = 'interpolate' would keep them)"] = int(
        np.count_nonzero(lost)
    )
    return {reason: count for reason, count in counts.items() if count}


def _refusal(time: np.ndarray, row: int, faults: Faults, where: str, dialect: Dialect) -> str:
    """Return the message for a row at which time does not increase, with possible remedies."""
    if faults.starts:
        row = min(row, faults.starts[0].row)
    if np.isinf(time[row]):
        what = f"time is infinite in row {row + 1}"
    elif np.isnan(time[row]):
        what = f"time is missing in row {row + 1}"
    elif time[row] == time[row - 1]:
        what = f"time stands still at row {row + 1}: {time[row]:.9g} s twice"
    else:
        what = (
            f"time goes backwards at row {row + 1}: from {time[row - 1]:.9g} s to {time[row]:.9g} s"
        )
    if faults.starts and faults.starts[0].row == row:
        period = faults.starts[0].period
        what += ", as of a counter that wraps" if period else ", and goes on from there"
        what += f" every {period:.9g} s" if period else ""
    return (
        f"{where}: {what}; the dialect '{dialect.name}' can define what to do: [time] restart = "
        "'continue' joins parts whose clock restarts or wraps; for single rows, on_repeat = "
        "'interpolate' gives them times between their neighbours', 'drop' leaves them out"
    )
