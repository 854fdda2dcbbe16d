"""Shift between two clocks, from signals: friction responds to motion and never precedes it.

Several methods determine it, each with its own error:

    classes
        explained variance of the force by classes of velocity (`clocks.classes`): robust, but late;
    starts
        first change of the force at each start of motion (`clocks.starts`), refined
        by the starts of fast strokes (`tribolab.reading.clocks.onset`);
    motion
        one fit of the force by distance, speed and acceleration, with slack or sticking before
        the motion (`tribolab.reading.clocks.joint`): slow, so it is skipped if the starts of all
        strokes and those of the fast ones agree within one standard error.

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
from tribolab.reading.clocks.doubts import doubt_about_shift, doubt_about_starts
from tribolab.reading.clocks.joint import shift_from_motion
from tribolab.reading.clocks.motion import Motion, clean_motion
from tribolab.reading.clocks.onset import refine_by_onsets
from tribolab.reading.clocks.starts import Logs, StartShift, changes, shift_from_starts

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
        Whether `expected` was computed from the dates in both logs.

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
    try:
        with one_thread():
            search = _Search(force_time, force, motion_time, velocity)
            search.search_by_classes(expected, dated)
            search.search_by_starts()
            if not search.settled:
                search.search_by_motion()
            return search.combined()
    except _UndeterminedError:
        return None


class _UndeterminedError(Exception):
    """Raised if the force does not vary with the motion."""


class _Search:
    """Search for the shift: each method refines the last result and adds its own to `ways`."""

    def __init__(self, force_time: Array, force: Array, motion_time: Array, velocity: Array):
        good = np.abs(force) < _MAX_POSSIBLE_VALUE
        self.force_time, force = force_time[good], force[good]
        velocity = np.where(np.abs(velocity) < _MAX_POSSIBLE_VALUE, velocity, 0.0)
        _require(len(self.force_time) >= 16 and len(motion_time) >= 16 and np.ptp(force) != 0)
        self.motion_time, self.motion = motion_time, clean_motion(motion_time, velocity)
        _require(self.motion.velocity.any())
        self.classes, self.way = motion_classes(self.motion.velocity)
        _require(self.classes.min() != self.classes.max())
        self.force = (force - force.mean()) / force.std()
        self.basis = Basis(motion_time, self.motion)
        _require(len(self.basis.begins))  # without a start, the stage moves all the time
        self.fit = Classes(self.force_time, self.force, motion_time, self.classes)
        # strokes of very different speeds are not interchangeable
        self.wide = _has_different_speeds(self.motion, self.way)
        self.stroke, self.sharp_fit = self.basis.stroke, False
        self.ways: dict[str, Estimate] = {}

    def search_by_classes(self, expected: float, dated: bool) -> None:
        """Find the likeliest shift by velocity classes."""
        apart = limits.MIN_DISTANCE_OF_SHIFTS.value * self.basis.stroke
        coarse = coarse_shift(
            self.force_time, self.force, self.motion_time, self.classes, expected, apart
        )
        if coarse is None:
            raise _UndeterminedError
        self.coarse, self.may = coarse, [Candidate(coarse.shift, np.nan, 0.0, 0)]
        if len(coarse.rivals) and not self.wide:
            shifts = np.concatenate([[coarse.shift], coarse.rivals])
            if dated and abs(coarse.shift - expected) < limits.MAX_ERROR_OF_DATES.value:
                shifts = shifts[np.abs(shifts - expected) < limits.MAX_ERROR_OF_DATES.value]
            self.may = candidates(self.force_time, self.force, self.basis, shifts)
        self.chosen = likeliest(self.may)
        shift = self.fit.refined(self.chosen.shift, coarse.half)
        significance = self.fit.significance(shift)
        _require(significance >= limits.MIN_F_RATIO_WITH_FIT.value)
        # classes can also explain a drift of the force, but then the shift is imprecise
        self.first = Estimate(shift, self.fit.uncertainty(shift))
        duration = float(np.ptp(self.motion_time)) / len(np.unique(self.classes))
        self.sharp = limits.MAX_UNCERTAINTY_OF_SHIFT.value * duration
        self.placed = self.chosen.unexplained < limits.MAX_UNEXPLAINED_OF_PLACE.value
        self.weak = significance < limits.MIN_F_RATIO.value
        self.vague = self.first.uncertainty > self.sharp and not self.placed
        _require(not self.vague or (self.wide and not self.weak))
        self.ways["classes"] = self.first

    def search_by_starts(self) -> None:
        """Refine the shift by the starts of motion: of all speeds, and of fast strokes."""
        shift, uncertainty = self.first
        # friction persists at rest, so the shift may be late by up to one rest
        durations = np.diff(self.motion_time[changes(self.way)])
        self.span = max(8.0 * self.coarse.half, 1.25 * float(median(durations)))
        ratio = self.fit.ratio(shift)
        self.seen = self._seen_starts(ratio)
        estimate = ShiftEstimate(shift, uncertainty, ratio)
        if self.seen is not None:
            explained = self.fit.ratio(self.seen.shift)
            estimate = ShiftEstimate(*self.seen[:2], explained, *self.seen[2:])
        self.starts, self.onsets, self.agree = estimate, estimate, True
        if estimate.rate == 0.0:
            self.onsets = self._by_onsets(estimate)
            # if both methods agree, the more precise result is kept
            apart = abs(self.onsets.shift - estimate.shift)
            self.agree = apart <= limits.MAX_ERRORS_OF_AGREEMENT.value * estimate.uncertainty
            vaguer = self.agree and self.onsets.uncertainty > estimate.uncertainty
            estimate = estimate if self.seen is not None and vaguer else self.onsets
        # only the first method uses slow starts, which slack or sticking would delay more
        twice = self.wide and not self.weak and self.seen is not None
        twice = twice and self.onsets is not self.starts
        self.twice = twice and starts_agree(self.starts, self.onsets, self.basis.stroke)
        apart = abs(self.onsets.shift - self.starts.shift)
        self.settled = self.twice and apart <= self.starts.uncertainty
        _require(not self.vague or self.twice)
        # a large error suggests a search around a wrong shift, so the starts are searched again
        if not self.twice and estimate.uncertainty > limits.MAX_ERROR_OF_STARTS.value * uncertainty:
            repeated = self._by_onsets(ShiftEstimate(shift, uncertainty, ratio))
            estimate = repeated if repeated.uncertainty < estimate.uncertainty else estimate
        if estimate.shift != shift:
            self.ways["starts"] = Estimate(estimate.shift, estimate.uncertainty)
        self.estimate = estimate

    def _seen_starts(self, ratio: float) -> StartShift | None:
        """Return the shift by all starts, among shifts at which classes explain the force well."""
        unexplained = min(
            limits.MAX_MISFIT_OF_STARTS.value * (1.0 - ratio) + limits.ROUNDING_OF_VARIANCE.value,
            1.0 - limits.MIN_EXPLAINED_OF_STARTS.value * ratio,
        )
        reach = 0.5 * self.basis.stroke if self.placed else np.inf

        def allowed(at: Array) -> NDArray[np.bool_]:
            near = np.abs(at - self.first.shift) <= reach
            return near & (1.0 - self.fit.ratios(at) < unexplained)

        velocity = self.motion.velocity
        logs = Logs(self.force_time, self.force, self.motion_time, velocity, self.way)
        return shift_from_starts(logs, self.first.shift, self.span, allowed)

    def _by_onsets(self, estimate: ShiftEstimate) -> ShiftEstimate:
        """Refine an estimate by the starts of all fast strokes."""
        velocity, fit = self.motion.velocity, self.fit
        onsets = refine_by_onsets(
            self.force_time, self.force, self.motion_time, velocity, estimate.shift, fit.period
        )
        if onsets is None:
            return estimate
        apart = abs(onsets.shift - estimate.shift)
        # measured at the fast strokes; until the middle of the log the clock rate adds uncertainty
        away = limits.CLOCK_RATE_ERROR.value * (onsets.time - self.middle)
        error = float(np.hypot(onsets.uncertainty, away))
        if apart > 3.0 * estimate.uncertainty:  # the methods disagree: neither is trusted more
            error = max(error, apart)
        return ShiftEstimate(onsets.shift, error, fit.ratio(onsets.shift))

    @property
    def middle(self) -> float:
        """Middle of the motion log [s], on its own clock."""
        return float(0.5 * (self.motion_time[0] + self.motion_time[-1]))

    def search_by_motion(self) -> None:
        """Fit the force with all effects of motion, close to the shift found from the starts."""
        estimate = self.estimate
        durations = np.diff(self.motion_time[changes(self.way)])
        self.stroke = float(median(durations[durations > 0.1 * durations.max()]))  # including rests
        least = 5.0 * estimate.uncertainty
        inside = min(0.4 * self.stroke, 0.8 * float(durations[[0, -1]].min()))
        near = min(self.span, max(least, inside))
        if estimate.rate != 0.0:
            drift = estimate.rate * (self.motion_time - self.middle)
            self.basis = Basis(self.motion_time + drift, self.motion)
        joint = shift_from_motion(
            self.force_time, self.force, self.basis, estimate.shift, near, least
        )
        agrees = limits.MAX_UNEXPLAINED_OF_AGREEMENT.value
        _require(not self.weak or (joint is not None and joint.unexplained <= agrees))
        if joint is None:
            return
        rate = estimate.rate_uncertainty if estimate.rate else limits.CLOCK_RATE_ERROR.value
        error = float(np.hypot(joint.uncertainty, rate * (joint.time - self.middle)))
        self.ways["motion"] = Estimate(joint.shift, error)
        apart = abs(joint.shift - estimate.shift)
        _require(not self.weak or self.placed or apart <= 0.5 * self.sharp)
        self.stroke = joint.stroke
        self.sharp_fit = joint.uncertainty < limits.MAX_UNCERTAINTY_OF_SHIFT.value * self.stroke
        # the starts at all speeds and the fit contradict the onsets of fast strokes
        if (
            self.sharp_fit
            and self.seen
            and not self.agree
            and consistent(self.seen, self.ways["motion"])
        ):
            self.estimate, self.ways["starts"] = self.starts, Estimate(*self.starts[:2])

    def combined(self) -> ShiftEstimate:
        """Return the shift by all methods, with the reason if it is refused."""
        found = self._two_methods()
        if found is None:
            return self.estimate._replace(ways=self.ways, refused="no two ways tell it")
        combined, part = found
        estimate = self.estimate._replace(
            shift=combined.shift,
            uncertainty=float(np.hypot(combined.uncertainty, part * self.stroke)),
            explained=self.fit.ratio(combined.shift),
            ways=self.ways,
        )
        moved = abs(estimate.shift - self.first.shift)
        far = moved > limits.MAX_DISTANCE_TO_CLASSES.value * self.stroke
        if self.wide and not self.twice and far:
            shifts = np.array([estimate.shift, *self.coarse.rivals])
            may = candidates(self.force_time, self.force, self.basis, shifts)
            return estimate._replace(refused=doubt_about_starts(may, self.stroke))
        rivals = [rival for rival in self.may if rival is not self.chosen]
        doubt = doubt_about_shift(
            estimate, self.fit, self.coarse.half, self.stroke, self.chosen, rivals
        )
        return estimate._replace(refused=doubt)

    def _two_methods(self) -> tuple[Estimate, float] | None:
        """Return a shift that two methods support, and its least error in stroke durations."""
        ways, stroke = self.ways, self.stroke
        starts, motion, classes = ways.get("starts"), ways.get("motion"), self.first
        sharp = limits.MAX_UNCERTAINTY_OF_SHIFT.value * stroke
        known = starts is not None and self.estimate.uncertainty < sharp
        if self.twice and contradicted(ways, stroke):
            other = self.onsets if self.estimate is self.starts else self.starts
            either = widened(ways["starts"], Estimate(*other[:2]))
            return either, limits.MIN_ERROR_OF_SHIFT.value
        if self.wide and known and starts and motion and consistent(starts, motion):
            if abs(starts.shift - motion.shift) > motion.uncertainty:
                starts = widened(starts, motion)
            return starts, limits.MIN_ERROR_OF_SHIFT.value
        if self.sharp_fit and motion:
            first = classes
            if known and starts:
                least = limits.MAX_ERROR_OF_CONFIRMATION.value * starts.uncertainty
                first = widened(starts, classes) if motion.uncertainty > least else starts
            return combine(first, motion), limits.ERROR_WITHOUT_FIT.value
        if starts and confirmed(starts, classes, stroke):
            return widened(starts, classes), limits.ERROR_WITHOUT_FIT.value
        return None


def _require(condition: object) -> None:
    """Raise if a condition for determining the shift is not met."""
    if not condition:
        raise _UndeterminedError


def _has_different_speeds(motion: Motion, way: NDArray[np.int64]) -> bool:
    """Whether strokes differ enough in speed that delays of slow starts are visible."""
    change = changes(way)[:-1]
    fastest = np.maximum.reduceat(np.abs(motion.velocity), change)[way[change] != 0]
    return bool(fastest.max() > limits.MAX_SPEED_RATIO.value * fastest.min())
