"""Checks on strokes: number, speed, sliding distance and sampling."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.core.errors import AnalysisError
from tribolab.core.limit import Limit
from tribolab.core.wording import Count, duration
from tribolab.friction.coefficient import steadiness
from tribolab.friction.oscillation.limits import BAND_BY_CHANCE
from tribolab.friction.oscillation.periods import AT_ODDS
from tribolab.friction.segments.strokes import find_strokes
from tribolab.qc.register import Check, Result
from tribolab.qc.run.subject import RunSubject

_NOT_CONSTANT = ("at rest", "ramp", "too short")

_CURE_OF_UNKNOWN_STROKES = (
    'Say stroke and frequency in the dialect ([speed] source = "stroke"), or record the position.'
)

_CURE_OF_OTHER_STROKES = (
    "Check that the frequency is right. If it changes within the run, state it for each step: as a "
    "column, or as values with the source step or programme in the dialect."
)

_STRENGTH = Limit(
    0.03, "1", "a weaker oscillation changes a mean over four periods by at most 0.3 %"
)


def find_lost_strokes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report strokes in which the position changes but no segment was found."""
    segments = subject.segments
    about = subject.segment_about
    if about.velocity_source != "position" or about.stroke_middle > 0:
        return []
    try:
        strokes = find_strokes(subject.run)
    except AnalysisError:
        return []
    number = strokes.number
    middle = np.flatnonzero((number >= 0) & (np.abs(strokes.place - 0.5) < 0.25))
    when, own = subject.time[middle], number[middle]
    slides = np.isin(segments["omitted_reason"].values.astype(str), _NOT_CONSTANT)
    start = np.sort(segments["omitted_start"].values[slides])
    stop = np.sort(segments["omitted_stop"].values[slides])
    omitted = np.searchsorted(start, when, side="right") > np.searchsorted(stop, when, side="left")
    kept = np.bincount(own[~omitted], minlength=strokes.way.size) > 0
    lost = strokes.usual & ~kept
    share = float(lost.sum() / max(strokes.usual.sum(), 1))
    if share <= limits["lost_strokes"]:
        return []
    first = int(np.flatnonzero(lost)[0])
    where = f"first at t = {subject.time[strokes.first[first]]:.6g} s"
    text = (
        f"{lost.sum()} of {Count(strokes.usual.sum()):stroke|strokes} have no segment of constant "
        f"speed, {where}; they are not part of the mean"
    )
    return [Result("suspect", "position", text, share, "1", where, int(lost.sum()))]


