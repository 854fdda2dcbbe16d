"""Flow and friction factors of a rough surface, tabulated against the mean separation."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.special import erfinv

from tribolab.arrays.broadcasting import over_dims
from tribolab.contact.gap import COMPLETE
from tribolab.contact.persson import rough_band
from tribolab.contact.separation import separation_table
from tribolab.core.errors import AnalysisError, Cure, nearest, shown
from tribolab.core.validity import examine, together
from tribolab.lubrication.effective_medium import medium_averages
from tribolab.lubrication.factor_table import FactorTable
from tribolab.surface.moments import cumulative, rms_roughness, rms_slope, spectrum_arrays
from tribolab.units.conversion import positive
from tribolab.units.stamping import labelled, stamp

PERCOLATION = 0.42  # relative contact area at which the last open channel closes
CUTOFF = 1e-9  # m, smallest gap included in the mean of 1/u
RoughBody = Literal["stationary", "moving"]
FACTORS = (
    "pressure_flow_factor",
    "shear_flow_factor",
    "shear_stress_factor",
    "shear_stress_correction",
    "pressure_stress_factor",
)

# Separations in the table: above percolation, u - u_c from _NEAR to _FAR times h_rms (the grid of
# gaps is too coarse for larger ones); below percolation, u down to _LOW times h_rms.
_NEAR, _FAR, _LOW, _POINTS = 1e-5, 8.0, 1e-3, 64


class Factors(NamedTuple):
    """The five flow and friction factors [1] at given separations."""

    phi_p: np.ndarray
    phi_s: np.ndarray
    phi_f: np.ndarray
    phi_fs: np.ndarray
    phi_fp: np.ndarray


@dataclass(frozen=True, eq=False)
class FlowFactors:
    """Flow and friction factors of one surface at mean separations; constant if smooth.

    Made by `flow_factors` or `smooth_factors`.

    Parameters
    ----------
    rms_roughness
        h_rms [m]; 0 for a smooth surface.
    percolation_separation
        Mean separation u_c [m] below which there is no flow; 0 if there is always flow.
    rough_body
        Which of the two bodies is rough; sets the sign of phi_s, and phi_fp.
    model
        Source of the factors, for the attributes of results.
    flow, friction
        Tables for a rough body at rest: `flow` of phi_p and (u + h_rms phi_s)/u, `friction` of
        phi_f, phi_fs and, if it does not follow from reciprocity, phi_fp. None if smooth.
    limits
        Attributes of `tribolab.core.validity`: whether the slopes are small enough for thin-film
        flow.
    roughness_balance
        (h2^2 - h1^2)/(h1^2 + h2^2) [1] of two rough bodies, 2 being the faster; None: from
        `rough_body`.
    slide
        Half the slide-roll ratio [1], by which phi_s is multiplied; 1 if one body is at rest.
    """

    rms_roughness: float
    percolation_separation: float
    rough_body: RoughBody
    model: str
    flow: FactorTable | None = field(default=None, repr=False)
    friction: FactorTable | None = field(default=None, repr=False)
    limits: Mapping[str, str] = field(default_factory=lambda: together([]), repr=False)
    roughness_balance: float | None = None
    slide: float = 1.0

    def at(self, separation: np.ndarray) -> Factors:
        """Return the five factors [1] at mean separations u > 0 [m] (any shape)."""
        u = np.asarray(separation, dtype=float)
        if self.flow is None or self.friction is None:
            ones, zero = np.ones_like(u), np.zeros_like(u)
            return Factors(ones, zero, ones, zero, ones)
        phi_p, open_flow = self.flow(u)[0]
        phi_f, phi_fs, *phi_fp = self.friction(u)[0]
        phi_s = self._sign * self.slide * u / self.rms_roughness * (1 - open_flow)
        drag = phi_fp[0] if phi_fp else open_flow
        # both bodies together carry the drag u dp/dx; if the rough one moves, it carries the rest
        return Factors(phi_p, phi_s, phi_f, phi_fs, (1 + self._sign) - self._sign * drag)

    def transport(self, u: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return phi_p and entrained separation u + h_rms phi_s [m], with derivatives by u."""
        if self.flow is None:
            return np.ones_like(u), np.zeros_like(u), u, np.ones_like(u)
        (phi_p, part), (phi_p_slope, part_slope) = self.flow(u)
        # by reciprocity, (u + h_rms phi_s)/u is phi_fp, or 2 - phi_fp if the rough body moves
        carried = self._sign * self.slide
        share, rate = (1 + carried) - carried * part, -carried * part_slope
        return phi_p, phi_p_slope, u * share, share + u * rate

    def dataset(self, separation: str | ArrayLike | xr.DataArray) -> xr.Dataset:
        """Return a dataset of the five factors [1] against separation [m]."""
        over = labelled(separation, "separation")
        if not np.all(over.values > 0):
            raise AnalysisError(
                "separation: factors exist at separations above zero; the lowest is "
                f"{np.min(over.values):g} m"
            )
        parts = {
            name: (over.dims, part)
            for name, part in zip(FACTORS, self.at(over.values), strict=True)
        }
        return stamp(
            xr.Dataset(parts, coords={**over.coords, "separation": over}),
            model=self.model,
            rough_body=self.rough_body,
            rms_roughness_m=self.rms_roughness,
            percolation_separation_m=self.percolation_separation,
            **self.limits,
        )

    def relative_viscosity(self, separation: np.ndarray) -> np.ndarray:
        """Return the viscosity at separations [m], relative to that at zero shear rate: 1 here."""
        return np.ones_like(separation)

    @property
    def _sign(self) -> float:
        if self.roughness_balance is not None:
            return self.roughness_balance
        return -1 if self.rough_body == "stationary" else 1


