"""Signals with different sampling rates in one table, with blank cells between values.

Friction keeps its samples; slower signals are interpolated between their values, and rows without
friction are left out if friction is the slower one. Blanks at irregular distances are missing
values and remain so.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.arrays.chunks import chosen, pieces
from tribolab.arrays.medians import median
from tribolab.core.untyped import Json
from tribolab.reading.dialect.column_rule import FRICTION_SIGNALS

_MAX_SHARE = 0.6  # largest share of rows in which a slower signal has a value
_MIN_VALUES = 8  # values needed to determine a rate
_EVEN = 2.0  # largest ratio of distances between values (95 % quantile) to their median
_GAP = 3.0  # multiple of the usual distance above which a gap is not bridged


class Together(NamedTuple):
    """Rows that were kept: time [s], columns, and attributes on the changes."""

    time: np.ndarray
    columns: dict[str, np.ndarray]
    attrs: Json = {}


def sampled_together(columns: dict[str, np.ndarray], time: np.ndarray) -> Together:
    """Interpolate signals of different rates to the rows of the friction signal.

    Parameters
    ----------
    columns
        Arrays in SI by quantity (time); blank cells are NaN.
    time
        Time [s] (time), increasing.

    Returns
    -------
    Together
        Time and columns, unchanged if all signals have values in most rows. ``interpolated`` names
        slower signals with their rate, and ``rows_without_friction`` is the number of rows without
        friction.

    Examples
    --------
    >>> load = np.where(np.arange(40) % 4 == 0, 5.0 + np.arange(40), np.nan)
    >>> signals = {"friction_force": np.ones(40), "normal_force": load}
    >>> both = sampled_together(signals, np.arange(40.0))
    >>> both.columns["normal_force"][:4].tolist(), both.attrs["interpolated"], both.time.size
    ([5.0, 6.0, 7.0, 8.0], 'normal_force: a value in every 4th row', 37)
    """
    seldom = {
        name: rows
        for name, values in columns.items()
        if values.dtype.kind == "f" and (rows := _rows(values)) is not None
    }
    if not seldom:
        return Together(time, columns)
    lead = next((name for name in (*FRICTION_SIGNALS, "shear_stress") if name in columns), None)
    texts = [
        f"{name}: a value in every {_ordinal(rows)} row"
        for name, rows in seldom.items()
        if name != lead
    ]
    result = {
        name: _interpolated(time, values, seldom[name])
        if name in seldom and name != lead
        else values
        for name, values in columns.items()
    }
    attrs: Json = {"interpolated": "; ".join(texts)} if texts else {}
    keep = np.ones(time.size, dtype=bool)
    if lead in seldom:
        keep[:] = False
        keep[seldom[lead]] = True
        attrs["rows_without_friction"] = int(time.size - seldom[lead].size)
    # leave out rows before the first and after the last value of a slower signal
    for name, rows in seldom.items():
        longest = int(np.diff(rows).max())
        if name != lead and rows[0] <= longest:
            keep[: rows[0]] = False
        if name != lead and time.size - 1 - rows[-1] <= longest:
            keep[rows[-1] + 1 :] = False
    if keep.all():
        return Together(time, result, attrs)
    return Together(
        chosen(time, keep), {name: chosen(values, keep) for name, values in result.items()}, attrs
    )


def _rows(values: np.ndarray) -> np.ndarray | None:
    """Return the rows in which a slower signal has a value; None unless they are evenly spaced."""
    count = sum(int(np.isfinite(values[a:b]).sum()) for a, b in pieces(0, values.size))
    if not _MIN_VALUES <= count <= _MAX_SHARE * values.size:
        return None
    rows = np.flatnonzero(np.isfinite(values))
    steps = np.diff(rows)
    usual = float(median(steps))
    even = usual >= 2 and float(np.quantile(steps, 0.95)) <= _EVEN * usual
    return rows if even else None


def _interpolated(time: np.ndarray, values: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return values interpolated between known ones; NaN outside their range and in gaps."""
    known = time[rows]
    between = np.interp(time, known, values[rows], left=np.nan, right=np.nan)
    after = np.clip(np.searchsorted(known, time), 1, known.size - 1)
    lost = known[after] - known[after - 1] > _GAP * median(np.diff(known))
    return np.where(lost & ~np.isfinite(values), np.nan, between)


def _ordinal(rows: np.ndarray) -> str:
    number = round(float(median(np.diff(rows))))
    return {2: "2nd", 3: "3rd"}.get(number, f"{number}th")