def _segment_speed(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    # steps of a rheometer have a shear rate instead of a speed
    unknown = np.isnan(subject.friction["sliding_speed"].values)
    if unlike := subject.about.strokes_unlike_s:
        often = subject.run.attrs["stroke_frequency_Hz"]
        text = (
            f"friction reverses at the stated {often:.3g} Hz during only part of the run; the "
            f"other {duration(unlike)} count as rest"
        )
        return [Result("fail", subject.required_friction_signal, text, cure=_CURE_OF_OTHER_STROKES)]
    if not unknown.any():
        known = Result("pass", "sliding_speed", "the speed of every segment is known")
        return _reciprocating(subject) or [known]
    text = (
        f"the speed of {int(unknown.sum())} of {Count(unknown.size):segment|segments} is unknown: "
        "they may include start, stop and rest"
    )
    where, count = subject.segment_label(int(np.argmax(unknown))), int(unknown.sum())
    unknown_speed = Result("suspect", "sliding_speed", text, where=where, count=count)
    return [unknown_speed, *_reciprocating(subject)]


def _reciprocating(subject: RunSubject) -> list[Result]:
    """Report segments of unknown direction in which the friction force reverses repeatedly."""
    turned = subject.reversals
    if not turned.any():
        return []
    first, count = int(np.flatnonzero(turned)[0]), int((turned > 0).sum())
    text = (
        f"friction changes its sign {int(turned.max())} times while the direction of sliding is "
        "unknown: this looks like reciprocating motion, and the mean over both directions is not "
        "a friction coefficient"
    )
    if often := subject.run.attrs.get("strokes_not_seen_Hz"):
        text += f"; it does not reverse at the stated {often:.4g} Hz"
    where, cure = subject.segment_label(first), _CURE_OF_UNKNOWN_STROKES
    return [
        Result("fail", subject.required_friction_signal, text, where=where, count=count, cure=cure)
    ]


def _distance(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    distance = subject.segments["sliding_distance"].values
    if not np.isfinite(subject.contact_width):
        text = "the contact width is not known (a campaign knows it from [contact])"
        results.append(Result("skipped", "sliding_distance", text))
    elif np.isfinite(distance).any():
        share = distance / subject.contact_width
        shortest = int(np.nanargmin(share))
        text = f"the shortest sliding distance is {share[shortest]:.3g} contact widths"
        status = "pass" if share[shortest] >= limits["contact_widths"] else "suspect"
        where, value = subject.segment_label(shortest), float(share[shortest])
        results.append(Result(status, "sliding_distance", text, value, "1", where))
    if subject.friction_signal is None:
        return results
    periods = subject.strong_periods(limits["strength"])
    if np.isfinite(periods).any():
        fewest = int(np.nanargmin(periods))
        text = f"one segment has only {periods[fewest]:.3g} stick-slip periods"
        status = "pass" if periods[fewest] >= limits["periods"] else "suspect"
        where, value = subject.segment_label(fewest), float(periods[fewest])
        results.append(Result(status, subject.friction_signal, text, value, "1", where))
    return [*results, *_unequal_periods(subject, limits)]


def _unequal_periods(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report oscillating segments in which drops and spectrum disagree on the period."""
    slip = subject.slip
    odd = np.array([AT_ODDS in str(remark) for remark in slip["remark"].values], bool)
    # the chance of a false alarm is limited for all segments together
    odd &= slip["false_alarm_probability"].values < BAND_BY_CHANCE.value / odd.size
    if odd.any():
        odd &= subject.friction["steady"].values == steadiness.IS_STEADY
        odd &= subject.oscillates_strongly(limits["strength"])
    if not odd.any():
        return []
    first, count = int(np.flatnonzero(odd)[0]), int(odd.sum())
    where = subject.segment_label(first)
    slip_remark = str(slip["remark"].values[first])
    text = (
        f"the period of stick-slip is not determined in {Count(count):segment|segments}: in "
        f"{where}, {slip_remark[slip_remark.index(AT_ODDS) :]}"
    )
    cure = (
        "Slide further at this speed, or check in the figure of the strokes which of the two is "
        "right."
    )
    signal = subject.friction_signal or ""
    return [Result("suspect", signal, text, where=where, count=count, cure=cure)]


def _sampling(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    periods = subject.strong_periods(limits["strength"])
    if not np.isfinite(periods).any():
        return [Result("pass", subject.required_friction_signal, "no stick-slip to resolve")]
    per_period = subject.segments["samples"].values / periods
    worst = int(np.nanargmin(per_period))
    text = f"the fastest stick-slip has {per_period[worst]:.3g} samples per period"
    status = "pass" if per_period[worst] >= limits["samples"] else "suspect"
    where, value = subject.segment_label(worst), float(per_period[worst])
    return [Result(status, subject.required_friction_signal, text, value, "1", where)]


DISTANCE = Check(
    "distance",
    22,
    "Is the sliding distance long enough?",
    "Slide further at this speed.",
    {
        "contact_widths": Limit(
            0.01, "1", "up to about 1 % of its width a contact shears without sliding"
        ),
        "periods": Limit(4.0, "1", "a mean over fewer periods depends on where it ends"),
        "strength": _STRENGTH,
    },
    _distance,
)

SAMPLING = Check(
    "sampling",
    23,
    "Is stick-slip sampled fast enough?",
    "Increase the sampling rate at this speed.",
    {
        "samples": Limit(8.0, "1", "fewer than 8 per period underestimate the drop"),
        "strength": _STRENGTH,
    },
    _sampling,
)

SEGMENT_SPEED = Check(
    "segment_speed",
    24,
    "Is the speed of every segment known?",
    "Look at the figure of the strokes and set `trim` in [segments], or record position or speed.",
    {},
    _segment_speed,
)
