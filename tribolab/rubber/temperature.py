"""Rubber modulus at another temperature, and flash temperature of contact spots."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError
from tribolab.rubber.modulus import FractionalZener, TabulatedModulus
from tribolab.rubber.prony import PronySeries
from tribolab.units.conversion import positive
from tribolab.units.quantities import si_values

Shiftable = FractionalZener | TabulatedModulus | PronySeries
_FARTHEST = 100.0  # K above the reference temperature, up to which WLF constants are valid


@dataclass(frozen=True)
class WilliamsLandelFerry:
    """Temperature dependence of a rubber's relaxation times (WLF equation).

    Parameters
    ----------
    c1, c2
        Constants C1 [1] and C2 [K] about the reference temperature; without a measurement, 17.44
        and 51.6 K about the glass transition are usual.
    reference_temperature
        Temperature of the master curve [K], or text such as ``"20 degC"``.

    Notes
    -----
    ``log10 a_T = -C1 (T - T_r)/(C2 + T - T_r)`` [1]_: the behaviour at the frequency omega and T is
    that at omega a_T and the reference temperature.

    References
    ----------
    .. [1] M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77, 3701 (1955).
       doi:10.1021/ja01619a008

    Examples
    --------
    >>> law = WilliamsLandelFerry(17.44, "51.6 K", "150 K")
    >>> f"{law.shift_factor('190 K'):.2e}"
    '2.42e-08'
    """

    c1: float
    c2: float
    reference_temperature: float

    def __post_init__(self) -> None:
        """Convert text to SI values."""
        object.__setattr__(self, "c1", positive(self.c1, "1", "c1"))
        for name in ("c2", "reference_temperature"):
            object.__setattr__(self, name, positive(getattr(self, name), "K", name))

    def shift_factor(self, temperature: str | float) -> float:
        """Return the WLF shift factor a_T [1] at a temperature [K].

        Raises
        ------
        AnalysisError
            If the temperature is too low for relaxation, or more than 100 K above the reference,
            where the law is not valid.
        """
        kelvin = positive(temperature, "K", "temperature")
        apart = kelvin - self.reference_temperature
        if self.c2 + apart <= 0:
            raise AnalysisError(
                f"temperature: {kelvin:.4g} K lies more than C2 = {self.c2:g} K under the "
                f"reference of {self.reference_temperature:.4g} K, where nothing relaxes any more; "
                "take a higher one, or a master curve about a lower one"
            )
        if apart > _FARTHEST:
            raise AnalysisError(
                f"temperature: {kelvin:.4g} K lies more than {_FARTHEST:g} K above the reference "
                f"of {self.reference_temperature:.4g} K, where the shift is no longer by C1 and "
                "C2; take a master curve about a higher one"
            )
        return float(10.0 ** (-self.c1 * apart / (self.c2 + apart)))


def modulus_at(modulus: Shiftable, temperature: str | float, law: WilliamsLandelFerry) -> Shiftable:
    """Return the modulus at another temperature, by time-temperature superposition.

    Parameters
    ----------
    modulus
        Modulus at the law's reference temperature: a master curve, a Prony series or a fractional
        Zener.
    temperature
        [K], or text such as ``"40 degC"``.
    law
        Temperature dependence of the relaxation times.

    Returns
    -------
    FractionalZener, TabulatedModulus or PronySeries
        Same type as `modulus`; a table has the same moduli at shifted frequencies.

    Raises
    ------
    AnalysisError
        If the temperature is outside the law's range.

    Notes
    -----
    ``E(omega, T) = E(omega a_T, T_r)``. The vertical shift by density times temperature, a few
    per cent over 20 K, is left out.

    Examples
    --------
    >>> from tribolab.rubber.modulus import PDMS_STAND_IN
    >>> law = WilliamsLandelFerry(6.0, "200 K", "20 degC")
    >>> warm = modulus_at(PDMS_STAND_IN, "40 degC", law)
    >>> round(warm.relaxation_time / PDMS_STAND_IN.relaxation_time, 3)
    0.285
    """
    factor = law.shift_factor(temperature)
    if isinstance(modulus, TabulatedModulus):
        shifted = modulus.angular_frequency / factor
        return TabulatedModulus(shifted, modulus.storage, modulus.loss)
    if isinstance(modulus, PronySeries):
        return replace(modulus, relaxation_times=modulus.relaxation_times * factor)
    return replace(modulus, relaxation_time=modulus.relaxation_time * factor)


def flash_temperature(
    shear_stress: str | ArrayLike,
    sliding_speed: str | ArrayLike,
    radius: str | float,
    conductivity: str | float = 0.16,
    diffusivity: str | float = 1.1e-7,
) -> np.ndarray | float:
    """Return an upper bound of the temperature rise in a sliding contact spot.

    Parameters
    ----------
    shear_stress
        Shear stress in the real contact [Pa] (any dims).
    sliding_speed
        [m/s] (any dims).
    radius
        Radius of the spot [m].
    conductivity, diffusivity
        Thermal conductivity [W/(m K)] and diffusivity [m2/s] of the rubber; default: PDMS. The
        other body is assumed to be an insulator, which overestimates the rise.

    Returns
    -------
    float or numpy.ndarray
        Largest temperature rise in the spot [K].

    Raises
    ------
    AnalysisError
        If a parameter is not positive.

    Notes
    -----
    ``dT = 2 q a/(K sqrt(pi (1.273 + Pe)))`` with the heat flux q = sigma v and Pe = v a/(2 kappa),
    for a round, uniform source in a steady state [1]_. The limits are q a/K for a slow spot and
    2 q/K sqrt(2 kappa a/(pi v)) for a fast one.

    References
    ----------
    .. [1] X. Tian, F. E. Kennedy, J. Tribol. 116, 167 (1994). doi:10.1115/1.2927035

    Examples
    --------
    >>> f"{flash_temperature('1 MPa', '10 mm/s', '50 um'):.2f} K"
    '1.87 K'
    """
    size = positive(radius, "m", "radius")
    conducts = positive(conductivity, "W/(m K)", "conductivity")
    diffuses = positive(diffusivity, "m2/s", "diffusivity")
    stress, speed = (
        si_values(value, name)
        for value, name in ((shear_stress, "shear_stress"), (sliding_speed, "sliding_speed"))
    )
    peclet = speed * size / (2 * diffuses)
    rise = 2 * stress * speed * size / (conducts * np.sqrt(np.pi * (1.273 + peclet)))
    return np.asarray(rise)[()]
