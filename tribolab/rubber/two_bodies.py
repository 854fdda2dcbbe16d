"""Hysteresis friction between two rubbers, each deformed by the roughness of the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from tribolab.contact.area import AreaTheory
from tribolab.contact.geometry import plane_strain_ratio
from tribolab.core.errors import AnalysisError
from tribolab.core.validity import examine
from tribolab.rubber.friction import PER_DECADE, Excitation, checked_sliding, solve_hysteresis
from tribolab.rubber.modulus import Modulus
from tribolab.surface.moments import refine_nodes, rms_slope, spectrum_arrays, spectrum_at
from tribolab.units.stamping import stamp


@dataclass(frozen=True, eq=False)
class RubberBody:
    """One of two rubber bodies in contact: its modulus, Poisson's ratio and roughness.

    Parameters
    ----------
    modulus
        Complex modulus as a function of angular frequency, see `tribolab.rubber.modulus`.
    psd
        Power spectrum of its surface with ``psd_2d`` [m4] (wavenumber); None if smooth.
    poisson_ratio
        Poisson's ratio [1].

    Examples
    --------
    >>> from tribolab.rubber.modulus import PDMS_STAND_IN
    >>> rubber = RubberBody(PDMS_STAND_IN, poisson_ratio=0.49)
    >>> f"{1 / rubber.compliance(0.0).real / 1e6:.2f} MPa"
    '1.97 MPa'
    """

    modulus: Modulus
    psd: xr.Dataset | None = None
    poisson_ratio: float = 0.5

    def __post_init__(self) -> None:
        """Convert Poisson's ratio, and raise an error for an impossible value."""
        object.__setattr__(self, "poisson_ratio", plane_strain_ratio(self.poisson_ratio))

    def compliance(self, angular_frequency: ArrayLike) -> np.ndarray:
        """Return the complex compliance (1 - nu^2)/E [1/Pa] at angular frequencies [rad/s]."""
        return np.asarray((1 - self.poisson_ratio**2) / self.modulus(angular_frequency))


def two_body_friction(
    sliding_speed: str | ArrayLike | xr.DataArray,
    pressure: str | ArrayLike | xr.DataArray,
    first: RubberBody,
    second: RubberBody,
    area: AreaTheory = "persson",
) -> xr.Dataset:
    """Return the hysteresis friction coefficient and contact area of two rough rubber bodies.

    Parameters
    ----------
    sliding_speed, pressure, area
        As for `viscoelastic_friction`; the speed is that of one body relative to the other.
    first, second
        The bodies; at least one is rough.

    Returns
    -------
    xarray.Dataset
        As for `viscoelastic_friction`.

    Notes
    -----
    The roughness of each body slides over the other body: its waves deform their own body
    statically, and the other one at ``omega = q v cos(phi)``. The modulus of this contact is
    ``1/E*(omega) = (1 - nu_1^2)/E_1(0) + (1 - nu_2^2)/E_2(omega)`` for the roughness of body 1, and
    vice versa. Loss and stored energy of both spectra add up; P(q) is that of both together.

    Examples
    --------
    >>> import numpy as np
    >>> from tribolab.rubber.modulus import PDMS_STAND_IN
    >>> q = np.array([1e3, 1e5, 1e9])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-3 * q**-4.0)}, coords={"wavenumber": q})
    >>> smooth, rough = RubberBody(PDMS_STAND_IN), RubberBody(PDMS_STAND_IN, psd)
    >>> one, both = (two_body_friction("1 mm/s", "42 kPa", rough, b) for b in (smooth, rough))
    >>> bool(both.contact_area_ratio < one.contact_area_ratio)
    True
    """
    speed, over = checked_sliding(sliding_speed, pressure)
    spectra = [spectrum_arrays(body.psd) for body in (first, second) if body.psd is not None]
    if not spectra:
        raise AnalysisError("psd: the power spectrum of at least one body is wanted")
    q = np.unique(np.concatenate([nodes for nodes, _ in spectra]))
    q, _ = refine_nodes(q, np.ones_like(q), PER_DECADE)  # nodes common to both spectra
    excited: list[Excitation] = []
    total = np.zeros_like(q)
    for rough, shaken in ((first, second), (second, first)):
        if rough.psd is None:
            continue
        nodes, spectrum = spectrum_arrays(rough.psd)
        inside = (q >= nodes[0]) & (q <= nodes[-1])
        at = np.where(inside, spectrum_at(q.clip(nodes[0], nodes[-1]), nodes, spectrum), 0.0)
        total += at
        excited.append((at, _contact_modulus(rough, shaken)))
    friction, touching = solve_hysteresis(speed, over, q, excited, area=area)
    dims, shape = (*over.dims, *speed.dims), (*over.shape, *speed.shape)
    slope = rms_slope(xr.Dataset({"psd_2d": ("wavenumber", total)}, {"wavenumber": q}))
    return stamp(
        xr.Dataset(
            {
                "friction_coefficient": (dims, friction.reshape(shape)),
                "contact_area_ratio": (dims, touching.reshape(shape)),
            },
            coords={**over.coords, **speed.coords},
        ),
        area=area,
        **examine("two_body_friction", slope=slope),
    )


def _contact_modulus(rough: RubberBody, shaken: RubberBody) -> Callable[[np.ndarray], np.ndarray]:
    still = rough.compliance(0.0).real
    return lambda omega: np.asarray(1 / (still + shaken.compliance(omega)))
