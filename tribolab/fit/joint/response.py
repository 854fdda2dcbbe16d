"""What a computed curve says at any viscosity: friction over the product of viscosity and speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from tribolab.errors import AnalysisError

_NEAR = 0.1  # of ln(eta v): of two computed points that lie closer one is enough
_FEWEST = 5
_FAR = 1.0  # of ln(eta v): over wider gaps a spline may be off by several percent


class Response(NamedTuple):
    """Friction at one load over ln(eta v), as the liquid is isoviscous.

    Parameters
    ----------
    log_fluid
        ln of the friction coefficient that the fluid makes.
    solid
        Friction coefficient per shear stress [1/Pa].
    low, high
        Ends of ln(eta v), eta v in N/m, between which it was computed.
    rest
        `solid` at rest, or at the lowest speed that was computed.
    """

    log_fluid: CubicSpline
    solid: CubicSpline
    low: float
    high: float
    rest: float

    def enlarged(self, factor: float) -> Response:
        """Return the response of a contact whose real area is larger by a factor."""
        larger = CubicSpline(self.solid.x, factor * self.solid(self.solid.x))
        return self._replace(solid=larger, rest=factor * self.rest)

    def at(self, place: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return f, df, k, dk at places ln(eta v), the derivatives by that; ends go on as they are.

        Below the lowest product the contact is as at rest; no answer is wanted far beyond either.
        """
        inside = np.clip(place, self.low, self.high)
        fluid = np.exp(self.log_fluid(inside))
        slope = fluid * self.log_fluid(inside, 1)
        solid = self.solid(inside)
        touch = solid > 0  # a spline may go under zero where the bodies part
        return fluid, slope, np.where(touch, solid, 0.0), np.where(touch, self.solid(inside, 1), 0)


def response_of(curve: xr.Dataset, *, friction_factors: bool = True) -> Response:
    """Return the response of a load from a computed curve.

    Parameters
    ----------
    curve
        From `stribeck_curve` over ``sliding_speed``, with any shear stress; its viscosity is among
        its attributes.
    friction_factors
        False takes the liquid's friction without its factors, which the curve knows as well.

    Raises
    ------
    AnalysisError
        If it has fewer than five speeds above zero, or fewer than some three a decade.

    Notes
    -----
    Flow and elastic forces balance at the same film where eta v is the same [1]_, Eqs. (3)-(5): f
    and k are functions of eta v alone, and one computed curve serves every viscosity.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026).
    """
    curve = curve.sortby("sliding_speed")
    speed = curve["sliding_speed"].values
    if friction_factors:
        fluid = sum(
            curve[f"friction_coefficient_{part}"].values for part in ("couette", "pressure")
        )
    else:
        fluid = (curve["friction_without_factors"] - curve["friction_coefficient_solid"]).values
    solid = curve["friction_per_shear_stress"].values
    rest = float(solid[np.argmin(np.abs(speed))]) if speed.size else 0.0
    known = (speed > 0) & np.isfinite(fluid) & (fluid > 0) & np.isfinite(solid)
    speed, fluid, solid = speed[known], np.asarray(fluid)[known], solid[known]
    place = np.log(float(curve.attrs["viscosity_Pa_s"]) * speed)
    kept = np.diff(place, prepend=-np.inf) > _NEAR
    if kept.sum() < _FEWEST:
        raise AnalysisError(
            f"a computed curve has {kept.sum()} speeds above zero; at least {_FEWEST} are wanted"
        )
    place = place[kept]
    if np.diff(place).max() > _FAR:
        raise AnalysisError("a computed curve wants three speeds in every decade, or more")
    return Response(
        CubicSpline(place, np.log(fluid[kept])),
        CubicSpline(place, solid[kept]),
        float(place[0]),
        float(place[-1]),
        rest,
    )


def constant_response(solid: float) -> Response:
    """Return the response of a contact without liquid: `solid` is its area over its load [1/Pa]."""
    place = np.array([-1e3, 1e3])
    nothing = np.full(2, -1e3)  # exp of it is zero
    return Response(
        CubicSpline(place, nothing), CubicSpline(place, np.full(2, solid)), -1e3, 1e3, solid
    )
