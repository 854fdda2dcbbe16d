"""Self-affine spectrum with a roll-off: constant below the roll-off, a power law above."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.core.errors import AnalysisError
from tribolab.units.conversion import positive
from tribolab.units.stamping import stamp


@dataclass(frozen=True)
class SelfAffine:
    """Isotropic 2D power spectrum: constant `plateau` below the roll-off, q^(-2(1+H)) above.

    Parameters
    ----------
    hurst
        Exponent H [1] of the power law; above 1 the spectrum falls faster than any fractal's.
    rolloff
        Roll-off wavenumber q_r [1/m].
    plateau
        Value C0 [m4] of the spectrum below the roll-off.
    low, high
        Smallest and largest wavenumber q0, q1 [1/m]; outside them the spectrum is zero.

    Notes
    -----
    The convention is Persson's, ``<h^2> = 2 pi int q C dq``. SurfaceTopography's 2D spectrum is
    4 pi^2 times larger.

    Examples
    --------
    >>> rough = SelfAffine(hurst=0.8, rolloff=1e4, plateau=1e-20, low=1e3, high=1e9)
    >>> float(psd_2d(rough, 5e3))
    1e-20
    """

    hurst: float
    rolloff: float
    plateau: float
    low: float
    high: float

    def __post_init__(self) -> None:
        """Raise an error for physically impossible parameters."""
        if not 0 < self.low < self.rolloff < self.high:
            raise AnalysisError(
                "self-affine spectrum: 0 < low < rolloff < high is wanted; got "
                f"{self.low:g}, {self.rolloff:g} and {self.high:g} 1/m"
            )
        if self.plateau <= 0 or self.hurst <= 0:
            raise AnalysisError("self-affine spectrum: plateau and hurst must be positive")


def psd_2d(spectrum: SelfAffine, wavenumber: ArrayLike) -> np.ndarray:
    """Return the 2D power spectrum C(q) [m4] at wavenumbers [1/m] (any dims)."""
    q = np.asarray(wavenumber, dtype=float)
    above = np.maximum(q / spectrum.rolloff, 1.0) ** (-2 * (1 + spectrum.hurst))
    inside = (q >= spectrum.low) & (q <= spectrum.high)
    return np.where(inside, spectrum.plateau * above, 0.0)


def psd_1d(spectrum: SelfAffine, wavenumber: ArrayLike) -> np.ndarray:
    """Return the two-sided 1D power spectrum of a straight profile, in closed form.

    Parameters
    ----------
    spectrum
        The isotropic surface.
    wavenumber
        Wavenumber k along the profile [1/m] (any dims), k >= 0.

    Returns
    -------
    numpy.ndarray
        C_1D [m3] at k. It is two-sided: ``<h^2> = int_{-inf}^{inf} C_1D dk``, twice the integral
        over positive k.

    Notes
    -----
    The forward Abel transform ``C_1D(k) = 2 int_k^inf C(q) q / sqrt(q^2 - k^2) dq``: over the
    plateau a difference of square roots, over the power law an incomplete beta function with
    ``t = k^2/q^2``. Between 0 and `low` it is not zero: waves oblique to the profile appear longer
    along it.
    """
    # imported late: scipy loads slowly
    from scipy.special import beta, betainc

    k = np.abs(np.asarray(wavenumber, dtype=float))
    q0, qr, q1, hurst = spectrum.low, spectrum.rolloff, spectrum.high, spectrum.hurst
    flat = np.sqrt(np.maximum(qr**2 - k**2, 0)) - np.sqrt(
        np.maximum(np.maximum(q0, np.minimum(k, qr)) ** 2 - k**2, 0)
    )
    a, safe = hurst + 0.5, np.maximum(k, 1e-9 * q0)
    ends = [np.minimum(safe / q, 1.0) ** 2 for q in (qr, q1)]
    powers = betainc(a, 0.5, ends[0]) - betainc(a, 0.5, ends[1])
    tail = 0.5 * qr * (qr / safe) ** (1 + 2 * hurst) * beta(a, 0.5) * powers
    return 2 * spectrum.plateau * (flat + tail)


def moment(spectrum: SelfAffine, order: float) -> float:
    """Return the integral of ``q^order C(q)`` over all wavenumbers, in closed form."""
    ratios = spectrum.low / spectrum.rolloff, spectrum.high / spectrum.rolloff
    flat = (1 - ratios[0] ** (order + 1)) / (order + 1)
    power = order + 1 - 2 * (1 + spectrum.hurst)
    steep = np.log(ratios[1]) if power == 0 else (ratios[1] ** power - 1) / power
    return float(spectrum.plateau * spectrum.rolloff ** (order + 1) * (flat + steep))


def rms_roughness(spectrum: SelfAffine) -> float:
    """Return the root-mean-square roughness h_rms [m]: ``h_rms^2 = 2 pi int q C dq``."""
    return float(np.sqrt(2 * np.pi * moment(spectrum, 1)))


def rms_slope(spectrum: SelfAffine) -> float:
    """Return the rms slope xi [1] of the surface: ``xi^2 = 2 pi int q^3 C dq`` (Eq. 12 of [1]).

    A straight profile shows a slope smaller by ``sqrt(2)``.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).
    """
    return float(np.sqrt(2 * np.pi * moment(spectrum, 3)))


def self_affine_psd(
    rms_roughness: str | float,
    hurst: float,
    rolloff: str | float,
    low: str | float,
    high: str | float,
    points: int = 1201,
) -> xr.Dataset:
    """Return the spectrum of a self-affine surface with a roll-off and a given rms roughness.

    Parameters
    ----------
    rms_roughness
        h_rms [m] of all waves.
    hurst
        Exponent H [1]: above the roll-off the spectrum falls like q to the -2(1+H).
    rolloff, low, high
        Roll-off, smallest and largest wavenumber [1/m].
    points
        Number of wavenumbers.

    Returns
    -------
    xarray.Dataset
        ``psd_2d`` [m4] over ``wavenumber`` [1/m].

    Raises
    ------
    AnalysisError
        If the wavenumbers are not in increasing order, or a number is not positive.

    Examples
    --------
    >>> from tribolab.surface.spectrum_roughness import spectral_roughness
    >>> psd = self_affine_psd("2 um", 0.8, rolloff=1e4, low=1e3, high=1e9)
    >>> f"{spectral_roughness(psd).rms_roughness[-1].item():.4g}"
    '2e-06'
    """
    wanted = positive(rms_roughness, "m", "rms_roughness")
    turn, first, last = (
        positive(value, "1/m", name)
        for value, name in ((rolloff, "rolloff"), (low, "low"), (high, "high"))
    )
    unit = SelfAffine(hurst, turn, plateau=1.0, low=first, high=last)
    plateau = wanted**2 / (2 * np.pi * moment(unit, 1))
    return tabulate(replace(unit, plateau=plateau), points)


def tabulate(spectrum: SelfAffine, points: int = 1201) -> xr.Dataset:
    """Return the spectrum on a logarithmic grid from `low` to `high`, with a node at the roll-off.

    Returns
    -------
    xarray.Dataset
        ``psd_2d`` [m4] over ``wavenumber`` [1/m]; the parameters are attributes.
    """
    decades = np.log(np.array([spectrum.rolloff / spectrum.low, spectrum.high / spectrum.low]))
    below = max(2, round(points * decades[0] / decades[1]))
    q = np.concatenate(
        [
            np.geomspace(spectrum.low, spectrum.rolloff, below)[:-1],
            np.geomspace(spectrum.rolloff, spectrum.high, points - below + 1),
        ]
    )
    data = xr.Dataset({"psd_2d": ("wavenumber", psd_2d(spectrum, q))}, {"wavenumber": q})
    return stamp(
        data,
        convention="<h^2> = 2 pi int q C dq",
        hurst_exponent=spectrum.hurst,
        rolloff_wavenumber_1_m=spectrum.rolloff,
        plateau_m4=spectrum.plateau,
    )
