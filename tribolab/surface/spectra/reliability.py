"""Trusted range of wavenumbers of a measured spectrum."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.units.conversion import to_si

# A spherical tip that traces profiles of the reference surfaces loses less than 5 % of C_1D up to
# the wavenumber at which the cumulative rms curvature reaches this share of the tip's curvature.
TIP_SHARE = 0.15
_NOISE_MARGIN = 20.0  # least ratio of C_1D to the noise floor: noise then adds at most 5 %
_FLOOR = 0.7  # the noise floor is taken from this share of the Nyquist wavenumber upwards
_FILTER_LOSS = 0.05  # largest share of the power that a profile filter may have removed
_GAUSS = np.log(2) / (2 * np.pi) ** 2  # transmission of ISO 16610-21: exp(-_GAUSS (q cutoff)^2)


def tip_cutoff(
    wavenumber: np.ndarray, psd_1d: np.ndarray, widths: np.ndarray, tip_radius: float
) -> float:
    """Return the wavenumber [1/m] above which a spherical tip cannot follow the profile.

    Parameters
    ----------
    wavenumber, psd_1d, widths
        Wavenumber [1/m], two-sided C_1D [m3] and width [1/m] of each bin.
    tip_radius
        Radius R of the tip [m].

    Returns
    -------
    float
        Upper edge of the last bin with ``R h''_rms(q) <= 0.15``; infinite if no bin passes it.

    Notes
    -----
    ``h''_rms(q)^2 = 2 int_0^q k^4 C_1D dk``: a tip blunts a summit if the curvature of the summit
    is not small compared with its own [1]_. The criterion is dimensionless.

    References
    ----------
    .. [1] A. Sanner, W. G. Noehring, L. A. Thimons, T. D. B. Jacobs, L. Pastewka,
       Scale-dependent roughness parameters for topography analysis, Appl. Surf. Sci. Adv. 7
       (2022) 100190, doi:10.1016/j.apsadv.2021.100190.
    """
    curvature = np.sqrt(np.cumsum(2 * wavenumber**4 * psd_1d * widths))
    beyond = curvature * tip_radius > TIP_SHARE
    if not beyond.any():
        return float("inf")
    first = int(np.argmax(beyond))
    return float(wavenumber[first] - 0.5 * widths[first])


def noise_cutoff(wavenumber: np.ndarray, psd_1d: np.ndarray) -> float:
    """Return the wavenumber [1/m] above which noise dominates the spectrum.

    The floor is the median of C_1D near the Nyquist wavenumber, from instrument noise, aliasing or
    quantisation. The spectrum is trusted where it exceeds 20 times the floor.
    """
    floor = float(np.median(psd_1d[wavenumber >= _FLOOR * wavenumber[-1]]))
    near = psd_1d < _NOISE_MARGIN * floor
    return float(wavenumber[np.argmax(near)]) if near.any() else float("inf")


def trusted_band(
    spectrum: xr.Dataset,
    scans: xr.Dataset,
    tip_radius: str | float | None,
    lowest: int,
    lost: float = float("inf"),
) -> tuple[np.ndarray, dict[str, float | str]]:
    """Return a mask of the bins in which a spectrum can be trusted, and what limits the range.

    Parameters
    ----------
    spectrum
        ``psd_1d`` (wavenumber) with the edges of its bins.
    scans
        The scans with the attributes ``tip_radius_m``, ``lambda_c_m`` and ``lambda_s_m``, if known.
    tip_radius
        Radius of the tip [m] or text, instead of the scans'.
    lowest
        First Fourier line that form removal and window do not affect.
    lost
        Wavenumber [1/m] above which gaps hide the surface.

    Returns
    -------
    tuple of numpy.ndarray and dict
        1 for bins entirely inside the trusted band, else 0; and attributes that name the cause of
        both limits. A spectrum of noise has no trusted bin.
    """
    q, c = spectrum.wavenumber.values, spectrum.psd_1d.values
    left, right = spectrum.wavenumber_low.values, spectrum.wavenumber_high.values
    first = min(q.size - 1, 1 if lowest > 1 else 0)  # the first bin lost power to form removal
    highs = {"Nyquist": float(right[-1]) / 2, "noise floor": noise_cutoff(q[first:], c[first:])}
    radius = scans.attrs.get("tip_radius_m") if tip_radius is None else tip_radius
    if radius is not None:
        radius = to_si(radius, "m", "tip_radius")
        highs["stylus tip"] = tip_cutoff(q, c, right - left, radius)
    if lost < highs["Nyquist"]:
        highs["gaps"] = lost
    lows = {"form removal": float(left[first])}
    if "lambda_s_m" in scans.attrs:
        kept = -0.5 * np.log(1 - _FILTER_LOSS)
        highs["lambda_s"] = float(np.sqrt(kept / _GAUSS) / scans.attrs["lambda_s_m"])
    if "lambda_c_m" in scans.attrs:
        passed = -np.log(1 - np.sqrt(1 - _FILTER_LOSS))
        lows["lambda_c"] = float(np.sqrt(passed / _GAUSS) / scans.attrs["lambda_c_m"])
    low_by, high_by = max(lows, key=lambda by: lows[by]), min(highs, key=lambda by: highs[by])
    low, high = lows[low_by], highs[high_by]
    trusted = (left >= low * (1 - 1e-9)) & (right <= high * (1 + 1e-9))
    attrs: dict[str, float | str] = {
        "trusted_low_1_m": float(left[trusted].min()) if trusted.any() else low,
        "trusted_high_1_m": float(right[trusted].max()) if trusted.any() else high,
        "trusted_low_limited_by": low_by,
        "trusted_high_limited_by": high_by,
    }
    if radius is not None:
        attrs["tip_radius_m"] = radius
    return trusted.astype(np.int8), attrs
