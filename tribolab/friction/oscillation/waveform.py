"""Waveform of an oscillation: steepness of rise and fall, and similarity of periods.

The class follows from eleven features by a multinomial logistic model. Its coefficients were fitted
to simulated traces (``tests/detection/calibrate_stick_slip.py``, with seeds not used in tests or
tables) and checked on real records.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import special

from tribolab.arrays.medians import median
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.events import Events
from tribolab.friction.oscillation.oscillation import Oscillation
from tribolab.friction.oscillation.regularity import scatter


class WaveformFeatures(NamedTuple):
    """Features of the waveform.

    Parameters
    ----------
    fall_share
        Median share of a cycle in which friction falls: 0.5 for a sine, near 0 for a sawtooth.
    asymmetry_p_value
        p value of the hypothesis that rises and falls last equally long, as in noise; from the sign
        test over cycles.
    derivative_skewness
        Skewness of the derivative: 0 for a sine, strongly negative for a sawtooth.
    period_scatter, drop_scatter
        Standard deviation over mean of the recurrence times and of the drops.
    events
        Number of whole cycles.
    """

    fall_share: float
    asymmetry_p_value: float
    derivative_skewness: float
    period_scatter: float
    drop_scatter: float
    events: int


def describe_waveform(
    values: np.ndarray, lag: int, events: Events, period: np.ndarray
) -> WaveformFeatures:
    """Return the features of the waveform of a record.

    Parameters
    ----------
    values
        Evenly sampled, some 48 samples per period (time).
    lag
        Samples over which the derivative is taken.
    events
        Cycles found in the record.
    period
        Times from drop to drop, pauses left out [s].
    """
    rise, fall = events.peak - events.start, events.stop - events.peak
    n = events.drop.size
    slope = values[lag:] - values[:-lag] if values.size > lag else np.zeros(0)
    slope = slope - slope.mean() if slope.size else slope
    square = slope * slope
    spread = float(np.sqrt(np.mean(square))) if slope.size else 0.0
    skewness = float(square @ slope) / slope.size / spread**3 if spread > 0 else np.nan
    if n == 0:
        return WaveformFeatures(np.nan, 1.0, skewness, np.nan, np.nan, 0)
    longer, shorter = int((rise > fall).sum()), int((rise < fall).sum())
    p_value = 1.0
    if longer + shorter:  # exact two-sided sign test
        tail = float(special.bdtr(min(longer, shorter), longer + shorter, 0.5))
        p_value = min(1.0, 2 * tail)
    return WaveformFeatures(
        fall_share=float(median(fall / (rise + fall))),
        asymmetry_p_value=p_value,
        derivative_skewness=skewness,
        period_scatter=scatter(period),
        drop_scatter=float(np.std(events.drop, ddof=1) / events.drop.mean()) if n > 1 else np.nan,
        events=n,
    )


CLASSES = ("smooth sliding", "sawtooth stick-slip", "sinus-like oscillation", "reversed sawtooth")
NOT_LOOKED_AT = "not evaluated"
NOT_CLEAR = "not decided"

# for each feature: value if unknown, lowest and highest; values beyond are clipped
WAVEFORM_LIMITS = {
    "prominence": (0.0, -0.5, 4.0),  # log10(power of the peak / background)
    "significance": (0.0, 0.0, 8.0),  # -log10 of the false-alarm probability
    "strength": (-0.3, -0.5, 1.5),  # log10(swing / noise)
    "share": (0.0, 0.0, 1.0),
    "harmonics": (0.5, 0.0, 1.2),
    "asymmetry": (0.0, -0.5, 0.5),  # 0.5 minus the share of the falling part
    "lean": (0.0, 0.0, 0.5),  # absolute value of the asymmetry
    "reversal": (0.0, 0.0, 6.0),  # -log10(p) of the test that rises and falls last equally long
    "skewness": (0.0, -4.0, 4.0),
    "sharpness": (0.0, 0.0, 4.0),  # absolute value of the skewness
    "scatter": (0.5, 0.0, 0.8),  # standard deviation of the periods divided by their mean
}

# one number for each class, in the order of CLASSES
_INTERCEPT = np.array([3.52, -2.46, 1.40, -2.46])
_COEFFICIENTS = {
    "prominence": np.array([-0.57, -0.06, 0.69, -0.06]),
    "significance": np.array([-0.15, -0.07, 0.29, -0.07]),
    "strength": np.array([-0.01, -0.53, 1.08, -0.53]),
    "share": np.array([-2.46, 1.19, 0.08, 1.19]),
    "harmonics": np.array([0.25, 0.15, -0.55, 0.15]),
    "asymmetry": np.array([0.00, 6.85, 0.00, -6.85]),
    "lean": np.array([-1.47, 5.72, -9.97, 5.72]),
    "reversal": np.array([-0.92, 0.38, 0.15, 0.38]),
    "skewness": np.array([0.00, -0.82, 0.00, 0.82]),
    "sharpness": np.array([-0.57, 0.76, -0.95, 0.76]),
    "scatter": np.array([2.75, 0.93, -4.60, 0.93]),
}


def features(form: WaveformFeatures, oscillation: Oscillation) -> dict[str, float]:
    """Return the features from which the class is predicted, each within its `WAVEFORM_LIMITS`."""
    raw = {
        "prominence": np.log10(max(oscillation.prominence, 1e-9)),
        "significance": -np.log10(max(oscillation.false_alarm, 1e-99)),
        "strength": np.log10(max(oscillation.swing, 1e-99) / max(oscillation.noise, 1e-99)),
        "share": oscillation.share,
        "harmonics": oscillation.harmonic_content,
        "asymmetry": 0.5 - form.fall_share,
        "lean": abs(0.5 - form.fall_share),
        "reversal": -np.log10(max(form.asymmetry_p_value, 1e-99)),
        "skewness": form.derivative_skewness,
        "sharpness": abs(form.derivative_skewness),
        "scatter": form.period_scatter,
    }
    return {
        name: float(np.clip(raw[name], low, high)) if np.isfinite(raw[name]) else unknown
        for name, (unknown, low, high) in WAVEFORM_LIMITS.items()
    }


def class_probabilities(values: dict[str, float]) -> np.ndarray:
    """Return the probability of each of `CLASSES` from the features.

    Parameters
    ----------
    values
        From `features`.
    """
    score = _INTERCEPT + sum(_COEFFICIENTS[name] * value for name, value in values.items())
    weight = np.exp(score - score.max())
    return weight / weight.sum()


def oscillating(kind: np.ndarray) -> np.ndarray:
    """Return which classes of waveform are oscillations, as a mask.

    Examples
    --------
    >>> oscillating(np.array(["smooth sliding", "sawtooth stick-slip", "not decided"])).tolist()
    [False, True, False]
    """
    return np.isin(kind.astype(str), CLASSES[1:])


def most_probable(probability: np.ndarray) -> str:
    """Return the most probable class; "not decided" if smooth sliding is unlikely but possible.

    Examples
    --------
    >>> most_probable(np.array([0.1, 0.3, 0.6, 0.0]))
    'sinus-like oscillation'
    >>> most_probable(np.array([0.3, 0.7, 0.0, 0.0]))
    'not decided'
    """
    likely = int(np.argmax(probability))
    if probability[0] > limits.MAX_DOUBT.value:
        return CLASSES[0] if likely == 0 else NOT_CLEAR
    return CLASSES[1 + int(np.argmax(probability[1:]))]
