"""Evidence for the quantity of a column from its name, its numbers and the other columns.

Each rule is a generator of `Evidence`. Weights are logarithms of odds and are added, so that the
order of rules does not matter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.reading.interpret.names import KNOWN_WORD, Match, is_count
from tribolab.reading.lexicon.lexicon import Role, normalise_label, role_of
from tribolab.reading.runs.force_ratio import LARGEST
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.rotating_parts import torque_of
from tribolab.reading.unknown.columns.unit_and_sign import FORCES, Bare
from tribolab.reading.unknown.model import DraftColumn, Kind
from tribolab.units.quantities import QUANTITIES, quantity, unit_conversion

RULED_OUT = -100.0
NEAR = 0.05  # two names whose scores differ by less suit a quantity about equally well
BOTH_FORCES = ("friction_force", "normal_force")  # either may be measured by a load cell
FRICTION = {"friction_force", "friction_coefficient", "shear_stress"}
# log odds by the role of a column: measured columns are preferred to set and derived ones
_ROLE: dict[Role, float] = {
    "": 0.0,
    "measured": math.log(1.1),
    "derived": math.log(0.6),
    "set": math.log(0.5),
    "extreme": math.log(0.4),
}
_CONSTANT = math.log(0.9)  # log odds of a constant force, which is probably a set-point
_PREFERRED = 0.03  # log odds by magnitude, for a name that may mean two quantities
_CROSSTALK = 5.0  # least ratio of the force along the motion to a force across it
_ACROSS = {"fy"}  # names of the force across the motion
_RADIAL = {"fr", "frad"}  # friction force; in a file with a torque, the load on the shaft
UNSURE = 0.5  # score of a name whose meaning the user has to confirm
_DECIDING = FORCES | {"sliding_velocity", "rotation_speed"}
_DIFFERENT = 0.01  # relative difference of two columns that are not copies


class Evidence(NamedTuple):
    """Evidence for (or, with a negative weight, against) a quantity of the column `place` (from 0).

    With the quantity "", the weight applies to all quantities. Only quantities that some evidence
    `proposes` are possible. With `sure` the user need not confirm the quantity, with `doubt` he has
    to.
    """

    place: int
    quantity: str
    weight: float
    why: str = ""
    proposes: bool = False
    sure: bool = False
    doubt: str = ""


class Facts(NamedTuple):
    """What is known about a table before its columns are assigned to quantities.

    Attributes
    ----------
    columns, bare
        The columns, and their names without units.
    options
        For each column the possible quantities of its name, the most likely first.
    numbers
        Numbers of the columns (rows, columns) as written.
    kind
        Whether the file is a run, a scan or another table.
    """

    columns: Sequence[DraftColumn]
    bare: Sequence[Bare]
    options: Sequence[Sequence[Match]]
    numbers: np.ndarray
    kind: Kind

    def candidates(self, place: int) -> list[Match]:
        """Return the quantities of a column's name that score about as high as the best."""
        options = self.options[place]
        return [o for o in options if o.score >= options[0].score - NEAR]

    def places(self, name: str) -> list[int]:
        """Return the indices of the columns whose names most likely mean a quantity."""
        return [p for p, o in enumerate(self.options) if o and o[0].quantity == name]

    def is_named(self, place: int, name: str = "") -> bool:
        """Whether a column's name certainly means the given quantity, or any if none is given."""
        options = self.options[place]
        return (
            bool(options) and options[0].score >= KNOWN_WORD and name in ("", options[0].quantity)
        )

    def any_named(self, name: str) -> bool:
        """Whether any column's name certainly means the given quantity."""
        return any(self.is_named(place, name) for place in range(len(self.options)))

    def is_either_force(self, place: int) -> bool:
        """Whether a column's name may mean both the friction force and the normal force."""
        near = {option.quantity for option in self.candidates(place)}
        return not self.is_named(place) and set(BOTH_FORCES) <= near


Rule = Callable[[Facts], Iterator[Evidence]]


