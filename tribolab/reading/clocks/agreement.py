"""Estimates of a clock shift by several methods, their agreement and combination."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribolab.reading.clocks import limits
from tribolab.reading.clocks.starts import StartShift


class Estimate(NamedTuple):
    """Result of one method: shift in the middle of the motion log [s], standard deviation [s]."""

    shift: float
    uncertainty: float


class ShiftEstimate(NamedTuple):
    """Estimate: motion clock + shift = force clock [s] in the middle of the motion log.

    At other times, `rate` times the time since the middle (motion clock) is added. `explained` is
    the share of the variance of the force that velocity classes explain, `ways` the result of each
    method, and `refused` the reason why the shift is unreliable ("" if it is reliable).
    """

    shift: float
    uncertainty: float
    explained: float
    rate: float = 0.0
    rate_uncertainty: float = limits.CLOCK_RATE_ERROR.value
    ways: dict[str, Estimate] = {}  # noqa: RUF012 - never changed
    refused: str = ""


def starts_agree(starts: ShiftEstimate, onsets: ShiftEstimate, stroke: float) -> bool:
    """Whether the shifts from all starts and from fast strokes (lasting `stroke` s) agree."""
    sharp = (
        max(starts.uncertainty, onsets.uncertainty) < limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
    )
    apart = abs(starts.shift - onsets.shift)
    return sharp and apart < max(
        limits.MAX_ERRORS_OF_AGREEMENT.value * starts.uncertainty,
        limits.MAX_DELAY_OF_CLASSES.value * stroke,
    )


def contradicted(ways: dict[str, Estimate], stroke: float) -> bool:
    """Whether the fit by the motion is missing, imprecise, or contradicts the starts."""
    starts, motion = ways["starts"], ways.get("motion")
    if motion is None or motion.uncertainty > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke:
        return True
    return abs(
        motion.shift - starts.shift
    ) > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke and not consistent(starts, motion)


def consistent(first: Estimate | StartShift, second: Estimate) -> bool:
    """Whether two results agree within their errors."""
    error = np.hypot(first.uncertainty, second.uncertainty)
    return bool(abs(first.shift - second.shift) <= limits.MAX_ERRORS_OF_AGREEMENT.value * error)


def confirmed(starts: Estimate, classes: Estimate, stroke: float) -> bool:
    """Whether velocity classes confirm the shift from the starts; strokes last `stroke` [s]."""
    return (
        consistent(starts, classes)
        or abs(starts.shift - classes.shift) < limits.MAX_DELAY_OF_CLASSES.value * stroke
    )


def widened(starts: Estimate, other: Estimate) -> Estimate:
    """Increase the uncertainty of starts by half the difference from another method.

    If friction follows the speed slowly, velocity classes are late, and starts may be late. If the
    stage sticks, a fit may be closer to the truth.
    """
    apart = 0.5 * (starts.shift - other.shift)
    return starts._replace(uncertainty=float(np.hypot(starts.uncertainty, apart)))


def combine(first: Estimate, second: Estimate) -> Estimate:
    """Return the mean of two results; its standard deviation includes their difference."""
    apart = second.shift - first.shift
    weights = np.array([1.0 / (each.uncertainty**2 + apart**2) for each in (first, second)])
    share = float(weights[1] / weights.sum())
    inner = (1.0 - share) * first.uncertainty + share * second.uncertainty
    error = np.sqrt(
        inner**2 + max(share * (1.0 - share), limits.MIN_SHARE_OF_DIFFERENCE.value) * apart**2
    )
    return Estimate(first.shift + share * apart, limits.ERROR_OF_METHODS.value * float(error))
