"""Persson's theory of rough contact without adhesion: contact area and mean separation.

Conventions: C(q) with <h^2> = 2 pi int q C dq; E* = E/(1 - nu^2); pressure is nominal. P(q) is the
apparent contact area A(q)/A0 seen when roughness beyond the wavenumber q is not resolved.
"""

from __future__ import annotations

import functools
from typing import TypeVar

import numpy as np
import xarray as xr
from scipy.interpolate import CubicHermiteSpline
from scipy.special import erf, exp1

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.area import AreaTheory, area_of
from tribolab.core.errors import AnalysisError
from tribolab.core.validity import examine
from tribolab.surface.moments import (
    cumulative,
    cumulative_at,
    refine_nodes,
    rms_slope,
    spectrum_arrays,
    spectrum_at,
)
from tribolab.units.conversion import positive
from tribolab.units.quantities import si_values
from tribolab.units.stamping import labelled, like, stamp_array

Pressure = TypeVar("Pressure", float, np.ndarray, xr.DataArray)
ROOT_PI = np.sqrt(np.pi)


@over_dims(psd=("wavenumber",))
def contact_area_ratio(
    pressure: str | Pressure,
    psd: xr.Dataset,
    effective_modulus: str | float,
    area: AreaTheory = "persson",
) -> Pressure:
    """Return the relative contact area A/A0 without adhesion, by Persson's or a corrected theory.

    Parameters
    ----------
    pressure
        Nominal pressure [Pa] (any dims), not negative; text with a unit if scalar.
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber), or of several surfaces with further dims,
        which become dims of the result.
    effective_modulus
        E* [Pa].
    area
        ``"persson"``; ``"corrected"`` for the reduced elastic energy of partial contact, within 5 %
        of boundary-element results; or ``"numerics"``, fitted to these.

    Returns
    -------
    float, numpy.ndarray or xarray.DataArray
        A/A0 [1], with the dims of `pressure`. A surface without roughness is in complete contact
        at any pressure above zero; at zero pressure there is no contact.

    Raises
    ------
    AnalysisError
        If a pressure is negative, E* is not positive or the spectrum is invalid.

    Notes
    -----
    ``A/A0 = erf(1 / (2 sqrt(G)))``, ``G = (E*/p)^2 (pi/4) int q^3 C dq``: Eqs. (6) and (7) of [1]_.
    Boundary-element results for random surfaces are 15 to 40 % higher, most at small area; the
    other theories of `tribolab.contact.area` correct this.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).
    .. [2] B. N. J. Persson, J. Chem. Phys. 115, 3840 (2001). doi:10.1063/1.1388626

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> q = np.array([1e3, 1e9])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-2 * q**-4.0)}, coords={"wavenumber": q})
    >>> f"{contact_area_ratio('0.1 MPa', psd, '2 MPa'):.4f}"
    '0.0855'
    """
    modulus = positive(effective_modulus, "Pa", "effective_modulus")
    slope = cumulative(*spectrum_arrays(psd), 3)[-1]
    valid = examine("contact_area_ratio", slope=np.sqrt(2 * np.pi * slope))
    values = pressure_values(pressure)
    ratio = _area(values, modulus * np.sqrt(np.pi * slope), area)
    return _add_validity(like(ratio, pressure, "contact_area_ratio"), valid)


def apparent_contact_area_ratio(
    pressure: str | Pressure,
    psd: xr.Dataset,
    effective_modulus: str | float,
    area: AreaTheory = "persson",
) -> xr.DataArray:
    """Return the apparent contact area ratio P(q) = A(q)/A0 at each wavenumber of the spectrum.

    Parameters
    ----------
    pressure, psd, effective_modulus, area
        As for `contact_area_ratio`.

    Returns
    -------
    xarray.DataArray
        P [1] (dims of pressure, wavenumber); 1 at the first wavenumber and A/A0 at the last.

    Notes
    -----
    Eqs. (6) and (7) of `contact_area_ratio`, with q instead of the upper limit q1.
    """
    modulus = positive(effective_modulus, "Pa", "effective_modulus")
    stiffness = modulus * np.sqrt(np.pi * cumulative(*spectrum_arrays(psd), 3))
    valid = examine("apparent_contact_area_ratio", slope=stiffness[-1] / modulus * np.sqrt(2))
    values = pressure_values(pressure)
    over: xr.DataArray = labelled(pressure, "pressure")
    q = psd["wavenumber"]
    ratio = xr.DataArray(
        _area(values[..., None], stiffness, area),
        coords={**over.coords, "wavenumber": q},
        dims=(*over.dims, "wavenumber"),
    )
    return _add_validity(stamp_array(ratio, "contact_area_ratio"), valid)


