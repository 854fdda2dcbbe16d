"""Hysteresis friction of rubber that slides on a rough surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.special import erf

from tribolab.contact.adhesive_contact import adhesion
from tribolab.contact.area import AreaTheory, area_of
from tribolab.core.errors import AnalysisError
from tribolab.core.validity import LIMITS, examine, together
from tribolab.rubber.modulus import Modulus, TabulatedModulus
from tribolab.rubber.temperature import flash_temperature
from tribolab.surface.moments import (
    bin_integrals,
    cumulative,
    refine_nodes,
    rms_slope,
    spectrum_arrays,
)
from tribolab.units.conversion import to_si
from tribolab.units.stamping import labelled, stamp

PER_DECADE = 60  # least number of wavenumbers per decade; coarser spectra are refined
Excitation = tuple[np.ndarray, Callable[[np.ndarray], np.ndarray]]  # spectrum, E*(omega)
_ANGLES = 24  # Gauss-Legendre points on a quarter turn


def viscoelastic_friction(
    sliding_speed: str | ArrayLike | xr.DataArray,
    pressure: str | ArrayLike | xr.DataArray,
    psd: xr.Dataset,
    modulus: Modulus,
    poisson_ratio: float = 0.5,
    complete_contact: bool = False,
    work_of_adhesion: str | float | None = None,
    area: AreaTheory = "persson",
) -> xr.Dataset:
    """Return the hysteresis friction coefficient and contact area of rubber on a rough surface.

    Parameters
    ----------
    sliding_speed
        v [m/s], not negative; its dim is ``sliding_speed``.
    pressure
        Nominal pressure sigma_0 [Pa] (any dims), above zero.
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).
    modulus
        Complex modulus as a function of angular frequency, see `tribolab.rubber.modulus`.
    poisson_ratio
        Poisson's ratio of the rubber [1].
    complete_contact
        Assume complete contact at every wavenumber (P = S = 1), e.g. due to adhesion.
    work_of_adhesion
        [J/m2]: adhesion then increases the contact at every wavenumber, as at rest.
    area
        Theory of P, see `tribolab.contact.area.area_of`.

    Returns
    -------
    xarray.Dataset
        ``friction_coefficient`` [1] and ``contact_area_ratio`` [1] over the dims of `pressure` and
        `sliding_speed`.

    Raises
    ------
    AnalysisError
        If a speed is negative, a pressure not above zero and finite, or Poisson's ratio is not
        above -1 and at most 0.5; or if the theory of the area is unknown.

    Notes
    -----
    With ``e(omega) = E(omega)/((1 - nu^2) sigma_0)``: ``mu = (1/2) int q^3 C S P dq int_0^{2 pi}
    cos(phi) Im e(q v cos phi) dphi``, ``P = erf(1/(2 sqrt(G)))``, ``S = 1/2 + P^2/2``,
    ``G = (1/8) int q^3 C dq int_0^{2 pi} |e(q v cos phi)|^2 dphi`` [1]_. At rest G is that of the
    elastic contact with the relaxed modulus. Other theories of the area replace the error function
    by another function of 1/(2 sqrt(G)). With adhesion P is that of sliding times P_adh/P of
    `adhesion` at rest, with the relaxed modulus, at each wavenumber; at most 1. The increase thus
    applies at the wavenumbers of the loss: it is larger for short waves than for long ones, and
    friction increases by less than the total contact area. Neglected are the stiffening of rubber
    at the frequencies of the shortest waves, which reduces adhesion, and heating; ``validity`` is
    "suspect" if contact spots of a quarter of the mean wavelength of heights would heat by more
    than 10 K by `tribolab.rubber.temperature.flash_temperature`.

    References
    ----------
    .. [1] B. N. J. Persson, J. Chem. Phys. 115, 3840 (2001). doi:10.1063/1.1388626

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.rubber.modulus import PDMS_STAND_IN
    >>> q = np.array([1e3, 1e5, 1e9])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-3 * q**-4.0)}, coords={"wavenumber": q})
    >>> viscoelastic_friction(0.0, "42 kPa", psd, PDMS_STAND_IN).friction_coefficient.item()
    0.0
    """
    if not -1 < poisson_ratio <= 0.5:
        raise AnalysisError(
            f"poisson_ratio: a value above -1 and at most 0.5 is wanted; got {poisson_ratio:g}"
        )
    speed, over = checked_sliding(sliding_speed, pressure)
    work = 0.0
    if work_of_adhesion is not None:
        work = to_si(work_of_adhesion, "J/m^2", name="work_of_adhesion")
    growth = None
    if work > 0 and not complete_contact:
        growth = _growth(over, psd, float(modulus(0.0).real) / (1 - poisson_ratio**2), work)
    q, spectrum = spectrum_arrays(psd)

    def solve(modulus: Modulus) -> tuple[np.ndarray, np.ndarray]:
        excited = [(spectrum, lambda omega: modulus(omega) / (1 - poisson_ratio**2))]
        return solve_hysteresis(speed, over, q, excited, complete_contact, growth, area)

    friction, touching = solve(modulus)
    rise = _heating(friction, touching, speed, over, psd)
    valid = examine("viscoelastic_friction", slope=rms_slope(psd), heating=rise)
    if isinstance(modulus, TabulatedModulus):
        other = solve(modulus.continued)
        valid = together([valid, _frequency_validity((friction, touching), other, speed, modulus)])
    dims, shape = (*over.dims, *speed.dims), (*over.shape, *speed.shape)
    return stamp(
        xr.Dataset(
            {
                "friction_coefficient": (dims, friction.reshape(shape)),
                "contact_area_ratio": (dims, touching.reshape(shape)),
            },
            coords={**over.coords, **speed.coords},
        ),
        poisson_ratio=poisson_ratio,
        complete_contact=int(complete_contact),
        work_of_adhesion_J_m2=work,
        area=area,
        modulus=repr(modulus),
        **valid,
    )


def checked_sliding(
    sliding_speed: str | ArrayLike | xr.DataArray, pressure: str | ArrayLike | xr.DataArray
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return sliding speeds [m/s] and pressures [Pa]; an AnalysisError if a value is impossible."""
    speed, over = labelled(sliding_speed, "sliding_speed"), labelled(pressure, "pressure")
    if speed.ndim > 1 or np.any(speed.values < 0) or not np.all(np.isfinite(speed.values)):
        raise AnalysisError(
            "sliding_speed: finite speeds of at least 0 m/s along one dimension are wanted"
        )
    if not np.all((over.values > 0) & (over.values < np.inf)):
        raise AnalysisError(
            f"pressure: it must be above zero and finite; the lowest is {over.values.min():g} Pa"
        )
    return speed, over


