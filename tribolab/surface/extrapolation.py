"""Extrapolation of a measured spectrum to the wavenumbers that contact theory needs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.errors import AnalysisError, Cure
from tribolab.core.provenance import history_line
from tribolab.surface.limits import MAX_FITTED_HURST, MAX_SURE_HURST, MIN_HURST
from tribolab.surface.moments import spectrum_arrays, spectrum_at
from tribolab.units.conversion import to_si
from tribolab.units.stamping import stamp

AS_MEASURED, TO_SMALL, TO_LARGE = 0, 1, 2
_PER_DECADE = 20
_ABOVE_ROLLOFF = 1.5  # start of the fitted range, relative to the roll-off


class PowerLaw(NamedTuple):
    """Power law of a spectrum, a straight line in logarithms: ``level + slope (ln q - centre)``."""

    level: float
    slope: float
    centre: float
    level_error: float
    slope_error: float

    @property
    def hurst(self) -> float:
        """Hurst exponent H, from ``C ~ q^(-2(1+H))``."""
        return -0.5 * self.slope - 1

    @property
    def hurst_error(self) -> float:
        """Standard error of the Hurst exponent."""
        return 0.5 * self.slope_error

    def log_value(self, wavenumber: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return ln C of the power law at a wavenumber, and its standard error."""
        x = np.log(wavenumber) - self.centre
        return self.level + self.slope * x, np.hypot(self.level_error, self.slope_error * x)


_UNKNOWN = PowerLaw(*[float("nan")] * 5)


class _Part(NamedTuple):
    """Section of a spectrum, with lower and upper 95 % limits divided by C (2, wavenumber)."""

    wavenumber: np.ndarray
    value: np.ndarray
    spread: np.ndarray
    origin: int

    def cut(self, low: float, high: float) -> _Part:
        """Return the section between two wavenumbers, with nodes at both ends."""
        q = self.wavenumber
        ends = np.array([end for end in (low, high) if q[0] < end < q[-1] and end not in q])
        nodes = np.unique(np.concatenate([q[(q >= low) & (q <= high)], ends]))
        near = np.minimum(np.searchsorted(q, nodes), q.size - 1)
        value = np.where(q[near] == nodes, self.value[near], spectrum_at(nodes, q, self.value))
        return _Part(nodes, value, self.spread[:, near], self.origin)