def name_evidence(facts: Facts) -> Iterator[Evidence]:
    """Propose the quantities that a column's name may mean; complete terms weigh most."""
    for place, options in enumerate(facts.options):
        for rank, option in enumerate(facts.candidates(place) if options else ()):
            weight = math.log(option.score) - 1e-3 * rank
            yield Evidence(place, option.quantity, weight, proposes=True)


def role_evidence(facts: Facts) -> Iterator[Evidence]:
    """Favour measured columns over set and derived ones.

    File: a Bruker UMT log with "Set Force" next to "Fz" (okilitive/CETR-tribometer).
    """
    if facts.kind == "run":
        for place, (name, _, _) in enumerate(facts.bare):
            yield Evidence(place, "", _ROLE[role_of(name)])


def repeated_name_evidence(facts: Facts) -> Iterator[Evidence]:
    """Favour the later of two columns with one name: some exporters put plotted columns first."""
    filled = (np.isfinite(facts.numbers) & (facts.numbers != 0)).any(axis=0)
    for place in range(len(facts.columns)):
        yield Evidence(place, "", 1e-4 * filled[place] + 1e-6 * place / len(facts.columns))


def number_evidence(facts: Facts) -> Iterator[Evidence]:
    """Judge by magnitude and steps if a column's name may mean several quantities."""
    has_units = any(unit is not None for _, unit, _ in facts.bare)
    for place, options in enumerate(facts.options):
        values = facts.numbers[:, place]
        for name in FORCES if options and np.ptp(values) == 0 else ():
            yield Evidence(place, name, _CONSTANT, "it is constant")
        if not options or facts.bare[place][1] is not None or len(facts.candidates(place)) == 1:
            continue
        sizes = np.abs(values[np.isfinite(values)])
        for option in facts.candidates(place):
            ratio = option.quantity in QUANTITIES and QUANTITIES[option.quantity].unit == "1"
            if ratio and (has_units or (sizes.size and np.median(sizes) < 2)):
                yield Evidence(place, option.quantity, _PREFERRED + NEAR, "its size is a ratio's")
            elif ratio and sizes.size and np.median(sizes) > LARGEST:
                yield Evidence(place, option.quantity, RULED_OUT, "it is larger than a coefficient")
        if options[0].quantity == "time" and not (np.diff(values) >= 0).all():
            yield Evidence(place, "time", -_PREFERRED - NEAR, "it does not rise")


def advance_evidence(facts: Facts) -> Iterator[Evidence]:
    """Rule out a constant column of time (or x of a scan) if another one rises in every row.

    Files: a Phoenix TE 67, "Step Time" next to "Test Time" (kyembot/pin-on-disk-data-analysis); a
    pen profilometer, two encoders (jonathan-bender/scaling-octo-telegram).
    """
    for name in ("time", "x"):
        steps = {place: np.diff(facts.numbers[:, place]) for place in facts.places(name)}
        if any(moved.size and (moved > 0).all() for moved in steps.values()):
            for place in (place for place, moved in steps.items() if not moved.any()):
                yield Evidence(place, "", RULED_OUT, "it is the same in all rows")


def size_evidence(facts: Facts) -> Iterator[Evidence]:
    """Favour the larger of two forces: a sensor across the motion measures only cross-talk.

    File: six axes of a load cell, Fx 2.3 N along and Fy 0.3 N across (liampond/EgbertsTribometer).
    """
    places = [p for p in facts.places("friction_force") if facts.is_named(p)]
    sizes = {place: typical_size(facts, place) for place in places}
    for place in places:
        others = [sizes[other] for other in places if other != place]
        plain = not role_of(facts.bare[place][0])
        if plain and others and sizes[place] > _CROSSTALK * max(others) > 0:
            yield Evidence(place, "friction_force", 0.3, "it is the larger force")


