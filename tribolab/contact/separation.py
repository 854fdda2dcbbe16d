"""Contact pressure as a function of mean separation, tabulated for solvers."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field, replace

import numpy as np
import xarray as xr
from scipy.interpolate import CubicHermiteSpline, PPoly

from tribolab.contact.persson import (
    ROOT_PI,
    Pressure,
    pressure_values,
    rough_band,
    slope_quadrature,
    tail,
    tail_slope,
)
from tribolab.core.errors import AnalysisError
from tribolab.surface.moments import cumulative
from tribolab.units.conversion import positive
from tribolab.units.quantities import si_values
from tribolab.units.stamping import like

_ROUNDING = 1e-14  # relative step below which Newton's method stops


@dataclass(frozen=True, eq=False)
class Separation:
    """Contact pressure p(u) of a rough surface at mean separation u, and its inverse u(p).

    Made by `separation_table`. Monotone everywhere: inside the table ln p is a cubic in
    ``U = ln(exp(u/h_rms) - 1)`` with the theory's own slopes; it is extrapolated at larger u as
    ``p ~ exp(-u/decay_length)``, at smaller u as ``u ~ exp(-(p/p_1)^2)``, both with the slope at
    the end of the table.

    Parameters
    ----------
    rms_roughness
        h_rms [m].
    decay_length
        u0 [m] of the low-pressure asymptote p ~ exp(-u/u0).
    effective_modulus
        E* [Pa].
    gamma
        Elastic-energy reduction factor [1].
    table_pressure, table_separation
        The table [Pa], [m], pressure increasing.
    """

    rms_roughness: float
    decay_length: float
    effective_modulus: float
    gamma: float
    table_pressure: np.ndarray = field(repr=False)
    table_separation: np.ndarray = field(repr=False)
    _curve: PPoly = field(repr=False)  # ln p as a function of U

    @functools.cached_property
    def _with_slope(self) -> PPoly:
        """Spline in U with two values: ln p and d ln p/dU."""
        curve = self._curve
        both = np.zeros((*curve.c.shape, 2))
        both[..., 0], both[1:, :, 1] = curve.c, curve.derivative().c
        return PPoly(both, curve.x)

    @functools.cached_property
    def _ends(self) -> tuple[float, float, float, float, float]:
        """Asymptotes: at large u, ln p and d ln p/du; at small u, p, u and -d ln u/d(p^2)."""
        far, near = self._curve.x[[-1, 0]]
        slope = self._curve(far, 1) * self._chain(self.table_separation[0])
        pressure, separation = self.table_pressure[-1], self.table_separation[-1]
        # chain rule d ln p/du = d ln p/dU dU/du; for u ~ exp(-k p^2), d ln u/d(p^2) = -k
        steep = self._curve(near, 1) * self._chain(separation)
        return (
            float(np.log(self.table_pressure[0])),
            float(slope),
            float(pressure),
            float(separation),
            float(-1 / (2 * pressure**2 * separation * steep)),
        )

    def _chain(self, separation: np.ndarray) -> np.ndarray:
        """Return the derivative dU/du = 1 / (h (1 - exp(-u/h)))."""
        return -1 / (self.rms_roughness * np.expm1(-separation / self.rms_roughness))

    def pressure(self, separation: str | Pressure) -> Pressure:
        """Return the contact pressure [Pa] at mean separations [m] (any dims); infinite at 0.

        Raises
        ------
        AnalysisError
            If a separation is negative.
        """
        values = self._separations(separation)
        return like(self._evaluate(values)[0], separation, "pressure")

    def pressure_and_slope(self, separation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return p [Pa] and dp/du [Pa/m] (zero or negative) at mean separations u [m] (any shape).

        Raises
        ------
        AnalysisError
            If a separation is negative.
        """
        return self._evaluate(self._separations(separation))

    def separation(self, pressure: str | Pressure) -> Pressure:
        """Return the mean separation [m] at contact pressures [Pa] (any dims); infinite at 0.

        Raises
        ------
        AnalysisError
            If a pressure is negative.
        """
        values = pressure_values(pressure)
        log_far, slope_far, p_near, u_near, steep = self._ends
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):  # NaN remains NaN
            log_p = np.log(values)
            u = self._invert(np.clip(log_p, log_far, np.log(p_near)))
            far = self.table_separation[0] + (log_p - log_far) / slope_far
            near = u_near * np.exp(-steep * (values**2 - p_near**2))
        u = np.where(log_p < log_far, far, np.where(values > p_near, near, u))
        return like(u, pressure, "separation")

    def _evaluate(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        log_far, slope_far, p_near, u_near, steep = self._ends
        u_far = self.table_separation[0]
        inside = np.minimum(np.maximum(u, u_near), u_far)
        ratio = inside / self.rms_roughness
        curve = ratio + np.log(-np.expm1(-ratio))
        both = self._with_slope(curve)
        log_p, slope = both[..., 0], both[..., 1] * self._chain(inside)
        log_p = log_p + slope_far * np.maximum(u - u_far, 0)
        slope = np.where(u > u_far, slope_far, slope)
        pressure = np.exp(log_p)
        if np.any(u < u_near):
            with np.errstate(divide="ignore", invalid="ignore"):
                near = np.sqrt(p_near**2 + np.log(u_near / u.clip(0, u_near)) / steep)
                rate = np.where(u > 0, -1 / (2 * steep * near**2 * u), -np.inf)
            pressure = np.where(u < u_near, near, pressure)
            slope = np.where(u < u_near, rate, slope)
        with np.errstate(invalid="ignore"):
            return pressure, pressure * slope

    def _invert(self, log_p: np.ndarray) -> np.ndarray:
        """Return u from the tabulated cubic, by Newton's method within one interval."""
        knots, curve = self._curve.x, self._curve
        levels = curve(knots)[::-1]
        cell = np.clip(np.searchsorted(levels, log_p, side="right") - 1, 0, levels.size - 2)
        upper, lower = knots[::-1][cell], knots[::-1][cell + 1]
        part = (log_p - levels[cell]) / (levels[cell + 1] - levels[cell])
        x = upper + part * (lower - upper)
        for _ in range(12):
            step = (curve(x) - log_p) / curve(x, 1)
            x = np.clip(x - step, lower, upper)
            if not np.any(np.abs(step) > _ROUNDING * (1 + np.abs(x))):
                break
        return self.rms_roughness * np.logaddexp(0.0, x)

    @staticmethod
    def _separations(separation: str | Pressure) -> np.ndarray:
        values = si_values(separation, "separation")
        if np.any(values < 0):
            raise AnalysisError(
                f"separation: it cannot be negative; the lowest is {np.nanmin(values):g} m"
            )
        return values


def separation_table(
    psd: xr.Dataset, effective_modulus: str | float, gamma: float = 0.45, points: int = 120
) -> Separation:
    """Return a table of contact pressure against mean separation for one surface.

    Parameters
    ----------
    psd
        Power spectrum with ``psd_2d`` [m4] (wavenumber).
    effective_modulus
        E* [Pa].
    gamma
        Elastic-energy reduction factor [1], 0.45 or 0.5.
    points
        Number of entries.

    Returns
    -------
    Separation
        Frozen; callable as ``table.pressure(u)``, ``table.separation(p)`` and
        ``table.pressure_and_slope(u)``.

    Raises
    ------
    AnalysisError
        If the surface has no roughness, E* is not positive or gamma not in (0, 1].

    Notes
    -----
    The theory is that of `tribolab.contact.persson.mean_separation`. The slopes of the table are
    exact, ``du/d(ln p) = -2 int (ds/q) [gamma + 3 (1 - gamma) erf(y)^2] exp(-y^2)``; slopes steeper
    than three times a chord are limited to that, which keeps a cubic monotone [1]_.

    References
    ----------
    .. [1] F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17, 238 (1980).
       doi:10.1137/0717021

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> q = np.array([1e3, 1e9])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-2 * q**-4.0)}, coords={"wavenumber": q})
    >>> table = separation_table(psd, "2 MPa")
    >>> f"{table.pressure(table.separation('0.1 MPa')):.6f}"
    '100000.000000'
    """
    modulus = positive(effective_modulus, "Pa", "effective_modulus")
    q, spectrum = rough_band(psd)
    unit = _unit_modulus_table(q.tobytes(), spectrum.tobytes(), gamma, points)
    coefficients = unit._curve.c.copy()
    coefficients[-1] += np.log(modulus)
    return replace(
        unit,
        effective_modulus=modulus,
        table_pressure=_frozen(unit.table_pressure * modulus),
        _curve=PPoly(coefficients, unit._curve.x),
    )


@functools.lru_cache(maxsize=16)
def _unit_modulus_table(
    q_bytes: bytes, spectrum_bytes: bytes, gamma: float, points: int
) -> Separation:
    """Return the table for a spectrum at E* = 1 Pa; the last few tables are cached."""
    q, spectrum = np.frombuffer(q_bytes), np.frombuffer(spectrum_bytes)
    slope, weight = slope_quadrature(q, spectrum)
    height = float(np.sqrt(2 * np.pi * cumulative(q, spectrum, 1)[-1]))
    # from pressures so low that the asymptote is accurate to 1e-6, to those with u < 1e-6 h_rms
    lowest = 1e-6 * min(q[0] * height, ROOT_PI * slope[-1])
    stiffness = np.concatenate(
        [
            np.geomspace(lowest, 0.3 * ROOT_PI * slope[-1], points // 2, endpoint=False),
            np.geomspace(0.3, 5.0, points - points // 2) * ROOT_PI * slope[-1],
        ]
    )
    y = stiffness[:, None] / (ROOT_PI * slope)
    u, rate = tail(y, gamma) @ weight, -(tail_slope(y, gamma) @ weight)
    curve = (u / height + np.log(-np.expm1(-u / height)))[::-1]
    log_p = np.log(stiffness)[::-1]
    # chain rule: dU/d(ln p) = dU/du du/d(ln p)
    slopes = -height * np.expm1(-u[::-1] / height) / rate[::-1]
    chords = np.diff(log_p) / np.diff(curve)
    steepest = 3 * np.maximum(np.append(chords, -np.inf), np.insert(chords, 0, -np.inf))
    return Separation(
        rms_roughness=height,
        decay_length=float(gamma * weight.sum()),
        effective_modulus=1.0,
        gamma=gamma,
        table_pressure=_frozen(stiffness),
        table_separation=_frozen(u),
        _curve=CubicHermiteSpline(curve, log_p, np.maximum(slopes, steepest)),
    )


def _frozen(values: np.ndarray) -> np.ndarray:
    values.flags.writeable = False
    return values
