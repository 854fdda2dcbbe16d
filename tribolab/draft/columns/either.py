"""Which of both forces a load cell measures, where its name does not say: by the stated load."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.draft.columns.labels import bare_name
from tribolab.draft.file.layout import Layout
from tribolab.draft.model import WHICH_FORCE, DraftColumn
from tribolab.draft.stated.lengths import find_arm
from tribolab.draft.stated.settings import Amount, numeric_settings
from tribolab.draft.stated.stated_load import find_load, stated_number
from tribolab.errors import shown
from tribolab.quantities import unit_conversion
from tribolab.reading.interpret.unit_texts import converts
from tribolab.reading.lexicon.lexicon import normalise_label, role_of

_LOADED = 0.4  # of the largest reading
_MOST = 0.98
_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
_WORKED_OUT = ("derived", "extreme")
_SLED = re.compile(
    r"sled|schlitten|schlitte|traineau|patin|slitta|trineo|tren[oó]|sanie|slee|slade|kelk|сан[ик]|滑块|滑塊|スレッド"
)
# the one force beside a stated load; a cell or a sensor may act at another arm
_IS_FORCE = re.compile(
    r"^(?:f|force|kraft|effort|fuerza|forza|forca|kuvvet|sila|voima|kracht|сила|力)$"
)
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
    if not open_ones and "normal_force" not in held:  # "Force" beside a dead weight
        open_ones = [c for c in columns if c.used and c.guessed and _IS_FORCE.search(_name(c))]
        open_ones = [c for c in open_ones if c.quantity == "friction_force"]
        if not open_ones and not held & _FRICTION:
            forces = (c for c in columns if converts(c.read_unit or "", "N"))
            open_ones = [c for c in forces if not c.used and _IS_FORCE.search(_name(c))]
    stated = numeric_settings(layout) if len(open_ones) == 1 else []
    load = find_load(stated)
    if load is None:
        return list(columns)
    guessed = _guessed(open_ones[0], load, numbers[:, open_ones[0].place - 1])
    if _IS_FORCE.search(_name(guessed)) and guessed.quantity == "friction_force":
        if find_arm(stated) is None:  # else it may be what a cell reads at the arm
            guessed = guessed._replace(guessed=(), options=())
    return [guessed if column.place == guessed.place else column for column in columns]


def without_means(layout: Layout, columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Leave out a mean coefficient of the instrument's own, where the forces give one.

    Parameters
    ----------
    layout
        From `tribolab.draft.file.layout.find_layout`.
    columns
        The columns as they are understood.
    """
    held = {c.quantity for c in columns if c.used}
    means = [c for c in columns if c.used and c.guessed and c.quantity == "friction_coefficient"]
    if not means or "friction_force" not in held or role_of(means[0].label) not in _WORKED_OUT:
        return list(columns)
    if "normal_force" not in held and find_load(numeric_settings(layout)) is None:
        return list(columns)
    note = "worked out by the instrument; the forces give it"
    return [
        c._replace(used=False, guessed=(), options=(), note=note) if c in means else c
        for c in columns
    ]


def _name(column: DraftColumn) -> str:
    return normalise_label(bare_name(column)[0])


def _guessed(column: DraftColumn, load: Amount, values: np.ndarray) -> DraftColumn:
    stated = stated_number(load) * unit_conversion(load.unit or "N", "normal_force")[0]
    read = np.abs(values[np.isfinite(values)])
    read = read * unit_conversion(column.read_unit or "N", "normal_force")[0]
    most = float(np.quantile(read, _MOST)) if read.size else 0.0  # a few readings are faults
    share = float(np.median(read[read > _LOADED * most])) / stated if most > 0 else 0.0
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
    # what pulls a sled of a stated weight is its friction
    sure = name == "friction_force" and _SLED.search(normalise_label(load.text)) is not None
    return column._replace(
        quantity=name,
        used=True,
        fill_in="",
        guessed=() if sure else (why,),
        options=() if sure else (other, "not used"),
    )
