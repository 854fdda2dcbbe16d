"""Grammar of units: text is parsed, never evaluated, and limited in length.

    unit   = factor { ("*" | "/" | "." | " ") factor }
    factor = ( name | number | "(" unit ")" ) [ ("**" | "^") exponent | digits | "-" digits ]

Products and quotients are evaluated from left to right, as in pint. Of all numbers only 10 may have
a power.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from tribolab.core.errors import UnitError, shown

_MAX_UNIT = 80  # longest unit in letters; those of rheology need some 30
_DEEPEST = 4
_LARGEST_POWER = 12.0
_TOKEN = re.compile(
    r"\s*(?:(?P<power>\*\*|\^)|(?P<operator>[*/.])|(?P<bracket>[()])"
    r"|(?P<number>\d+(?:\.\d+)?(?:[eE][+-]?\d{1,2})?)|(?P<sign>[+-])"
    r"|(?P<name>[^\W\d_][^\W\d]*|[%°Å]\w*))"
)


class Parsed(NamedTuple):
    """Parsed unit: a number and powers of names; ``10 mm/s2`` is 10, mm: 1, s: -2."""

    factor: float
    powers: dict[str, float]


def parse_unit(text: str) -> Parsed:
    """Return the number and the powers of names that a unit consists of.

    Parameters
    ----------
    text
        Unit as text: ``"mm/s"``, ``"N m-2"``, ``"kg*m**2/s^2"``, ``"10^-3 N"``.

    Raises
    ------
    UnitError
        If it does not follow the grammar, or is longer or larger than a unit can be.

    Examples
    --------
    >>> parse_unit("10 mm/s2")
    Parsed(factor=10.0, powers={'mm': 1.0, 's': -2.0})
    >>> parse_unit("N/(m s)").powers == parse_unit("N*m-1*s**-1").powers
    True
    >>> parse_unit("9**9**9")
    Traceback (most recent call last):
    tribolab.core.errors.UnitError: '9**9**9' is not a unit: of numbers only 10 has powers
    """
    if len(text) > _MAX_UNIT:
        raise UnitError(f"'{text[:20]} ...' is not a unit: it is longer than {_MAX_UNIT} letters")
    if not text.strip():  # a number without a unit
        return Parsed(1.0, {})
    reader = _Reader(text)
    parsed = reader.unit(0)
    if reader.kind:
        raise reader.error(f"'{shown(reader.value)}' does not belong there")
    return parsed


class _Reader:
    """Reader of a unit, one token at a time."""

    def __init__(self, text: str) -> None:
        self.text, self.at = text.strip(), 0
        self.kind, self.value, self.apart = "", "", False
        self.step()

    def step(self) -> None:
        rest = self.text[self.at :]
        if not rest:
            self.kind, self.value = "", ""
            return
        match = _TOKEN.match(rest)
        if match is None:
            raise self.error(f"'{rest[0]}' does not belong there")
        self.kind, self.value = str(match.lastgroup), match[str(match.lastgroup)]
        self.apart = rest[0].isspace()
        self.at += match.end()

    def error(self, why: str) -> UnitError:
        return UnitError(f"'{shown(self.text)}' is not a unit: {why}")

    def unit(self, depth: int) -> Parsed:
        if depth > _DEEPEST:
            raise self.error("too many brackets")
        factor, powers = self.factor(depth)
        powers = dict(powers)
        while self.kind and self.value != ")":
            over = self.value == "/"
            if self.kind == "operator":
                self.step()
            elif self.kind == "number":  # a number after a name, such as "ch 1", is a channel
                raise self.error(f"'{shown(self.value)}' does not belong there")
            more, names = self.factor(depth)
            if over and more == 0:
                raise self.error("it divides by zero")
            factor = factor / more if over else factor * more
            for name, power in names.items():
                powers[name] = powers.get(name, 0.0) + (-power if over else power)
        if not 1e-60 < abs(factor) < 1e60 or any(
            abs(power) > _LARGEST_POWER for power in powers.values()
        ):
            raise self.error("its numbers are out of range")
        return Parsed(factor, powers)

    def factor(self, depth: int) -> Parsed:
        kind, value = self.kind, self.value
        if kind == "number":
            parsed = Parsed(float(value), {})
        elif kind == "name":
            parsed = Parsed(1.0, {value: 1.0})
        elif value == "(":
            self.step()
            parsed = self.unit(depth + 1)
            if self.value != ")":
                raise self.error("a bracket is not closed")
        else:
            raise self.error(f"after '{shown(self.text[: self.at])}' a name is wanted")
        self.step()
        power = self.power(kind)
        if power is None:
            return parsed
        if parsed.powers == {} and value != "10":
            raise self.error("of numbers only 10 has powers")
        if abs(power) > 3 * _LARGEST_POWER or (abs(power) > _LARGEST_POWER and parsed.powers):
            raise self.error(f"the power {power:g} is out of range")
        return Parsed(parsed.factor**power, {n: p * power for n, p in parsed.powers.items()})

    def power(self, of: str) -> float | None:
        """Read a power: after ** or ^, or digits directly after a name, as in m2 and s-1."""
        signed = self.kind == "power"
        if signed:
            self.step()
        elif self.apart or of == "number" or self.kind not in ("number", "sign"):
            return None
        sign = 1.0
        if self.kind == "sign":
            sign = -1.0 if self.value == "-" else 1.0
            self.step()
        bracket = signed and self.value == "("
        if bracket:
            self.step()
            if self.kind == "sign":
                sign = -1.0 if self.value == "-" else 1.0
                self.step()
        if self.kind != "number" or len(self.value) > 4:
            raise self.error("a power is a small number")
        power = sign * float(self.value)
        self.step()
        if bracket:
            if self.value != ")":
                raise self.error("a bracket is not closed")
            self.step()
        return power
