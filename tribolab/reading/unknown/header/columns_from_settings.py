"""Columns that settings decide where their names do not: a stated rate, a stated stroke."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.errors import UnitError
from tribolab.reading.dialect.time_rule import sampling_interval
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.text.bounded_patterns import guarded
from tribolab.reading.unknown.header.sampling import find_sampling
from tribolab.reading.unknown.header.settings import numeric_settings
from tribolab.reading.unknown.layout.text_layout import Layout
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units import conversion

_SAME_INTERVAL = 0.02  # relative
_SAME_STROKE = 0.05  # relative: noise and the ends of a drive add to it
_ENDS = 0.5  # % of the rows at each end, which may be noise


def columns_from_settings(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Confirm the guess of a column if a setting agrees with its numbers.

    Parameters
    ----------
    layout
        From `tribolab.reading.unknown.layout.text_layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    result = []
    for column in columns:
        values = numbers[:, column.place - 1]
        left = column.guessed
        if column.used and left and column.quantity == "time":
            known = f"time is in {column.unit}"
            if any(g.startswith(known) for g in left) and _has_rate(layout, column, values):
                left = tuple(g for g in left if not g.startswith(known))
        elif column.used and left and column.quantity == "position":
            left = () if _goes_a_stroke(layout, column, values) else left
        if left != column.guessed:
            column = column._replace(guessed=left, options=column.options if left else ())
        result.append(column)
    return result


def _has_rate(layout: Layout, column: DraftColumn, values: np.ndarray) -> bool:
    """Whether the samples lie as far apart as the text says, read in the unit that was guessed."""
    said = find_sampling(layout)
    if said is None or not said.has_unit:
        return False
    number = guarded(said.pattern).last("\n".join(layout.text_above())) or ""
    try:
        step = sampling_interval(f"{number.replace(',', '.')} {said.unit}", "rate")
    except UnitError:
        return False
    steps = np.diff(values)
    steps = steps[np.isfinite(steps) & (steps > 0)]
    mine = float(np.median(steps)) * conversion(column.unit or "s", "s")[0] if steps.size else 0.0
    return abs(mine / step - 1) < _SAME_INTERVAL


def _goes_a_stroke(layout: Layout, column: DraftColumn, values: np.ndarray) -> bool:
    """Whether a column goes to and fro by the stroke that the text states."""
    unit, known = column.read_unit, values[np.isfinite(values)]
    if unit is None or not converts(unit, "m") or not known.size:
        return False
    low, high = np.percentile(known, [_ENDS, 100 - _ENDS])
    way = float(high - low) * conversion(unit, "m")[0]
    strokes = [stroke.si("m") for stroke in numeric_settings(layout).of("stroke", unit="m")]
    return any(stroke > 0 and abs(way / stroke - 1) < _SAME_STROKE for stroke in strokes)
