"""One clock for a run: steps that start anew are joined, and time strictly increases.

Rules, stated once. Time has to increase from row to row; a run in which it stands still or goes
back is refused, with the row, unless the dialect says what to do: ``[time] on_repeat = "drop"``
leaves out rows that are not later than all rows before them, ``[time] restart = "continue"`` joins
steps (or files) whose clock starts anew: by the moments at which they started where the file says
so, else each begins where the one before it ended.
"""

from __future__ import annotations

import numpy as np

from tribolab.errors import ReadError
from tribolab.io.dialect_model import Dialect
from tribolab.io.pieces import Content, last_match
from tribolab.units import to_si

_BLOCK = 1 << 18  # samples looked at in one go, so that no second array of full length is made


def set_time(content: Content, dialect: Dialect) -> None:
    """Give pieces without a time column one from the sample rate (or from the row numbers)."""
    if dialect.time.source == "column":
        return
    step = 1.0
    if dialect.time.rate_pattern:
        found = last_match(dialect.time.rate_pattern, content.pieces[0].before)
        if found is None:
            raise ReadError(
                f"{content.path}: no sample rate matches '{dialect.time.rate_pattern}' "
                f"(instrument '{dialect.name}', time.rate_pattern)"
            )
        step = 1.0 / to_si(f"{found} {dialect.time.rate_unit}", "Hz", str(content.path))
    elif dialect.time.rate:
        step = 1.0 / to_si(dialect.time.rate, "Hz", "time.rate")
    start = 0
    for piece in content.pieces:
        rows = len(next(iter(piece.columns.values())))
        piece.columns["time"] = (start + np.arange(rows)) * step
        if dialect.time.restart == "error":
            start += rows


def join_clocks(contents: list[Content], dialect: Dialect) -> None:
    """Shift the pieces' times so that they follow one another, where the dialect says so."""
    pieces = [piece for content in contents for piece in content.pieces]
    if dialect.time.restart != "continue" or len(pieces) < 2:
        return
    stamps = [piece.started for piece in pieces]
    first = stamps[0]
    end = None
    for piece, stamp in zip(pieces, stamps, strict=True):
        time = piece.columns["time"]
        if first is not None and None not in stamps:
            time += (stamp - first).total_seconds()
        elif end is not None:
            time += end if time[0] > 0 else end - time[0] + _interval(time)
        end = time[-1]


def _interval(time: np.ndarray) -> float:
    return float(np.median(np.diff(time))) if len(time) > 1 else 1.0


def first_fault(time: np.ndarray) -> int | None:
    """Row (from 0) of the first time that is missing or not later than the one before it."""
    for start in range(0, len(time), _BLOCK):
        part = time[max(start - 1, 0) : start + _BLOCK]
        if start == 0 and not np.isfinite(part[0]):
            return 0
        with np.errstate(invalid="ignore"):  # from one infinite time to the next
            bad = ~(np.diff(part) > 0) | ~np.isfinite(part[1:])
        if bad.any():
            return max(start - 1, 0) + int(np.argmax(bad)) + 1
    return None


def kept_rows(time: np.ndarray, where: str, dialect: Dialect) -> np.ndarray | None:
    """Rows to keep for a strictly increasing time; None means all of them.

    Raises
    ------
    ReadError
        If time does not increase and the dialect does not say what to do.
    """
    row = first_fault(time)
    if row is None:
        return None
    if dialect.time.on_repeat == "drop":
        highest = np.fmax.accumulate(np.where(np.isfinite(time), time, np.nan))
        keep = np.ones(len(time), dtype=bool)
        keep[1:] = time[1:] > highest[:-1]
        keep &= np.isfinite(time)
        if not keep.any():
            raise ReadError(f"{where}: not one time is a finite number")
        return keep
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
    raise ReadError(
        f"{where}: {what}; the dialect '{dialect.name}' can say what to do: [time] "
        "on_repeat = 'drop' leaves such rows out, restart = 'continue' joins steps whose clock "
        "starts anew"
    )
