"""Reasons why an estimated clock shift may be wrong, in words."""

from __future__ import annotations

import numpy as np

from tribolab.reading.clocks import limits
from tribolab.reading.clocks.agreement import ShiftEstimate
from tribolab.reading.clocks.candidate_shifts import Candidate
from tribolab.reading.clocks.classes import Classes


def doubt_about_starts(may: list[Candidate], stroke: float) -> str:
    """Return why the starts may give a wrong shift (far from the velocity classes), else ""."""
    for rival in may[1:]:
        if rival.outdoes(may[0]) and abs(rival.shift - may[0].shift) > 0.5 * stroke:
            return (
                f"the slow strokes do not tell whether they are seen: {may[0].shift:.4g} s by the "
                f"starts, but {rival.shift:.4g} s explains more"
            )
    return ""


def doubt_about_shift(
    estimate: ShiftEstimate,
    fit: Classes,
    half: float,
    stroke: float,
    chosen: Candidate,
    rivals: list[Candidate],
) -> str:
    """Return why a shift is unreliable, else ""; `stroke` is the duration of a stroke [s]."""
    if (
        estimate.uncertainty > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
        and "motion" in estimate.ways
    ):
        text = ", ".join(f"{name} {way.shift:.4g} s" for name, way in estimate.ways.items())
        return f"the ways to tell it disagree: {text}"
    if estimate.uncertainty > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke:
        return f"no way tells it sharply: {estimate.shift:.4g} s to {estimate.uncertainty:.2g} s"
    left = (
        limits.MAX_MISFIT_OF_RIVAL.value * (1.0 - estimate.explained)
        + limits.ROUNDING_OF_VARIANCE.value
    )
    for rival in rivals:
        if chosen.clears(rival):
            continue
        at = fit.refined(rival.shift, half)
        ratio = fit.ratio(at)
        as_good = (
            1.0 - ratio < left and ratio > limits.MIN_EXPLAINED_OF_RIVAL.value * estimate.explained
        )
        # a fit that explains far less than the classes does not contradict them
        fitted = (
            chosen.unexplained
            < limits.MAX_MISFIT_OF_FIT.value * (1.0 - estimate.explained)
            + limits.ROUNDING_OF_VARIANCE.value
        )
        fitted &= not np.isnan(rival.unexplained)
        as_good |= fitted and not chosen.surpasses(rival)
        if abs(at - estimate.shift) > 0.5 * stroke and as_good:
            return f"the motion repeats: {estimate.shift:.4g} s and {at:.4g} s do equally well"
    return ""
