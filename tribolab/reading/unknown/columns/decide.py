"""Assignment of quantities to all columns at once, with the largest total evidence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.core.errors import shown
from tribolab.reading.interpret.names import KNOWN_WORD, Match
from tribolab.reading.unit_texts import converts
from tribolab.reading.unknown.columns.evidence import (
    BOTH_FORCES,
    NEAR,
    RULED_OUT,
    UNSURE,
    Evidence,
    Facts,
    Rule,
    is_contested,
)
from tribolab.reading.unknown.columns.unit_and_sign import FORCES, filled_in
from tribolab.reading.unknown.model import DraftColumn, Reason
from tribolab.units.quantities import quantity

SIGNALS = {
    "friction_force",
    "normal_force",
    "friction_coefficient",
    "sliding_velocity",
    "position",
    "shear_stress",
    "film_thickness",
}
_TORQUE = "a torque: with the radius at which it acts it is a force"
_NOTHING = -20.0  # log odds of a column that gets no quantity
_NOT_PROPOSED = -1000.0


def decide(facts: Facts, rules: Sequence[Rule]) -> list[DraftColumn]:
    """Assign each quantity to at most one column, with the largest total evidence.

    Return the columns with quantities and guesses; columns without a quantity have the reason.
    """
    evidence = [one for rule in rules for one in rule(facts)]
    names = sorted({one.quantity for one in evidence if one.proposes})
    score = _scores(facts, evidence, names)
    by_place: dict[int, list[Evidence]] = {}
    for one in evidence:
        by_place.setdefault(one.place, []).append(one)
    decided = _Assignment(facts, by_place, names, score, _assign(score))
    return [_described(decided, place) for place in range(len(facts.columns))]


class _Assignment(NamedTuple):
    """Chosen quantity of each column, as an index of `names`, and the evidence by column."""

    facts: Facts
    by_place: Mapping[int, Sequence[Evidence]]
    names: Sequence[str]
    score: np.ndarray
    chosen: Sequence[int | None]

    def about(self, place: int) -> Sequence[Evidence]:
        """Return the evidence on one column."""
        return self.by_place.get(place, ())

    def option(self, place: int, name: str) -> Match:
        """Return how well a column's name suits a quantity; evidence may make it certain."""
        said = [option for option in self.facts.options[place] if option.quantity == name]
        option = said[0] if said else Match(name, UNSURE, None)
        if any(one.sure and one.quantity == name for one in self.about(place)):
            return option._replace(score=max(option.score, KNOWN_WORD))
        if option.score < KNOWN_WORD and self.other_force_is_taken(place, name):
            return option._replace(score=KNOWN_WORD)
        return option

    def other_force_is_taken(self, place: int, name: str) -> bool:
        """Whether a column must be one of both forces, because another column is the other one."""
        other = BOTH_FORCES[name == BOTH_FORCES[0]]
        if not self.facts.is_either_force(place) or other not in self.names:
            return False
        k = self.names.index(other)
        return k in self.chosen and self.facts.is_named(self.chosen.index(k), other)

    def rivals(self, place: int) -> list[int]:
        """Return columns without a quantity that suit this column's quantity about as well."""
        k = self.chosen[place]
        if k is None:
            return []
        least = self.score[place, k] - NEAR
        return [
            other
            for other, taken in enumerate(self.chosen)
            if taken is None
            and self.score[other, k] > RULED_OUT / 2
            and (
                self.score[other, k] > least
                or is_contested(self.facts, other, place, self.names[k])
            )
        ]

    def has_spares(self, place: int) -> bool:
        """Whether a force has several columns, but only this one has values in this file."""
        k, rivals = self.chosen[place], self.rivals(place)
        filled = [np.any(np.isfinite(x) & (x != 0)) for x in self.facts.numbers[:, rivals].T]
        return k is not None and self.names[k] in FORCES and bool(rivals) and not any(filled)


def _scores(facts: Facts, evidence: Sequence[Evidence], names: Sequence[str]) -> np.ndarray:
    """Return the total weight of evidence for each column (rows) and quantity (columns)."""
    score = np.full((len(facts.columns), len(names)), _NOT_PROPOSED)
    for one in evidence:
        if one.proposes:
            score[one.place, names.index(one.quantity)] = 0.0
    for one in evidence:
        if not one.quantity:
            score[one.place] += one.weight
        elif one.quantity in names:
            score[one.place, names.index(one.quantity)] += one.weight
    return score


