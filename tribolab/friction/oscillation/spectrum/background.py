"""Background of a spectrum (red plus white noise), and significance of power above it."""

from __future__ import annotations

import numpy as np
from scipy import special

from tribolab.friction.oscillation import limits

_CORNER_FREQUENCIES = 24  # number of trial corner frequencies
# trial ratios of the power of white noise to that of red noise at zero frequency
_WHITE_SHARES = np.concatenate([[0.0], np.geomspace(1e-6, 1.0, 25)])
_LEVEL_SHIFTS = np.linspace(-1.2, 1.2, 17)  # trial shifts of the level (natural log)
_COST_MARGIN = 1e-3  # tolerance of the cost, far above the rounding errors of single precision


def red_noise(frequency: np.ndarray, power: np.ndarray, freedom: np.ndarray) -> np.ndarray:
    """Fit red noise (an AR(1) process) plus white noise to a spectrum, ignoring peaks.

    Parameters
    ----------
    frequency, power, freedom
        Frequency [Hz], power density and degrees of freedom of bands (band).

    Returns
    -------
    ndarray
        Power density of the background (band).

    Notes
    -----
    S(f) = S_0 [1/(1 + (f/f_c)^2) + w]: an AR(1) process far below the sampling rate, and the
    sensor's white noise. The sum of absolute deviations of log S, weighted with the root of the
    degrees of freedom, is minimised; excesses above a factor of two are clipped, so that peaks and
    their harmonics do not raise their own background. All models are evaluated at once.
    """
    corners = np.concatenate(
        [np.geomspace(frequency[0] / 4, frequency[-1] * 2, _CORNER_FREQUENCIES), [np.inf]]
    )
    shape = 1 / (1 + (frequency[None, :] / corners[:, None]) ** 2)
    models = np.log(shape[:, None, :] + _WHITE_SHARES[None, :, None]).reshape(-1, frequency.size)
    # the log of a mean of few exponential values is biased low
    half = freedom / 2
    measured = np.log(np.maximum(power, 1e-300)) - (special.digamma(half) - np.log(half))
    weight = np.sqrt(np.minimum(freedom, 64.0))
    weight = weight / weight.sum()
    rest = measured - models
    level = _quantile(rest, 0.4)
    rest -= level
    best, shift = _best_model(rest, weight)
    return np.exp(models[best] + (level[best] + shift))


def _best_model(rest: np.ndarray, weight: np.ndarray) -> tuple[int, float]:
    """Return the background model that fits best, and the shift of its level."""
    roughly, off = rest.astype(np.float32), np.empty(rest.shape, np.float32)
    cost = np.stack(
        [_cost(roughly, np.float32(s), weight.astype(np.float32), off) for s in _LEVEL_SHIFTS]
    )
    model, shift = np.nonzero(cost.T <= cost.min() + _COST_MARGIN)
    part = rest[model]
    best = int(np.argmin(_cost(part, _LEVEL_SHIFTS[shift, None], weight, part)))
    return int(model[best]), float(_LEVEL_SHIFTS[shift[best]])


def _cost(
    rest: np.ndarray, shift: np.ndarray | np.float32, weight: np.ndarray, off: np.ndarray
) -> np.ndarray:
    """Return the weighted misfit of each model, with clipped excesses (model); overwrites `off`."""
    np.subtract(rest, shift, out=off)
    np.minimum(off, limits.MAX_EXCESS_OF_BAND.value, out=off)
    cost: np.ndarray = np.abs(off, out=off) @ weight
    return cost


def _quantile(values: np.ndarray, share: float) -> np.ndarray:
    """Return a quantile of each row (row, 1), without the NaN check of `numpy.quantile`."""
    place = share * (values.shape[1] - 1)
    first = min(int(place), values.shape[1] - 2)
    part = np.partition(values, (first, first + 1), axis=1)[:, first : first + 2]
    low, high, after = part[:, :1], part[:, 1:], place - first
    return high - (high - low) * (1 - after) if after >= 0.5 else low + (high - low) * after


def false_alarm(power: np.ndarray, background: np.ndarray, freedom: np.ndarray) -> np.ndarray:
    """Return the probability that noise alone makes at least one band as strong as this one (band).

    Parameters
    ----------
    power, background, freedom
        Power densities and degrees of freedom (band).

    Returns
    -------
    ndarray
        1 - (1 - p)^N (band), with p the tail of the chi-squared distribution.

    Examples
    --------
    >>> false_alarm(np.array([1.0, 30.0]), np.ones(2), np.full(2, 2.0)).round(3).tolist()
    [0.6, 0.0]
    """
    single = special.gammaincc(freedom / 2, freedom / 2 * power / background)
    return -np.expm1(power.size * np.log1p(-np.minimum(single, 1 - 1e-12)))


def significant_power(background: np.ndarray, freedom: np.ndarray, chance: float) -> np.ndarray:
    """Return the power density that noise exceeds in any band with the given probability."""
    single = -np.expm1(np.log1p(-chance) / background.size)
    return background * special.gammainccinv(freedom / 2, single) / (freedom / 2)
