"""Viscosity of the media of a campaign: stated, or of a liquid known by name at its temperature."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from tribolab.core.coverage import NORMAL
from tribolab.core.limit import Limit


class MediumViscosity(NamedTuple):
    """Viscosity of a medium and how well it is known.

    Parameters
    ----------
    value
        Viscosity [Pa s].
    error
        Relative standard uncertainty [1]; 0 if unknown.
    bounds
        Range [Pa s] with 95 % coverage; None if unknown.
    """

    value: float
    error: float
    bounds: tuple[float, float] | None


VISCOSITY_DIFFERS = Limit(
    0.2, "1", "ratio less 1 of a stated viscosity to that of the liquid at its temperature: two "
    "degrees, or two per cent of water in glycerol", "Cheng (2008), doi:10.1021/ie071349z",
)  # fmt: skip


def contradicting_viscosity(
    name: str, viscosity: float | None, temperature: float | None, water_content: float | None
) -> str:
    """Return a message if a stated viscosity differs from that of the known liquid; else "".

    Parameters
    ----------
    name, viscosity, temperature, water_content
        As for `medium_viscosity`.
    """
    # imported late for a quick start
    from tribolab.lubrication.viscosity import knows_liquid, liquid_viscosity

    if viscosity is None or temperature is None or not knows_liquid(name):
        return ""
    known = liquid_viscosity(name, temperature, water_content or 0.0).value
    if abs(math.log(viscosity / known)) <= math.log1p(VISCOSITY_DIFFERS.value):
        return ""
    water = f" with {100 * water_content:.3g} % water" if water_content else ""
    return (
        f"the stated viscosity is {viscosity:.3g} Pa s, but {name} at {temperature - 273.15:.4g} °C"
        f"{water} has {known:.3g} Pa s. The stated one is used. Check temperature and water_content"
    )


class LiquidStated(NamedTuple):
    """Properties of a liquid, as stated in a table [medium.NAME].

    Parameters
    ----------
    name
        Name; for known liquids the effect of temperature and water is computed.
    viscosity, bounds
        Viscosity and its range [Pa s]; None if not stated.
    temperature, water_content
        Temperature [K], and mass fraction of water [1].
    per_kelvin
        Relative decrease of the viscosity per kelvin [1/K]; None if not stated.
    """

    name: str
    viscosity: float | None
    bounds: tuple[float, float] | None
    temperature: float | None
    water_content: float | None
    per_kelvin: float | None = None


class Recorded(NamedTuple):
    """Mean temperature recorded in the runs of a curve, and its standard deviation [K]."""

    temperature: float
    spread: float


def medium_viscosity(
    liquid: LiquidStated, stated: Mapping[str, float], recorded: Recorded | None = None
) -> MediumViscosity | None:
    """Return the viscosity of a medium; None if neither it nor its temperature is stated.

    Parameters
    ----------
    liquid
        The liquid as stated in the campaign file.
    stated
        Standard uncertainties by name; temperature [K] and water_content [1] are used.
    recorded
        Temperature of the runs, at which the viscosity is computed if its change is known.

    Raises
    ------
    AnalysisError
        If the substance is not liquid at this temperature.

    Examples
    --------
    >>> oil = LiquidStated("oil", 0.1, None, 293.15, None, 0.03)
    >>> round(medium_viscosity(oil, {}, Recorded(303.15, 0.0)).value, 4)
    0.0741
    """
    # imported late for a quick start
    from tribolab.lubrication.viscosity import knows_liquid, liquid_viscosity

    value, bounds, water = liquid.viscosity, liquid.bounds, liquid.water_content or 0.0
    at = liquid.temperature
    computed = None
    if knows_liquid(liquid.name) and (at is not None or (recorded and value is None)):
        at = at if recorded is None else recorded.temperature
        assert at is not None
        computed = liquid_viscosity(liquid.name, at, water)
    if value is None and computed is None:
        return None
    factor = 1.0
    if value is not None and recorded is not None and liquid.temperature is not None:
        if liquid.per_kelvin is not None:
            factor = math.exp(-liquid.per_kelvin * (recorded.temperature - liquid.temperature))
        elif computed is not None:
            factor = computed.value / liquid_viscosity(liquid.name, liquid.temperature, water).value
    kelvin, of_water = (stated.get(name, 0.0) for name in ("temperature", "water_content"))
    kelvin = math.hypot(kelvin, recorded.spread if recorded else 0.0)
    error = (liquid.per_kelvin or 0.0) * kelvin
    if bounds is not None:
        error = math.log(bounds[1] / bounds[0]) / (2 * NORMAL)
    elif computed is not None:
        if value is not None:  # a stated viscosity does not have the error of the formula
            computed = computed._replace(formula=0.0)
        error = computed.uncertainty(kelvin, of_water)
    value = factor * (value if value is not None else computed.value if computed else math.nan)
    if bounds is not None:
        bounds = factor * bounds[0], factor * bounds[1]
    elif error > 0:
        bounds = value * math.exp(-NORMAL * error), value * math.exp(NORMAL * error)
    return MediumViscosity(value, error, bounds)
