"""Derivation of quantities from known ones by rules of physics, and missing inputs.

Known quantities are columns, amounts stated in text, and the user's answers. The rules are those of
physics.toml; the user is asked for a quantity that no rule gives.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Generic, NamedTuple, TypeVar

from tribolab.reading.interpret.rules import Rule, rules

_DOUBT = re.compile(r"(?P<over>\w+) / (?P<under>\w+) > (?P<most>[\d.]+)")
_WORD = re.compile(r"'[^']*'|[a-z]\w*")
_SIGN = re.compile(r" [-+*/] ")
_Source = TypeVar("_Source")


class Given(NamedTuple, Generic[_Source]):
    """Known quantity with its symbol in formulas, its source, and its value [SI] if it has one."""

    quantity: str
    symbol: str
    source: _Source
    number: float | None = None


class Derivation(NamedTuple, Generic[_Source]):
    """Derivation tree of a quantity, which is either known or follows from others by a rule."""

    quantity: str
    given: Given[_Source] | None = None
    rule: Rule | None = None
    needs: tuple[Derivation[_Source], ...] = ()

    @property
    def formula(self) -> str:
        """The quantity as a formula of known quantities, in the notation of dialects."""
        if self.given is not None or self.rule is None:
            return self.given.symbol if self.given is not None else ""
        parts = {need.quantity: need.formula for need in self.needs}
        composed = {need.quantity for need in self.needs if _SIGN.search(parts[need.quantity])}

        def written(word: re.Match[str]) -> str:
            part = parts.get(word[0], word[0])
            return f"({part})" if word[0] in composed else part

        return _WORD.sub(written, self.rule.formula)

    @property
    def leaves(self) -> tuple[Given[_Source], ...]:
        """Known quantities on which the derived quantity depends, each once."""
        if self.given is not None:
            return (self.given,)
        return tuple(dict.fromkeys(leaf for need in self.needs for leaf in need.leaves))

    @property
    def is_doubtful(self) -> bool:
        """Whether a rule used in the derivation may be invalid for these numbers."""
        return any(need.is_doubtful for need in self.needs) or (
            self.rule is not None and _in_doubt(self.rule, self.needs)
        )


Known = Mapping[str, Given[_Source]]


def derive(
    goal: str,
    known: Known[_Source],
    facts: Collection[str] = (),
    *,
    without: frozenset[str] = frozenset(),
) -> Derivation[_Source] | None:
    """Return how a quantity can be derived from known ones; None if this is not possible.

    Parameters
    ----------
    goal
        A quantity of physics.toml.
    known
        Known inputs by quantity.
    facts
        Facts on the rig, e.g. "crank" of a reciprocating drive.
    without
        Quantities whose derivation is already in progress.

    Examples
    --------
    >>> names = ("torque", "inner_radius", "outer_radius")
    >>> known = {name: Given(name, name, None) for name in names}
    >>> derive("friction_force", known).formula
    'torque / ((inner_radius + outer_radius) / 2)'
    """
    if goal in known:
        return Derivation(goal, known[goal])
    if goal in without:
        return None
    for rule, wanted in rules_for(goal, facts):
        needs = [derive(name, known, facts, without=without | {goal}) for name in wanted]
        found = tuple(need for need in needs if need is not None)
        if len(found) == len(needs):
            return Derivation(goal, None, rule, found)
    return None


def missing_members(
    goal: str,
    known: Known[_Source],
    facts: Collection[str] = (),
    *,
    without: frozenset[str] = frozenset(),
) -> tuple[str, ...]:
    """Return the inputs that are missing to derive a quantity; empty if nothing is missing.

    These are the unknown inputs of a rule whose other inputs are known, else the quantity itself.

    Examples
    --------
    >>> missing_members("friction_force", {"torque": Given("torque", "torque", None)})
    ('track_radius',)
    >>> missing_members("friction_force", {})
    ('friction_force',)
    """
    if derive(goal, known, facts, without=without) is not None:
        return ()
    sought = without | {goal}
    for rule, wanted in rules_for(goal, facts):
        lost = [n for n in wanted if derive(n, known, facts, without=sought) is None]
        members: list[str] = []
        for name in lost:
            deeper = (
                (name,) if name in sought else missing_members(name, known, facts, without=sought)
            )
            members += deeper if deeper != (name,) or name in rule.asks else [""]
        if members and "" not in members:
            return tuple(dict.fromkeys(members))
    return (goal,)


def rules_for(goal: str, facts: Collection[str]) -> Iterator[tuple[Rule, tuple[str, ...]]]:
    """Yield each rule that gives a quantity, with its inputs; a speed follows from the position."""
    for rule in rules():
        if rule.use == "proof" or (rule.condition and rule.condition not in facts):
            continue
        if rule.rate and rule.formula == goal:
            yield rule, (rule.gives,)
        elif rule.gives == goal and not rule.rate:
            yield rule, rule.needs


def _in_doubt(rule: Rule, needs: tuple[Derivation[_Source], ...]) -> bool:
    ratio = _DOUBT.fullmatch(rule.doubt)
    if ratio is None:
        return rule.doubt == "always"
    numbers = {need.quantity: need.given.number for need in needs if need.given is not None}
    over, under = numbers.get(ratio["over"]), numbers.get(ratio["under"])
    if over is None or under is None:
        return True
    return over > float(ratio["most"]) * under
