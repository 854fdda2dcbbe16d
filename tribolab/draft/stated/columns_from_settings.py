"""What settings tell of columns that their names leave open: a stated rate, a stated stroke."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.draft.file.layout import Layout
from tribolab.draft.model import DraftColumn
from tribolab.draft.stated.sampling import find_sampling
from tribolab.draft.stated.settings import numeric_settings
from tribolab.draft.words.stated_words import STROKE
from tribolab.errors import UnitError
from tribolab.io.dialects.patterns import guarded
from tribolab.io.dialects.time_rule import sampling_interval
from tribolab.reading.interpret.unit_texts import converts
from tribolab.units import conversion

_CLOSE = 0.02  # relative, of an interval
_AS_FAR = 0.05  # relative, of a way: noise and the ends of a drive add to it
_ENDS = 0.5  # % of the rows at each end, which may be noise


def columns_from_settings(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Take for sure what a column was guessed to be where a setting agrees with its numbers.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    result = []
    for column in columns:
        values = numbers[:, column.place - 1]
        if column.used and column.guessed and column.quantity == "time":
            known = f"time is in {column.unit}"
            if any(g.startswith(known) for g in column.guessed) and _has_rate(
                layout, column, values
            ):
                left = tuple(g for g in column.guessed if not g.startswith(known))
                column = column._replace(guessed=left, options=column.options if left else ())
        elif column.used and column.guessed and column.quantity == "position":
            if _goes_a_stroke(layout, column, values):
                column = column._replace(guessed=(), options=())
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
    return abs(mine / step - 1) < _CLOSE


def _goes_a_stroke(layout: Layout, column: DraftColumn, values: np.ndarray) -> bool:
    """Whether a column goes to and fro by the stroke that the text states."""
    unit = column.read_unit
    if unit is None or not converts(unit, "m"):
        return False
    known = values[np.isfinite(values)]
    if not known.size:
        return False
    low, high = np.percentile(known, [_ENDS, 100 - _ENDS])
    way = float(high - low) * conversion(unit, "m")[0]
    stated = [
        value.number * conversion(value.unit, "m")[0]
        for value in numeric_settings(layout)
        if value.unit and STROKE.search(value.key) and converts(value.unit, "m")
    ]
    return any(stroke > 0 and abs(way / stroke - 1) < _AS_FAR for stroke in stated)
