"""Errors of the points of a curve, individual and shared, and their covariance for a fit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.linalg import cholesky, solve_triangular

from tribolab.metrology.budget_curve import shared_parts

_MIN_ERROR = 1e-15  # smallest error of a friction coefficient, for points that fit exactly


class PointErrors(NamedTuple):
    """Errors of points: individual ones, and shared ones that shift several points together.

    Parameters
    ----------
    own
        Standard error of each point (point).
    shared
        Signed change of the points by one standard uncertainty of each shared input (part, point);
        no row without shared inputs.
    """

    own: np.ndarray
    shared: np.ndarray

    @property
    def covariance(self) -> np.ndarray:
        """Covariance of the points, ``diag(own^2) + sum_j c_j c_j^T u_j^2`` (point, point)."""
        return np.diag(self.own**2) + self.shared.T @ self.shared

    def at(self, which: np.ndarray | slice) -> PointErrors:
        """Return the errors of a selection of the points."""
        return PointErrors(self.own[which], self.shared[:, which])

    def with_part(self, part: np.ndarray) -> PointErrors:
        """Return the errors with one or more shared errors added, (point) or (part, point)."""
        return PointErrors(self.own, np.vstack([self.shared, part]))

    def whitened(self, values: np.ndarray) -> np.ndarray:
        """Return values divided by the Cholesky factor of the covariance, which decorrelates them.

        Parameters
        ----------
        values
            (point, ...)

        Notes
        -----
        ``L^-1 x`` with ``L L^T`` the covariance: the sum of squares is ``x^T C^-1 x``.

        Examples
        --------
        >>> errors = PointErrors(np.array([0.1, 0.1]), np.array([[0.2, 0.2]]))
        >>> together, against = (errors.whitened(np.array(x)) for x in ([0.2, 0.2], [0.2, -0.2]))
        >>> round(float(together @ together), 3), round(float(against @ against), 3)
        (0.889, 8.0)
        """
        if not self.shared.size:
            own = np.maximum(self.own, _MIN_ERROR)
            return values / (own if values.ndim == 1 else own[:, None])
        return np.asarray(
            solve_triangular(cholesky(self.covariance, lower=True), values, lower=True)
        )


def shared_errors(measured: xr.Dataset, speed: np.ndarray) -> np.ndarray:
    """Return the shared errors of a measured curve (part, sliding_speed).

    Parameters
    ----------
    measured
        A measured curve; without parts of its uncertainty, nothing is shared.
    speed
        Speeds of the points [m/s] (sliding_speed).
    """
    at = np.searchsorted(measured["sliding_speed"].values, speed)
    rows = [np.nan_to_num(row[at]) for _, row in shared_parts(measured)]
    return np.array([row for row in rows if row.any()]).reshape(-1, speed.size)
