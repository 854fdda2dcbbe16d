"""Rules of physics between quantities, from physics.toml, and the units of the quantities."""

from __future__ import annotations

import functools
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

from tribolab.units.conversion import conversion
from tribolab.units.quantities import QUANTITIES, quantity, unit_conversion

_WORD = re.compile(
    r"'(?P<amount>[\d.]+)[^']*'|(?P<name>[a-z]\w*)|(?P<number>\d[\d.]*)|(?P<sign>[*/])"
)


class Rule(NamedTuple):
    """Rule ``gives = formula`` in SI units; with `rate`, ``d(gives)/dt = formula``."""

    gives: str
    formula: str
    rate: bool = False
    use: Literal["both", "proof", "derivation"] = "both"
    condition: str = ""  # required fact about the rig
    asks: tuple[str, ...] = ()
    doubt: str = ""
    speed: str = ""

    @property
    def needs(self) -> tuple[str, ...]:
        """Quantities in the formula."""
        names = (word["name"] for word in _WORD.finditer(self.formula))
        return tuple(dict.fromkeys(name for name in names if name not in (None, "pi")))

    @property
    def members(self) -> tuple[str, ...]:
        """All quantities that the rule relates."""
        return (self.gives, *self.needs, *(("time",) if self.rate else ()))

    @property
    def proves(self) -> bool:
        """Whether columns can prove the rule: a product of quantities that instruments record."""
        known = units_written()
        return (
            self.use != "derivation"
            and not set(self.formula) & set("+-(")
            and all(name in known for name in self.members)
        )

    def powers(self) -> tuple[float, dict[str, int]]:
        """Return the constant factor of the formula and the exponent of each quantity in it."""
        factor, powers, sign = 1.0, dict[str, int](), 1
        for word in _WORD.finditer(self.formula):
            if word["sign"]:
                sign = 1 if word["sign"] == "*" else -1
            elif word["name"]:
                powers[word["name"]] = sign
            else:
                factor *= float(word["amount"] or word["number"]) ** sign
        return factor, powers

    def __str__(self) -> str:
        """Return the rule in words, e.g. "sliding velocity = rotation speed x track radius"."""
        text = self.formula.replace("_", " ").replace("*", "x")
        return f"{self.gives.replace('_', ' ')} = {text}{' x time' if self.rate else ''}"


@functools.cache
def rules() -> tuple[Rule, ...]:
    """Return the rules of physics.toml, in order."""
    fields = ("gives", "formula", "rate", "use", "if", "asks", "doubt", "speed")
    defaults = Rule("", "")
    made = (
        [block.get(*one) for one in zip(fields, defaults, strict=True)] for block in _toml()["rule"]
    )
    return tuple(Rule._make(tuple(v) if isinstance(v, list) else v for v in rule) for rule in made)


def units_written() -> Mapping[str, list[str]]:
    """Return the units that instruments use, by quantity."""
    return _toml()["unit"]


def plausible_sizes() -> Mapping[str, tuple[float, float]]:
    """Return the smallest and largest plausible value [SI] in a friction test, by quantity."""
    return _toml()["size"]


@functools.cache
def si_unit(name: str) -> str:
    """Return the SI unit of a quantity in a rule."""
    if name in QUANTITIES:
        return quantity(name).unit
    return next(unit for unit, names in _toml()["si"].items() if name in names)


@functools.cache
def to_si(name: str, unit: str) -> float:
    """Return the factor that converts a quantity from a unit to its SI unit."""
    if name in QUANTITIES:
        return unit_conversion(unit, name)[0]
    return conversion(unit, si_unit(name))[0]


@functools.cache
def _toml() -> Mapping[str, Any]:
    return tomllib.loads(Path(__file__).with_name("physics.toml").read_text(encoding="utf-8"))
