"""How far apart two clocks are, told from the signals: friction answers to motion, never before.

Several ways tell it, each with its own error:

classes
    how well classes of velocity explain the force (`clocks.classes`): robust, late;
starts
    when the force begins to change at each start of motion (`clocks.starts`), sharpened
    by the fast strokes' beginnings (`tribolab.reading.clocks.onset`);
motion
    one fit of the force by distance, speed and acceleration, with slack or a stick before the
    motion (`tribolab.reading.clocks.joint`).

What the ways cannot tell apart (a stick, slack) is in the uncertainty. Where they contradict one
another, none is sharp, or the motion repeats so that another shift fits as well, no shift is told.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribolab.arrays.medians import median
from tribolab.arrays.threads import one_thread
from tribolab.core.aliases import Array
from tribolab.reading.clocks import limits
from tribolab.reading.clocks.basis import Basis
from tribolab.reading.clocks.candidate_shifts import Candidate, candidates, likeliest
from tribolab.reading.clocks.classes import Classes, coarse_shift, motion_classes
from tribolab.reading.clocks.joint import told_by_motion
from tribolab.reading.clocks.motion import Motion, clean_motion
from tribolab.reading.clocks.onset import refine_by_onsets
from tribolab.reading.clocks.starts import (
    Logs,
    ToldByStarts,
    changes,
    shift_from_starts,
)

# N, m/s: what lies beyond is a damaged number, and its square would overflow
_MAX_POSSIBLE_VALUE = 1e12


class Told(NamedTuple):
    """What one way tells: shift in the middle of the motion log [s], standard deviation [s]."""

    shift: float
    uncertainty: float


class ShiftEstimate(NamedTuple):
    """Motion clock + shift = force clock [s] in the middle of the motion log, and how well known.

    Away from the middle, `rate` times the time since then on the motion clock is added.
    `explained` is the part of the force's variance that the classes of velocity explain, `ways`
    what each way tells, and `refused` why the shift cannot be relied on ("" if it can).
    """

    shift: float
    uncertainty: float
    explained: float
    rate: float = 0.0
    rate_uncertainty: float = limits.CLOCK_RATE_ERROR.value
    ways: dict[str, Told] = {}  # noqa: RUF012 - never changed
    refused: str = ""


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
        Shift [s] that is preferred where several explain the force equally well.
    dated
        Whether `expected` is known, from the dates in both logs.

    Returns
    -------
    ShiftEstimate or None
        None if the force does not vary with the motion. An estimate with `refused` is a guess.

    Notes
    -----
    The uncertainty is a standard deviation and holds the sampling of both logs, the noise, the
    clocks' rates as far as the starts leave them open (10 ppm if they tell nothing), and by how
    much the ways differ: friction that rises before the sample slides, or only after slack is
    taken up, moves the shift by what that lasts.
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
    if not len(basis.begins):  # it moves from the first sample to the last, or ends moving
        return None
    apart = limits.MIN_DISTANCE_OF_SHIFTS.value * basis.stroke
    coarse = coarse_shift(force_time, force, motion_time, classes, expected, apart)
    if coarse is None:
        return None
    fit = Classes(force_time, force, motion_time, classes)
    may = [Candidate(coarse.shift, np.nan, 0.0, 0)]
    # strokes of so different speeds do not repeat; a rest only looks like the stroke before
    wide = _wide(motion, way)
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
    # a drift is explained by any classes that follow one another, but no shift fits it sharply
    uncertainty = fit.uncertainty(shift)
    sharp = (
        limits.MAX_UNCERTAINTY_OF_SHIFT.value * float(np.ptp(motion_time)) / len(np.unique(classes))
    )
    placed = chosen.unexplained < limits.MAX_UNEXPLAINED_OF_PLACE.value
    weak = significance < limits.MIN_F_RATIO.value
    vague = uncertainty > sharp and not placed
    if vague and (weak or not wide):
        return None
    ways = {"classes": Told(shift, uncertainty)}
    # late by up to a rest, as the force stays on
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

    told = shift_from_starts(logs, shift, span, allowed)
    estimate = ShiftEstimate(shift, uncertainty, ratio)
    if told is not None:
        estimate = ShiftEstimate(told.shift, told.uncertainty, fit.ratio(told.shift), *told[2:])
    starts, onsets, agree = estimate, estimate, True
    if estimate.rate == 0.0:
        onsets = _sharpened(estimate, force_time, force, motion_time, motion.velocity, fit)
        # of two methods that agree, the sharper one is kept
        agree = (
            abs(onsets.shift - starts.shift)
            <= limits.MAX_ERRORS_OF_AGREEMENT.value * starts.uncertainty
        )
        vaguer = agree and onsets.uncertainty > starts.uncertainty
        estimate = starts if told is not None and vaguer else onsets
    # slack or a stick would delay the slow starts, which only the first of them sees, by more
    twice = wide and not weak and told is not None and onsets is not starts
    twice = twice and _alike(starts, onsets, basis.stroke)
    if vague and not twice:
        return None
    # starts that know so little were looked for at a wrong place
    if not twice and estimate.uncertainty > limits.MAX_ERROR_OF_STARTS.value * uncertainty:
        anew = ShiftEstimate(shift, uncertainty, ratio)
        anew = _sharpened(anew, force_time, force, motion_time, motion.velocity, fit)
        estimate = anew if anew.uncertainty < estimate.uncertainty else estimate
    if estimate.shift != shift:
        ways["starts"] = Told(estimate.shift, estimate.uncertainty)
    middle = 0.5 * (motion_time[0] + motion_time[-1])
    durations = np.diff(motion_time[changes(way)])
    stroke = float(median(durations[durations > 0.1 * durations.max()]))  # or rest
    ends = durations[[0, -1]]
    least = 5.0 * estimate.uncertainty
    near = min(span, max(least, min(0.4 * stroke, 0.8 * float(ends.min()))))
    if estimate.rate != 0.0:
        basis = Basis(motion_time + estimate.rate * (motion_time - middle), motion)
    joint = told_by_motion(force_time, force, basis, estimate.shift, near, least)
    if weak and (joint is None or joint.unexplained > limits.MAX_UNEXPLAINED_OF_AGREEMENT.value):
        return None
    if joint is not None:
        apart = limits.CLOCK_RATE_ERROR.value if estimate.rate == 0.0 else estimate.rate_uncertainty
        error = float(np.hypot(joint.uncertainty, apart * (joint.time - middle)))
        ways["motion"] = Told(joint.shift, error)
        if weak and not placed and abs(joint.shift - estimate.shift) > 0.5 * sharp:
            return None
        stroke = joint.stroke
    sharp_fit = (
        joint is not None and joint.uncertainty < limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
    )
    if sharp_fit and told is not None and not agree and _agree(told, ways["motion"]):
        estimate, ways["starts"] = starts, Told(*starts[:2])  # two methods contradict the onsets
    known = (
        "starts" in ways and estimate.uncertainty < limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
    )
    if twice and _contradicted(ways, stroke):
        other = onsets if estimate is starts else starts
        combined, part = _late(ways["starts"], Told(*other[:2])), limits.MIN_ERROR_OF_SHIFT.value
    elif wide and known and "motion" in ways and _agree(ways["starts"], ways["motion"]):
        combined, part = ways["starts"], limits.MIN_ERROR_OF_SHIFT.value
        if abs(combined.shift - ways["motion"].shift) > ways["motion"].uncertainty:
            combined = _late(combined, ways["motion"])
    elif sharp_fit:
        first = ways["classes"]
        if known:
            vague = (
                ways["motion"].uncertainty
                > limits.MAX_ERROR_OF_CONFIRMATION.value * ways["starts"].uncertainty
            )
            first = _late(ways["starts"], ways["classes"]) if vague else ways["starts"]
        combined, part = _combined(first, ways["motion"]), limits.ERROR_WITHOUT_FIT.value
    elif "starts" in ways and _confirmed(ways["starts"], ways["classes"], stroke):
        combined, part = _late(ways["starts"], ways["classes"]), limits.ERROR_WITHOUT_FIT.value
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
        return estimate._replace(refused=_doubt_of_moved(may, stroke))
    rivals = [rival for rival in may if rival is not chosen]
    doubt = _doubt(estimate, fit, coarse.half, stroke, chosen, rivals)
    return estimate._replace(refused=doubt)


def _doubt_of_moved(may: list[Candidate], stroke: float) -> str:
    """Say why the first of shifts, that starts moved far from what classes tell, may be wrong."""
    for rival in may[1:]:
        if rival.outdoes(may[0]) and abs(rival.shift - may[0].shift) > 0.5 * stroke:
            return (
                f"the slow strokes do not tell whether they are seen: {may[0].shift:.4g} s by the "
                f"starts, but {rival.shift:.4g} s explains more"
            )
    return ""


def _wide(motion: Motion, way: NDArray[np.int64]) -> bool:
    """Whether strokes differ so much in speed that what delays a slow start shows in the starts."""
    change = changes(way)[:-1]
    fastest = np.maximum.reduceat(np.abs(motion.velocity), change)[way[change] != 0]
    return bool(fastest.max() > limits.MAX_SPEED_RATIO.value * fastest.min())


def _alike(starts: ShiftEstimate, onsets: ShiftEstimate, stroke: float) -> bool:
    """Whether starts at all speeds and those of fast strokes of a duration [s] tell the same."""
    sharp = (
        max(starts.uncertainty, onsets.uncertainty) < limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
    )
    apart = abs(starts.shift - onsets.shift)
    return sharp and apart < max(
        limits.MAX_ERRORS_OF_AGREEMENT.value * starts.uncertainty,
        limits.MAX_DELAY_OF_CLASSES.value * stroke,
    )


def _contradicted(ways: dict[str, Told], stroke: float) -> bool:
    """Whether starts, which two methods found alike, rule out the fit by the motion.

    It is ruled out if it lies further away than errors of either allow, and than is left open by
    strokes of a duration [s]: what is nearer may be right.
    """
    starts, motion = ways["starts"], ways.get("motion")
    if motion is None or motion.uncertainty > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke:
        return True
    return abs(
        motion.shift - starts.shift
    ) > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke and not _agree(starts, motion)


def _agree(first: Told | ToldByStarts, second: Told) -> bool:
    """Whether two ways lie no further apart than their errors allow."""
    error = np.hypot(first.uncertainty, second.uncertainty)
    return bool(abs(first.shift - second.shift) <= limits.MAX_ERRORS_OF_AGREEMENT.value * error)


def _confirmed(starts: Told, classes: Told, stroke: float) -> bool:
    """Whether classes of speed confirm what the starts of strokes of a duration [s] tell."""
    return (
        _agree(starts, classes)
        or abs(starts.shift - classes.shift) < limits.MAX_DELAY_OF_CLASSES.value * stroke
    )


def _late(starts: Told, other: Told) -> Told:
    """Widen what starts tell by half of what lies between them and another way.

    Where friction takes its time to follow the speed, classes of speed are late, and the starts
    may be; where the stage sticks, a fit may be nearer to the truth.
    """
    apart = 0.5 * (starts.shift - other.shift)
    return starts._replace(uncertainty=float(np.hypot(starts.uncertainty, apart)))


def _refined(fit: Classes, shift: float, around: float) -> float:
    """Shift near a coarse one at which the classes explain most."""
    while around > 0.2 * fit.period:
        shifts = shift + around * np.linspace(-1.0, 1.0, 33)
        shift = float(shifts[np.argmax([fit.explained(s) for s in shifts])])
        around /= 8.0
    return shift


def _combined(first: Told, second: Told) -> Told:
    """Mean of two ways and its standard deviation, which holds how far they lie apart."""
    apart = second.shift - first.shift
    weights = np.array([1.0 / (told.uncertainty**2 + apart**2) for told in (first, second)])
    share = float(weights[1] / weights.sum())
    inner = (1.0 - share) * first.uncertainty + share * second.uncertainty
    error = np.sqrt(
        inner**2 + max(share * (1.0 - share), limits.MIN_SHARE_OF_DIFFERENCE.value) * apart**2
    )
    return Told(first.shift + share * apart, limits.ERROR_OF_METHODS.value * float(error))


def _doubt(
    estimate: ShiftEstimate,
    fit: Classes,
    half: float,
    stroke: float,
    chosen: Candidate,
    rivals: list[Candidate],
) -> str:
    """Why a shift cannot be relied on; empty if it can. Strokes last `stroke` [s]."""
    if (
        estimate.uncertainty > limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
        and "motion" in estimate.ways
    ):
        told = ", ".join(f"{name} {way.shift:.4g} s" for name, way in estimate.ways.items())
        return f"the ways to tell it disagree: {told}"
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
        # a fit that explains far less than the classes do says nothing against what they tell
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
    """Sharpen an estimate by the fast strokes' beginnings taken together."""
    onsets = refine_by_onsets(force_time, force, motion_time, velocity, estimate.shift, fit.period)
    if onsets is None:
        return estimate
    apart = abs(onsets.shift - estimate.shift)
    # known where the fast strokes are; the clocks' rates leave it open elsewhere
    middle = 0.5 * (motion_time[0] + motion_time[-1])
    error = float(
        np.hypot(onsets.uncertainty, limits.CLOCK_RATE_ERROR.value * (onsets.time - middle))
    )
    if apart > 3.0 * estimate.uncertainty:  # the two ways disagree, and neither can be trusted more
        error = max(error, apart)
    return ShiftEstimate(onsets.shift, error, fit.ratio(onsets.shift))
