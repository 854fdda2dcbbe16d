"""Viscosity of the media of a campaign: stated, or of a liquid known by name at its temperature."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from tribolab.core.limit import Limit

_95 = 1.959963984540054


class MediumViscosity(NamedTuple):
    """Viscosity of a medium and how well it is known.

    Parameters
    ----------
    value
        [Pa s]
    error
        Relative standard uncertainty [1]; 0 where nothing is known of it.
    bounds
        Between which values [Pa s] it is with 95 %; None where nothing is known.
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
    """Say that a stated viscosity is not that of the liquid as stated; "" if they agree.

    Parameters
    ----------
    name, viscosity, temperature, water_content
        As for `medium_viscosity`.
    """
    # late: starting stays quick
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


def medium_viscosity(
    name: str,
    viscosity: float | None,
    bounds: tuple[float, float] | None,
    temperature: float | None,
    water_content: float | None,
    stated: Mapping[str, float],
) -> MediumViscosity | None:
    """Return the viscosity of a medium; None if neither it nor its temperature is stated.

    Parameters
    ----------
    name
        What it is called; liquids that are known by name tell how temperature and water act.
    viscosity, bounds
        As stated [Pa s].
    temperature, water_content
        [K], mass fraction [1].
    stated
        Standard uncertainties by name, of which those of temperature [K] and water content [1]
        count.

    Raises
    ------
    AnalysisError
        If the liquid is not one at this temperature.
    """
    # late: starting stays quick
    from tribolab.lubrication.viscosity import knows_liquid, liquid_viscosity

    computed = None
    if temperature is not None and knows_liquid(name):
        computed = liquid_viscosity(name, temperature, water_content or 0.0)
    if viscosity is None and computed is None:
        return None
    error = 0.0
    if bounds is not None:
        error = math.log(bounds[1] / bounds[0]) / (2 * _95)
    elif computed is not None:
        kelvin, water = (stated.get(name, 0.0) for name in ("temperature", "water_content"))
        if viscosity is not None:  # measured, not by the formula
            computed = computed._replace(formula=0.0)
        error = computed.uncertainty(kelvin, water)
    value = viscosity if viscosity is not None else computed.value if computed else math.nan
    if bounds is None and error > 0:
        bounds = value * math.exp(-_95 * error), value * math.exp(_95 * error)
    return MediumViscosity(value, error, bounds)
