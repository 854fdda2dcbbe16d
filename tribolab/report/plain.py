"""Conversion of numbers, speeds and lists to plain text, e.g. with unit prefixes."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from decimal import ROUND_HALF_UP, Decimal

from tribolab.core.wording import number

_PREFIXES = ((1e-9, "nm/s"), (1e-6, "µm/s"), (1e-3, "mm/s"), (1.0, "m/s"))


def plain_speed(speed: float | None) -> str:
    """Return a sliding speed [m/s] to two digits with a suitable unit prefix.

    Examples
    --------
    >>> plain_speed(0.999e-6), plain_speed(9.994e-5), plain_speed(4.64e-6), plain_speed(9.996e-4)
    ('1 µm/s', '100 µm/s', '4.6 µm/s', '1 mm/s')

    Measured speeds that belong to one set-point give the same text:

    >>> plain_speed(2.14998e-3), plain_speed(2.15e-3), plain_speed(2.15104e-3)
    ('2.2 mm/s', '2.2 mm/s', '2.2 mm/s')
    """
    if speed is None or not math.isfinite(speed):
        return "speed unknown"
    if speed == 0:
        return "0 m/s"
    rounded = _two_digits(speed)
    factor, prefix = next(
        (pair for pair in _PREFIXES if abs(rounded) < 999.5 * pair[0]), _PREFIXES[-1]
    )
    return f"{number(rounded / factor, 3)} {prefix}"


def _two_digits(speed: float) -> float:
    """Round a speed to two digits, after rounding to three: 2.1499 counts as 2.15.

    Speeds are often set in steps of a third of a decade (1, 2.15, 4.64), and 2.15 is at the edge
    of rounding to two digits.
    """
    three = Decimal(f"{speed:.3g}")
    return float(three.quantize(Decimal((0, (1,), three.adjusted() - 1)), ROUND_HALF_UP))


_SPEED = re.compile(r"(?<![\d.])(\d+(?:\.\d+)?) (nm/s|µm/s|mm/s|m/s)\b")


def plain_speeds(text: str) -> str:
    """Return a text in which each speed has two digits and a suitable unit prefix.

    Examples
    --------
    >>> plain_speeds("from 0.999 µm/s to 99.9 µm/s, 2.15 mm/s")
    'from 1 µm/s to 100 µm/s, 2.2 mm/s'
    """
    factors = {prefix: factor for factor, prefix in _PREFIXES}
    return _SPEED.sub(lambda match: plain_speed(float(match[1]) * factors[match[2]]), text)


_POWER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)e([+-]?\d+)(?: (m/s)\b)?")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def without_exponents(text: str) -> str:
    """Return a text in which numbers such as 1e-9 are written without an exponent.

    Examples
    --------
    >>> without_exponents("below 1e-9 m/s, 7.4e-09 m/s; 1e5 to 2.5e+08 rad/s, 1e-3 of it")
    'below 1 nm/s, 7.4 nm/s; 10⁵ to 2.5 × 10⁸ rad/s, 0.001 of it'
    """

    def plainly(match: re.Match[str]) -> str:
        power = int(match[2])
        if match[3]:
            return plain_speed(float(f"{match[1]}e{power}"))
        if -4 < power < 0:
            return number(float(f"{match[1]}e{power}"), 6)
        raised = f"10{str(power).translate(_RAISED)}"
        return raised if float(match[1]) == 1 else f"{match[1]} × {raised}"

    return _POWER.sub(plainly, text)


def listed(words: Sequence[str]) -> str:
    """Return several words as one text, with commas and "and".

    Examples
    --------
    >>> listed(["31 N", "91 N", "131 N"]), listed(["31 N"])
    ('31 N, 91 N and 131 N', '31 N')
    """
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"