@over_dims(psd=("wavenumber",))
def mean_separation(
    pressure: str | Pressure, psd: xr.Dataset, effective_modulus: str | float, gamma: float = 0.45
) -> Pressure:
    """Return the mean interfacial separation of a rough contact at given pressures.

    Parameters
    ----------
    pressure
        Nominal pressure [Pa] (any dims), not negative; text with a unit if scalar.
    psd
        As for `contact_area_ratio`.
    effective_modulus
        E* [Pa].
    gamma
        Elastic-energy reduction factor [1], 0.45 as in [1]_ or 0.5.

    Returns
    -------
    float, numpy.ndarray or xarray.DataArray
        u [m], with the dims of `pressure`; infinite at zero pressure. For a solver use the table
        `tribolab.contact.separation.separation_table`.

    Raises
    ------
    AnalysisError
        If a pressure is negative, gamma is not in (0, 1], or the surface has no roughness.

    Notes
    -----
    ``u(p) = 2 int (ds/q) F(p / (E* sqrt(pi) s))`` with ``s(q)^2 = int_{q0}^q q'^3 C dq'`` and
    ``F(y) = int_y^inf (dt/t) [gamma + 3 (1 - gamma) erf(t)^2] exp(-t^2)``. At small pressure
    ``p ~ exp(-u/u0)`` with ``u0 = 2 gamma int ds/q``. Eq. (8) of [3]_ is an approximation: its
    alpha is h_rms/u0, about 1.8; the printed 0.5 is 1/alpha.

    References
    ----------
    .. [1] C. Yang, B. N. J. Persson, J. Phys.: Condens. Matter 20, 215214 (2008).
       doi:10.1088/0953-8984/20/21/215214
    .. [2] B. N. J. Persson, Phys. Rev. Lett. 99, 125502 (2007).
       doi:10.1103/PhysRevLett.99.125502
    .. [3] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).

    Examples
    --------
    >>> import xarray as xr
    >>> q, c = [1e3, 1e5, 1e8], [1e-22, 1e-22, 1e-34]
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, coords={"wavenumber": q})
    >>> u = mean_separation("0.04 MPa", psd, "2 MPa")
    >>> f"{1e6 * u:.2f} um"
    '2.40 um'
    """
    modulus = positive(effective_modulus, "Pa", "effective_modulus")
    slope, weight = slope_quadrature(*spectrum_arrays(psd))
    valid = examine("mean_separation", slope=rms_slope(psd))
    values = pressure_values(pressure)
    flat = values.ravel() / (ROOT_PI * modulus)
    separation = np.empty_like(flat)
    for part in range(0, flat.size, 128):  # in blocks, to limit memory
        piece = flat[part : part + 128, None]
        separation[part : part + 128] = tail(piece / slope, gamma) @ weight
    return _add_validity(like(separation.reshape(values.shape), pressure, "separation"), valid)


def _add_validity(result: Pressure, valid: dict[str, str]) -> Pressure:
    """Return a DataArray with the validity attributes added; a plain array is unchanged."""
    return result.assign_attrs(valid) if isinstance(result, xr.DataArray) else result


