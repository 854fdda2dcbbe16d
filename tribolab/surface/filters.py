"""The Gaussian profile filter of ISO 16610-21."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp

# alpha = sqrt(ln 2 / pi): a wave at the cut-off keeps half of its amplitude
_ALPHA = float(np.sqrt(np.log(2) / np.pi))


def transmission(wavelength: np.ndarray | float, cutoff: float) -> np.ndarray:
    """Return the amplitude transmission [1] of the Gaussian low-pass filter; 0.5 at `cutoff` [m].

    >>> round(float(transmission(0.8e-3, 0.8e-3)), 12)
    0.5
    """
    return np.exp(-np.pi * (_ALPHA * cutoff / np.asarray(wavelength, dtype=float)) ** 2)


def gaussian_filter(scans: xr.Dataset, cutoff: str | float) -> xr.Dataset:
    """Return profiles smoothed along x by the Gaussian low-pass filter of ISO 16610-21.

    Parameters
    ----------
    scans
        ``height`` [m] (..., x), evenly spaced, without dropouts.
    cutoff
        Cut-off wavelength [m] or text, e.g. ``"0.8 mm"``.

    Returns
    -------
    xarray.Dataset
        The scans with the mean line in ``height``; attribute ``gaussian_cutoff_m``.

    Raises
    ------
    AnalysisError
        If the cut-off is shorter than two points or longer than the profile.

    Notes
    -----
    Weight function ``exp(-pi (x / (alpha cutoff))^2) / (alpha cutoff)`` with
    ``alpha = sqrt(ln 2 / pi)``. Near the ends the remaining weights are normalised to one, so a
    level profile stays level. Within half a cut-off of the ends a tilted profile is bent;
    `roughness_parameters` ignores that part.

    References
    ----------
    .. [1] ISO 16610-21:2011, Linear profile filters: Gaussian filters.

    Examples
    --------
    >>> x = 1e-6 * np.arange(4000)
    >>> wave = xr.Dataset({"height": ("x", np.sin(2 * np.pi * x / 250e-6))}, {"x": x})
    >>> mean_line = gaussian_filter(wave, "250 um").height.values[1000:3000]
    >>> round(float(abs(mean_line).max()), 4)
    0.5
    """
    # imported late: scipy loads slowly
    from scipy import fft

    cutoff = to_si(cutoff, "m", "cutoff")
    x = scans.x.values
    pitch = float((x[-1] - x[0]) / (x.size - 1))
    if not 2 * pitch <= cutoff <= x.size * pitch:
        raise AnalysisError(
            f"the cut-off {cutoff:.3g} m must lie between two points "
            f"({2 * pitch:.3g} m) and the length of the profile ({x.size * pitch:.3g} m)",
            function="gaussian_filter",
        )
    height = scans.height.transpose(..., "x")
    # weights below 5e-14 of the maximum are left out
    reach = min(int(np.ceil(1.5 * cutoff / pitch)), x.size - 1)
    at = pitch * np.arange(-reach, reach + 1)
    weights = np.exp(-np.pi * (at / (_ALPHA * cutoff)) ** 2)
    weights /= weights.sum()
    rows = height.values.reshape(-1, x.size)
    length = fft.next_fast_len(x.size + 2 * reach, real=True)  # padding prevents wrap-around
    transfer, here = fft.rfft(weights, length), slice(reach, reach + x.size)
    share = fft.irfft(fft.rfft(np.ones(x.size), length) * transfer, length)[here]
    smooth = fft.irfft(fft.rfft(rows, length) * transfer, length)[:, here] / share
    result = scans.assign(height=height.copy(data=smooth.reshape(height.shape)))
    return stamp(result, gaussian_cutoff_m=cutoff)