def flow_factors(
    psd: xr.Dataset,
    rough_body: RoughBody = "stationary",
    percolation: float = PERCOLATION,
    cutoff: str | float = CUTOFF,
    gamma: float = 0.45,
) -> FlowFactors:
    """Return flow and friction factors of a rough surface, by effective-medium theory.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).
    rough_body
        ``"stationary"`` if the rough body is at rest and the smooth one moves (fluid in the valleys
        is left behind: phi_s < 0), ``"moving"`` in the opposite case (phi_s > 0). It also
        determines phi_fp: friction is the drag on the moving body.
    percolation
        Relative contact area at which flow stops, in (0, 1).
    cutoff
        Gap [m] below which <1/u> is cut off.
    gamma
        Elastic-energy reduction factor [1] of the mean separation.

    Returns
    -------
    FlowFactors
        Frozen table of the surface, independent of modulus and load.

    Raises
    ------
    AnalysisError
        If the surface has no roughness (use `smooth_factors`), or a parameter is out of range.

    Notes
    -----
    With the local conductance s = u^3, averages over the gap distribution P(u) with the contact
    counted at u = 0, d = 1/(1 - percolation) and D = s + (d - 1) s_e, the effective conductance
    solves ``1 = <d s_e/D>`` [1]_ [2]_ and

    - phi_p = s_e/u^3 (pressure flow),
    - phi_fp = u_e/u, u_e = d s_e <u/D> (drag by the pressure gradient),
    - phi_s = -(u/h_rms) (1 - phi_fp) (shear flow; the sign is that of `rough_body`),
    - phi_fs = 3 u <u (u - u_e)/D> (drag by the pressure that roughness generates),
    - phi_f = u <1/u>,

    u being the mean. Onsager's reciprocity, (u + h_rms phi_s)/u = phi_fp for a rough body at rest,
    is fulfilled by construction. On a moving rough body the factor of the pressure gradient is 2 -
    phi_fp instead: together the two bodies carry u dp/dx, so that reciprocity is again fulfilled,
    (u + h_rms phi_s)/u = 2 - phi_fp. For u -> infinity and a rough body at rest, phi_p = 1 - (9/d -
    3)(h/u)^2, phi_fp = 1 - (3/d)(h/u)^2, phi_fs = (3/d)(h/u)^2 and phi_f = 1 + (h/u)^2; d = 2 gives
    the results of Tripp [3]_. Below percolation phi_p = phi_fp = 0.

    References
    ----------
    .. [1] D. A. G. Bruggeman, Ann. Phys. 416, 636 (1935). doi:10.1002/andp.19354160705
    .. [2] B. N. J. Persson, M. Scaraggi, Eur. Phys. J. E 34, 113 (2011).
       doi:10.1140/epje/i2011-11113-9
    .. [3] J. H. Tripp, J. Lubr. Technol. 105, 458 (1983). doi:10.1115/1.3254641

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> q = np.array([1e3, 1e5, 1e9])
    >>> c = np.array([1e-22, 1e-22, 1e-38])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, coords={"wavenumber": q})
    >>> factors = flow_factors(psd)
    >>> far = factors.at(100 * factors.rms_roughness)
    >>> f"{float(far.phi_p):.5f} {float(far.phi_f):.5f}"
    '0.99978 1.00010'
    """
    check_rough_body(rough_body)
    if not 0 < percolation < 1:
        raise AnalysisError(
            f"percolation: a relative contact area between 0 and 1 is wanted; got {percolation:g}"
        )
    if rms_roughness(psd) == 0:
        raise AnalysisError(
            "psd: it has no roughness and so never percolates", cure=Cure(notebook="use psd=None")
        )
    q, spectrum = rough_band(psd)
    smallest = positive(cutoff, "m", "cutoff")
    return replace(
        _tabulated(q.tobytes(), spectrum.tobytes(), percolation, smallest, gamma),
        rough_body=rough_body,
    )