def extrapolate(
    psd: xr.Dataset,
    *,
    q_low: str | float | None = None,
    q_high: str | float = np.pi / 1e-9,
    fit_decade: tuple[str | float, str | float] | None = None,
) -> xr.Dataset:
    """Extend a 2D spectrum by a constant to small and by a power law to large wavenumbers.

    Parameters
    ----------
    psd
        ``psd_2d`` [m4] (wavenumber), with ``psd_2d_low``, ``psd_2d_high`` if known.
    q_low
        Smallest wavenumber q0 [1/m], usually pi over the width of the contact; by default that of
        the spectrum. If larger, the spectrum is cut there.
    q_high
        Largest wavenumber q1 [1/m]; by default pi / 1 nm.
    fit_decade
        Wavenumbers (from, to) [1/m] of the power law's fit; by default the last decade of the
        spectrum, starting at least 1.5 times above the roll-off.

    Returns
    -------
    xarray.Dataset
        ``psd_2d`` with its band from `q_low` to `q_high`, and ``origin``: 0 measured, 1
        extrapolated to small, 2 to large wavenumbers. Attributes ``hurst_exponent`` and its
        standard error, ``fit_low_1_m``, ``fit_high_1_m``, ``rolloff_wavenumber_1_m`` and
        ``rolloff`` (found or not); ``not_self_affine`` is a reason not to use the power law.

    Raises
    ------
    AnalysisError
        If q_low is not below q_high or the spectrum is invalid; for an extrapolation to large
        wavenumbers also if the spectrum falls too slowly or too fast for a rough surface over the
        fitted decade, or that decade has fewer than three points. Without this extrapolation
        results that cannot be fitted are NaN.

    Notes
    -----
    ``C = C_0 (q/q_r)^(-2(1+H))``, by weighted regression of ln C on ln q. The band widens with the
    distance from the fitted decade by the standard errors of level and exponent; if the points
    scatter more than their bands, the errors are increased by that ratio.

    Examples
    --------
    >>> q = np.geomspace(1e4, 1e6, 21)
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", 1e-5 * q**-3.6)}, {"wavenumber": q})
    >>> wide = extrapolate(psd, q_low="1e3 1/m", q_high=1e9)
    >>> round(wide.attrs["hurst_exponent"], 12), float(wide.wavenumber[-1])
    (0.8, 1000000000.0)
    """
    q, c = spectrum_arrays(psd)
    low = float(q[0]) if q_low is None else to_si(q_low, "1/m", "q_low")
    high = to_si(q_high, "1/m", "q_high")
    if not 0 < low < high:
        raise AnalysisError(
            f"q_low must lie below q_high; got {low:.4g} and {high:.4g} 1/m", function="extrapolate"
        )
    if not (c > 0).any():
        raise AnalysisError("the spectrum is zero everywhere", function="extrapolate")
    try:
        law, decade, rolloff = _fit(q, c, _log_error(psd), fit_decade)
    except AnalysisError:
        if high > q[-1] or fit_decade is not None:
            raise
        law, decade, rolloff = _UNKNOWN, (np.nan, np.nan), np.nan
    if high > q[-1]:
        _refuse_law(law, decade, str(psd.attrs.get("not_self_affine", "")))
    measured = _Part(q, c, _relative_band(psd, c), AS_MEASURED)
    parts = [measured.cut(low, high)]
    if low < q[0]:
        grid = _grid(low, min(high, float(q[0])))
        grid = grid[:-1] if high >= q[0] else grid
        level, spread = np.full(grid.size, c[0]), np.repeat(measured.spread[:, :1], grid.size, 1)
        parts.insert(0, _Part(grid, level, spread, TO_SMALL))
    if high > q[-1]:
        grid = _grid(max(low, float(q[-1])), high)
        grid = grid[1:] if low <= q[-1] else grid
        log_c, log_error = law.log_value(grid)
        spread = np.exp(NORMAL * np.stack([-log_error, log_error]))
        parts.append(_Part(grid, np.exp(log_c), spread, TO_LARGE))
    value = np.concatenate([part.value for part in parts])
    below, above = np.concatenate([part.spread for part in parts], axis=1) * value
    origin = np.concatenate([np.full(part.wavenumber.size, part.origin, np.int8) for part in parts])
    data = xr.Dataset(
        {
            "psd_2d": ("wavenumber", value),
            "psd_2d_low": ("wavenumber", below),
            "psd_2d_high": ("wavenumber", above),
            "origin": ("wavenumber", origin, origin_flags()),
        },
        {"wavenumber": np.concatenate([part.wavenumber for part in parts])},
    )
    action = f"extrapolated to {low:.4g} ... {high:.4g} 1/m"
    kept = {k: v for k, v in psd.attrs.items() if k != "origin"}
    kept["history"] = "\n".join(filter(None, [kept.get("history", ""), history_line(action)]))
    seen = rolloff > 1.05 * q[0]
    rough = _is_surface_law(law)  # whether the fitted power law was used
    attrs = {
        **kept,
        "hurst_exponent": law.hurst if rough else float("nan"),
        "hurst_exponent_standard_error": law.hurst_error if rough else float("nan"),
        "fit_low_1_m": decade[0],
        "fit_high_1_m": decade[1],
        "rolloff_wavenumber_1_m": rolloff,
        "rolloff": "not known: no power law fits the spectrum"
        if np.isnan(rolloff)
        else "seen in the spectrum"
        if seen
        else f"not reached: C(q) still rises towards {q[0]:.3g} 1/m, so the plateau below is an "
        "assumption; longer scans would show it",
    }
    return stamp(data.assign_attrs(attrs))


def _is_surface_law(law: PowerLaw) -> bool:
    """Return whether the Hurst exponent is possible for a rough surface, within its error."""
    hurst, error = law.hurst, law.hurst_error
    sure = hurst - NORMAL * error
    return bool(MIN_HURST.value <= hurst <= MAX_FITTED_HURST.value and sure <= MAX_SURE_HURST.value)


def _refuse_law(law: PowerLaw, decade: tuple[float, float], why: str) -> None:
    """Raise an error if the fitted slope of the spectrum is impossible for a rough surface."""
    if _is_surface_law(law):
        return
    if law.hurst < MIN_HURST.value:
        why = why or "noise, rounded heights, or waves of one length with nothing between them"
    why = why or "a gauge, a groove, or what a filter or the window left of a single wave"
    raise AnalysisError(
        f"C(q) falls between {decade[0]:.4g} and {decade[1]:.4g} 1/m as on a surface with a Hurst "
        f"exponent of {law.hurst:.2g} ± {NORMAL * law.hurst_error:.2g} (U95); "
        "self-affine surfaces have "
        f"{MIN_HURST.value:g} to 1 and smooth ones up to {MAX_SURE_HURST.value:g}, so no power "
        f"law leads on from there ({why})",
        cure=Cure(
            notebook="take the measured spectrum alone (q_high = its last wavenumber), or another "
            "fit_decade",
            campaign="say q_high in [roughness], no more than the last measured wavenumber, or "
            "another fit_decade",
        ),
        function="extrapolate",
    )


