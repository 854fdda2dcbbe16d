"""What a run lacks for a friction coefficient over the sliding speed, and how to state it."""

from __future__ import annotations

from collections.abc import Collection

_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}
_SPEED = {"sliding_velocity", "position", "set_speed"}
_CRANK = (
    'the length of the stroke, for the sliding speed: stroke = "(a length)" under [speed] of a '
    "dialect, with source = 'stroke' and how often the crank turns"
)
_RADIUS = 'radius = "(a length)" under [speed] of a dialect'


def missing_of(names: Collection[str]) -> list[str]:
    """Say what is missing of friction, load and sliding speed, and how each is stated.

    Parameters
    ----------
    names
        Quantities of the run, ``torque`` where one is known that no radius makes a force of, and
        ``crank`` where what turns drives strokes.

    Returns
    -------
    list of str
        Empty if nothing is.

    Examples
    --------
    >>> missing_of({"friction_force", "rotation_speed", "normal_force"})[0][:46]
    'the radius of the track, for the sliding speed'
    >>> missing_of({"friction_force", "normal_force", "position"})
    []
    """
    held = set(names)
    said = []
    no_friction, no_speed = not held & _FRICTION, not held & _SPEED
    turns = "rotation_speed" in held
    if no_friction and "torque" in held:
        what = "the radius of the track, for the friction"
        what += " and the sliding speed: " if no_speed and turns else ": "
        formula = "formula = \"torque / '(a length)'\" under [[derived]] of a dialect"
        said.append(what + (f"{formula}, and {_RADIUS}" if no_speed and turns else formula))
    elif no_speed and turns and "crank" in held:
        said.append(_CRANK)
    elif no_speed and turns:
        said.append(f"the radius of the track, for the sliding speed: {_RADIUS}")
    if no_friction and "torque" not in held:
        said.append("the friction: no column is known to hold it")
    if not held & _LOAD:
        said.append('the load: normal_force = "(a force)" in the [[run]] of a campaign file')
    if no_speed and not turns:
        said.append('the sliding speed: sliding_speed = "(a speed)" in the [[run]] of a campaign')
    return said
