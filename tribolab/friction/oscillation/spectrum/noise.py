"""Sample-to-sample noise and quantisation step of a signal."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median_in_pieces

_SAMPLED_VALUES = 200_000  # this many values suffice to find the quantisation step


def quantisation_step(values: np.ndarray) -> float:
    """Return the smallest step between recorded values; 0 if values hardly repeat.

    Notes
    -----
    A digitised signal takes few different values. If more than half of the values are different,
    the step cannot be determined.
    """
    values = _known(values)
    if values.size < 32:
        return 0.0
    sample = values[:: max(1, values.size // _SAMPLED_VALUES)]
    levels = np.unique(sample)
    if levels.size < 2 or levels.size > 0.5 * sample.size:
        return 0.0
    steps = np.diff(levels)
    # rounding leaves differences of 1e-12 between equal codes; they are not a step
    steps = steps[steps > 1e-9 * np.abs(levels).max()]
    return float(np.quantile(steps, 0.05)) if steps.size else 0.0


def noise_level(values: np.ndarray) -> float:
    """Return the robust standard deviation of the sample-to-sample noise, in the signal's unit.

    Notes
    -----
    It is the median absolute second difference, which drift and slow waves hardly change, divided
    by 0.6745 sqrt(6).
    """
    values = _known(values)
    if values.size < 5:
        return 0.0

    def second(start: int, stop: int) -> np.ndarray:
        return np.abs(np.diff(values[start : stop + 2], 2))

    return float(median_in_pieces(second, values.size - 2) / (0.6745 * np.sqrt(6.0)))


def _known(values: np.ndarray) -> np.ndarray:
    """Return the finite values as one row; no copy is made if all are finite."""
    values = values.reshape(-1)
    if not np.isnan(values.sum()):  # the sum is NaN if any value is missing
        return values
    return values[~np.isnan(values)]
