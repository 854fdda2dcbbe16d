"""Noise from sample to sample, and the step of the converter, from the samples themselves."""

from __future__ import annotations

import numpy as np

from tribolab.arrays.medians import median_in_pieces

_SAMPLED_VALUES = 200_000  # values that suffice to find the quantisation step


def quantisation_step(values: np.ndarray) -> float:
    """Smallest step between recorded values, in their unit; 0 where values hardly repeat.

    Notes
    -----
    A digitised signal takes few different values. Where more than half of the values are
    different, no step can be told from the numbers and none is claimed.
    """
    values = _known(values)
    if values.size < 32:
        return 0.0
    sample = values[:: max(1, values.size // _SAMPLED_VALUES)]
    levels = np.unique(sample)
    if levels.size < 2 or levels.size > 0.5 * sample.size:
        return 0.0
    steps = np.diff(levels)
    # arithmetic leaves dust of 1e-12 between equal codes; it is not a step
    steps = steps[steps > 1e-9 * np.abs(levels).max()]
    return float(np.quantile(steps, 0.05)) if steps.size else 0.0


def noise_level(values: np.ndarray) -> float:
    """Robust standard deviation of the sample-to-sample noise, in the signal's unit.

    Notes
    -----
    From second differences, which a drift or a slow wave leaves near zero: their median
    absolute deviation over 0.6745 sqrt(6).
    """
    values = _known(values)
    if values.size < 5:
        return 0.0

    def second(start: int, stop: int) -> np.ndarray:
        return np.abs(np.diff(values[start : stop + 2], 2))

    return float(median_in_pieces(second, values.size - 2) / (0.6745 * np.sqrt(6.0)))


def _known(values: np.ndarray) -> np.ndarray:
    """Values that are numbers, in a row; no copy is made if all are."""
    values = values.reshape(-1)
    if not np.isnan(values.sum()):  # one number says whether anything is missing
        return values
    return values[~np.isnan(values)]
