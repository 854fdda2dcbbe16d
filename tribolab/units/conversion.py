"""Conversion of text such as ``"31 N"`` to numbers in SI units, which are used internally."""

from __future__ import annotations

import functools
import importlib.util
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tribolab.core.errors import AnalysisError, UnitError, shown
from tribolab.units.common_units import CONVERSIONS, measures_another, prefix_factor
from tribolab.units.grammar import parse_unit
from tribolab.units.reciprocals import (
    Counted,
    contains_angle,
    counts_turns,
    reciprocal,
    scale_of_reciprocal,
    usual_reading,
)
from tribolab.units.spellings import plain_unit

if TYPE_CHECKING:
    import pint

_MAX_QUANTITY = 200  # longest text of a number with its unit
_NUMBER = re.compile(r"^\s*([+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*$")

# Units that instruments write differently from pint, or that are unknown to pint.
_SPELLINGS = {
    "microns": "um",
    "micron": "um",
    "mic": "um",
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
# torques: pint would read Nm as number metric, a unit of yarn
_SPELLINGS |= {
    f"{prefix}N{sign}{length}": f"{prefix}N*{length}"
    for prefix in ("", "u", "m", "c", "k")
    for sign in ("", "-")
    for length in ("m", "cm", "mm")
}


@functools.lru_cache(maxsize=1)
def registry() -> pint.UnitRegistry[float]:
    """Return the pint registry of units, which is created at first use."""
    # imported late: pint loads slowly
    import pint

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)


@functools.lru_cache(maxsize=1)
def _words_of_pint() -> tuple[frozenset[str], tuple[str, ...]]:
    """Return all words in pint's definitions of units, and its prefixes, without loading pint."""
    spec = importlib.util.find_spec("pint")
    folder = Path(spec.origin).parent if spec and spec.origin else Path()
    text = "\n".join(file.read_text("utf-8") for file in sorted(folder.glob("*_en.txt")))
    text = re.sub(r"(?m)#.*$|^@(?!alias).*$|\[\w*\]", "", text)
    return frozenset(re.findall(r"[^\s=;,:()*/^+-]+", text)), (
        *re.findall(r"(\S+)-(?=\s)", text),
        "",
    )


@functools.lru_cache(maxsize=4096)
def _may_be_unit(name: str) -> bool:
    """Whether pint may know a unit; if not, its registry, which loads slowly, is not needed.

    Examples
    --------
    >>> [_may_be_unit(name) for name in ("microseconds", "kip", "delta_degC", "velocity")]
    [True, True, True, False]
    """
    words, prefixes = _words_of_pint()
    bare = {name, name.removesuffix("s")}
    found = any(b.removeprefix(p) in words for b in bare for p in prefixes if b.startswith(p))
    return found or not words or name.startswith(("delta_", "\u0394"))


