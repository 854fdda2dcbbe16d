"""Inputs that are missing for friction against sliding speed, and how to state them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Literal, NamedTuple

from tribolab.reading.interpret.derive import Given, Known, missing_members

Goal = Literal["friction", "load", "speed"]
_GOALS: dict[Goal, tuple[str, ...]] = {  # alternatives; only the first may be derived
    "friction": ("friction_force", "friction_coefficient", "shear_stress"),
    "load": ("normal_force", "normal_stress", "friction_coefficient"),
    "speed": ("sliding_velocity", "position", "set_speed"),
}
_ORDER = ("track_radius", "arm", "stroke", "friction_force", "normal_force", "sliding_velocity")
_SYNONYMS = {"first_radius": "track_radius", "second_radius": "track_radius"}
_RADIUS = 'radius = "(a length)" under [speed] of a dialect'
_FORMULA = "formula = \"torque / '(a length)'\" under [[derived]] of a dialect"
_STROKE = 'stroke = "(a length)" under [speed] of a dialect'
_WHAT = {
    "arm": "the length of the arm, for the friction",
    "stroke": "the length of the stroke, for the sliding speed",
    "friction_force": "the friction",
    "normal_force": "the load",
    "sliding_velocity": "the sliding speed",
}
_HOW = {
    "arm": "a formula under [[derived]] of a dialect",
    "friction_force": "no column is known to hold it",
    "normal_force": 'normal_force = "(a force)" in the [[run]] of a campaign file',
    "sliding_velocity": 'sliding_speed = "(a speed)" in the [[run]] of a campaign',
}
_OPTIONS = {
    "normal_force": "--load 20N",
    "track_radius": "--radius 15mm",
    "sliding_velocity": "--speed 10mm/s",
}
_REVERSING = (
    "how long the strokes are and how often they come, for the sliding speed (the friction turns "
    "over again and again)"
)
_STROKES = (
    'stroke = "(a length)" and frequency = "(e.g. 2 Hz)" under [speed] of a dialect, with source = '
    "'stroke'"
)


class MissingInput(NamedTuple):
    """Missing quantity, what it is needed for, and facts about the rig."""

    member: str
    goals: tuple[Goal, ...]
    facts: frozenset[str] = frozenset()

    @property
    def what(self) -> str:
        """The missing input and its purpose, in words."""
        if self.member == "track_radius":
            wanted = {"friction": "the friction", "speed": "the sliding speed"}
            return f"the radius of the track, for {' and '.join(wanted[g] for g in self.goals)}"
        return _REVERSING if self._reverses else _WHAT[self.member]

    @property
    def option(self) -> str:
        """Command-line option that states the input, with an example; "" if there is none."""
        return "" if self._reverses else _OPTIONS.get(self.member, "")

    @property
    def _reverses(self) -> bool:
        return self.member == "sliding_velocity" and "reversals" in self.facts

    def __str__(self) -> str:
        """Return the missing input in words, and how to state it in a file."""
        if self.member == "track_radius":
            of_goals = {"friction": _FORMULA, "speed": _RADIUS}
            return f"{self.what}: {', and '.join(of_goals[goal] for goal in self.goals)}"
        if self.member == "stroke":
            turns = ", with source = 'stroke' and how often the crank turns"
            return f"{self.what}: {_STROKE}{turns if 'crank' in self.facts else ''}"
        return f"{self.what}: {_STROKES if self._reverses else _HOW[self.member]}"


def missing_inputs(
    known: Known[object] | Collection[str], facts: Collection[str] = ()
) -> list[MissingInput]:
    """Return the inputs that are missing to determine friction, load and sliding speed.

    Parameters
    ----------
    known
        Known inputs by quantity of physics.toml, or only their names.
    facts
        Facts about the rig: "crank" if a rotation drives strokes, "reversals" if the friction
        reverses as in strokes.

    Examples
    --------
    >>> str(missing_inputs({"friction_force", "rotation_speed", "normal_force"})[0])[:46]
    'the radius of the track, for the sliding speed'
    >>> missing_inputs({"friction_force", "normal_force", "position"})
    []
    """
    given: Known[object] = (
        known if isinstance(known, Mapping) else {name: Given(name, name, None) for name in known}
    )
    goals: dict[str, list[Goal]] = {}
    for goal, (first, *others) in _GOALS.items():
        if not any(name in given for name in others):
            for member in missing_members(first, given, facts):
                of_member = goals.setdefault(_SYNONYMS.get(member, member), [])
                of_member += [] if goal in of_member else [goal]
    return [
        MissingInput(member, tuple(goals[member]), frozenset(facts))
        for member in sorted(goals, key=_ORDER.index)
    ]
