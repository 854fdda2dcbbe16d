"""Quantities of unnamed columns, guessed from how their numbers change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribolab.reading.clocks.faults import find_faults, rows_at_fault
from tribolab.reading.unknown.model import other_units, time_unit

if TYPE_CHECKING:
    from tribolab.reading.unknown.model import DraftColumn, Kind

_ROWS = 20_000  # rows that are inspected
_MIN_CORRELATION = 0.9999  # correlation of one signal in two units
_COMPARED = 1000  # columns of which all pairs are compared
_MIN_FACTORS, _MIN_STRAIGHT = 5, 0.98  # rows; correlation of the logarithm with the row number
_EVERY = 20  # every 20th sample gives nearly the same path length of a smooth signal
_SMOOTH = 1.12  # largest ratio of the path lengths from all and from each 20th sample
_MAX_SCAN = 200.0  # mm, longest traverse of a profilometer
_HIGHEST = 5.0  # mm, largest range of a stylus gauge


def by_behaviour(
    columns: list[DraftColumn], numbers: np.ndarray, units: tuple[str, str] = ("", "")
) -> tuple[Kind, list[DraftColumn], list[str]]:
    """Recognise a map, a profile or a run by the numbers of the columns.

    Three columns whose first two fill a grid are a map. Two columns, the first
    rising in even steps, are a profile: a run needs more than one signal. In other tables the
    first column that rises in every row is time, and a column that reverses smoothly is the
    position.
    """
    part = numbers[:_ROWS]
    width = part.shape[1]
    if width == 3 and _is_grid(part):
        return "scan", *_scan(columns, part, units)
    rising = [i for i in range(width) if len(part) > 2 and (np.diff(part[:, i]) > 0).all()]
    if width == 2 and rising[:1] == [0] and _is_even(part[:, 0]):
        return "scan", *_scan(columns, part, units)
    if not rising:
        rising = [i for i in range(width) if _is_clock(part[:, i])]
    if not rising:
        return "table", columns, []
    if _rises_by_factors(part[:, rising[0]]):
        words = f"column {rising[0] + 1} rises by factors, as a frequency does, and is no time"
        return "table", columns, [words]
    return "run", *_run(columns, part, rising[0])


def _is_grid(part: np.ndarray) -> bool:
    levels = [np.unique(part[:, i]).size for i in (0, 1)]
    pairs = len(np.unique(part[:, :2], axis=0))
    n = len(part)
    return min(levels) > 1 and pairs == n and n <= levels[0] * levels[1] < n + max(levels)


def _rises_by_factors(x: np.ndarray) -> bool:
    """Whether numbers rise by similar factors over more than a decade, as frequencies do.

    File: frequency, storage and loss modulus without names (RHEOS data_freq.csv).
    """
    if len(x) < _MIN_FACTORS or x[0] <= 0 or x[-1] < 10 * x[0]:
        return False
    return bool(np.corrcoef(np.arange(len(x)), np.log(x))[0, 1] > _MIN_STRAIGHT)


def _is_even(x: np.ndarray) -> bool:
    steps = np.diff(x)
    return bool(np.ptp(steps) <= 0.05 * np.median(steps))


def _is_clock(x: np.ndarray) -> bool:
    """Whether numbers rise in even steps, apart from restarts."""
    if len(x) < 2 * _EVERY or not np.isfinite(x).all():
        return False
    steps = np.diff(x)
    falls = int((steps <= 0).sum())
    usual = np.median(steps)
    even = np.mean(np.abs(steps - usual) < 0.5 * usual) if usual > 0 else 0.0
    if not 0 < falls <= len(x) / _EVERY or even < 0.9:
        return False
    faults = find_faults(x)
    joined = x + faults.offsets()
    return bool(faults.starts) and not rows_at_fault(joined, faults).any()


def _scan_units(part: np.ndarray, height: int) -> tuple[str, str]:
    """Return the likely units of positions and heights, from the ranges of their numbers."""
    heights = part[np.isfinite(part[:, height]), height]
    reach, length = np.ptp(heights) if heights.size else 0.0, np.ptp(part[:, 0])
    if length > _MAX_SCAN:  # too long for millimetres
        return "um", "um" if reach < 0.1 * length else "nm"
    return "mm", "um" if reach > 0.1 * length or reach > _HIGHEST else "mm"


def _scan(
    columns: list[DraftColumn], part: np.ndarray, stated: tuple[str, str]
) -> tuple[list[DraftColumn], list[str]]:
    """Return columns of positions and heights; units that the text does not state are guesses."""
    names = ("x", "y", "height") if part.shape[1] == 3 else ("x", "height")
    along, across = stated if all(stated) else _scan_units(part, len(names) - 1)
    axes = []
    for column, name in zip(columns, names, strict=True):
        unit = across if name == "height" else along
        axis = column._replace(quantity=name, unit=unit, used=True)
        if name == "x" and not all(stated) and (np.diff(part[:, 0]) == 1).all():
            fill_in = 'the distance of two points, as it counts them, e.g. "0.5 um"'
            why = "it counts the points, whose distance is not stated"
            axis = axis._replace(used=False, unit=None, guessed=(why,), fill_in=fill_in)
        elif not all(stated):
            others = other_units("height" if name == "height" else "m", unit)
            axis = axis._replace(guessed=(f"it is {name} in {unit}",), options=others)
        axes.append(axis)
    if all(stated):
        return axes, []
    if len(names) == 3:
        return axes, ["it is a map: columns 1 and 2 fill a grid"]
    return axes, ["it is a profile: two columns, the first rises in even steps"]


def _run(
    columns: list[DraftColumn], part: np.ndarray, time: int
) -> tuple[list[DraftColumn], list[str]]:
    unit = time_unit(part[:, time])
    rises = "it rises in every row"
    if (np.diff(part[:, time]) <= 0).any():
        rises = "it rises by even steps, and restarts now and then"
    why = f"it is time in {unit}: {rises}"
    result = list(columns)
    result[time] = columns[time]._replace(quantity="time", unit=unit, used=True, guessed=(why,))
    result[time] = result[time]._replace(options=(*other_units("s", unit), "not used"))
    others = [i for i in range(part.shape[1]) if i != time]
    kin = _same_signals(part, others)
    smooth = [i for i in others if _reverses_smoothly(part[:, i])]
    position = max(smooth, key=lambda i: np.ptp(part[:, i]), default=None)
    for i in others:
        same = [str(k + 1) for k in kin.get(i, ())]
        note = f"the same signal as column {', '.join(same)}" if same else "without a name"
        result[i] = columns[i]._replace(note=note)
    if position is not None:
        why = "it is the position in mm: it reverses smoothly"
        result[position] = columns[position]._replace(
            quantity="position",
            unit="mm",
            used=True,
            guessed=(why,),
            options=(*other_units("m", "mm"), "not used"),
        )
    return result, []


def _same_signals(part: np.ndarray, places: list[int]) -> dict[int, list[int]]:
    """Return, for each column, the columns with the same signal in another unit."""
    some = part[:, places[:_COMPARED]]
    with np.errstate(invalid="ignore"):
        moves = np.isfinite(some).all(axis=0) & (np.ptp(some, axis=0) > 0)
    moving = np.asarray(places[:_COMPARED])[moves]
    if moving.size < 2:
        return {}
    alike = np.abs(np.corrcoef(part[:, moving], rowvar=False)) > _MIN_CORRELATION
    np.fill_diagonal(alike, False)
    return {int(i): moving[row].tolist() for i, row in zip(moving, alike, strict=True)}


def _reverses_smoothly(x: np.ndarray) -> bool:
    if len(x) < 10 * _EVERY or not np.isfinite(x).all() or np.ptp(x) == 0:
        return False
    fine = np.abs(np.diff(x)).sum()
    coarse = np.abs(np.diff(x[::_EVERY])).sum()
    return bool(coarse > 1.5 * np.ptp(x) and fine < _SMOOTH * coarse)