def solve_hysteresis(
    speed: xr.DataArray,
    over: xr.DataArray,
    nodes: np.ndarray,
    excited: Sequence[Excitation],
    complete_contact: bool = False,
    growth: np.ndarray | None = None,
    area: AreaTheory = "persson",
) -> tuple[np.ndarray, np.ndarray]:
    """Return the friction coefficient, and the area at the largest wavenumber (pressures, speed).

    Parameters
    ----------
    speed, over
        Sliding speeds and pressures.
    nodes, excited
        Wavenumbers; and one or two pairs of a spectrum at these wavenumbers and a function that
        returns E* [Pa] of the contact that it deforms, at angular frequencies [rad/s].
    complete_contact, growth, area
        Whether contact is complete; ratio of P with to P without adhesion; theory of the area.
    """
    stored, lost = np.zeros(()), np.zeros(())
    for heights, modulus in excited:
        q, spectrum = refine_nodes(nodes, heights, PER_DECADE)
        energies = _turn_averages(np.atleast_1d(speed.values)[:, None] * q, modulus)
        stored, lost = (x + spectrum * e for x, e in zip((stored, lost), energies, strict=True))
    # dims: pressures, speeds, wavenumbers
    relative = 1 / over.values.reshape(*over.shape, 1, 1)
    g = relative**2 / 8 * cumulative(q, stored, 3)
    with np.errstate(divide="ignore"):
        touching = np.ones_like(g) if complete_contact else area_of(1 / (2 * np.sqrt(g)), area)
    if growth is not None:
        touching = np.minimum(touching * growth, 1.0)
    integrand = touching * (1 + touching**2) / 2 * lost
    friction = relative[..., 0] / 2 * bin_integrals(q, integrand, 3).sum(axis=-1)
    return friction, touching[..., -1]


