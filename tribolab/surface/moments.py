"""Moments of a power spectrum, exact for a power law between neighbouring nodes.

Between two nodes C(q) is the straight line in log-log that joins them, so the integral over a bin
is a closed form: with g = q^(n+1) C, int q^n C dq = ln(q_b/q_a) (g_b - g_a) / ln(g_b/g_a). No bin
is skipped, kinks at nodes are exact, and three nodes are enough for a plateau with one power law.
In a bin that touches a zero, where no power law exists, C is linear in q.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError


def spectrum_arrays(psd: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return wavenumbers [rad/m] and C [m4] of a power spectrum, or raise if it is invalid.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).

    Raises
    ------
    AnalysisError
        If ``psd_2d`` is missing, the wavenumbers do not increase strictly from above zero, or
        C is negative or not finite anywhere; the message names the first such place.
    """
    if "psd_2d" not in psd or psd["psd_2d"].dims != ("wavenumber",):
        raise AnalysisError(
            "psd: a variable 'psd_2d' with the one dimension 'wavenumber' is wanted; "
            f"it has {', '.join(map(str, psd.data_vars)) or 'no variables'}"
        )
    q = np.asarray(psd["wavenumber"].values, dtype=float)
    spectrum = np.asarray(psd["psd_2d"].values, dtype=float)
    if q.size < 2:
        raise AnalysisError(f"psd: at least two wavenumbers are needed; it has {q.size}")
    if q[0] > q[-1]:
        raise AnalysisError(
            f"psd: the first wavenumber {q[0]:.4g} 1/m lies above the last {q[-1]:.4g} 1/m; "
            "q0 must be smaller than q1: sort by 'wavenumber'"
        )
    if not (q[0] > 0 and np.isfinite(q[-1])):
        raise AnalysisError(
            f"psd: wavenumbers must be positive and finite; they run from {q[0]:.4g} to "
            f"{q[-1]:.4g} 1/m: leave q = 0 out"
        )
    steps = q[1:] > q[:-1]
    if not steps.all():
        at = int(np.argmin(steps)) + 1
        raise AnalysisError(
            f"psd: wavenumbers must increase strictly; number {at} ({q[at]:.6g} 1/m) does not lie "
            f"above the one before it ({q[at - 1]:.6g} 1/m): sort by 'wavenumber', merge repeats"
        )
    good = (spectrum >= 0) & (spectrum < np.inf)
    if not good.all():
        at = int(np.argmin(good))
        raise AnalysisError(
            f"psd: C must be finite and not negative; at q = {q[at]:.6g} 1/m it is "
            f"{spectrum[at]:.4g} m4: leave this wavenumber out or mend the spectrum"
        )
    return q, spectrum


def bin_integrals(q: np.ndarray, spectrum: np.ndarray, order: float) -> np.ndarray:
    """Return the integral of q^order C over each bin between neighbouring nodes.

    Parameters
    ----------
    q
        Nodes [rad/m], strictly increasing, positive (n).
    spectrum
        C at the nodes, not negative (..., n).
    order
        Exponent of q.

    Returns
    -------
    numpy.ndarray
        One integral for each bin (..., n - 1).
    """
    left, right = spectrum[..., :-1], spectrum[..., 1:]
    return _integral(q[:-1], q[1:], left, right, order, (left == 0) | (right == 0))


def _integral(
    a: np.ndarray,
    b: np.ndarray,
    left: np.ndarray,
    right: np.ndarray,
    order: float,
    linear: np.ndarray,
) -> np.ndarray:
    """Return the integral of q^order C from a to b; C is a power law, or a line if `linear`."""
    width = np.log(b / a)
    g = a ** (order + 1) * left
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.log(right / left) + (order + 1) * width  # (log-log slope of C + order + 1) width
        small = np.abs(z) < 1e-5  # for an exponent of -1 the closed form is 0/0: use a series
        result = width * g * np.where(small, 1 + z / 2 + z * z / 6, np.expm1(z) / z)
        if linear.any():
            slope = np.where(b > a, (right - left) / (b - a), 0.0)
            line = (left - slope * a) * _power(a, b, order) + slope * _power(a, b, order + 1)
            result = np.where(linear, line, result)
    return result


def _power(a: np.ndarray, b: np.ndarray, order: float) -> np.ndarray:
    """Return the integral of q^order from a to b."""
    return np.log(b / a) if order == -1 else (b ** (order + 1) - a ** (order + 1)) / (order + 1)


def cumulative(q: np.ndarray, spectrum: np.ndarray, order: float) -> np.ndarray:
    """Return the integral of q^order C from the first node to each node (..., n); starts with 0."""
    bins = bin_integrals(q, spectrum, order)
    start = np.zeros((*bins.shape[:-1], 1))
    return np.concatenate([start, np.cumsum(bins, axis=-1)], axis=-1)