@functools.lru_cache(maxsize=16)
def _tabulated(
    q: bytes, spectrum: bytes, percolation: float, cutoff: float, gamma: float
) -> FlowFactors:
    """Return the table of factors for a spectrum; the last few tables are cached."""
    psd = xr.Dataset(
        {"psd_2d": ("wavenumber", np.frombuffer(spectrum))},
        coords={"wavenumber": np.frombuffer(q)},
    )
    height = rms_roughness(psd)
    pressure_of = separation_table(psd, 1.0, gamma)
    slope = np.sqrt(cumulative(*spectrum_arrays(psd), 3)[-1])
    closing = float(pressure_of.separation(float(np.sqrt(np.pi) * slope * erfinv(percolation))))
    above = closing + height * np.geomspace(_NEAR, _FAR, _POINTS)
    # the contact is treated as complete at separations below a hundredth of the cut-off
    lowest = max(min(_LOW * height, closing / 3), 2 * COMPLETE * cutoff)
    if lowest > closing / 2:
        raise AnalysisError(
            f"psd: with h_rms = {height:.2g} m its channels close at a mean separation of "
            f"{closing:.2g} m, which a cut-off of {cutoff:.2g} m cannot resolve",
            cure=Cure(notebook="take the surface for smooth, psd=None, or a smaller cut-off"),
        )
    below = np.geomspace(lowest, closing, _POINTS // 3)
    conductance, entrained, correction, inverse = medium_averages(
        np.concatenate([below, above]), pressure_of, psd, percolation, cutoff, gamma
    )
    first = below.size
    ends = 1 - percolation  # 1/d with the dimension d of the effective medium
    return FlowFactors(
        rms_roughness=height,
        percolation_separation=closing,
        rough_body="stationary",
        model=f"effective medium, percolation at A/A0 = {percolation:g}, cut-off {cutoff:g} m",
        flow=FactorTable(
            above,
            np.stack([conductance[first:], entrained[first:]]),
            closing,
            -np.array([9 * ends - 3, 3 * ends]) * height**2,
            np.ones(2),
            smooth=True,
        ),
        friction=FactorTable(
            np.concatenate([below, above]),
            np.stack([inverse, correction]),
            0.0,
            np.array([1.0, 3 * ends]) * height**2,
            np.array([1.0, 0.0]),
            smooth=True,
        ),
        limits=examine("flow_factors", slope=rms_slope(psd)),
    )


def smooth_factors(rough_body: RoughBody = "stationary") -> FlowFactors:
    """Return the factors of smooth surfaces: phi_p = phi_f = phi_fp = 1, phi_s = phi_fs = 0."""
    check_rough_body(rough_body)
    return FlowFactors(0.0, 0.0, rough_body, "smooth")


@over_dims(psd=("wavenumber",))
def relative_flow_factors(psd: xr.Dataset, over: ArrayLike, **options: Any) -> xr.Dataset:
    """Return flow and friction factors against the mean separation / rms roughness.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber); a spectrum with a further dim, such as
        ``surface``, gives factors with that dim.
    over
        Mean separation over rms roughness [1].
    **options
        Further arguments of `flow_factors`.

    Returns
    -------
    xarray.Dataset
        The five factors of `flow_factors` [1] and ``separation`` [m], over
        ``relative_separation`` [1].

    Raises
    ------
    AnalysisError
        As `flow_factors`, and if a separation is not above zero.

    Examples
    --------
    >>> from tribolab.studies import xu2026
    >>> found = relative_flow_factors(xu2026.psd(["Smooth", "Sb-S"], points=301), [0.5, 2.0])
    >>> found.pressure_flow_factor.dims
    ('surface', 'relative_separation')
    >>> found.pressure_flow_factor.values.round(2).tolist()
    [[0.07, 0.68], [0.07, 0.68]]
    """
    table = flow_factors(psd, **options)
    relative = np.atleast_1d(np.asarray(over, float))
    separation = xr.DataArray(
        relative * table.rms_roughness, {"relative_separation": relative}, "relative_separation"
    )
    factors = table.dataset(separation).reset_coords("separation")
    return stamp(factors, **{k: v for k, v in factors.attrs.items() if not k.endswith("_m")})


def check_rough_body(rough_body: str) -> None:
    """Raise an error unless the argument is "stationary" or "moving"."""
    known = ["stationary", "moving"]
    if rough_body not in known:
        raise AnalysisError(
            f"rough_body: '{shown(rough_body)}' is not one{nearest(rough_body, known)}"
        )
