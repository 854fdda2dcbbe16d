"""Inputs that a run lacks for the coefficient of friction against sliding speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tribolab.arrays.reversals import reversals
from tribolab.core.errors import shown
from tribolab.reading.interpret.derive import Given
from tribolab.reading.interpret.missing import MissingInput, missing_inputs
from tribolab.reading.interpret.names import is_count
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.labels import bare_name
from tribolab.reading.unknown.columns.rotating_parts import (
    angle_of,
    radius_of,
    torque_of,
    unscaled_torque_of,
)
from tribolab.reading.unknown.derivations.derive import held_quantities
from tribolab.reading.unknown.derivations.model import CRANK, SAYS_FRICTION, Follows
from tribolab.reading.unknown.derivations.stated_lines import column_in_volts
from tribolab.reading.unknown.model import DraftColumn, Reason, Understood

_OF_FRICTION = ("N", "N m", "1", "Pa", "V")


class Uncalibrated(NamedTuple):
    """Column of friction or torque whose calibration factor is unknown."""

    column: DraftColumn
    torque: bool = False
    member: str = "calibration"
    goals: tuple[str, ...] = ("friction",)

    def __str__(self) -> str:
        """Return the missing calibration in words, and how to state it."""
        label = shown(self.column.label, 30)
        if self.torque:
            return (
                f"what one number of the torque '{label}' is, for the friction: unit and scale of "
                'its [[column]] with symbol = "torque" in a dialect'
            )
        return (
            f"what a volt of '{label}' is worth (such as 8.2 N/V), for the friction: 'tribolab "
            "info FILE --write my.toml' asks for it in a terminal"
        )


def lacking(understood: Understood, follows: Follows) -> list[MissingInput | Uncalibrated]:
    """Return the inputs that a run lacks for the coefficient of friction against speed."""
    columns = understood.columns
    known = {name: follows.given[name] for name in follows.given}
    at_arm = "arm_force" in known
    names = held_quantities(understood) - ({"friction_force"} if at_arm else set())
    names |= {formula.quantity for formula in follows.formulas}
    if any(c.fill_in and c.reason is Reason.EITHER_FORCE for c in columns):
        names |= {"friction_force", "normal_force"}  # the user is asked which of the two it is
    if follows.speed is not None and follows.speed.source != "none":
        names.add("sliding_velocity")
    if any(value.name == "set_normal_force" for value in follows.values):
        names.add("normal_force")
    held = held_quantities(understood) | names
    torque = unscaled_torque_of(columns)
    torque = None if held & SAYS_FRICTION or torque_of(columns) is not None else torque
    if torque is not None or (torque_of(columns) is None and not at_arm and unknown_of(columns)):
        names.add("friction_force")  # the user is asked for the calibration or the column
    facts = set(follows.facts)
    if any(value.name == CRANK for value in follows.values):
        facts.add("crank")
    signals = (c for c in columns if c.used and c.quantity in SAYS_FRICTION)
    if any(reversals(understood.numbers[:, c.place - 1]) for c in signals):
        facts.add("reversals")
    known |= {name: Given(name, name, None) for name in names}
    lacks: list[MissingInput | Uncalibrated] = [*missing_inputs(known, facts)]
    volts = None if held & SAYS_FRICTION else column_in_volts(columns, "friction_force")
    uncalibrated = [Uncalibrated(torque, torque=True)] if torque is not None else []
    uncalibrated += [Uncalibrated(volts)] if volts is not None else []
    return [*uncalibrated, *lacks]


def unknown_of(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return columns with unknown names that may be the friction, except those of rotation."""
    turning = (
        torque_of(columns),
        angle_of(columns),
        radius_of(columns),
        unscaled_torque_of(columns),
    )
    places = {column.place for column in turning if column is not None}
    noted = (c for c in columns if c.note and c.reason is not Reason.TEXT)
    unknown = (c for c in noted if not c.quantity and c.label and _may_be_friction(c))
    return [column for column in unknown if column.place not in places]


def _may_be_friction(column: DraftColumn) -> bool:
    """Whether a column may be a friction signal by its unit; 'h in mm' may not."""
    unit = column.unit or bare_name(column)[1]
    return not unit or is_count(unit) or any(converts(unit, si) for si in _OF_FRICTION)
