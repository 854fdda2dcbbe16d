"""Lookup of quantities by name: SI unit, symbol and long name; values in SI units."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import TribolabError, UnitError, nearest, shown
from tribolab.units.conversion import conversion, to_si
from tribolab.units.quantity_table import QUANTITY_ROWS
from tribolab.units.reciprocals import Counted, reciprocal


class Quantity(NamedTuple):
    """Name, symbol (as in papers), SI unit (as in netCDF attributes) and long name of a quantity.

    Quantities per time or length need `bare`: the meaning of a unit like "1/min"; "ask" if cycles
    and radians are both usual (`units.reciprocals`).
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    bare: Counted | None = None


def dictionary(rows: Iterable[tuple[Any, ...]]) -> dict[str, Quantity]:
    """Return a dictionary of quantities by name; raise if a name occurs twice.

    Raises
    ------
    TribolabError
        If a name occurs twice, or a quantity per time or length does not state what it counts.

    Examples
    --------
    >>> dictionary([("gap", "u", "m", "local interfacial gap")])["gap"].unit
    'm'
    """
    known: dict[str, Quantity] = {}
    for row in rows:
        entry = Quantity(*row)
        if entry.name in known:
            raise TribolabError(
                f"the quantity '{entry.name}' stands twice in the dictionary: as "
                f"'{known[entry.name].long_name}' and as '{entry.long_name}'; give one another name"
            )
        if entry.bare is None and reciprocal(entry.unit):
            raise TribolabError(
                f"the quantity '{entry.name}' [{entry.unit}] does not name what it counts: add "
                '"cycles", "radians", "nothing" or "ask"'
            )
        known[entry.name] = entry
    return known


QUANTITIES: dict[str, Quantity] = dictionary(QUANTITY_ROWS)

_DERIVED = {
    "_std": "standard deviation of the {}",
    "_sem": "standard error of the {}",
    "_low": "lower bound of the {}",
    "_high": "upper bound of the {}",
    "_between": "standard deviation between runs of the {}",
    "_within": "standard deviation within runs of the {}",
    "_u": "standard uncertainty of the {}",
    "_U95": "expanded uncertainty (95 %) of the {}",
}
_DOF = "_dof"  # degrees of freedom, dimensionless whatever the unit of the quantity


def quantity(name: str) -> Quantity:
    """Return the quantity with a name, which may end in ``_std``, ``_sem``, ``_u`` etc.

    Raises
    ------
    TribolabError
        If there is no such quantity; the message names the nearest.

    Examples
    --------
    >>> quantity("normal_force").unit
    'N'
    >>> quantity("friction_coefficient_std").long_name
    'standard deviation of the friction coefficient'
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    for ending, text in _DERIVED.items():
        base = QUANTITIES.get(name.removesuffix(ending))
        if name.endswith(ending) and base:
            return Quantity(name, base.symbol, base.unit, text.format(base.long_name), base.bare)
    if name.endswith(_DOF) and (base := QUANTITIES.get(name.removesuffix(_DOF))):
        return Quantity(name, "\\nu", "1", f"degrees of freedom of the {base.long_name}")
    raise TribolabError(f"no quantity is called '{shown(name)}'{nearest(name, QUANTITIES)}")


def unit_conversion(unit: str, name: str) -> tuple[float, float]:
    """Return scale and offset from `unit` to the SI unit of a quantity.

    Raises
    ------
    UnitError
        If the unit is unknown, of another dimension, or may be read in two ways.

    Examples
    --------
    >>> round(60 * unit_conversion("U/min", "rotation_speed")[0], 6)
    6.283185
    """
    known = quantity(name)
    return conversion(unit, known.unit, known.bare)


def si_values(value: str | ArrayLike, name: str) -> np.ndarray:
    """Return the values of a quantity as SI floats; entries may be text with a unit.

    Raises
    ------
    UnitError
        If a text has no unit or one of another dimension, or an entry is no number.

    Examples
    --------
    >>> si_values(["42 kPa", "0.1 MPa"], "pressure")
    array([ 42000., 100000.])
    """
    unit, bare = quantity(name).unit, quantity(name).bare
    try:
        if np.asarray(value).dtype.kind in "fiub":
            return np.asarray(value, dtype=float)
        # as objects, because an array of text would turn numbers into text without a unit
        entries = np.asarray(value, dtype=object)
        numbers = [
            to_si(str(cell), unit, name=name, bare=bare) if isinstance(cell, str) else float(cell)
            for cell in entries.ravel()
        ]
    except (TypeError, ValueError) as error:
        raise UnitError(
            f"{name}: numbers in {unit}, or text such as '1 {unit}', are wanted; got "
            f"{shown(repr(value), 60)}"
        ) from error
    return np.array(numbers, dtype=float).reshape(entries.shape)