def slope_quadrature(q: np.ndarray, spectrum: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return slopes s and weights w for integrals ``2 int (ds/q) f(s)`` over a spectrum.

    Gauss-Legendre in ln q on every bin. In the first bin s starts from 0 like a square root, which
    the substitution ln q = ln q0 + L t^2 removes.

    Raises
    ------
    AnalysisError
        If the spectrum is zero everywhere.
    """
    moments = cumulative(q, spectrum, 3)
    if moments[-1] == 0:
        raise AnalysisError(
            "psd: the spectrum is zero everywhere; a surface without roughness has no separation: "
            "use the Hertz contact"
        )
    first = int(np.argmax(moments > 0)) - 1
    q, spectrum = q[first:], spectrum[first:]
    nodes = np.log(refine_nodes(q, spectrum, per_decade=25)[0])
    t, weight = np.polynomial.legendre.leggauss(4 if nodes.size < 400 else 2)
    half = np.diff(nodes)[1:, None] / 2
    rest = nodes[1:-1, None] + half * (1 + t)
    t1, weight1 = np.polynomial.legendre.leggauss(16)
    t1, weight1 = (1 + t1) / 2, weight1 / 2
    start = nodes[1] - nodes[0]
    logs = np.concatenate([nodes[0] + start * t1**2, rest.ravel()])
    steps = np.concatenate([2 * start * t1 * weight1, (half * weight).ravel()])
    wavenumber = np.exp(logs).clip(q[0], q[-1])
    slope = np.sqrt(cumulative_at(wavenumber, q, spectrum, 3))
    return slope, wavenumber**3 * spectrum_at(wavenumber, q, spectrum) / slope * steps


def rough_band(psd: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return q and C of a spectrum, cropped to its roughness and one zero at each end.

    This avoids 0/0 in ranges without roughness, e.g. for the opening gap. Moments do not change,
    because C is linear in the bin next to a zero.
    """
    q, spectrum = spectrum_arrays(psd)
    rough = np.flatnonzero(spectrum)
    if rough.size == 0:
        return q, spectrum
    part = slice(max(rough[0] - 1, 0), rough[-1] + 2)
    return q[part], spectrum[part]


def tail(y: np.ndarray, gamma: float) -> np.ndarray:
    """Return F(y) = int_y^inf (dt/t) [gamma + 3 (1 - gamma) erf(t)^2] exp(-t^2), within 1e-8."""
    spline, lowest, highest = _tail_table(float(gamma))
    with np.errstate(divide="ignore"):
        x = np.log(y)
    result = np.exp(spline(np.clip(x, lowest, highest)))
    result = result + gamma * np.maximum(lowest - x, 0)  # F ~ -gamma ln y at small y
    return np.where(x > highest, 0.0, result)


def coarse_tail(log_y: np.ndarray, gamma: float) -> np.ndarray:
    """Return F of `tail` at ln y, accurate to 1e-5 for y < 1; faster than `tail` in long sums."""
    values, steps, lowest, per_unit = _coarse_table(float(gamma))
    position = np.clip((log_y - lowest) * per_unit, 0, values.size - 1)
    cell = position.astype(np.intp)
    return values[cell] + steps[cell] * (position - cell)


def tail_slope(y: np.ndarray, gamma: float) -> np.ndarray:
    """Return -dF/d(ln y) = [gamma + 3 (1 - gamma) erf(y)^2] exp(-y^2)."""
    return (gamma + 3 * (1 - gamma) * erf(y) ** 2) * np.exp(-np.minimum(y * y, 745.0))


@functools.lru_cache(maxsize=8)
def _tail_table(gamma: float) -> tuple[CubicHermiteSpline, float, float]:
    """Return a spline of ln F against ln y with exact slopes, and its lowest and highest ln y."""
    if not 0 < gamma <= 1:
        raise AnalysisError(f"gamma: a value above 0 and at most 1 is wanted; got {gamma:g}")
    x = np.linspace(-12.0, np.log(26.0), 1601)
    t, weight = np.polynomial.legendre.leggauss(12)
    half = (x[1] - x[0]) / 2
    y = np.exp(x[:-1, None] + half * (1 + t))
    pieces = half * (erf(y) ** 2 * np.exp(-y * y)) @ weight
    last = exp1(np.exp(2 * x[-1])) / 2  # erf = 1 at larger y
    both = np.cumsum(np.concatenate([[last], pieces[::-1]]))[::-1]
    value = gamma / 2 * exp1(np.exp(2 * x)) + 3 * (1 - gamma) * both
    slope = -tail_slope(np.exp(x), gamma) / value
    return CubicHermiteSpline(x, np.log(value), slope), float(x[0]), float(x[-1])


@functools.lru_cache(maxsize=8)
def _coarse_table(gamma: float) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return F and its differences at equal steps of ln y, the lowest ln y and 1/step."""
    x, step = np.linspace(-25.0, np.log(26.0), 14001, retstep=True)
    values = np.append(tail(np.exp(x[:-1]), gamma), 0.0)
    return values, np.diff(values, append=0.0), float(x[0]), float(1 / step)


def _area(pressure: np.ndarray, stiffness: np.ndarray | float, area: AreaTheory) -> np.ndarray:
    """Return A/A0 at p/stiffness; a smooth surface (stiffness 0) is in contact if p > 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(pressure == 0, 0.0, area_of(pressure / stiffness, area))


def pressure_values(pressure: str | Pressure) -> np.ndarray:
    """Return pressures [Pa] as an array of floats; NaN remains NaN.

    Raises
    ------
    AnalysisError
        If one is negative.
    """
    values = si_values(pressure, "pressure")
    if np.any(values < 0):
        raise AnalysisError(
            f"pressure: without adhesion it cannot be negative; the lowest is {np.nanmin(values):g}"
            " Pa"
        )
    return values
