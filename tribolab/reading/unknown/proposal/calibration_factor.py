"""Calibration of a column as stated by a person: a unit, or an amount of a unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple

from tribolab.core.errors import UnitError, shown
from tribolab.reading.unit_texts import converts
from tribolab.units.conversion import conversion
from tribolab.units.quantities import QUANTITIES, quantity

# no quantities of a run, but what a radius makes a friction force and a position of
TORQUE: Final = "torque"
ANGLE: Final = "angle"
_NO_QUANTITY = {TORQUE: "N m", ANGLE: "rad"}
_SAID = re.compile(
    r"^\s*([+-]?\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)?(?:/(\d+(?:[.,]\d+)?)(?=\s*[^\W\d]))?\s*(.*?)\s*$",
    re.DOTALL,
)
_PER = re.compile(r"^(.*\S)\s*(?:/|\bper\b)\s*(\S+)$", re.DOTALL)


class Worth(NamedTuple):
    """A number of a column is ``scale`` times ``unit``, which measures ``name``."""

    name: str
    unit: str
    scale: float = 1.0


def worth_of(text: str, names: Sequence[str], read_unit: str | None = None) -> Worth:
    """Interpret a unit, or the calibration of a column.

    Parameters
    ----------
    text
        ``"mN"``, ``"0.5 mN"`` (one count is so much), ``"1/600 turn"`` or ``"8.2 N/V"``.
    names
        Quantities that it may measure, `TORQUE`, or `ANGLE`; the first whose unit it is.
    read_unit
        The unit of the column according to the file.

    Raises
    ------
    UnitError
        If it measures none of them.

    Examples
    --------
    >>> worth_of("8,2 N/V", ["friction_force"], "V")
    Worth(name='friction_force', unit='N', scale=8.2)
    >>> worth_of("1/500 turn", ["angle"])
    Worth(name='angle', unit='turn', scale=0.002)
    >>> worth_of("mN m", ["friction_force", "torque"])
    Worth(name='torque', unit='mN m', scale=1.0)
    """
    said = _SAID.match(text)
    number, part, unit = (said[1] or "1", said[2] or "1", said[3]) if said else ("1", "1", text)
    scale = float(number.replace(",", ".")) / float(part.replace(",", "."))
    if (name := _measured(unit, names)) is not None:
        return Worth(name, unit, scale)
    parts = _PER.match(unit)
    if parts and (name := _measured(parts[1], names)) is not None:
        return Worth(name, parts[1], scale * _ratio(read_unit, parts[2]))
    known = " or ".join(f"{name}, e.g. '{si_unit_of(name)}'" for name in names)
    raise UnitError(f"'{shown(text, 40)}' is no unit of {known}, nor an amount of it")


def si_unit_of(name: str) -> str:
    """SI unit of a quantity, of a torque, or of an angle."""
    return _NO_QUANTITY.get(name) or quantity(name).unit


def _measured(unit: str, names: Sequence[str]) -> str | None:
    for name in names:
        bare = quantity(name).bare if name in QUANTITIES else None
        if converts(unit, si_unit_of(name), bare) or (
            si_unit_of(name) == "1" and unit in ("", "1")
        ):
            return name
    return None


def _ratio(read_unit: str | None, per: str) -> float:
    """Return how many of what an amount is stated for one number of the column is."""
    if not read_unit or not converts(read_unit, per):
        return 1.0  # counts, digits, divisions
    return conversion(read_unit, per)[0]