def cumulative_at(
    wavenumber: np.ndarray, q: np.ndarray, spectrum: np.ndarray, order: float
) -> np.ndarray:
    """Return the integral of q^order C from the first node to any wavenumbers of the spectrum."""
    left = np.clip(np.searchsorted(q, wavenumber, side="right") - 1, 0, q.size - 2)
    low, high = spectrum[left], spectrum[left + 1]
    here = spectrum_at(wavenumber, q, spectrum)
    part = _integral(q[left], wavenumber, low, here, order, (low == 0) | (high == 0))
    return cumulative(q, spectrum, order)[left] + part


def spectral_moment(psd: xr.Dataset, order: float) -> float:
    """Return the moment int q^order C dq over all wavenumbers of a power spectrum.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).
    order
        Exponent of q: 1 for roughness, 3 for slope, 5 for curvature.

    Returns
    -------
    float
        The moment [m^(3 - order)], without the factor 2 pi.

    Raises
    ------
    AnalysisError
        If the spectrum is invalid, see `spectrum_arrays`.

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> q = np.array([1e3, 1e5])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", q**-4.0)}, coords={"wavenumber": q})
    >>> round(spectral_moment(psd, 3), 12)  # int dq/q = ln 100
    4.605170185988
    """
    return float(bin_integrals(*spectrum_arrays(psd), order).sum())


def rms_roughness(psd: xr.Dataset) -> float:
    """Return the rms roughness h_rms [m] of a spectrum: <h^2> = 2 pi int q C dq."""
    return float(np.sqrt(2 * np.pi * spectral_moment(psd, 1)))


def rms_slope(psd: xr.Dataset) -> float:
    """Return the rms slope xi [1] of a spectrum: xi^2 = 2 pi int q^3 C dq (Eq. 12)."""
    return float(np.sqrt(2 * np.pi * spectral_moment(psd, 3)))


def refine_nodes(
    q: np.ndarray, spectrum: np.ndarray, per_decade: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return a spectrum with nodes added, so that there are `per_decade` in each decade.

    The moments do not change; quantities computed at the nodes (a gap, a modulus) gain resolution.
    Bins next to a zero, where C is linear in q, are not divided.
    """
    pieces = np.ceil(np.diff(np.log10(q)) * per_decade - 1e-9).astype(int).clip(1)
    pieces[(spectrum[:-1] == 0) | (spectrum[1:] == 0)] = 1
    start = np.repeat(np.arange(q.size - 1), pieces)
    step = np.arange(start.size) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    part = step / np.repeat(pieces, pieces)
    fine = np.append(q[start] * (q[start + 1] / q[start]) ** part, q[-1])
    return fine, spectrum_at(fine, q, spectrum)


def spectrum_at(wavenumber: np.ndarray, q: np.ndarray, spectrum: np.ndarray) -> np.ndarray:
    """Return C at given wavenumbers, interpolated by power laws, or linearly next to a zero."""
    wavenumber = np.asarray(wavenumber, dtype=float)
    if (spectrum > 0).all():
        return np.exp(np.interp(np.log(wavenumber), np.log(q), np.log(spectrum)))
    left = np.clip(np.searchsorted(q, wavenumber, side="right") - 1, 0, q.size - 2)
    low, high = spectrum[left], spectrum[left + 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.log(wavenumber / q[left]) / np.log(q[left + 1] / q[left])
        law = low * (high / low) ** part
    part = (wavenumber - q[left]) / (q[left + 1] - q[left])
    line = low * (1 - part) + high * part
    return np.where((low > 0) & (high > 0), law, line)


def band(psd: xr.Dataset, q_low: float, q_high: float) -> xr.Dataset:
    """Return the part of a power spectrum between two wavenumbers, with nodes at both.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).
    q_low, q_high
        Limits [rad/m] inside the spectrum.

    Returns
    -------
    xarray.Dataset
        ``psd_2d`` (wavenumber) from `q_low` to `q_high`.

    Raises
    ------
    AnalysisError
        If `q_low` is not below `q_high` or the spectrum does not reach that far.
    """
    q, spectrum = spectrum_arrays(psd)
    if not q_low < q_high:
        raise AnalysisError(
            f"q_low = {q_low:.4g} 1/m must lie below q_high = {q_high:.4g} 1/m", function="band"
        )
    if q_low < q[0] * (1 - 1e-12) or q_high > q[-1] * (1 + 1e-12):
        raise AnalysisError(
            f"the spectrum reaches from {q[0]:.4g} to {q[-1]:.4g} 1/m only, and "
            f"{q_low:.4g} to {q_high:.4g} 1/m were asked for: extrapolate it first",
            function="band",
        )
    inside = q[(q > q_low) & (q < q_high)]
    nodes = np.concatenate([[q_low], inside, [q_high]])
    part = psd[["psd_2d"]].isel(wavenumber=0, drop=True)
    part["psd_2d"] = ("wavenumber", spectrum_at(nodes.clip(q[0], q[-1]), q, spectrum))
    part = part.assign_coords(wavenumber=nodes)
    for name in ("psd_2d", "wavenumber"):
        part[name].attrs.update(psd[name].attrs)
    return part
