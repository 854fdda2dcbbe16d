"""Interpretation of typed amounts: number with unit, weight, strokes, turns."""

from __future__ import annotations

import math
import re

from tribolab.core.errors import ReadError, TribolabError
from tribolab.reading.unit_texts import converts, is_unit
from tribolab.units.conversion import positive
from tribolab.units.reciprocals import reciprocal
from tribolab.units.spellings import WEIGHTS

_COMMA = re.compile(r"^(\d+),(\d{1,2}|\d{4,})(?=\D)")  # decimal comma, not a thousands separator
_WEIGHT = re.compile(rf"^(\s*[\d.]+(?:[eE][+-]?\d+)?\s*)({'|'.join(WEIGHTS)})\s*$")
_TIMES = re.compile(r"^(\d+(?:[.,]\d+)?)\s*[x×*·]\s*(?=\d)")  # a weight on a lever: 10 x 5 kg
_AMOUNT = re.compile(  # "8 mm at 2 Hz"
    r"(?<![\w.,])(?P<number>\d+(?:[.,]\d+)?)\s*(?P<unit>[^\W\d_][^\s,;]*)"
)
NUMBER = re.compile(r"^[+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?$")
DECIMAL = re.compile(r"^[+-]?\d+[.,]\d+$")  # a decimal number, hence no column number
_RADIUS = re.compile(r"\b(radius|diameter)\b", re.IGNORECASE)
_EXAMPLE = {"load": "20 N", "speed": "6 mm/min", "rate": "100 Hz"}
_USUAL = {"m": "mm", "N": "N", "m/s": "mm/s", "Hz": "Hz", "s": "s"}
_AMOUNTS = {"load": ("N",), "speed": ("m/s",), "rate": ("Hz", "s")}


def as_amount(typed: str, amount: str) -> str:
    """Return a typed load, speed or rate as a number with a unit; "" if a column was typed."""
    if DECIMAL.match(typed):
        raise ReadError(f"{typed} has no unit: type it with one, such as {_EXAMPLE[amount]}")
    if NUMBER.match(typed) or not typed[0].isdigit():
        return ""
    if amount == "speed" and (speed := turning(typed)):
        return speed
    units = _AMOUNTS[amount]
    for unit in units:
        try:
            return amount_typed(typed, amount, unit)
        except TribolabError:
            if unit == units[-1]:
                raise
    return ""


def amount_typed(typed: str, name: str, si_unit: str) -> str:
    """Return a typed number with a unit for a dialect; a weight is converted to its force."""
    if NUMBER.match(typed):
        raise ReadError(f"{typed} has no unit: type it with one, such as {typed} {_USUAL[si_unit]}")
    times = _TIMES.match(typed) if si_unit == "N" else None
    text = typed[times.end() :] if times else typed
    text = _COMMA.sub(r"\1.\2", text)
    if si_unit == "N" and (weight := _WEIGHT.match(text)):
        text = f"{weight[1].strip()} {WEIGHTS[weight[2]]}"
    if times:
        factor = float(times[1].replace(",", "."))
        text = f"{factor * positive(text, si_unit, f'the {name}'):.6g} {si_unit}"
    positive(text, si_unit, f"the {name}")
    return text


def as_strokes(typed: str) -> tuple[str, str] | None:
    """Return the length and frequency of strokes in a typed text; None if it states neither.

    >>> as_strokes("stroke 6 mm, 1.5 Hz"), as_strokes("2 Hz"), as_strokes("6 mm/min")
    (('6 mm', '1.5 Hz'), ('', '2 Hz'), None)
    """
    parts = {
        si: f"{match['number'].replace(',', '.')} {unit}"
        for match in _AMOUNT.finditer(typed)
        for si in ("m", "Hz")
        if is_unit(unit := match["unit"].rstrip(".,;")) and converts(unit, si)
    }
    return (parts.get("m", ""), parts.get("Hz", "")) if parts else None


def turning(typed: str) -> str:
    """Return the speed [m/s] from a typed rotation speed and radius (or diameter), else "".

    >>> turning("8 rpm at 22.5 mm radius"), turning("8 mm at 2 Hz")
    ('0.0188496 m/s', '')
    """
    how, strokes = _RADIUS.search(typed), as_strokes(typed)
    if how is None or strokes is None or not all(strokes):
        return ""
    length = positive(strokes[0], "m", f"the {how[1].lower()}")
    radius = length / 2 if how[1].lower() == "diameter" else length
    return f"{2 * math.pi * radius * positive(strokes[1], 'Hz', 'the turns'):.6g} m/s"


def turns_alone(rate: str) -> bool:
    """Whether a rate has a unit of rotation, such as rpm; Hz may also count strokes.

    >>> turns_alone("8 rpm"), turns_alone("2 Hz")
    (True, False)
    """
    unit = rate.split(maxsplit=1)[-1]
    return (
        (known := reciprocal(unit)) is not None
        and known.counts == "cycles"
        and "hz" not in (unit.lower())
    )
