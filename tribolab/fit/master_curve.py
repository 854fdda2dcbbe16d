"""Test whether friction in several liquids is a single function of viscosity times speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.interpolate import BSpline
from scipy.special import fdtrc

from tribolab.core.errors import AnalysisError

_SPLINE_COEFFICIENTS = 14  # with seven coefficients the test is insensitive


class Collapse(NamedTuple):
    """Result of an F-test: one common curve, or a separate level and slope for each liquid.

    Parameters
    ----------
    statistic, p_value
        F, and the probability of a larger F if the curve is common.
    level, slope
        ln mu, and d ln mu/d ln(eta v), of each liquid relative to the first.
    abscissa, fitted
        Increasing eta v [N/m], and the friction coefficient [1] of the common curve there.
    """

    statistic: float
    p_value: float
    level: np.ndarray
    slope: np.ndarray
    abscissa: np.ndarray
    fitted: np.ndarray

    def _repr_html_(self) -> str:
        """Return HTML of the test, and of the level and slope of each liquid."""
        liquids = "".join(
            f"<tr><td>{number}</td><td>{level:.3g}</td><td>{slope:.3g}</td></tr>"
            for number, (level, slope) in enumerate(zip(self.level, self.slope, strict=True), 1)
        )
        return (
            f"<p><b>Common curve</b>: F = {self.statistic:.3g}, p = {self.p_value:.3g}</p><table>"
            f"<tr><th>liquid</th><th>level of ln µ</th><th>slope</th></tr>{liquids}</table>"
        )


def collapse_test(
    curves: list[xr.Dataset],
    viscosity: list[float],
    *,
    level_error: float = 0.05,
    viscosity_error: float = 0.1,
) -> Collapse:
    """Test whether curves in several liquids collapse on one function of viscosity times speed.

    Parameters
    ----------
    curves
        ``friction_coefficient`` with ``_sem`` (sliding_speed), one for each liquid, of one contact
        and load.
    viscosity
        Viscosity of each liquid [Pa s].
    level_error, viscosity_error
        Relative standard uncertainties [1] of friction and viscosity, common to all points of a
        liquid.

    Returns
    -------
    Collapse

    Raises
    ------
    AnalysisError
        If there are fewer than two liquids or too few points.

    Notes
    -----
    A cubic spline with 14 coefficients for ln mu against ln(eta v) is compared with the same spline
    plus a level and a slope for each liquid except the first. Both are fitted by generalised least
    squares, with the noise of the points and the errors of level and viscosity (times the slope of
    the curve). For Newtonian liquids at one load the curve is exactly common. A shear stress that
    depends on speed, different works of adhesion, shear thinning and heating break the collapse.

    Examples
    --------
    >>> speed = np.geomspace(1e-5, 1e-1, 13)
    >>> def curve(eta):
    ...     mu = 0.1 / (1 + (eta * speed / 1e-4) ** 0.5) + (eta * speed) ** 0.5
    ...     data = {"friction_coefficient": mu, "friction_coefficient_sem": 0.03 * mu}
    ...     return xr.Dataset({n: ("sliding_speed", v) for n, v in data.items()},
    ...                       {"sliding_speed": speed})
    >>> etas = [0.02, 0.2, 1.4]
    >>> found = collapse_test([curve(eta) for eta in etas], etas)
    >>> found._repr_html_().count("<tr>")  # a head and the liquids
    4
    >>> found.p_value > 0.9
    True
    """
    if len(curves) < 2 or len(curves) != len(viscosity):
        raise AnalysisError("curves: two liquids or more are wanted, and a viscosity for each")
    parts = []
    for number, (curve, eta) in enumerate(zip(curves, viscosity, strict=True)):
        (dim,) = curve["friction_coefficient"].dims
        mu, sem = (curve[f"friction_coefficient{end}"].values for end in ("", "_sem"))
        x = np.log(np.maximum(eta * curve[dim].values, 1e-300))
        good = (curve[dim].values > 0) & (mu > 0) & (sem > 0)
        parts.append(np.stack([x, np.log(mu), sem / mu, np.full(x.size, number)])[:, good])
    x, y, noise, liquid = np.concatenate(parts, axis=1)
    extra = 2 * (len(curves) - 1)
    if x.size <= _SPLINE_COEFFICIENTS + extra:
        raise AnalysisError(
            f"curves: more than {_SPLINE_COEFFICIENTS + extra} points are wanted; got {x.size}"
        )
    spline = _spline(x)
    same = (liquid[:, None] == liquid).astype(float)
    covariance = np.diag(noise**2) + level_error**2 * same
    first = np.linalg.lstsq(spline / noise[:, None], y / noise, rcond=None)[0]
    steep = np.gradient(spline @ first, x) if np.all(np.diff(x) > 0) else _slopes(x, spline @ first)
    covariance += viscosity_error**2 * same * np.outer(steep, steep)
    root = np.linalg.cholesky(covariance)
    own = [(liquid == k).astype(float) for k in range(1, len(curves))]
    more = np.stack([*own, *(one * (x - x.mean()) for one in own)], axis=1)
    white = [np.linalg.solve(root, part) for part in (y[:, None], spline, more)]
    target = white[0][:, 0]
    rss, best = _least(white[1], target)
    rss_more, wide = _least(np.hstack(white[1:]), target)
    freedom = x.size - np.linalg.matrix_rank(np.hstack(white[1:]))
    # the errors are known, so chi-square per degree of freedom is taken as at least 1
    statistic = (rss - rss_more) / extra / max(rss_more / freedom, 1.0)
    found = wide[_SPLINE_COEFFICIENTS:]
    order = np.argsort(x)
    return Collapse(
        float(statistic),
        float(fdtrc(extra, freedom, max(statistic, 0.0))),
        np.append(0.0, found[: len(own)]),
        np.append(0.0, found[len(own) :]),
        np.exp(x[order]),
        np.exp((spline @ best)[order]),
    )


def _spline(x: np.ndarray) -> np.ndarray:
    """Return cubic B-splines with knots at quantiles of x (points, coefficients)."""
    inner = np.quantile(x, np.linspace(0, 1, _SPLINE_COEFFICIENTS - 2)[1:-1])
    low, high = x.min(), x.max()
    knots = np.concatenate([np.full(4, low), inner, np.full(4, high)])
    return np.asarray(BSpline.design_matrix(x, knots, 3).toarray())


def _slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    order = np.argsort(x, kind="stable")
    at, first = np.unique(x[order], return_index=True)
    return np.interp(x, at, np.gradient(y[order][first], at))


def _least(matrix: np.ndarray, target: np.ndarray) -> tuple[float, np.ndarray]:
    best = np.linalg.lstsq(matrix, target, rcond=None)[0]
    return float(np.sum((target - matrix @ best) ** 2)), best
