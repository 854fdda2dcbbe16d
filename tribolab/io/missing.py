"""What a run lacks for a friction coefficient over the sliding speed, and how to state it."""

from __future__ import annotations

from collections.abc import Collection

_FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
_LOAD = {"normal_force", "normal_stress", "friction_coefficient"}
_SPEED = {"sliding_velocity", "position", "set_speed"}
_STROKE = 'stroke = "(a length)" under [speed] of a dialect'
_CRANK = (
    'the length of the stroke, for the sliding speed: stroke = "(a length)" under [speed] of a '
    "dialect, with source = 'stroke' and how often the crank turns"
)
_SHUTTLES = (
    "how long the strokes are and how often they come, for the sliding speed (the friction turns "
    'over again and again): stroke = "(a length)" and frequency = "(e.g. 2 Hz)" under [speed] of a '
    "dialect, with source = 'stroke'"
)
_RADIUS = 'radius = "(a length)" under [speed] of a dialect'


def missing_of(names: Collection[str]) -> list[str]:
    """Say what is missing of friction, load and sliding speed, and how each is stated.

    Parameters
    ----------
    names
        Quantities of the run, ``torque`` where one is known that no radius makes a force of, and
        ``stroke_frequency`` where it is known how often strokes come, and not how long they are,
        ``crank`` where what turns drives strokes; ``reversals`` where the friction turns over as
        that of strokes does.

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
    elif no_speed and "stroke_frequency" in held:
        said.append(f"the length of the stroke, for the sliding speed: {_STROKE}")
    if no_friction and "torque" not in held:
        said.append("the friction: no column is known to hold it")
    if not held & _LOAD:
        said.append('the load: normal_force = "(a force)" in the [[run]] of a campaign file')
    if no_speed and not turns and "stroke_frequency" not in held:
        one_way = 'the sliding speed: sliding_speed = "(a speed)" in the [[run]] of a campaign'
        said.append(_SHUTTLES if "reversals" in held else one_way)
    return said
