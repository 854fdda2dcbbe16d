"""Text on the agreement of measurement and model, from the residuals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.core.coverage import NORMAL
from tribolab.core.wording import aligned, number, percent, speed_text

if TYPE_CHECKING:
    import xarray as xr

_UNLIKELY = 0.05  # p value below which the order of the residuals' signs is significant
_LARGE = 0.10  # share of the measured friction that any reader notices
_SMALL_DIFFERENCE = 0.02  # share of the curve's peak
_LARGE_DIFFERENCE = 0.3
_MAX_RATIO = 2.0  # factor between measurement and model; above it the model does not fit
_MAX_SIGMAS = 3.0  # standard errors
_NOT_DESCRIBED = "the model does not describe this curve"
_NO_STRESS = "no shear stress describes this curve"


def has_shear_stress(fit: xr.Dataset) -> bool:
    """Return whether the fit found a positive shear stress."""
    return bool(fit.attrs["shear_stress_Pa"] > 0)


def stress_interval(low: float | None, high: float | None) -> str:
    """Return the 95 % interval [Pa] of a shear stress in MPa, never negative.

    Examples
    --------
    >>> stress_interval(0.8e6, 0.88e6), stress_interval(-0.092e6, 0.335e6)
    ('0.800 to 0.880', 'up to 0.335: it may be zero')
    """
    if low is None or high is None:
        return "–"
    if low <= 0:
        return f"up to {aligned(1e-6 * high)}: it may be zero"
    return f"{aligned(1e-6 * low)} to {aligned(1e-6 * high)}"


def shear_stress_u95(fit: Mapping[str, Any], error: float) -> float:
    """Return U95 [Pa] of a shear stress, or of a quantity from it, from its standard error.

    The coverage factor is that of the fitted stress: the wider half of its 95 % interval over its
    standard error; 1.96 without an interval.

    Examples
    --------
    >>> fit = {"shear_stress_Pa": 5.0, "shear_stress_total_error_Pa": 1.0}
    >>> shear_stress_u95(fit | {"shear_stress_low_Pa": 2.5, "shear_stress_high_Pa": 8.0}, 2.0)
    6.0
    """
    low, high = fit.get("shear_stress_low_Pa"), fit.get("shear_stress_high_Pa")
    own, stress = fit["shear_stress_total_error_Pa"], fit["shear_stress_Pa"]
    if low is None or high is None or not own:
        return NORMAL * error
    return max(high - stress, stress - low) / own * error


def is_described(words: str) -> bool:
    """Return whether a `judgement` states that the model describes the curve.

    Examples
    --------
    >>> is_described("the model does not describe this curve: off by a factor of 3")
    False
    """
    return not words.startswith((_NOT_DESCRIBED, _NO_STRESS))


def judgement(fit: xr.Dataset) -> str:
    """Return a sentence on how well one shear stress describes the measured curve.

    Parameters
    ----------
    fit
        The group "fit" of a model's data file.

    Notes
    -----
    Disagreement is tested by chi-square and by the order of the residuals' signs. Its place is
    given by the range of speeds that one shear stress describes within the errors, and by the
    points that deviate by more than a tenth of the friction.
    """
    if not has_shear_stress(fit):
        why = "the fitted one is not positive, so no model is drawn"
        return f"{_NO_STRESS}: {why}; see stick-slip and sliding mode"
    used = fit["used"].values > 0
    speed = fit["sliding_speed"].values[used]
    mu, off = (
        fit[name].values[used] for name in ("friction_coefficient", "friction_coefficient_residual")
    )
    share = np.abs(off) / np.maximum(np.abs(mu), 1e-12)
    worst = int(np.argmax(np.abs(off)))
    error = fit["friction_coefficient_residual_u"].values[used]
    clear = (mu > 0) & (mu - off > 0) & ~(np.abs(off) <= _MAX_SIGMAS * error)
    factor = float(np.exp(np.abs(np.log(mu[clear] / (mu - off)[clear])).max(initial=0.0)))
    parts = [_verdict(fit.attrs, np.abs(off).max() / np.abs(mu).max(), factor)]
    low, high = fit.attrs["valid_speed_low_m_s"], fit.attrs["valid_speed_high_m_s"]
    if np.isfinite(low) and (low > 1.01 * speed[0] or high < 0.99 * speed[-1]):
        parts.append(
            f"within the errors one shear stress describes {speed_text(low)} to {speed_text(high)}"
        )
    elif not np.isfinite(low):
        parts.append("no range of speeds is described within the errors")
    far = (share > _LARGE) & ~((speed >= 0.99 * low) & (speed <= 1.01 * high))
    if far.any():
        beyond = "beyond these " if np.isfinite(low) else ""
        parts.append(
            f"{beyond}the two differ by more than {percent(_LARGE)} of the friction at "
            f"{_stretches(speed, far)}"
        )
    side = "above" if off[worst] > 0 else "below"
    parts.append(
        f"largest at {speed_text(speed[worst])}, where the measurement is "
        f"{number(abs(off[worst]), 2)} {side} the model's {number(mu[worst] - off[worst])}"
    )
    return "; ".join(parts)


def _stretches(speed: np.ndarray, chosen: np.ndarray) -> str:
    """Return a text on the speeds [m/s] at which a condition is true."""
    ends = np.flatnonzero(np.diff(np.r_[False, chosen, False].astype(int)))
    words = []
    for first, beyond in ends.reshape(-1, 2):
        last = beyond - 1
        at = speed_text(speed[first])
        words.append(at if first == last else f"{at} to {speed_text(speed[last])}")
    return " and at ".join(filter(None, [", ".join(words[:-1]), words[-1]]))


def _verdict(attrs: Mapping[str, Any], largest: float, factor: float) -> str:
    """Return a text on the agreement, and on systematic residuals."""
    ordered = attrs["runs_p_value"] < _UNLIKELY
    if attrs["chi_square_p_value"] >= _UNLIKELY and not ordered:
        return "the model describes the curve within the errors"
    if attrs["chi_square_p_value"] >= _UNLIKELY:
        return (
            "within the errors, but the residuals vary systematically: the shape differs slightly"
        )
    if largest > _LARGE_DIFFERENCE:
        return f"{_NOT_DESCRIBED}: off by up to {percent(largest)} of the peak friction"
    if factor > _MAX_RATIO:
        return f"{_NOT_DESCRIBED}: off by up to a factor of {number(factor, 2)}"
    trend = " and vary systematically with speed" if ordered else ""
    within = percent(max(largest, _SMALL_DIFFERENCE))
    return (
        f"the model fits to within {within} of the peak friction; the residuals "
        f"exceed the error bars{trend}"
    )
