"""Shift between two clocks, from signals: friction responds to motion and never precedes it.

Several methods determine it, each with its own error:

    classes
        explained variance of the force by classes of velocity (`clocks.classes`): robust, late;
    starts
        first change of the force at each start of motion (`clocks.starts`), refined
        by the starts of fast strokes (`tribolab.reading.clocks.onset`);
    motion
        one fit of the force by distance, speed and acceleration, with slack or sticking before
        the motion (`tribolab.reading.clocks.joint`).

Effects that no method can separate (sticking, slack) are in the uncertainty. The shift is refused
if methods contradict each other, none is precise, or repeated motion fits equally at another shift.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.arrays.threads import one_thread
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.agreement import (
    Estimate,
    ShiftEstimate,
    combine,
    confirmed,
    consistent,
    contradicted,
    starts_agree,
    widened,
)
from tribolab.reading.clocks.basis import Basis
from tribolab.reading.clocks.candidate_shifts import Candidate, candidates, likeliest
from tribolab.reading.clocks.classes import Classes, coarse_shift, motion_classes
from tribolab.reading.clocks.joint import shift_from_motion
from tribolab.reading.clocks.motion import Motion, clean_motion
from tribolab.reading.clocks.onset import refine_by_onsets
from tribolab.reading.clocks.starts import (
    Logs,
    changes,
    shift_from_starts,
)

# N, m/s: larger values are damaged, and their squares would overflow
_MAX_POSSIBLE_VALUE = 1e12


def estimate_clock_shift(
    force_time: Array,
    force: Array,
    motion_time: Array,
    velocity: Array,
    expected: float = 0.0,
    dated: bool = False,
) -> ShiftEstimate | None:
    """Estimate the shift between the clocks of a force log and a motion log.

    Parameters
    ----------
    force_time, force
        Force log: its own clock [s] and the friction force [N].
    motion_time, velocity
        Motion log: its own clock [s] and the signed velocity [m/s].
    expected
        Shift [s] that is preferred if several explain the force equally well.
    dated
        Whether `expected` is known, from the dates in both logs.

    Returns
    -------
    ShiftEstimate or None
        None if the force does not vary with the motion. An estimate with `refused` is a guess.

    Notes
    -----
    The uncertainty is a standard deviation. It includes the sampling of both logs, the noise, the
    uncertain ratio of the clock rates (10 ppm if the starts do not determine it), and the
    difference between methods: friction that rises before the sample slides, or only after slack is
    taken up, shifts the result by that duration.
    """
    with one_thread():
        return _estimated(force_time, force, motion_time, velocity, expected, dated)


def _estimated(
    force_time: Array,
    force: Array,
    motion_time: Array,
    velocity: Array,
    expected: float,
    dated: bool,
) -> ShiftEstimate | None:
    good = np.abs(force) < _MAX_POSSIBLE_VALUE
    force_time, force = force_time[good], force[good]
    velocity = np.where(np.abs(velocity) < _MAX_POSSIBLE_VALUE, velocity, 0.0)
    if len(force_time) < 16 or len(motion_time) < 16 or np.ptp(force) == 0:
        return None
    motion = clean_motion(motion_time, velocity)
    if not motion.velocity.any():
        return None
    classes, way = motion_classes(motion.velocity)
    if classes.min() == classes.max():
        return None
    force = (force - force.mean()) / force.std()
    basis = Basis(motion_time, motion)
    if not len(basis.begins):  # moving from the first to the last sample
        return None
    apart = limits.MIN_DISTANCE_OF_SHIFTS.value * basis.stroke
    coarse = coarse_shift(force_time, force, motion_time, classes, expected, apart)
    if coarse is None:
        return None
    fit = Classes(force_time, force, motion_time, classes)
    may = [Candidate(coarse.shift, np.nan, 0.0, 0)]
    # strokes of very different speeds are not interchangeable
    wide = _has_different_speeds(motion, way)
    if len(coarse.rivals) and not wide:
        shifts = np.concatenate([[coarse.shift], coarse.rivals])
        if dated and abs(coarse.shift - expected) < limits.MAX_ERROR_OF_DATES.value:
            shifts = shifts[np.abs(shifts - expected) < limits.MAX_ERROR_OF_DATES.value]
        may = candidates(force_time, force, basis, shifts)
    chosen = likeliest(may)
    shift = _refined(fit, chosen.shift, coarse.half)
    significance = fit.significance(shift)
    if significance < limits.MIN_F_RATIO_WITH_FIT.value:
        return None
    # any sequence of classes explains a drift, but no shift fits it precisely
    uncertainty = fit.uncertainty(shift)
    sharp = (
        limits.MAX_UNCERTAINTY_OF_SHIFT.value * float(np.ptp(motion_time)) / len(np.unique(classes))
    )
    placed = chosen.unexplained < limits.MAX_UNEXPLAINED_OF_PLACE.value
    weak = significance < limits.MIN_F_RATIO.value
    vague = uncertainty > sharp and not placed
    if vague and (weak or not wide):
        return None
    ways = {"classes": Estimate(shift, uncertainty)}
    # friction remains at rest, so the shift may be late by up to a rest
    span = max(8.0 * coarse.half, 1.25 * float(median(np.diff(motion_time[changes(way)]))))
    logs = Logs(force_time, force, motion_time, motion.velocity, way)
    ratio = fit.ratio(shift)
    unexplained = min(
        limits.MAX_MISFIT_OF_STARTS.value * (1.0 - ratio) + limits.ROUNDING_OF_VARIANCE.value,
        1.0 - limits.MIN_EXPLAINED_OF_STARTS.value * ratio,
    )
    reach = 0.5 * basis.stroke if placed else np.inf

    def allowed(at: Array) -> NDArray[np.bool_]:
        return (np.abs(at - shift) <= reach) & (1.0 - fit.ratios(at) < unexplained)

    seen = shift_from_starts(logs, shift, span, allowed)
    estimate = ShiftEstimate(shift, uncertainty, ratio)
    if seen is not None:
        estimate = ShiftEstimate(seen.shift, seen.uncertainty, fit.ratio(seen.shift), *seen[2:])
    starts, onsets, agree = estimate, estimate, True
    if estimate.rate == 0.0:
        onsets = _sharpened(estimate, force_time, force, motion_time, motion.velocity, fit)
        # of two consistent methods, the more precise one is kept
        agree = (
            abs(onsets.shift - starts.shift)
            <= limits.MAX_ERRORS_OF_AGREEMENT.value * starts.uncertainty
        )
        vaguer = agree and onsets.uncertainty > starts.uncertainty
        estimate = starts if seen is not None and vaguer else onsets
    # slack or sticking would delay slow starts more, which only the first method uses
    twice = wide and not weak and seen is not None and onsets is not starts
    twice = twice and starts_agree(starts, onsets, basis.stroke)
    if vague and not twice:
        return None
    # starts with a large error were searched at a wrong position
    if not twice and estimate.uncertainty > limits.MAX_ERROR_OF_STARTS.value * uncertainty:
        repeated = ShiftEstimate(shift, uncertainty, ratio)
        repeated = _sharpened(repeated, force_time, force, motion_time, motion.velocity, fit)
        estimate = repeated if repeated.uncertainty < estimate.uncertainty else estimate
    if estimate.shift != shift:
        ways["starts"] = Estimate(estimate.shift, estimate.uncertainty)
    middle = 0.5 * (motion_time[0] + motion_time[-1])
    durations = np.diff(motion_time[changes(way)])
    stroke = float(median(durations[durations > 0.1 * durations.max()]))  # or rest
    ends = durations[[0, -1]]
    least = 5.0 * estimate.uncertainty
    near = min(span, max(least, min(0.4 * stroke, 0.8 * float(ends.min()))))
    if estimate.rate != 0.0:
        basis = Basis(motion_time + estimate.rate * (motion_time - middle), motion)
    joint = shift_from_motion(force_time, force, basis, estimate.shift, near, least)
    if weak and (joint is None or joint.unexplained > limits.MAX_UNEXPLAINED_OF_AGREEMENT.value):
        return None
    if joint is not None:
        apart = limits.CLOCK_RATE_ERROR.value if estimate.rate == 0.0 else estimate.rate_uncertainty
        error = float(np.hypot(joint.uncertainty, apart * (joint.time - middle)))
        ways["motion"] = Estimate(joint.shift, error)
        if weak and not placed and abs(joint.shift - estimate.shift) > 0.5 * sharp:
            return None
        stroke = joint.stroke
    sharp_fit = (
        joint is not None and joint.uncertainty < limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
    )
    if sharp_fit and seen is not None and not agree and consistent(seen, ways["motion"]):
        estimate, ways["starts"] = (
            starts,
            Estimate(*starts[:2]),
        )  # two methods contradict the onsets
    known = (
        "starts" in ways and estimate.uncertainty < limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
    )
    if twice and contradicted(ways, stroke):
        other = onsets if estimate is starts else starts
        combined, part = (
            widened(ways["starts"], Estimate(*other[:2])),
            limits.MIN_ERROR_OF_SHIFT.value,
        )
    elif wide and known and "motion" in ways and consistent(ways["starts"], ways["motion"]):
        combined, part = ways["starts"], limits.MIN_ERROR_OF_SHIFT.value
        if abs(combined.shift - ways["motion"].shift) > ways["motion"].uncertainty:
            combined = widened(combined, ways["motion"])
    elif sharp_fit:
        first = ways["classes"]
        if known:
            vague = (
                ways["motion"].uncertainty
                > limits.MAX_ERROR_OF_CONFIRMATION.value * ways["starts"].uncertainty
            )
            first = widened(ways["starts"], ways["classes"]) if vague else ways["starts"]
        combined, part = combine(first, ways["motion"]), limits.ERROR_WITHOUT_FIT.value
    elif "starts" in ways and confirmed(ways["starts"], ways["classes"], stroke):
        combined, part = widened(ways["starts"], ways["classes"]), limits.ERROR_WITHOUT_FIT.value
    else:
        return estimate._replace(ways=ways, refused="no two ways tell it")
    error = float(np.hypot(combined.uncertainty, part * stroke))
    estimate = estimate._replace(shift=combined.shift, uncertainty=error, ways=ways)
    estimate = estimate._replace(explained=fit.ratio(combined.shift))
    if (
        wide
        and not twice
        and abs(estimate.shift - shift) > limits.MAX_DISTANCE_TO_CLASSES.value * stroke
    ):
        may = candidates(force_time, force, basis, np.array([estimate.shift, *coarse.rivals]))
        return estimate._replace(refused=_doubt_about_starts(may, stroke))
    rivals = [rival for rival in may if rival is not chosen]
    doubt = _doubt(estimate, fit, coarse.half, stroke, chosen, rivals)
    return estimate._replace(refused=doubt)


def _doubt_about_starts(may: list[Candidate], stroke: float) -> str:
    """Return why a shift moved far from the velocity classes by the starts may be wrong."""
    for rival in may[1:]:
        if rival.outdoes(may[0]) and abs(rival.shift - may[0].shift) > 0.5 * stroke:
            return (
                f"the slow strokes do not tell whether they are seen: {may[0].shift:.4g} s by the "
                f"starts, but {rival.shift:.4g} s explains more"
            )
    return ""


def _has_different_speeds(motion: Motion, way: NDArray[np.int64]) -> bool:
    """Whether strokes differ enough in speed that delays of slow starts are visible."""
    change = changes(way)[:-1]
    fastest = np.maximum.reduceat(np.abs(motion.velocity), change)[way[change] != 0]
    return bool(fastest.max() > limits.MAX_SPEED_RATIO.value * fastest.min())


def _refined(fit: Classes, shift: float, around: float) -> float:
    """Return the shift near a coarse one at which the classes explain most."""
    while around > 0.2 * fit.period:
        shifts = shift + around * np.linspace(-1.0, 1.0, 33)
        shift = float(shifts[np.argmax([fit.explained(s) for s in shifts])])
        around /= 8.0
    return shift


def _doubt(
    estimate: ShiftEstimate,
    fit: Classes,
    half: float,
    stroke: float,
    chosen: Candidate,
    rivals: list[Candidate],
) -> str:
    """Return why a shift is unreliable, "" if it is not; strokes last `stroke` [s]."""
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
        at = _refined(fit, rival.shift, half)
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


def _sharpened(
    estimate: ShiftEstimate,
    force_time: Array,
    force: Array,
    motion_time: Array,
    velocity: Array,
    fit: Classes,
) -> ShiftEstimate:
    """Refine an estimate by the starts of all fast strokes."""
    onsets = refine_by_onsets(force_time, force, motion_time, velocity, estimate.shift, fit.period)
    if onsets is None:
        return estimate
    apart = abs(onsets.shift - estimate.shift)
    # the shift is known at the fast strokes; elsewhere the clock rates add uncertainty
    middle = 0.5 * (motion_time[0] + motion_time[-1])
    error = float(
        np.hypot(onsets.uncertainty, limits.CLOCK_RATE_ERROR.value * (onsets.time - middle))
    )
    if apart > 3.0 * estimate.uncertainty:  # the methods disagree: neither is trusted more
        error = max(error, apart)
    return ShiftEstimate(onsets.shift, error, fit.ratio(onsets.shift))
