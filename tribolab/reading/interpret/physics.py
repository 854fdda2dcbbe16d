"""Identification of columns by rules of physics that their numbers obey.

A rule whose members may all be columns of a file is tested on the rows. If the ratio of its two
sides is constant, and some units make it 1, the meaning of these columns is proved.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tribolab.reading.interpret.limits import AGREEMENT, ROWS, SPREAD
from tribolab.reading.interpret.rules import (
    Rule,
    plausible_sizes,
    rules,
    si_unit,
    to_si,
    units_written,
)
from tribolab.reading.unit_texts import converts
from tribolab.units.quantities import QUANTITIES
from tribolab.units.spellings import WEIGHTS

_MAX_MEMBERS = 500  # combinations of columns that are tested for one rule
Units = dict[int, str]


class Candidate(NamedTuple):
    """Possible quantities of a column, and its unit (None if not stated)."""

    quantities: frozenset[str]
    unit: str | None


class Proof(NamedTuple):
    """Proven quantity and unit of a column, and the rules of physics that prove them."""

    quantity: str
    unit: str
    rules: tuple[Rule, ...]


class _Fit(NamedTuple):
    rule: Rule
    places: tuple[int, ...]  # column indices of the rule's result and inputs
    spread: float
    units: list[tuple[str, ...]]

    @property
    def roles(self) -> dict[int, str]:
        return dict(zip(self.places, self.rule.members, strict=True))


def prove(candidates: Sequence[Candidate], numbers: np.ndarray) -> dict[int, Proof]:
    """Return the quantities and units of those columns whose numbers prove them.

    Keys are column indices from 0. Columns whose unit remains ambiguous are left out.
    """
    roles: dict[int, str] = {}
    fits: list[_Fit] = []
    found = (
        fit
        for rule in rules()
        if rule.proves
        for places in _members(rule, candidates)
        if (fit := _fit(rule, places, candidates, numbers)) is not None
    )
    for fit in sorted(found, key=lambda fit: fit.spread):
        if all(roles.get(place, role) == role for place, role in fit.roles.items()):
            roles |= fit.roles
            fits.append(fit)
    return {
        place: Proof(roles[place], unit, tuple(fit.rule for fit in fits if place in fit.places))
        for place, unit in _only_units(fits).items()
    }


def known_quantities() -> frozenset[str]:
    """Return the quantities that can be proven by rules of physics."""
    return frozenset(name for rule in rules() if rule.proves for name in rule.members)


def _members(rule: Rule, candidates: Sequence[Candidate]) -> Iterator[tuple[int, ...]]:
    """Yield each combination of distinct columns that may be the quantities in a rule."""
    options = [
        [place for place, candidate in enumerate(candidates) if name in candidate.quantities]
        for name in rule.members
    ]
    for places in itertools.islice(itertools.product(*options), _MAX_MEMBERS):
        if len(set(places)) == len(places):
            yield places


def _fit(
    rule: Rule,
    places: tuple[int, ...],
    candidates: Sequence[Candidate],
    numbers: np.ndarray,
) -> _Fit | None:
    """Return the units in which the columns obey a rule; None if there are no such units."""
    left = numbers[:, places[0]]
    right = _product(rule, numbers[:, places[1 : 1 + len(rule.needs)]])
    if rule.rate:
        # an integral must follow its rate over each tenth of the record
        edges = np.linspace(0, len(left) - 1, min(11, len(left))).astype(int)
        steps = 0.5 * (right[1:] + right[:-1]) * np.diff(numbers[:, places[-1]])
        sums = np.concatenate([[0.0], np.cumsum(np.where(np.isfinite(steps), steps, 0.0))])
        left, right = np.diff(left[edges]), np.diff(sums[edges])
    usable = np.isfinite(left) & np.isfinite(right) & (right != 0)
    usable &= np.abs(left) > 0.05 * np.nanmax(np.abs(left), initial=0.0)  # few digits near zero
    if usable.sum() < (5 if rule.rate else ROWS.value):
        return None
    low, ratio, high = np.quantile(left[usable] / right[usable], [0.1, 0.5, 0.9])
    spread = (high - low) / abs(ratio) if ratio else math.inf
    if not ratio > 0 or not spread < SPREAD.value:
        return None
    units = [
        units
        for units in itertools.product(*_units(rule, places, candidates, numbers))
        if abs(ratio / _expected(rule, units) - 1) < AGREEMENT.value
    ]
    return _Fit(rule, places, spread, units) if units else None


def _expected(rule: Rule, units: tuple[str, ...]) -> float:
    """Return the ratio of a rule's left to right side, if all numbers are in the given units."""
    factor, powers = rule.powers()
    scales = [to_si(n, u) for n, u in zip(rule.members, units, strict=True)]
    right = (s ** powers.get(n, 1) for n, s in zip(rule.members[1:], scales[1:], strict=True))
    return factor * math.prod(right) / scales[0]


def _product(rule: Rule, columns: np.ndarray) -> np.ndarray:
    powers = rule.powers()[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.prod([c ** powers[n] for n, c in zip(rule.needs, columns.T, strict=True)], axis=0)


def _units(
    rule: Rule,
    places: tuple[int, ...],
    candidates: Sequence[Candidate],
    numbers: np.ndarray,
) -> Iterator[list[str]]:
    """Yield, for each quantity in a rule, the units in which its column has a plausible size."""
    for name, place in zip(rule.members, places, strict=True):
        own = candidates[place].unit
        options = units_written()[name] if own is None else _read_as(name, own)
        values = np.abs(numbers[:, place])
        size = float(np.nanmax(values, initial=0.0))
        least, most = plausible_sizes()[name]
        yield [unit for unit in options if least <= size * to_si(name, unit) <= most]


def _read_as(name: str, unit: str) -> list[str]:
    """Return the unit of a column as a list, empty if it does not fit the quantity `name`.

    For a force, "g" becomes "gf".
    """
    si = si_unit(name)
    read = WEIGHTS.get(unit, unit) if si == "N" else unit
    bare = QUANTITIES[name].bare if name in QUANTITIES else None
    return [read] if converts(read, si, bare) else []


def _only_units(fits: Sequence[_Fit]) -> Units:
    """Return the units that all rules together determine uniquely, by column index."""
    options = [list(fit.units) for fit in fits]
    domains: dict[int, set[str]] = {}
    changed = True
    while changed:
        changed, domains = False, {}
        for fit, units in zip(fits, options, strict=True):
            for n, place in enumerate(fit.places):
                here = {choice[n] for choice in units}
                domains[place] = domains[place] & here if place in domains else here
        for k, fit in enumerate(fits):
            kept = [
                choice
                for choice in options[k]
                if all(unit in domains[p] for p, unit in zip(fit.places, choice, strict=True))
            ]
            changed |= len(kept) < len(options[k])
            options[k] = kept
    return (
        {place: min(units) for place, units in domains.items() if len(units) == 1} if fits else {}
    )
