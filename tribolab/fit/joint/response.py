"""Computed friction as a function of viscosity times speed, for any viscosity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from tribolab.core.errors import AnalysisError
from tribolab.fit import limits

_MIN_SPACING = 0.1  # smallest step of ln(eta v); closer computed points are omitted
_KNOT_OFFSET = 1e4  # offset between the knots of successive responses; no response is wider


class Response(NamedTuple):
    """Friction at one load as a function of ln(eta v), for a liquid of constant viscosity.

    Parameters
    ----------
    log_fluid
        ln of the friction coefficient due to the fluid.
    solid
        Friction coefficient per shear stress [1/Pa].
    low, high
        Computed range of ln(eta v), with eta v in N/m.
    rest
        `solid` at rest, or at the lowest computed speed.
    """

    log_fluid: CubicSpline
    solid: CubicSpline
    low: float
    high: float
    rest: float

    def enlarged(self, factor: float) -> Response:
        """Return the response with the real contact area multiplied by a factor."""
        larger = CubicSpline(self.solid.x, factor * self.solid(self.solid.x))
        return self._replace(solid=larger, rest=factor * self.rest)

    def at(self, log_product: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return fluid friction f, area k, and derivatives, as f, df, k, dk at ln(eta v).

        Outside the computed range the values at its ends are returned.
        """
        inside = np.clip(log_product, self.low, self.high)
        fluid = np.exp(self.log_fluid(inside))
        slope = fluid * self.log_fluid(inside, 1)
        solid = self.solid(inside)
        touch = solid > 0  # where the bodies separate, the spline may become negative
        return fluid, slope, np.where(touch, solid, 0.0), np.where(touch, self.solid(inside, 1), 0)


class Responses(NamedTuple):
    """Several responses in one table, for evaluation together.

    Parameters
    ----------
    ends
        Lowest and highest ln(eta v) of each response (response, 2).
    knots
        Start of the pieces, shifted by `_KNOT_OFFSET` from one response to the next (piece).
    begin
        Start of the pieces, unshifted (piece).
    pieces
        Coefficients of ln f and of k, from the cubic to the constant term (4, 2, piece).
    """

    ends: np.ndarray
    knots: np.ndarray
    begin: np.ndarray
    pieces: np.ndarray

    @classmethod
    def of(cls, responses: Sequence[Response]) -> Responses:
        """Return several responses combined in one table."""
        begin = [response.solid.x[:-1] for response in responses]
        moved = [_KNOT_OFFSET * number + part for number, part in enumerate(begin)]
        pieces = [np.stack([r.log_fluid.c, r.solid.c], axis=1) for r in responses]
        return cls(
            np.array([(response.low, response.high) for response in responses]),
            np.concatenate(moved),
            np.concatenate(begin),
            np.concatenate(pieces, axis=-1),
        )

    def at(self, log_product: np.ndarray, which: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return f, df, k, dk as `Response.at`, for the response `which` of each point.

        `log_product` is ln(eta v) (..., point), `which` an index of the response (point).
        """
        low, high = self.ends[which].T
        inside = np.minimum(np.maximum(log_product, low), high)
        piece = np.searchsorted(self.knots, inside + _KNOT_OFFSET * which, side="right") - 1
        x = (inside - self.begin[piece])[..., None, :]
        a, b, c, d = np.moveaxis(self.pieces[:, :, piece], 1, -2)
        log_fluid, solid = np.moveaxis(((a * x + b) * x + c) * x + d, -2, 0)
        fluid_slope, solid_slope = np.moveaxis((3 * a * x + 2 * b) * x + c, -2, 0)
        fluid = np.exp(log_fluid)
        touch = solid > 0  # where the bodies separate, the spline may become negative
        return fluid, fluid * fluid_slope, np.where(touch, solid, 0.0), touch * solid_slope


def response_of(curve: xr.Dataset, *, friction_factors: bool = True) -> Response:
    """Return the response at one load from a computed friction curve.

    Parameters
    ----------
    curve
        From `stribeck_curve` over ``sliding_speed``, with any shear stress and its viscosity as an
        attribute.
    friction_factors
        False uses the liquid's friction without friction factors, which the curve also contains.

    Raises
    ------
    AnalysisError
        If the curve has fewer than five speeds above zero, or fewer than some three per decade.

    Notes
    -----
    The film depends on eta v only [1]_, Eqs. (3)-(5): f and k are functions of eta v, and one
    computed curve is sufficient for all viscosities.

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
    log_product = np.log(float(curve.attrs["viscosity_Pa_s"]) * speed)
    kept = np.diff(log_product, prepend=-np.inf) > _MIN_SPACING
    if kept.sum() < limits.MIN_SPEEDS_OF_RESPONSE.value:
        raise AnalysisError(
            f"a computed curve has {kept.sum()} speeds above zero; at least "
            f"{limits.MIN_SPEEDS_OF_RESPONSE.value} are wanted"
        )
    log_product = log_product[kept]
    if np.diff(log_product).max() > limits.MAX_SPACING_OF_RESPONSE.value:
        raise AnalysisError("a computed curve wants three speeds in every decade, or more")
    return Response(
        CubicSpline(log_product, np.log(fluid[kept])),
        CubicSpline(log_product, solid[kept]),
        float(log_product[0]),
        float(log_product[-1]),
        rest,
    )


def constant_response(solid: float) -> Response:
    """Return the response of a dry contact: `solid` is its real area over its load [1/Pa]."""
    log_product = np.array([-1e3, 1e3])
    nothing = np.full(2, -1e3)  # exp(-1000) is 0
    return Response(
        CubicSpline(log_product, nothing),
        CubicSpline(log_product, np.full(2, solid)),
        -1e3,
        1e3,
        solid,
    )
