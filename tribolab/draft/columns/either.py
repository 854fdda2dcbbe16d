"""Which of both forces a load cell measures, where its name does not say: by the stated load."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribolab.draft.columns.stated_load import find_load, stated_number
from tribolab.draft.columns.values import DraftValue, find_values
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import WHICH_FORCE, DraftColumn
from tribolab.errors import shown
from tribolab.quantities import unit_conversion

_LOADED = 0.4  # of the largest reading
_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
_SAME = (0.75, 1.33)  # times the stated load: a reading of the load itself


def told_by_load(
    layout: Layout, columns: Sequence[DraftColumn], numbers: np.ndarray
) -> list[DraftColumn]:
    """Guess which force a column of either holds from the load that the text states.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    numbers
        Their numbers (rows, columns) as written.
    """
    open_ones = [c for c in columns if c.fill_in == WHICH_FORCE.format(shown(c.label))]
    held = {c.quantity for c in columns if c.used}
    if not open_ones and not held & _FRICTION:  # "Load" of a machine that pulls a sled
        open_ones = [c for c in columns if c.used and c.quantity == "normal_force"]
    load = find_load(find_values(layout)) if len(open_ones) == 1 else None
    if load is None:
        return list(columns)
    guessed = _guessed(open_ones[0], load, numbers[:, open_ones[0].place - 1])
    return [guessed if column.place == guessed.place else column for column in columns]


def _guessed(column: DraftColumn, load: DraftValue, values: np.ndarray) -> DraftColumn:
    stated = stated_number(load) * unit_conversion(load.unit or "N", "normal_force")[0]
    read = np.abs(values[np.isfinite(values)])
    read = read * unit_conversion(column.read_unit or "N", "normal_force")[0]
    share = float(np.median(read[read > _LOADED * read.max()])) / stated if read.any() else 0.0
    if not 0 < share < _SAME[1]:
        return column
    pressed = share > _SAME[0]
    if pressed and not column.fill_in:
        return column
    if pressed:
        name, other = "normal_force", "friction_force"
        why = f"it is the normal force: it reads what '{load.text}' says"
    else:
        name, other = "friction_force", "normal_force"
        why = f"it is the friction force: '{load.text}' is the load"
    return column._replace(
        quantity=name, used=True, fill_in="", guessed=(why,), options=(other, "not used")
    )