def origin_flags() -> dict[str, str | list[int]]:
    """Return the CF flag attributes that explain the values of the variable ``origin``."""
    return {
        "flag_values": [AS_MEASURED, TO_SMALL, TO_LARGE],
        "flag_meanings": "measured extrapolated_to_small_q extrapolated_to_large_q",
    }


def _grid(low: float, high: float) -> np.ndarray:
    grid = np.geomspace(low, high, max(2, int(np.ceil(_PER_DECADE * np.log10(high / low))) + 1))
    grid[0], grid[-1] = low, high
    return grid


def _relative_band(psd: xr.Dataset, c: np.ndarray) -> np.ndarray:
    """Return lower and upper limit of the 95 % band, divided by C; both are 1 without a band."""
    if "psd_2d_low" not in psd:
        return np.ones((2, c.size))
    band = np.stack([psd.psd_2d_low.values, psd.psd_2d_high.values])
    return np.divide(band, c, out=np.ones_like(band), where=c > 0)


def _log_error(psd: xr.Dataset) -> np.ndarray | None:
    """Return the standard error of ln C, from the width of the 95 % band."""
    if "psd_2d_low" not in psd:
        return None
    with np.errstate(divide="ignore", invalid="ignore"):
        width = np.log(psd.psd_2d_high.values / psd.psd_2d_low.values)
    error = width / (2 * NORMAL)
    return error if np.isfinite(error).all() and (error > 0).all() else None


def _fit(
    q: np.ndarray,
    c: np.ndarray,
    error: np.ndarray | None,
    fit_decade: tuple[str | float, str | float] | None,
) -> tuple[PowerLaw, tuple[float, float], float]:
    """Return the fitted power law, the decade of its fit, and the roll-off [1/m]."""
    if fit_decade is not None:
        low, high = (to_si(value, "1/m", "fit_decade") for value in fit_decade)
        law = _regress(q, c, error, low, high)
        return law, (low, high), _crossing(law, c[0])
    high, floor = float(q[-1]), float(q[-1]) / 10
    low = max(floor, float(q[0]))
    rolloff = float(q[0])
    for _ in range(20):
        law = _regress(q, c, error, low, high)
        rolloff = _crossing(law, c[0])
        # the fit keeps at least four points, wherever the roll-off is
        new = min(max(floor, float(q[0]), _ABOVE_ROLLOFF * rolloff), float(q[-min(4, q.size)]))
        if abs(new - low) <= 1e-9 * low:
            break
        low = new
    return law, (low, high), rolloff


def _crossing(law: PowerLaw, plateau: float) -> float:
    if not plateau > 0:
        return 0.0
    return float(np.exp(np.clip(law.centre + (np.log(plateau) - law.level) / law.slope, -700, 700)))


def _regress(
    q: np.ndarray, c: np.ndarray, error: np.ndarray | None, low: float, high: float
) -> PowerLaw:
    chosen = (q >= low * (1 - 1e-9)) & (q <= high * (1 + 1e-9)) & (c > 0)
    number = int(chosen.sum())
    if number < 3:
        raise AnalysisError(
            f"{number} points lie between {low:.4g} and {high:.4g} 1/m, three are the "
            f"least for a power law; the spectrum reaches from {q[0]:.4g} to {q[-1]:.4g} 1/m",
            cure=Cure(
                notebook="give another fit_decade", campaign="say another fit_decade in [roughness]"
            ),
            function="extrapolate",
        )
    x, y = np.log(q[chosen]), np.log(c[chosen])
    sigma = np.ones(number) if error is None else error[chosen]
    weight = sigma**-2.0
    centre = float(np.average(x, weights=weight))
    level = float(np.average(y, weights=weight))
    norm = float(np.sum(weight * (x - centre) ** 2))
    slope = float(np.sum(weight * (x - centre) * y) / norm)
    if not slope < -1e-9:
        raise AnalysisError(
            f"C(q) does not fall between {low:.4g} and {high:.4g} 1/m (exponent {slope:.2f})",
            cure=Cure(
                notebook="choose a decade where it does with fit_decade=(from, to)",
                campaign="choose a decade where it does with fit_decade in [roughness]",
            ),
            function="extrapolate",
        )
    misfit = np.sum(weight * (y - level - slope * (x - centre)) ** 2) / max(number - 2, 1)
    growth = np.sqrt(misfit) if error is None else np.sqrt(max(1.0, misfit))
    return PowerLaw(
        level, slope, centre, float(growth / np.sqrt(weight.sum())), float(growth / np.sqrt(norm))
    )
