"""Viscosity of known liquids as a function of temperature and water content."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

from tribolab.core.errors import AnalysisError, nearest, shown
from tribolab.units.conversion import to_si

LIQUIDS = ("glycerol", "water", "silicone oil 100 cSt")
_SYNONYMS = {"glycerine": "glycerol", "glycerin": "glycerol", "silicon oil": "silicone oil"}
_OIL = re.compile(r"silicone oil[ _]*(\d+(?:\.\d+)?) *(?:cst|mm2/s|mm²/s)?$")
_ZERO = 273.15  # 0 degrees Celsius in K
_HIGHEST = {"water": 100.0, "glycerol": 100.0, "silicone oil": 150.0}  # upper limits, degrees C
# Relative standard uncertainty of the formulas; for oils it includes that of their grade
_FORMULA = {"water": 0.01, "glycerol": 0.02, "silicone oil": 0.03}
# Silicone oils: viscosity at 25 degrees Celsius [mm2/s], density at 25 degrees relative to water,
# relative decrease of the viscosity from 37.8 to 98.9 degrees Celsius (ref. 2)
_OILS = (
    (1.0, 0.818, 0.37),
    (2.0, 0.873, 0.48),
    (5.0, 0.915, 0.54),
    (10.0, 0.935, 0.55),
    (20.0, 0.950, 0.59),
    (50.0, 0.960, 0.59),
    (100.0, 0.965, 0.60),
    (1000.0, 0.970, 0.60),
    (10000.0, 0.975, 0.60),
    (100000.0, 0.977, 0.61),
)
_EXPANSION = 9.5e-4  # 1/K, volumetric thermal expansion of silicone oils


class Viscosity(NamedTuple):
    """Viscosity of a liquid, with its sensitivity to temperature and composition.

    Parameters
    ----------
    value
        [Pa s]
    per_kelvin
        d ln(viscosity)/dT [1/K].
    per_water
        d ln(viscosity)/d(mass fraction of water) [1].
    formula
        Relative standard uncertainty of the formula [1].
    """

    value: float
    per_kelvin: float
    per_water: float
    formula: float

    def uncertainty(self, temperature: float = 0.0, water_content: float = 0.0) -> float:
        """Return the relative standard uncertainty of the viscosity [1].

        Parameters
        ----------
        temperature
            Standard uncertainty of the temperature [K].
        water_content
            Standard uncertainty of the mass fraction of water [1].

        Examples
        --------
        >>> round(liquid_viscosity("glycerol", "23 °C", 0.01).uncertainty(0.5 / 3**0.5), 3)
        0.032
        """
        return math.hypot(
            self.per_kelvin * temperature, self.per_water * water_content, self.formula
        )


def liquid_viscosity(
    liquid: str, temperature: str | float, water_content: str | float = 0.0
) -> Viscosity:
    """Return the viscosity of water, aqueous glycerol, or a silicone oil.

    Parameters
    ----------
    liquid
        ``"glycerol"``, ``"water"``, or ``"silicone oil 1000 cSt"`` with the nominal viscosity at
        25 °C.
    temperature
        [K], or text such as ``"23 °C"``.
    water_content
        Mass fraction of water in glycerol [1], or text such as ``"1 %"``.

    Returns
    -------
    Viscosity

    Raises
    ------
    AnalysisError
        If the liquid is unknown, not liquid at this temperature, or cannot contain water.
    UnitError
        If a text has no unit or a wrong one.

    Notes
    -----
    Glycerol with water: Cheng's formula [1]_, accurate to some two per cent from 0 to 100 °C. Oils:
    nominal viscosity and Walther's law, ``log log(nu + 0.7) = A - B log T``, with B from the
    tabulated decrease [2]_ between 37.8 and 98.9 °C.

    References
    ----------
    .. [1] Cheng (2008), Ind. Eng. Chem. Res. 47, 3285-3288. doi:10.1021/ie071349z
    .. [2] Shin-Etsu Chemical, Silicone fluid KF-96, performance test results.

    Examples
    --------
    >>> wet = liquid_viscosity("glycerol", "23 °C", "1 %")
    >>> round(wet.value, 3), round(wet.per_kelvin, 3), round(-wet.per_water / 100, 2)
    (0.872, -0.086, 0.21)
    """
    name = _require_name(liquid)
    kelvin = to_si(temperature, "K", name="temperature")
    water = to_si(water_content, "1", name="water_content")
    kind = "silicone oil" if name.startswith("silicone") else name
    if not 0 <= kelvin - _ZERO <= _HIGHEST[kind]:
        raise AnalysisError(
            f"temperature: the viscosity of {shown(name)} is known from 0 to {_HIGHEST[kind]:g} °C;"
            f" got {kelvin - _ZERO:g} °C"
        )
    if not 0 <= water <= 1 or (water and kind != "glycerol"):
        raise AnalysisError(
            "water_content: a mass fraction of water in glycerol from 0 to 1 is wanted; got "
            f"{water:g} in {shown(name)}"
        )
    if kind == "silicone oil":
        return _silicone_oil(float(name.split()[2]), kelvin)
    celsius = kelvin - _ZERO
    of_water = 1.0 if kind == "water" else water
    step, drop = 0.01, 1e-4
    value = _glycerol(celsius, of_water)
    warm, cold = (math.log(_glycerol(celsius + s, of_water)) for s in (step, -step))
    wet, dry = min(of_water + drop, 1.0), max(of_water - drop, 0.0)
    per_water = math.log(_glycerol(celsius, wet) / _glycerol(celsius, dry)) / (wet - dry)
    per_water = per_water if kind == "glycerol" else 0.0
    return Viscosity(value, (warm - cold) / (2 * step), per_water, _FORMULA[kind])


def knows_liquid(name: str) -> bool:
    """Return whether the viscosity of a medium is known from its name.

    Examples
    --------
    >>> knows_liquid("Glycerol"), knows_liquid("silicone oil 350 cSt"), knows_liquid("engine oil")
    (True, True, False)
    """
    return _known(name) is not None


def _known(liquid: str) -> str | None:
    name = " ".join(liquid.lower().replace("_", " ").split())
    for other, usual in _SYNONYMS.items():
        name = name.replace(other, usual)
    if name in ("glycerol", "water"):
        return name
    match = _OIL.match(name)
    if match and _OILS[0][0] <= float(match[1]) <= _OILS[-1][0]:
        return f"silicone oil {match[1]} cSt"
    return None


def _require_name(liquid: str) -> str:
    name = _known(liquid)
    if name is None:
        raise AnalysisError(
            f"the viscosity of '{shown(liquid)}' is not known{nearest(liquid, LIQUIDS)}; silicone "
            f"oils are from {_OILS[0][0]:g} to {_OILS[-1][0]:g} cSt"
        )
    return name


def _glycerol(celsius: float, water: float) -> float:
    """Return the viscosity [Pa s] of glycerol with a mass fraction of water, by Cheng's Eq. (6)."""
    t, glycerol = celsius, 1.0 - water
    of_water = 1.790e-3 * math.exp((-1230 - t) * t / (36100 + 360 * t))
    pure = 12.100 * math.exp((-1233 + t) * t / (9900 + 70 * t))
    a = 0.705 - 0.0017 * t
    b = (4.9 + 0.036 * t) * a**2.5
    mixing = a * b * glycerol * water / (a * glycerol + b * water)
    return float(of_water ** (water + mixing) * pure ** (glycerol - mixing))