def _heating(
    friction: np.ndarray, area: np.ndarray, speed: xr.DataArray, over: xr.DataArray, psd: xr.Dataset
) -> np.ndarray:
    """Return the temperature rise [K] of contact spots by hysteresis (pressures, speed)."""
    q, spectrum = spectrum_arrays(psd)
    first, second = (cumulative(q, spectrum, power)[-1] for power in (1, 2))
    if first == 0:
        return np.zeros_like(friction)
    spot = np.pi / 2 * first / second
    stress = friction * over.values.reshape(*over.shape, 1) / area
    return np.asarray(flash_temperature(stress, np.atleast_1d(speed.values), spot))


def _growth(over: xr.DataArray, psd: xr.Dataset, stiffness: float, work: float) -> np.ndarray:
    """Return P(q) with adhesion at rest, divided by P(q) without (pressures, 1, wavenumber)."""
    q, spectrum = refine_nodes(*spectrum_arrays(psd), PER_DECADE)
    bound = adhesion(over.values.ravel(), psd, stiffness, work)
    nodes = bound["wavenumber"].values
    with np.errstate(divide="ignore"):
        free = erf(
            over.values.reshape(-1, 1) / stiffness / np.sqrt(np.pi * cumulative(q, spectrum, 3))
        )
    seen = bound["apparent_contact_area_ratio"].values
    logs = np.stack([np.interp(np.log(q), np.log(nodes), row) for row in np.log(seen)])
    return np.exp(logs - np.log(free)).reshape(*over.shape, 1, q.size)


def _frequency_validity(
    forces: tuple[np.ndarray, ...],
    other: tuple[np.ndarray, ...],
    speed: xr.DataArray,
    modulus: TabulatedModulus,
) -> dict[str, str]:
    """Return validity attributes for speeds that excite frequencies outside the measured table."""
    share = np.zeros(np.atleast_1d(speed.values).size)
    for force, two in zip(forces, other, strict=True):
        largest = np.maximum(np.abs(force), np.abs(two))
        apart = np.divide(np.abs(force - two), largest, out=np.zeros_like(force), where=largest > 0)
        share = np.maximum(share, apart.reshape(-1, share.size).max(axis=0))
    limit, speeds = LIMITS["frequency"], np.atleast_1d(speed.values)
    ends = modulus.angular_frequency[[0, -1]]
    table = f"the table holds {ends[0]:.3g} to {ends[1]:.3g} rad/s"
    examine("viscoelastic_friction", f"at every speed, {table}", frequency=share.min())
    sure = speeds[share <= limit.suspect]
    known = f"sure from {sure.min():.3g} to {sure.max():.3g} m/s" if sure.size else "at no speed"
    return examine(
        "viscoelastic_friction", f"({known}; {table})", frequency=min(share.max(), limit.refuse)
    )


def _turn_averages(
    frequency: np.ndarray, modulus: Callable[[np.ndarray], np.ndarray]
) -> tuple[np.ndarray, np.ndarray]:
    """Return the integrals over one turn of |E|^2 and cos(phi) Im E, with E at omega cos(phi).

    Both are four times their integral over a quarter: E(-omega) is the conjugate of E(omega).
    """
    t, weight = np.polynomial.legendre.leggauss(_ANGLES)
    cosine, weight = np.cos(np.pi / 4 * (1 + t)), np.pi * weight
    stored, lost = np.zeros(frequency.shape), np.zeros(frequency.shape)
    for c, w in zip(cosine, weight, strict=True):
        value = modulus(frequency * c)
        stored += w * (value.real**2 + value.imag**2)
        lost += w * c * value.imag
    return stored, lost
