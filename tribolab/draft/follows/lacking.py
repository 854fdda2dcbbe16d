"""What a run lacks for a friction coefficient over the sliding speed, and nothing tells."""

from __future__ import annotations

from collections.abc import Sequence

from tribolab.draft.columns.turning import angle_of, radius_of, torque_of, unscaled_torque_of
from tribolab.draft.follows.bridges import in_volts
from tribolab.draft.follows.model import CRANK, SAYS_FRICTION, Follows
from tribolab.draft.follows.speed import angle_in
from tribolab.draft.follows.two_bodies import has_turning_surfaces
from tribolab.draft.model import NO_NUMBERS, WHICH_FORCE, DraftColumn, Understood
from tribolab.draft.stated.lengths import is_at_arm
from tribolab.draft.stated.stated_zero import friction_column
from tribolab.errors import shown
from tribolab.io.dialects.cells import split_name
from tribolab.io.missing import missing_of
from tribolab.reading.interpret.names import is_stroke_frequency
from tribolab.reversals import reversals


def lacking(understood: Understood, follows: Follows) -> list[str]:
    """Say what a friction coefficient over speed needs, and neither columns nor text hold.

    Parameters
    ----------
    understood, follows
        What was found out about the file.
    """
    # with a unit still to be filled in, or of two meanings, a column is there all the same
    names = {c.quantity for c in understood.columns if c.quantity and (c.used or c.fill_in)}
    names |= {formula.quantity for formula in follows.formulas}
    if any(c.fill_in == WHICH_FORCE.format(shown(c.label)) for c in understood.columns):
        names |= {"friction_force", "normal_force"}  # it is asked which of both
    if follows.speed is not None and follows.speed.source != "none":
        names.add("sliding_velocity")
    if any(value.name == "set_normal_force" for value in follows.values):
        names.add("normal_force")
    if any(value.name == CRANK for value in follows.values):
        names.add("crank")
    if angle_in(understood) is not None or has_turning_surfaces(understood.columns):
        names.add("rotation_speed")  # the radius makes a position, or a speed, of it
    reading = friction_column(understood.columns)
    made = any(formula.quantity == "friction_force" for formula in follows.formulas)
    if reading is not None and is_at_arm(reading) and not made:
        names.remove("friction_force")  # without the radius an arm's force is none of the contact
        names.add("torque")
    elif torque_of(understood.columns) is not None:
        names.add("torque")
    elif (torque := unscaled_torque_of(understood.columns)) is not None and not (
        names & SAYS_FRICTION
    ):
        names.add("friction_force")
        worth = (
            f"what one number of the torque '{shown(torque.label, 30)}' is, for the friction: unit "
            'and scale of its [[column]] with symbol = "torque" in a dialect'
        )
        return [worth, *missing_of(names)]
    elif unknown_of(understood.columns):
        names.add("friction_force")  # it is asked whether one of them holds it
    if any(is_stroke_frequency(*_named(c)) for c in understood.columns if not c.used):
        names.add("stroke_frequency")
    signals = (c for c in understood.columns if c.used and c.quantity in SAYS_FRICTION)
    if any(reversals(understood.numbers[:, c.place - 1]) for c in signals):
        names.add("reversals")
    lacks = missing_of(names)
    friction = {"friction_force", "friction_coefficient", "shear_stress"}
    known = {c.quantity for c in understood.columns if c.used or c.fill_in}
    known |= {formula.quantity for formula in follows.formulas}
    volts = None if known & friction else in_volts(understood.columns, "friction_force")
    if volts is not None:
        what = f"what a volt of '{shown(volts.label, 30)}' is worth (such as 8.2 N/V), for the "
        lacks.insert(0, f"{what}friction: 'tribolab dialect' asks for it in a terminal")
    return lacks


def _named(column: DraftColumn) -> tuple[str, str | None]:
    name, unit = split_name(column.label)
    return name, column.file_unit or unit


def unknown_of(columns: Sequence[DraftColumn]) -> list[DraftColumn]:
    """Return the columns of which nothing is known, but those of what turns.

    Parameters
    ----------
    columns
        The columns as they are understood.
    """
    turning = (
        torque_of(columns),
        angle_of(columns),
        radius_of(columns),
        unscaled_torque_of(columns),
    )
    places = {column.place for column in turning if column is not None}
    noted = (c for c in columns if c.note and not c.note.startswith(NO_NUMBERS))
    unknown = (c for c in noted if not c.quantity and c.label)
    return [column for column in unknown if column.place not in places]
