"""Roughness, slope and curvature from the moments of a power spectrum."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.arrays.broadcasting import over_dims
from tribolab.core.provenance import history_line
from tribolab.surface.moments import cumulative, spectrum_arrays
from tribolab.units.stamping import stamp


@over_dims(psd=("wavenumber",))
def spectral_roughness(psd: xr.Dataset) -> xr.Dataset:
    """Return the rms roughness, slope and curvature of a spectrum, cumulative in wavenumber.

    Parameters
    ----------
    psd
        ``psd_2d`` [m4] (wavenumber), with its band if known. Further dims, for several surfaces,
        are kept in the result.

    Returns
    -------
    xarray.Dataset
        ``rms_roughness`` [m], ``rms_slope`` [1], ``rms_curvature`` [1/m] of all waves up to each
        ``wavenumber``; the last value includes all waves. With a band, ``..._low`` and
        ``..._high``: outer bounds, as if all points had errors of the same sign.

    Notes
    -----
    ``h_rms^2 = 2 pi int q C dq``, ``xi^2 = 2 pi int q^3 C dq`` (Eq. 12 of [1]_),
    ``kappa^2 = (pi/2) int q^5 C dq``, the mean square of half the Laplacian. A straight profile
    shows a slope smaller by ``sqrt(2)``.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> q = np.geomspace(1e3, 1e7, 41)
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", q**-4.0)}, {"wavenumber": q})
    >>> slope = spectral_roughness(psd).rms_slope
    >>> bool(abs(float(slope[-1]) - np.sqrt(2 * np.pi * np.log(1e4))) < 1e-12)
    True
    """
    q, _ = spectrum_arrays(psd)
    result = {}
    for ending in ("", "_low", "_high"):
        name = f"psd_2d{ending}"
        if name not in psd:
            continue
        spectrum = psd[name].values
        for quantity, order, factor in (
            ("rms_roughness", 1, 2 * np.pi),
            ("rms_slope", 3, 2 * np.pi),
            ("rms_curvature", 5, 0.5 * np.pi),
        ):
            value = np.sqrt(factor * cumulative(q, spectrum, order))
            result[f"{quantity}{ending}"] = ("wavenumber", value)
    return stamp(
        xr.Dataset(result, {"wavenumber": q}), history=history_line("moments of the spectrum")
    )
