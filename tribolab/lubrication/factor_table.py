"""Interpolation of flow and friction factors tabulated against the mean separation."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator, PPoly


@dataclass(frozen=True, eq=False)
class FactorTable:
    """Interpolated factors: cubics of ln phi against ln(u - origin), with asymptotes at both ends.

    The cubics are monotone, or splines if the factors are known to be smooth.

    Beyond the last node phi = limit + A(u)/u^2, where A approaches its known value as 1/u^2; below
    the first node the power law of the first cell is extrapolated.
    """

    u: np.ndarray  # mean separations at the nodes [m], increasing
    values: np.ndarray  # values at the nodes (factor, u)
    origin: float
    coefficient: np.ndarray  # factor of 1/u^2 at large u (factor)
    limit: np.ndarray  # value at large u (factor)
    smooth: bool = False
    _curve: PPoly = field(init=False, repr=False)  # two values: ln phi, and its slope (2, factor)

    def __post_init__(self) -> None:
        """Compute the interpolating curve."""
        cubic = CubicSpline if self.smooth else PchipInterpolator
        curve = cubic(np.log(self.u - self.origin), np.log(self.values), axis=1)
        both = np.zeros((*curve.c.shape[:2], 2, len(self.values)))
        both[:, :, 0], both[1:, :, 1] = curve.c, curve.derivative().c
        object.__setattr__(self, "_curve", PPoly(both, curve.x))

    def __call__(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the factors and d(factor)/du at mean separations u (factor, ...)."""
        distance = np.maximum(u - self.origin, 0)
        first, last = self._curve.x[0], self._curve.x[-1]
        with np.errstate(divide="ignore", invalid="ignore"):
            log_u = np.log(distance)
            curve = self._curve(np.minimum(np.maximum(log_u, first), last))
            log_value, rate = curve.transpose(-2, -1, *range(u.ndim))
            if np.any(log_u < first):
                log_value = log_value + rate * np.maximum(np.minimum(log_u - first, 0), -1e3)
            value = np.exp(log_value)
            slope = value * rate / distance
            if np.any(distance == 0):
                value = np.where((distance > 0) | (rate < 0.5), value, 0.0)  # at u = origin
                slope = np.where(distance > 0, slope, 0.0)
            end = self.u[-1]
            beyond = u > end
            if not np.any(beyond):
                return value, slope
            shape = (-1,) + (1,) * np.ndim(u)
            c, limit = self.coefficient.reshape(shape), self.limit.reshape(shape)
            excess = ((self.values[:, -1].reshape(shape) - limit) * end**2 - c) * end**2
            part, rest = c / u**2, excess / u**4
            far, far_slope = limit + part + rest, -(2 * part + 4 * rest) / u
        return np.where(beyond, far, value), np.where(beyond, far_slope, slope)