def _assign(score: np.ndarray) -> list[int | None]:
    """Return, for each column, the index of its quantity in the scores, or None."""
    chosen: list[int | None] = [None] * len(score)
    if not score.size:
        return chosen
    rows = np.flatnonzero(score.max(axis=1) > _NOTHING)
    best = score[rows].argmax(axis=1)
    if np.unique(best).size < best.size:
        # imported late: takes longer to load than a known file takes to read
        from scipy.optimize import linear_sum_assignment

        found, best = linear_sum_assignment(-np.maximum(score[rows], _NOTHING))
        rows = rows[found]
    for row, k in zip(rows.tolist(), best.tolist(), strict=True):
        chosen[row] = k if score[row, k] > _NOTHING else None
    return chosen


def _described(decided: _Assignment, place: int) -> DraftColumn:
    """Return a column with its quantity, and the guesses that the user has to confirm."""
    k, facts, column = decided.chosen[place], decided.facts, decided.facts.columns[place]
    if k is None:
        return _unused(decided, place)
    name = decided.names[k]
    option, rivals = decided.option(place, name), decided.rivals(place)
    if decided.has_spares(place):
        return _filled(decided, place, name)._replace(optional=True)
    result = _filled(decided, place, name, several=bool(rivals))
    options = [*result.options, *(f"column {other + 1}" for other in rivals)]
    if option.score < KNOWN_WORD:
        others = [other.quantity for other in facts.options[place] if other.quantity != name]
        options += [*others, "not used"]
    about = decided.about(place)
    doubts = [one.doubt for one in about if one.doubt and one.quantity in (name, "")]
    if doubts and not options and name in BOTH_FORCES:
        options = [BOTH_FORCES[name == BOTH_FORCES[0]], "not used"]
    result = result._replace(options=tuple(options), guessed=(*result.guessed, *doubts))
    if option.score < KNOWN_WORD and facts.is_either_force(place) and not result.fill_in:
        return result._replace(
            used=False,
            fill_in=Reason.EITHER_FORCE.value.format(shown(column.label)),
            reason=Reason.EITHER_FORCE,
        )
    return result


def _filled(decided: _Assignment, place: int, name: str, *, several: bool = False) -> DraftColumn:
    facts = decided.facts
    option, values = decided.option(place, name), facts.numbers[:, place]
    return filled_in(
        facts.columns[place], facts.bare[place], option, values, facts.kind, several=several
    )


def _unused(decided: _Assignment, place: int) -> DraftColumn:
    """Return a column without a quantity, with the reason as its note."""
    facts, names, score = decided.facts, decided.names, decided.score
    column = facts.columns[place]
    if not column.label:
        return column
    about = decided.about(place)
    why = next((one.why for one in about if one.weight <= RULED_OUT and one.why), "")
    k = int(np.argmax(score[place])) if names else 0
    if not names or score[place, k] < _NOTHING or k not in decided.chosen:
        hint = why or _hint(facts, place)
        unknown = Reason.UNKNOWN_NAME if hint == "" else None
        return column._replace(note=hint or Reason.UNKNOWN_NAME.value, reason=unknown)
    taken = decided.chosen.index(k)
    if decided.has_spares(taken):
        note = f"nothing but zeros here; column {taken + 1} is filled"
        return _filled(decided, place, names[k])._replace(optional=True, note=note)
    note = f"also looks like {names[k]}; column {taken + 1} is used"
    return column._replace(quantity=names[k], note=note)


def _hint(facts: Facts, place: int) -> str:
    """Return the quantity suggested by the unit of a column with an unknown name, else ""."""
    unit = facts.bare[place][1]
    if unit is None:
        return ""
    fits = [q for q in SIGNALS if quantity(q).unit != "1" and converts(unit, quantity(q).unit)]
    if fits:
        return f"its unit fits {' or '.join(sorted(fits))}"
    return _TORQUE if converts(unit, "N m") else ""