def _silicone_oil(nominal: float, kelvin: float) -> Viscosity:
    """Return the viscosity of a silicone oil with a given grade [mm2/s at 25 degrees Celsius]."""
    from scipy.optimize import brentq  # needed for oils only

    density, falls = _grade_data(nominal)

    def kinematic(slope: float, at: float) -> float:
        start = math.log10(math.log10(nominal + 0.7))
        return float(10 ** (10 ** (start - slope * math.log10(at / 298.15))) - 0.7)

    def too_steep(slope: float) -> float:
        return 1 - kinematic(slope, _ZERO + 98.9) / kinematic(slope, _ZERO + 37.8) - falls

    slope = brentq(too_steep, 0.2, 4.0)

    def dynamic(at: float) -> float:
        heavy = 1e3 * density * (1 - _EXPANSION * (at - 298.15))
        return 1e-6 * kinematic(slope, at) * heavy

    step = 0.01
    per_kelvin = math.log(dynamic(kelvin + step) / dynamic(kelvin - step)) / (2 * step)
    return Viscosity(dynamic(kelvin), per_kelvin, 0.0, _FORMULA["silicone oil"])


def _grade_data(nominal: float) -> tuple[float, float]:
    """Return the relative density of a silicone oil and its viscosity decrease from 38 to 99 °C."""
    for low, high in zip(_OILS, _OILS[1:], strict=False):
        if low[0] <= nominal <= high[0]:
            part = math.log(nominal / low[0]) / math.log(high[0] / low[0])
            return (low[1] + part * (high[1] - low[1]), low[2] + part * (high[2] - low[2]))
    raise AnalysisError(f"silicone oils of {nominal:g} cSt are not in the table")
