"""Units at the edge: text such as ``"31 N"`` becomes an SI float; inside are only SI floats."""

from __future__ import annotations

import functools
import math
import re
from typing import TYPE_CHECKING

from tribolab.errors import AnalysisError, UnitError

if TYPE_CHECKING:
    import pint

_NUMBER = re.compile(r"^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")

# How instruments write units that pint reads otherwise or not at all.
_SPELLINGS = {
    "microns": "um",
    "micron": "um",
    "sec": "s",
    "secs": "s",
    "msec": "ms",
    "mm/sec": "mm/s",
    "um/sec": "um/s",
    "g": "gram",
    "gf": "force_gram",
    "kgf": "force_kilogram",
    "-": "",
    "1": "",
    "deg": "degree",
    "°": "degree",
    "°C": "degC",
    "C": "degC",
    "ºC": "degC",
    "Pa.s": "Pa*s",
    "Pa s": "Pa*s",
    "mPa s": "mPa*s",
    "mPa.s": "mPa*s",
}


_PREFIXES = {"p": 1e-12, "n": 1e-9, "u": 1e-6, "\u00b5": 1e-6, "\u03bc": 1e-6, "m": 1e-3}
_PREFIXES |= {"c": 1e-2, "k": 1e3, "M": 1e6, "G": 1e9}
# What instruments write most, so that reading a file need not wait half a second for pint; the
# same numbers as pint's.
_USUAL = {
    ("", "1"): (1.0, 0.0),
    ("-", "1"): (1.0, 0.0),
    ("%", "1"): (0.01, 0.0),
    ("percent", "1"): (0.01, 0.0),
    ("sec", "s"): (1.0, 0.0),
    ("min", "s"): (60.0, 0.0),
    ("micron", "m"): (1e-6, 0.0),
    ("microns", "m"): (1e-6, 0.0),
    ("gf", "N"): (0.00980665, 0.0),
    ("bar", "Pa"): (1e5, 0.0),
    ("dyne/cm²", "Pa"): (0.1, 0.0),
    ("Pa.s", "Pa s"): (1.0, 0.0),
    ("mPa.s", "Pa s"): (1e-3, 0.0),
    ("mPa s", "Pa s"): (1e-3, 0.0),
    ("°C", "K"): (1.0, 273.15),
    ("degC", "K"): (1.0, 273.15),
    ("deg", "rad"): (math.pi / 180, 0.0),
    ("rpm", "rad/s"): (math.pi / 30, 0.0),
}


@functools.lru_cache(maxsize=1)
def registry() -> pint.UnitRegistry:
    """Return the one pint registry, made when first asked for."""
    import pint

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)


def _clean(unit: str) -> str:
    unit = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u")
    unit = _SPELLINGS.get(unit, unit)
    unit = re.sub(r"(?<=[A-Za-z])(-?\d)", r"**\1", unit)  # netCDF writes m2 and s-1
    return unit.replace("^", "**").replace("²", "**2").replace("³", "**3")


def _prefix(unit: str, si_unit: str) -> float | None:
    """Scale of the SI unit itself with a prefix: mm/s for m/s. Loading pint takes 0.5 s."""
    if unit == si_unit:
        return 1.0
    # a prefix is raised with its unit: mm2 is not for here
    if re.fullmatch(r"(m|s|N|Pa|V)(/s)?", si_unit) and unit[1:] == si_unit:
        return _PREFIXES.get(unit[0])
    return None


@functools.lru_cache(maxsize=512)
def conversion(unit: str, si_unit: str) -> tuple[float, float]:
    """Scale and offset that turn a number in `unit` into `si_unit`: ``si = scale * x + offset``.

    Parameters
    ----------
    unit
        Unit as an instrument or a person writes it: ``"mm/s"``, ``"µm"``, ``"gf"``, ``"degC"``.
    si_unit
        The unit wanted: ``"m/s"``, ``"K"``.

    Raises
    ------
    UnitError
        If the unit is unknown or of another dimension.

    Examples
    --------
    >>> conversion("mm/s", "m/s")
    (0.001, 0.0)
    """
    if (prefix := _prefix(unit, si_unit)) is not None:
        return prefix, 0.0
    if (unit, si_unit) in _USUAL:
        return _USUAL[unit, si_unit]
    import pint

    ureg = registry()
    try:
        source, target = ureg.Unit(_clean(unit)), ureg.Unit(_clean(si_unit))
        zero = ureg.Quantity(0.0, source).to(target).magnitude
        one = ureg.Quantity(1.0, source).to(target).magnitude
    except pint.DimensionalityError as error:
        raise UnitError(f"unit '{unit}' cannot be turned into '{si_unit}'") from error
    except Exception as error:  # pint raises many kinds on text that is no unit
        raise UnitError(f"'{unit}' is not a unit that is known; write e.g. '{si_unit}'") from error
    scale = float(one - zero)
    # a decimal prefix is exact on paper: 1000 um = 1 mm, not 0.9999999999999999
    return float(f"{scale:.15g}"), float(zero)


def base_unit(unit: str) -> str:
    """Return the SI base units of a unit; "m" where it is no unit.

    Examples
    --------
    >>> base_unit("N mm")
    'kg*m**2/s**2'
    """
    import pint

    try:
        return f"{registry().Quantity(1.0, _clean(unit)).to_base_units().units:~C}"
    except (pint.PintError, ValueError, TypeError):
        return "m"


def to_si(value: str | float | int, si_unit: str, name: str = "value") -> float:
    """Turn ``"31 N"``, or a number that already is SI, into an SI float.

    Parameters
    ----------
    value
        Text with a number and a unit, or a bare number in `si_unit`.
    si_unit
        The SI unit wanted.
    name
        What the value is called where the user wrote it; the error names it.

    Raises
    ------
    UnitError
        If the text has no number, no unit, or a unit of another dimension.

    Examples
    --------
    >>> to_si("7 cm", "m")
    0.07
    >>> to_si(0.07, "m")
    0.07
    """
    if isinstance(value, bool):
        raise UnitError(f"{name}: a number with a unit is wanted, e.g. '1 {si_unit}'; got {value}")
    if not isinstance(value, str):
        try:
            return float(value)
        except (TypeError, ValueError) as error:
            raise UnitError(
                f"{name}: one number, or text such as '1 {si_unit}', is wanted; got {value!r:.60}"
            ) from error
    match = _NUMBER.match(value)
    if not match:
        raise UnitError(f"{name}: '{value}' has no number; write e.g. '1 {si_unit}'")
    number, unit = float(match[1]), match[2]
    if not unit and si_unit not in ("", "1"):
        raise UnitError(f"{name}: '{value}' has no unit; write e.g. '{value} {si_unit}'")
    try:
        scale, offset = conversion(unit, si_unit)
    except UnitError as error:
        raise UnitError(f"{name}: {error}; a value in {si_unit} is wanted") from error
    return float(f"{number * scale + offset:.15g}")


def positive(value: str | float, unit: str, name: str) -> float:
    """Return text with a unit, or an SI number, as an SI float above zero.

    Raises
    ------
    UnitError
        If the text has no unit or one of the wrong dimension.
    AnalysisError
        If the number is not positive and finite.

    Examples
    --------
    >>> positive("2 MPa", "Pa", "effective_modulus")
    2000000.0
    """
    number = to_si(value, unit, name=name)
    if not 0 < number < math.inf:
        raise AnalysisError(f"{name}: a positive, finite value in {unit} is wanted; got {number:g}")
    return number
