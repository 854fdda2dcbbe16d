"""Agreement of a recorded friction coefficient with the recorded forces."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from tribolab.reading.interpret.names import split_unit
from tribolab.reading.runs.force_ratio import doubt_about, doubt_about_coefficient
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.quantities import unit_conversion

_RATIO = ("friction_coefficient", "friction_force", "normal_force")
_APART = 1.5  # times: filters and zeros that the instrument took off make less
_MIN_LOADED_ROWS = 20  # rows under load that are needed
_LOADED = 0.5  # of the largest load
_OVER_N = re.compile(r"\w{1,3}\s*/\s*N")  # a symbol and its unit, or divided by the normal force


def disagreement(columns: Sequence[DraftColumn], numbers: np.ndarray) -> list[str]:
    """Note if the recorded coefficient differs from the ratio of the forces, or cannot be one.

    Return one guess, or none.
    """
    held = {column.quantity: column for column in columns if column.used and column.quantity}
    ratio, *forces = (held.get(name) for name in _RATIO)
    friction, load = (None if column is None else _si(column, numbers) for column in forces)
    if ratio is None:
        doubt = "" if friction is None or load is None else doubt_about(friction, load)
        return [f"{doubt} they are read as named"] if doubt else []
    stated = _si(ratio, numbers)
    if friction is None:
        doubt = doubt_about_coefficient(stated)
        return [f"{doubt} it is read as it stands"] if doubt else []
    if load is None:
        return []
    sound = np.isfinite(stated) & np.isfinite(friction) & np.isfinite(load) & (stated != 0)
    if sound.sum() < _MIN_LOADED_ROWS:
        return []
    sound &= np.abs(load) > _LOADED * np.abs(load[sound]).max()
    if sound.sum() < _MIN_LOADED_ROWS:
        return []
    ratios = stated[sound], friction[sound] / load[sound]
    sizes = [float(np.median(np.abs(x))) for x in ratios]
    if min(sizes) > 0 and max(sizes) / min(sizes) <= _APART:
        return []
    return [
        f"the forces are right, whose ratio is {sizes[1]:.3g}; column {ratio.place} states "
        f"{sizes[0]:.3g}"
    ]


def force_or_ratio(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Make a guess of 'Ff/N' where no other name has its unit behind a stroke, as 't/s' would."""
    if any(_has_unit_behind_stroke(column.label) for column in columns):
        return list(columns)
    return [
        column._replace(
            guessed=(*column.guessed, "'/N' says its unit, and not that a load was divided by"),
            options=(*column.options, "friction_coefficient"),
        )
        if column.used
        and column.quantity == "friction_force"
        and _OVER_N.fullmatch(column.label.strip())
        else column
        for column in columns
    ]


def _has_unit_behind_stroke(label: str) -> bool:
    name, unit = split_unit(label.strip())
    behind = label.strip()[len(name) :].lstrip().startswith("/")
    return unit is not None and behind and not _OVER_N.fullmatch(label.strip())


def _si(column: DraftColumn, numbers: np.ndarray) -> np.ndarray:
    scale, offset = unit_conversion(column.read_unit or "", str(column.quantity))
    return np.asarray(column.sign * scale * numbers[:, column.place - 1] + offset)