# typeset exponents and signs
_SIGNS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−\u00a0", "0123456789-- ", "")
_TIMES = re.compile(r"^[x×*·]\s?(?=\d\S*\s+[^\W\d_])")  # "x 1e-4 N", but not a name like "x1000"
_RAISED = re.compile(r"(?<=10)([⁻⁺]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
_PRODUCT = re.compile(r"(?<!\s)\s*[·⋅・∙•]\s*")  # matches whole runs of blanks without backtracking


def pint_spelling(unit: str) -> str:
    """Return a unit in pint's spelling, from typeset spelling or that of netCDF."""
    unit = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u")
    unit = _RAISED.sub(r"^\1", _TIMES.sub("", unit))
    unit = _PRODUCT.sub("*", unit.translate(_SIGNS))
    unit = _SPELLINGS.get(unit, unit)
    # netCDF writes m2 and s-1; the e of 1e-4 is no unit name
    unit = re.sub(r"(?<=[A-Za-z])(?<!\d[eE])(-?\d)", r"**\1", unit)
    return unit.replace("^", "**")


class _Units(NamedTuple):
    factor: float
    units: pint.Unit


def _units(text: str) -> _Units:
    """Return the factor and pint units of a text, which is parsed here and never evaluated."""
    factor, powers = parse_unit(pint_spelling(text))
    ureg = registry()
    product = ureg.Unit("")
    for name, power in powers.items():
        product = product * ureg.Unit(name) ** power
    return _Units(factor, product)


@functools.lru_cache(maxsize=512)
def conversion(unit: str, si_unit: str, bare: Counted | None = None) -> tuple[float, float]:
    """Return scale and offset from `unit` to `si_unit`: ``si = scale * x + offset``.

    Parameters
    ----------
    unit
        Unit as an instrument or a person writes it: ``"mm/s"``, ``"µm"``, ``"gf"``, ``"degC"``.
    si_unit
        The requested unit: ``"m/s"``, ``"K"``.
    bare
        Meaning of a unit per time or length that names neither cycles nor radians, like
        ``"1/min"``; default from `tribolab.units.reciprocals.usual_reading`.

    Raises
    ------
    UnitError
        If the unit is unknown or of another dimension, or may be read in two ways.

    Examples
    --------
    >>> conversion("mm/s", "m/s")
    (0.001, 0.0)
    >>> conversion("1/s", "rad/s", "cycles")
    (6.28318530717959, 0.0)
    """
    if (prefix := prefix_factor(unit, si_unit)) is not None:
        return prefix, 0.0
    if len(unit) > _MAX_QUANTITY:
        raise UnitError(f"'{shown(unit)}' is not a unit: it has more than {_MAX_QUANTITY} letters")
    if (unit, si_unit) in CONVERSIONS:
        return CONVERSIONS[unit, si_unit]
    if (unit, si_unit) == ("mS", "s"):  # milliseconds: a time is never in millisiemens
        return 1e-3, 0.0
    if measures_another(unit, si_unit):
        raise UnitError(f"unit '{shown(unit)}' cannot be turned into '{si_unit}'")
    if (spelt := plain_unit(unit)) != unit.strip() and len(unit) < _MAX_QUANTITY:
        return conversion(spelt, si_unit, bare)
    if si_unit == "1" and bare == "cycles" and counts_turns(unit):
        return 1.0, 0.0
    turning = scale_of_reciprocal(unit, si_unit, bare or usual_reading(si_unit))
    if turning is not None:
        return float(f"{turning:.15g}"), 0.0
    counted = reciprocal(si_unit)
    if (si_unit in ("", "1") or counted) and contains_angle(unit):
        raise UnitError(
            f"unit '{shown(unit)}' counts an angle or cycles, and cannot become '{si_unit}'"
        )
    if counted and si_unit != (plain := f"1/{counted.per}"):  # rare units such as "mm/s/mm"
        scale = conversion(unit, plain, "nothing")[0]
        return scale * conversion(plain, si_unit, bare)[0], 0.0
    try:
        # reject text that breaks the grammar of units, or has unknown words, without loading pint
        _, powers = parse_unit(pint_spelling(unit))
        if unknown := [name for name in powers if not _may_be_unit(name)]:
            raise UnitError(f"'{shown(unknown[0])}' is no unit")
    except UnitError as error:
        text = shown(unit)
        raise UnitError(f"'{text}' is not a unit that is known; write e.g. '{si_unit}'") from error
    # imported late: pint loads slowly
    import pint

    ureg = registry()
    try:
        source, target = _units(unit), _units(si_unit)
        zero = ureg.Quantity(0.0, source.units).to(target.units).magnitude
        size = ureg.Quantity(source.factor, source.units).to(target.units).magnitude
    except pint.DimensionalityError as error:
        raise UnitError(f"unit '{shown(unit)}' cannot be turned into '{si_unit}'") from error
    except Exception as error:  # for text that is not a unit, pint raises errors of many classes
        text = shown(unit)
        raise UnitError(f"'{text}' is not a unit that is known; write e.g. '{si_unit}'") from error
    scale = float(size - zero)
    # 15 digits make decimal prefixes exact: 1000 um = 1 mm, not 0.9999999999999999
    return float(f"{scale:.15g}"), float(zero)


def base_unit(unit: str) -> str:
    """Return a unit expressed in SI base units; "m" for text that is not a unit.

    Examples
    --------
    >>> base_unit("N mm"), base_unit("Н·м")
    ('kg*m**2/s**2', 'kg*m**2/s**2')
    """
    if (spelt := plain_unit(unit)) != unit.strip() and len(unit) < _MAX_QUANTITY:
        return base_unit(spelt)
    # imported late: pint loads slowly
    import pint

    try:
        return f"{registry().Quantity(1.0, _units(unit).units).to_base_units().units:~C}"
    except (UnitError, pint.PintError, ValueError, TypeError):
        return "m"


def to_si(
    value: str | float | int, si_unit: str, name: str = "value", bare: Counted | None = None
) -> float:
    """Return an SI number from text such as ``"31 N"``, or from a number already in SI.

    Parameters
    ----------
    value
        Text with a number and a unit, or a bare number in `si_unit`.
    si_unit
        The requested SI unit.
    name
        Name of the value for the user, for the error message.
    bare
        As for `conversion`.

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
                f"{name}: one number, or text such as '1 {si_unit}', is wanted; got "
                f"{shown(repr(value), 60)}"
            ) from error
    text = shown(value)
    match = _NUMBER.match(value) if len(value) <= _MAX_QUANTITY else None
    if not match:
        raise UnitError(f"{name}: '{text}' has no number; write e.g. '1 {si_unit}'")
    number, unit = float(match[1]), match[2]
    if not math.isfinite(number):
        raise UnitError(f"{name}: '{text}' is larger than any number; write e.g. '1 {si_unit}'")
    if not unit and si_unit not in ("", "1"):
        raise UnitError(f"{name}: '{text}' has no unit; write e.g. '{text} {si_unit}'")
    if re.match(r",\d", unit):
        pointed = shown(value.strip().replace(",", ".", 1))
        raise UnitError(f"{name}: '{text}' has a decimal comma; write '{pointed}'")
    try:
        scale, offset = conversion(unit, si_unit, bare)
    except UnitError as error:
        raise UnitError(f"{name}: {error}; a value in {si_unit} is wanted") from error
    return float(f"{number * scale + offset:.15g}")


def positive(value: str | float, unit: str, name: str) -> float:
    """Return a positive SI number from text with a unit, or from a number already in SI.

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
