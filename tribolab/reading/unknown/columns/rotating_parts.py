"""Columns of rotating rigs that are not quantities of a run: torque, angle, turns, track radius."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

import numpy as np

from tribolab.reading.interpret.names import is_count, is_track_radius, split_unit
from tribolab.reading.lexicon.lexicon import key_pattern, normalise_label, part_pattern
from tribolab.reading.text.cells import split_name
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.model import DraftColumn
from tribolab.units.spellings import MICRO

_TORQUE = key_pattern("torque")
_OTHER_MOMENT = part_pattern("other_moment")
_TORQUE_UNIT = re.compile(rf"[cmku{MICRO}]?N\s?[·⋅・∙•*.]?\s?[cmu{MICRO}]?m")  # joules are excluded
_ANGLE = key_pattern("angle")
# names of rotating parts; in a unit of angle they are angles
_TURNS_IN_ANGLES = part_pattern("turns_in_angles")
_TURNS = re.compile(
    r"^(?:number|no|nr|n)?(?:of)?(?:revolution|turn|rev|rotation|umdrehung)(?:s|en)?$"
)
_UNITS_OF_TURNS = {"", "-", "1", "rev", "revs", "turn", "turns", "U", "revolutions"}
_WHOLE = 0.5  # share of whole numbers above which a column counts whole turns


def torque_of(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the only torque column, found by name or else by unit; None if there are several.

    A column that the user named as the torque takes precedence.
    """
    if (said := _named_by_user(columns, "torque")) is not None:
        return said
    # a treadmill has another moment: "Pitch Moment (Nm)" (csu-hmc/pitch-moment-compensation)
    columns = [c for c in columns if not _OTHER_MOMENT.search(normalise_label(c.label))]
    units = [_name_and_unit(column)[1] for column in columns if not column.used]
    single = sum(bool(_TORQUE_UNIT.fullmatch(unit)) for unit in units) == 1
    named = _only_column(columns, _TORQUE.search, "N m")
    return named or (_only_column(columns, str, "N m") if single else None)


def unscaled_torque_of(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the only torque column without a calibration: in divisions, counts or volts."""
    if torque_of(columns) is not None:
        return None
    fitting = []
    for column in columns:
        name, unit = _name_and_unit(column)
        bare = name.split(",")[0]
        other = unit and not (converts(unit, "V") or is_count(unit))
        if not column.used and _TORQUE.search(normalise_label(bare)) and not other:
            fitting.append(column)
    return fitting[0] if len(fitting) == 1 else None


def angle_of(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the only column with an angle of rotation, else None."""
    named = _named_by_user(columns, "angle") or _only_column(columns, _ANGLE.search, "rad")
    return named or _only_column(columns, _TURNS_IN_ANGLES.search, "rad")


def turns_of(columns: Sequence[DraftColumn], numbers: np.ndarray) -> DraftColumn | None:
    """Return the only column that counts fractions of turns, which is an angle; else None."""
    fitting = []
    for column in columns:
        name, unit = _name_and_unit(column)
        turns = numbers[:, column.place - 1]
        parts = np.isfinite(turns).all() and np.mean(turns == np.round(turns)) < _WHOLE
        called = _TURNS.search(normalise_label(name)) and unit in _UNITS_OF_TURNS
        if called and parts and not column.used:
            fitting.append(column._replace(unit="turn"))
    return fitting[0] if len(fitting) == 1 else None


def radius_of(columns: Sequence[DraftColumn]) -> DraftColumn | None:
    """Return the only column with the track radius, else None."""
    return _only_column(columns, is_track_radius, "m")


def _named_by_user(columns: Sequence[DraftColumn], name: str) -> DraftColumn | None:
    """Return the column that the user named as the torque or angle."""
    return next((column for column in columns if column.said == name), None)


def _only_column(
    columns: Sequence[DraftColumn], is_named: Callable[[str], object], si_unit: str
) -> DraftColumn | None:
    fitting = []
    for column in columns:
        name, unit = _name_and_unit(column)
        if not column.used and is_named(normalise_label(name)) and converts(unit, si_unit):
            said = column.unit is None and column.file_unit and column.name is not None
            own = None if said else unit
            fitting.append(column._replace(unit=own))
    return fitting[0] if len(fitting) == 1 else None


def _name_and_unit(column: DraftColumn) -> tuple[str, str]:
    name, unit = split_name(column.label)
    if unit is None and column.file_unit is None and column.unit is None:
        name, unit = split_unit(name)
    return name, column.unit or column.file_unit or unit or ""
