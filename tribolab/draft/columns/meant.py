"""What names of columns can mean beside each other: an axis where something turns is no way."""

from __future__ import annotations

import numpy as np

from tribolab.draft.columns.fill_in import Bare
from tribolab.draft.columns.turning import angle_of, torque_of
from tribolab.draft.model import DraftColumn
from tribolab.draft.words.strokes import is_frequency, lengths_beside_frequencies
from tribolab.reading.interpret.names import KNOWN_WORD, Match, is_axis
from tribolab.reading.lexicon.lexicon import normalise_label, role_of

ACROSS = {"fy"}  # names of a force across the motion
_RADIAL = {"fr", "frad"}  # friction, but beside a torque what presses on the shaft
_PERHAPS = 0.5  # score of a name that is asked about


def meant(
    columns: list[DraftColumn], bare: list[Bare], matched: list[list[Match]], numbers: np.ndarray
) -> list[list[Match]]:
    """Leave out what the names of columns cannot mean beside the others.

    Parameters
    ----------
    columns, bare
        The columns, and their names without units.
    matched
        For each the quantities that its name may stand for, the likeliest first.
    numbers
        Their numbers (rows, columns) as written.
    """
    matched = _without_path(_without_rows(bare, numbers, matched), numbers)
    matched = _without_weak(columns, bare, _across_if_moved(bare, matched))
    return _without_lengths(bare, _without_axes(columns, bare, matched))


def _without_rows(
    bare: list[Bare], numbers: np.ndarray, matched: list[list[Match]]
) -> list[list[Match]]:
    """Take "n" for the number of the row where it goes on by one."""
    return [
        []
        if normalise_label(name) == "n" and unit is None and (np.diff(numbers[:, place]) == 1).all()
        else options
        for place, ((name, unit, _), options) in enumerate(zip(bare, matched, strict=True))
    ]


def _without_path(matched: list[list[Match]], numbers: np.ndarray) -> list[list[Match]]:
    """Beside a position that turns round, a length that only grows is the whole path."""
    places = [k for k, o in enumerate(matched) if o and o[0].quantity == "position"]
    steps = {k: np.diff(numbers[np.isfinite(numbers[:, k]), k]) for k in places}
    turn = [k for k, moved in steps.items() if (moved < 0).any() and (moved > 0).any()]
    grow = [k for k, moved in steps.items() if moved.size and (moved >= 0).all()]
    return [[] if turn and k in grow else options for k, options in enumerate(matched)]


def _across_if_moved(bare: list[Bare], matched: list[list[Match]]) -> list[list[Match]]:
    """Take a sensor of either displacement for that across, where the motion is told otherwise."""
    told = {"rotation_speed", "sliding_velocity", "position"}
    surely = {o.quantity for options in matched for o in options[:1] if o.score >= KNOWN_WORD}
    if not surely & told:
        return matched
    either = {"position", "height_displacement"}
    return [
        [Match("height_displacement", KNOWN_WORD, None)]
        if options and options[0].score < KNOWN_WORD and either == {o.quantity for o in options}
        else options
        for options in matched
    ]


def _without_weak(
    columns: list[DraftColumn], bare: list[Bare], matched: list[list[Match]]
) -> list[list[Match]]:
    """Leave out names that barely mean friction where another column surely does.

    A torque is friction, and a force across the motion or a maximum beside it is none; where the
    friction force is recorded, a mean coefficient of an instrument's own adds nothing.
    """
    torque = torque_of(columns) is not None
    if torque:
        matched = [
            [Match("normal_force", _PERHAPS, None)] if normalise_label(name) in _RADIAL else options
            for (name, _, _), options in zip(bare, matched, strict=True)
        ]
    surely = {o.quantity for options in matched for o in options[:1] if o.score >= KNOWN_WORD}
    forces = {"friction_force", "normal_force"} <= surely

    def is_weak(name: str, options: list[Match]) -> bool:
        if not options:
            return False
        role, of = role_of(name), options[0].quantity
        if of == "friction_force":
            across = normalise_label(name) in ACROSS and (
                torque or "friction_coefficient" in surely
            )
            return across or (torque and role == "extreme")
        return forces and of == "friction_coefficient" and role in ("derived", "extreme")

    return [
        [] if is_weak(name, options) else options
        for (name, _, _), options in zip(bare, matched, strict=True)
    ]


def _without_lengths(bare: list[Bare], matched: list[list[Match]]) -> list[list[Match]]:
    """Beside a frequency the length of strokes is no position, and the frequency no turning."""
    lengths = lengths_beside_frequencies([(name, unit) for name, unit, _ in bare])
    if not lengths:
        return matched
    return [
        [] if place in lengths or is_frequency(name, unit) else options
        for place, ((name, unit, _), options) in enumerate(zip(bare, matched, strict=True))
    ]


def _without_axes(
    columns: list[DraftColumn], bare: list[Bare], matched: list[list[Match]]
) -> list[list[Match]]:
    """Where something turns, the axes of the machine's stage are no sliding position."""
    turns = any(options and options[0].quantity == "rotation_speed" for options in matched)
    if not turns and angle_of(columns) is None:
        return matched
    return [
        [option for option in options if option.quantity != "position"]
        if is_axis(name) and options and options[0].quantity == "position"
        else options
        for (name, _, _), options in zip(bare, matched, strict=True)
    ]
