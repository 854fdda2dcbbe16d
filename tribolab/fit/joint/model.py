"""Friction at several loads as one function of a few parameters, with its derivatives."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.response import Response, Responses

REFERENCE_SPEED = 1e-5  # v0 [m/s], chosen so that sigma_0 and n are nearly uncorrelated


class Points(NamedTuple):
    """Measured points of all curves, one after another.

    Parameters
    ----------
    log_speed
        ln v, v in m/s (point).
    log_friction, error
        ln mu and the relative standard error of mu (point).
    curve, level
        Index of the computed response, and of the run whose level error a point has (point).
    """

    log_speed: np.ndarray
    log_friction: np.ndarray
    error: np.ndarray
    curve: np.ndarray
    level: np.ndarray

    def without(self, left_out: np.ndarray) -> Points:
        """Return the points without those of given curves."""
        kept = ~np.isin(self.curve, left_out)
        return Points(*(column[kept] for column in self))


class Curve(NamedTuple):
    """Computed response that belongs to one measured curve.

    Parameters
    ----------
    response
        Friction as a function of ln(eta v); constant for a dry contact.
    surface
        Number of the surface.
    log_load
        ln(load/reference load).
    dry
        Whether the curve was measured without the liquid.
    """

    response: Response
    surface: int
    log_load: float
    dry: bool = False


class Parameters(NamedTuple):
    """Indices of the parameters in a vector, and the mean and deviation of their priors.

    Parameters
    ----------
    stress, speed, load, dry
        Indices of ln sigma_0, n, m, and ln(dry/wet shear stress), by surface.
    viscosity
        Index of ln eta.
    mean, spread
        Mean and standard deviation of the normal prior; a spread of 0 fixes the parameter.
    """

    stress: np.ndarray
    speed: np.ndarray
    load: np.ndarray
    dry: np.ndarray
    viscosity: int
    mean: np.ndarray
    spread: np.ndarray


def parameters_of(
    surfaces: int, viscosity: float, priors: JointPriors, transfer: Sequence[float] = ()
) -> Parameters:
    """Return the parameters of several surfaces in one liquid.

    Parameters
    ----------
    surfaces
        Number of surfaces.
    viscosity
        Median of the prior [Pa s].
    priors
        Priors of the other parameters.
    transfer
        For each surface, the prior standard deviation of ln(dry/wet shear stress); empty if nothing
        was measured dry.
    """
    index = np.arange(surfaces)
    dry = 3 * surfaces + 1 + np.arange(len(transfer))
    mean = np.zeros(3 * surfaces + 1 + len(transfer))
    mean[index], mean[3 * surfaces] = np.log(priors.shear_stress), np.log(viscosity)
    spread = np.repeat(
        [priors.shear_stress_spread, priors.speed_exponent, priors.load_exponent], surfaces
    )
    spread = np.concatenate([spread, [priors.viscosity_spread], transfer])
    return Parameters(
        index, surfaces + index, 2 * surfaces + index, dry, 3 * surfaces, mean, spread
    )


@dataclass(frozen=True, eq=False)
class JointModel:
    """Model of a joint fit: points, computed curves, parameters, and reference load F0 [N/m].

    Notes
    -----
    ``ln mu = ln[f(eta v) + sigma_0 (v/v0)^n (F/F0)^m k(eta v)]``. For a dry curve f = 0, k is the
    contact area with adhesion divided by the load, and sigma_0 is multiplied by the ratio of dry to
    wet shear stress.
    """

    points: Points
    curves: Sequence[Curve]
    parameters: Parameters
    reference_load: float

    def log_reference(self, load: float) -> float:
        """Return ln(load/reference load) of a load [N/m]."""
        return float(np.log(load / self.reference_load))

    def predicted(
        self, theta: np.ndarray, at: Points | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return ln mu (..., point) and its derivatives (..., point, parameter).

        Parameters
        ----------
        theta
            One or several sets of parameters (..., parameter).
        at
            Points to use instead of the measured ones.
        """
        points = self.points if at is None else at
        design = self._design if at is None else self._design_of(at)
        viscosity = self.parameters.viscosity
        fluid, slope, area, area_slope = self._responses.at(
            points.log_speed + theta[..., viscosity, None], points.curve
        )
        stress = np.exp(theta @ design.T)
        friction = fluid + stress * area
        slopes = (stress * area / friction)[..., None] * design
        slopes[..., viscosity] = (slope + stress * area_slope) / friction
        return np.log(friction), slopes

    @functools.cached_property
    def _responses(self) -> Responses:
        return Responses.of([curve.response for curve in self.curves])

    @functools.cached_property
    def _design(self) -> np.ndarray:
        return self._design_of(self.points)

    def _design_of(self, points: Points) -> np.ndarray:
        """Return d ln(shear stress)/d(parameter) for all parameters (point, parameter)."""
        where, number = self.parameters, points.curve
        surface, log_load, dry = (
            np.array([getattr(curve, name) for curve in self.curves])[number]
            for name in ("surface", "log_load", "dry")
        )
        design = np.zeros((number.size, where.mean.size))
        rows = np.arange(number.size)
        design[rows, where.stress[surface]] = 1.0
        design[rows, where.speed[surface]] = points.log_speed - np.log(REFERENCE_SPEED)
        design[rows, where.load[surface]] = log_load
        design[rows[dry], where.dry[surface[dry]]] = 1.0
        return design

    def without(self, left_out: np.ndarray) -> JointModel:
        """Return the model without given curves."""
        return replace(self, points=self.points.without(left_out))


class Shared(NamedTuple):
    """Correlations between points of their level errors, and of their speed-correlated errors."""

    level: np.ndarray
    near: np.ndarray


def shared_by_points(points: Points, other: Points, length: float) -> Shared:
    """Return the correlations of points within a run, and of neighbouring speeds in a curve."""
    same = points.curve[:, None] == other.curve
    apart = np.abs(points.log_speed[:, None] - other.log_speed)
    return Shared(
        (points.level[:, None] == other.level).astype(float),
        np.where(same, np.exp(-apart / length), 0.0),
    )
