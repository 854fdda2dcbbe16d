"""The friction of several loads as one function of a few parameters, with its derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.response import Response

SPEED = 1e-5  # m/s, v0: there sigma_0 and n are hardly correlated


class Points(NamedTuple):
    """Measured points of all curves, one after the other.

    Parameters
    ----------
    log_speed
        ln v, v in m/s (point).
    log_friction, error
        ln mu and the standard error of mu over mu (point).
    curve, level
        Which response, and which common level, a point has (point).
    """

    log_speed: np.ndarray
    log_friction: np.ndarray
    error: np.ndarray
    curve: np.ndarray
    level: np.ndarray

    def without(self, left_out: np.ndarray) -> Points:
        """Return the points but those of some curves."""
        kept = ~np.isin(self.curve, left_out)
        return Points(*(column[kept] for column in self))


class Curve(NamedTuple):
    """What is computed beside one measured curve.

    Parameters
    ----------
    response
        Over ln(eta v); of a dry contact constant.
    surface
        Number of the surface.
    log_load
        ln of the load over the reference load.
    dry
        Whether the curve was measured without the liquid.
    """

    response: Response
    surface: int
    log_load: float
    dry: bool = False


class Parameters(NamedTuple):
    """Where each parameter stands in the vector, and its prior (parameter).

    Parameters
    ----------
    stress, speed, load, dry
        Places of ln sigma_0, n, m, and ln of dry over wet shear stress, by surface.
    viscosity
        Place of ln eta.
    mean, spread
        Of the prior, normal; a spread of 0 holds the parameter fixed.
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
    """Return the parameters of several surfaces with one liquid.

    Parameters
    ----------
    surfaces
        How many.
    viscosity
        Median of the prior [Pa s].
    priors
        Of the rest.
    transfer
        For each surface the prior's standard deviation of ln of its dry over its wet shear stress;
        empty if nothing was measured dry.
    """
    places = np.arange(surfaces)
    dry = 3 * surfaces + 1 + np.arange(len(transfer))
    mean = np.zeros(3 * surfaces + 1 + len(transfer))
    mean[places], mean[3 * surfaces] = np.log(priors.shear_stress), np.log(viscosity)
    spread = np.repeat(
        [priors.shear_stress_spread, priors.speed_exponent, priors.load_exponent], surfaces
    )
    spread = np.concatenate([spread, [priors.viscosity_spread], transfer])
    return Parameters(
        places, surfaces + places, 2 * surfaces + places, dry, 3 * surfaces, mean, spread
    )


class JointModel(NamedTuple):
    """Points, the curves computed beside them, the parameters, and F0 [N/m].

    Notes
    -----
    ``ln mu = ln[f(eta v) + sigma_0 (v/v0)^n (F/F0)^m k(eta v)]``; of a dry curve f = 0, k is the
    area with adhesion over the load, and sigma_0 is multiplied with the dry over the wet stress.
    """

    points: Points
    curves: Sequence[Curve]
    parameters: Parameters
    reference_load: float

    def log_reference(self, load: float) -> float:
        """Return ln of a load [N/m] over the reference load."""
        return float(np.log(load / self.reference_load))

    def predicted(
        self, theta: np.ndarray, at: Points | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return ln mu (point) and its derivatives (point, parameter).

        Parameters
        ----------
        theta
            The parameters (parameter).
        at
            Other points than the measured ones.
        """
        points = self.points if at is None else at
        where = self.parameters
        value = np.empty(points.log_speed.size)
        slopes = np.zeros((value.size, theta.size))
        for number in np.unique(points.curve):
            mine = points.curve == number
            curve = self.curves[number]
            s, away = curve.surface, points.log_speed[mine] - np.log(SPEED)
            fluid, slope, area, area_slope = curve.response.at(
                points.log_speed[mine] + theta[where.viscosity]
            )
            exponent = theta[where.stress[s]] + theta[where.speed[s]] * away
            exponent = exponent + theta[where.load[s]] * curve.log_load
            if curve.dry:
                exponent = exponent + theta[where.dry[s]]
            stress = np.exp(exponent)
            friction = fluid + stress * area
            share = stress * area / friction
            value[mine] = np.log(friction)
            slopes[mine, where.stress[s]] = share
            slopes[mine, where.speed[s]] = share * away
            slopes[mine, where.load[s]] = share * curve.log_load
            slopes[mine, where.viscosity] = (slope + stress * area_slope) / friction
            if curve.dry:
                slopes[mine, where.dry[s]] = share
        return value, slopes

    def without(self, left_out: np.ndarray) -> JointModel:
        """Return the model of all curves but some."""
        return self._replace(points=self.points.without(left_out))


class Shared(NamedTuple):
    """What errors of points have in common: blocks of one level, and neighbours of one curve."""

    level: np.ndarray
    near: np.ndarray


def shared_errors(one: Points, other: Points, length: float) -> Shared:
    """Return correlations (point, other point) of unit levels and of unit correlated errors."""
    same = one.curve[:, None] == other.curve
    apart = np.abs(one.log_speed[:, None] - other.log_speed)
    return Shared(
        (one.level[:, None] == other.level).astype(float),
        np.where(same, np.exp(-apart / length), 0.0),
    )
