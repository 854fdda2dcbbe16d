"""Effect of Hurst exponents above 1, in the stand-in spectra, on slope and contact."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace

from scipy.optimize import brentq

from tribolab.core.untyped import Json
from tribolab.records.surfaces.hurst_words import hurst_verdict
from tribolab.studies import xu2026
from tribolab.surface.self_affine import SelfAffine, moment

_SLOPE = 3  # exponent of q in the integral of q^3 C, which gives the mean square slope
_ENDLESS = 1e30  # 1/m, practically infinite wavenumber


@dataclass(frozen=True)
class SteepSpectrum:
    """Stand-in spectrum with a Hurst exponent above 1.

    Parameters
    ----------
    surface
        Name of the surface.
    hurst
        Exponent H [1].
    half_slope_wavelength
        Wavelength [m]: half of the mean square slope comes from longer waves.
    slope_beyond
        Relative increase of the rms slope [1] if the power law were extended to infinite
        wavenumbers.
    verdict
        Meaning of the exponent.
    """

    surface: str
    hurst: float
    half_slope_wavelength: float
    slope_beyond: float
    verdict: str


def steep_spectra() -> list[Json]:
    """Return a record for each stand-in spectrum with H above 1, for the page.

    Examples
    --------
    >>> [one["surface"] for one in steep_spectra()]
    ['Smooth', 'Sb-S', 'Sb-R']
    """
    return [
        asdict(_judged(surface.name, surface.spectrum))
        for surface in xu2026.surfaces.values()
        if surface.spectrum.hurst > 1
    ]


def _judged(name: str, spectrum: SelfAffine) -> SteepSpectrum:
    whole = moment(spectrum, _SLOPE)
    endless = moment(replace(spectrum, high=_ENDLESS), _SLOPE)
    return SteepSpectrum(
        name,
        spectrum.hurst,
        2 * math.pi / _half(spectrum, whole),
        math.sqrt(endless / whole) - 1,
        hurst_verdict(spectrum.hurst),
    )


def _half(spectrum: SelfAffine, whole: float) -> float:
    """Return the wavenumber [1/m] below which half of the mean square slope arises."""

    def missing(log_q: float) -> float:
        return moment(replace(spectrum, high=math.exp(log_q)), _SLOPE) / whole - 0.5

    ends = math.log(spectrum.rolloff * (1 + 1e-9)), math.log(spectrum.high)
    return math.exp(brentq(missing, *ends))
