"""Random Gaussian profiles and maps with a given isotropic spectrum."""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import cumulative, spectrum_arrays, spectrum_at
from tribolab.surface.self_affine import SelfAffine, psd_1d, psd_2d, rms_roughness
from tribolab.units.stamping import stamp


def synthesise_profiles(
    spectrum: SelfAffine,
    *,
    points: int,
    pitch: float,
    profiles: int = 1,
    rng: np.random.Generator | int | None = None,
) -> xr.Dataset:
    """Return straight profiles of a random Gaussian surface with a given isotropic spectrum.

    Parameters
    ----------
    spectrum
        The surface.
    points, pitch
        Number of points of a profile, and their distance [m].
    profiles
        Number of independent profiles.
    rng
        Generator or seed.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (profile, x), with zero mean, periodic over ``points * pitch``. Attributes:
        ``variance_of_spectrum_m2`` of the surface, and ``variance_in_band_m2`` expected for the
        wavenumbers of these profiles.

    Raises
    ------
    AnalysisError
        If there are fewer than four points or the pitch is not positive.

    Notes
    -----
    Waves ``k_j = 2 pi j / length`` up to ``pi / pitch`` have independent normal amplitudes of
    variance ``2 C_1D(k_j) dk``, with the two-sided C_1D of `self_affine.psd_1d`. Waves longer than
    the length and shorter than two points are left out.

    Examples
    --------
    >>> rough = SelfAffine(hurst=0.8, rolloff=1e4, plateau=1e-20, low=1e3, high=1e9)
    >>> scans = synthesise_profiles(rough, points=4096, pitch=1e-6, profiles=3, rng=1)
    >>> scans.height.dims, scans.height.shape
    (('profile', 'x'), (3, 4096))
    """
    if points < 4 or pitch <= 0:
        raise AnalysisError(
            "at least 4 points and a positive pitch", function="synthesise_profiles"
        )
    rng = np.random.default_rng(rng)
    step = 2 * np.pi / (points * pitch)
    k = step * np.arange(1, (points - 1) // 2 + 1)
    variance = 2 * psd_1d(spectrum, k) * step
    amplitudes = np.zeros((profiles, points // 2 + 1), dtype=complex)
    normal = rng.standard_normal((2, profiles, k.size))
    amplitudes[:, 1 : k.size + 1] = (0.5 * points * np.sqrt(variance)) * (
        normal[0] + 1j * normal[1]
    )
    height = np.fft.irfft(amplitudes, points, axis=-1)
    data = xr.Dataset(
        {"height": (("profile", "x"), height)}, {"x": pitch * np.arange(points, dtype=float)}
    )
    return stamp(
        data,
        lowest_wavenumber_1_m=float(k[0]),
        highest_wavenumber_1_m=float(k[-1]),
        variance_in_band_m2=float(variance.sum()),
        variance_of_spectrum_m2=rms_roughness(spectrum) ** 2,
    )


def synthesise_map(
    spectrum: SelfAffine | xr.Dataset,
    *,
    points: int,
    pitch: float,
    rng: np.random.Generator | int | None = None,
) -> xr.Dataset:
    """Return a square map of a random Gaussian surface with a given isotropic spectrum.

    Parameters
    ----------
    spectrum
        The surface: a law, or ``psd_2d`` [m4] (wavenumber), zero outside its wavenumbers.
    points, pitch
        Number of points along each side, and their distance [m].
    rng
        Generator or seed.

    Returns
    -------
    xarray.Dataset
        ``height`` [m] (y, x), with zero mean, periodic over ``points * pitch`` along both axes.
        The attributes are those of `synthesise_profiles`.

    Raises
    ------
    AnalysisError
        If there are fewer than four points or the pitch is not positive.

    Notes
    -----
    White noise, filtered by ``(2 pi / pitch) sqrt(C(q))``. Only waves that fit the square are
    included, on a lattice with the step ``2 pi / (points * pitch)``.

    Examples
    --------
    >>> rough = SelfAffine(hurst=0.8, rolloff=5e4, plateau=1e-22, low=6e3, high=7e5)
    >>> surface = synthesise_map(rough, points=256, pitch=1e-6, rng=1)
    >>> surface.height.dims, surface.height.shape
    (('y', 'x'), (256, 256))
    >>> from tribolab.surface.self_affine import tabulate
    >>> again = synthesise_map(tabulate(rough), points=256, pitch=1e-6, rng=1)
    >>> bool(abs(again.height - surface.height).max() < 1e-9 * surface.height.max())
    True
    """
    if points < 4 or pitch <= 0:
        raise AnalysisError("at least 4 points and a positive pitch", function="synthesise_map")
    rng = np.random.default_rng(rng)
    k = 2 * np.pi * np.fft.fftfreq(points, pitch)
    q = np.hypot(k[:, None], np.abs(k[: points // 2 + 1]))
    if isinstance(spectrum, SelfAffine):
        c, variance = psd_2d(spectrum, q), rms_roughness(spectrum) ** 2
    else:
        nodes, values = spectrum_arrays(spectrum)
        inside = (q >= nodes[0]) & (q <= nodes[-1])
        c = np.where(inside, spectrum_at(np.clip(q, nodes[0], nodes[-1]), nodes, values), 0.0)
        variance = 2 * np.pi * float(cumulative(nodes, values, 1)[-1])
    step = 2 * np.pi / (points * pitch)
    white = np.fft.rfft2(rng.standard_normal((points, points)))
    height = np.fft.irfft2(white * (2 * np.pi / pitch) * np.sqrt(c), s=(points, points))
    twice = np.ones(q.shape[1])  # each column counts twice, for its mirror image
    twice[1 : (points + 1) // 2] = 2
    x = pitch * np.arange(points, dtype=float)
    inside = q[c > 0]
    return stamp(
        xr.Dataset({"height": (("y", "x"), height)}, {"y": x, "x": x}),
        lowest_wavenumber_1_m=float(inside.min(initial=np.inf)),
        highest_wavenumber_1_m=float(inside.max(initial=0.0)),
        variance_in_band_m2=float((c * twice).sum() * step**2),
        variance_of_spectrum_m2=variance,
    )