def rectified_evidence(facts: Facts) -> Iterator[Evidence]:
    """Favour a force with a sign over its magnitude: Bruker UMT writes both Fx and Ff."""
    places = [p for p in facts.places("friction_force") if facts.is_named(p)]
    for place in places:
        signed = facts.numbers[:, place]
        for other in places if (signed < 0).any() else ():
            gap = np.abs(np.abs(signed) - facts.numbers[:, other])
            gap = gap[np.isfinite(gap)]
            near = _DIFFERENT * np.nanmax(np.abs(signed), initial=0.0)
            if other != place and gap.size and gap.max() <= near:
                yield Evidence(place, "friction_force", 0.3, "the other is its magnitude")


def row_count_evidence(facts: Facts) -> Iterator[Evidence]:
    """Rule out a column "n" that increases by one in each row: it is a row counter."""
    for place, (name, unit, _) in enumerate(facts.bare):
        if normalise_label(name) != "n" or unit is not None:
            continue
        numbers = facts.numbers[:, place]
        if np.isfinite(numbers).all() and (np.diff(numbers) == 1).all():
            yield Evidence(place, "", RULED_OUT, "it counts the rows")


def torque_evidence(facts: Facts) -> Iterator[Evidence]:
    """If a torque is recorded, take it as the friction rather than forces with unclear names."""
    torque = torque_of(facts.columns) is not None
    if torque and not any(facts.places(name) for name in (*FRICTION, "normal_force")):
        forces = [p for p, (_, unit, _) in enumerate(facts.bare) if unit and converts(unit, "N")]
        for place in forces if len(forces) == 1 else ():
            doubt = "it is the load, the only force next to a torque"
            yield Evidence(place, "normal_force", 0.0, proposes=True, sure=True, doubt=doubt)
    ratio = facts.any_named("friction_coefficient")
    pressed = facts.places("normal_force")
    for place, (name, _, _) in enumerate(facts.bare):
        short = normalise_label(name)
        if torque and short in _RADIAL:
            yield Evidence(place, "", RULED_OUT)
            yield Evidence(place, "normal_force", math.log(UNSURE) - RULED_OUT, proposes=True)
        elif torque and facts.is_either_force(place) and not {*pressed} - {place}:
            why = "the torque is the friction"
            yield Evidence(place, "friction_force", RULED_OUT, why)
            yield Evidence(place, "normal_force", 0.0, why, sure=True)
        elif not facts.options[place] or facts.options[place][0].quantity != "friction_force":
            continue
        elif (short in _ACROSS and (torque or ratio)) or (torque and role_of(name) == "extreme"):
            yield Evidence(place, "", RULED_OUT)


def typical_size(facts: Facts, place: int) -> float:
    """Return the median magnitude of a column's nonzero numbers in SI units."""
    option, unit = facts.options[place][0], facts.bare[place][1]
    unit = None if unit is not None and is_count(unit) else unit
    known = quantity(option.quantity)
    scale = unit_conversion(option.unit or unit or known.unit, option.quantity)[0]
    values = np.abs(facts.numbers[:, place])
    moving = values[np.isfinite(values) & (values > 0)]
    return float(scale * np.median(moving)) if moving.size else 0.0


def is_contested(facts: Facts, place: int, best: int, name: str) -> bool:
    """Whether two columns are equally well named for a quantity, but contain different values."""
    if name not in _DECIDING or role_of(facts.bare[best][0]) == "measured":
        return False
    if role_of(facts.bare[place][0]) or not facts.is_named(place, name):
        return False
    sizes = typical_size(facts, place), typical_size(facts, best)
    across = normalise_label(facts.bare[place][0]) in _ACROSS and sizes[0] < sizes[1]
    return not across and min(sizes) > 0 and abs(sizes[0] / sizes[1] - 1) > _DIFFERENT


RULES: tuple[Rule, ...] = (
    name_evidence,
    role_evidence,
    repeated_name_evidence,
    number_evidence,
    advance_evidence,
    size_evidence,
    rectified_evidence,
    row_count_evidence,
    torque_evidence,
)
