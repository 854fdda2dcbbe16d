"""Checks on sliding itself: disturbances, direction, steadiness, and whether it says enough."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from tribolab.core.limit import Limit
from tribolab.errors import AnalysisError
from tribolab.friction.coefficient import steadiness
from tribolab.friction.coefficient.steadiness import chance_limit, relative_change, undecided
from tribolab.friction.oscillation.lines import Line
from tribolab.friction.oscillation.periods import AT_ODDS
from tribolab.friction.oscillation.regularity import SLIP_KINDS
from tribolab.friction.oscillation.survey import CHANCE
from tribolab.friction.oscillation.waveform import CLASSES
from tribolab.friction.points.strokes import run_means, shared_error
from tribolab.friction.segments.strokes import find_strokes
from tribolab.friction.statistics import NORMAL
from tribolab.friction.zero.limits import LOADS_DIFFER
from tribolab.friction.zero.of_run import PAIRED
from tribolab.qc.flags import FAIL, GOOD
from tribolab.qc.register import Check, Result, Skip
from tribolab.qc.run.per_segment import by_segment, status_of
from tribolab.qc.run.subject import RunSubject
from tribolab.words import Count, duration

_NOT_CONSTANT = ("at rest", "ramp", "too short")

_CURE_OF_UNKNOWN_STROKES = (
    'Say stroke and frequency in the dialect ([speed] source = "stroke"), or record the position.'
)

_CURE_OF_OTHER_STROKES = (
    "See that the frequency is right. If it changes within the run, state it for each step: as a "
    "column, or as values with the source step or programme in the dialect."
)


def _signal(subject: RunSubject) -> str:
    if subject.friction_signal is None:
        raise Skip("no friction was recorded")
    return subject.friction_signal


def _hum(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    hum = [line for line in subject.sliding_lines if line.mains]
    return _strongest(subject, hum, limits, "mains hum")


def _resonance(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    lines = [line for line in subject.sliding_lines if not line.mains]
    frequency = np.array([line.frequency for line in lines])
    speed = np.array([line.speed for line in lines])
    fixed = []
    for line in lines:
        # stick-slip moves with the speed; a line of the rig stays where it is
        alike = speed[np.abs(np.log(frequency / line.frequency)) < limits["width"]]
        if alike.max() >= limits["speeds"] * alike.min():
            fixed.append(line)
    return _strongest(subject, fixed, limits, "a resonance")


def _strongest(
    subject: RunSubject, lines: list[Line], limits: Mapping[str, float], kind: str
) -> list[Result]:
    name = _signal(subject)
    if not lines:
        return [Result("pass", name, f"no line of {kind}", 0.0)]
    worst = max(lines, key=lambda line: line.amplitude)
    share = worst.amplitude / subject.typical_friction
    where = subject.segment_label(worst.segment)
    text = f"{kind} at {worst.frequency:.4g} Hz, {share:.2%} of the typical friction, {where}"
    return [Result(status_of(share, limits), name, text, share, "1", where, noted=True)]


def _sense(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Friction that falls slowly and rises sharply belongs to a sensor whose sign is turned."""
    kind = subject.slip["waveform"].values
    # what varies along a track may fall slowly, too, but not again and again alike
    reversed_ = (kind == CLASSES[3]) & (subject.slip["regularity"].values == SLIP_KINDS[0])
    reversed_ &= ~_follows_load(subject, limits["of_load"])
    if not reversed_.sum() > 0.5 * np.isin(kind, CLASSES[1:]).sum():
        return []
    first = int(np.flatnonzero(reversed_)[0])
    where, count = subject.segment_label(first), int(reversed_.sum())
    text = (
        f"friction falls slowly and rises sharply in {Count(count):segment|segments}, as "
        "stick-slip does behind a sensor whose sign is turned"
    )
    return [Result("suspect", _signal(subject), text, where=where, count=count)]


def _follows_load(subject: RunSubject, least: float) -> np.ndarray:
    """Return where friction varies because the load does (segment)."""
    name = _signal(subject)
    if "normal_force" not in subject.signals or name != "friction_force":
        return np.zeros(len(subject.slices), bool)
    of_load, of_friction = (
        subject.segment_stds(own) / np.abs(subject.segment_means(own))
        for own in ("normal_force", name)
    )
    return of_load > least * of_friction


def _sign(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    try:
        sense = _sense(subject, limits)
    except Skip:  # a run without friction: the other part says why
        sense = []
    try:
        return [*_opposes(subject, limits), *sense]
    except Skip:
        if sense:
            return sense
        raise


def _opposes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    if subject.segments.attrs.get("velocity_source") not in ("recorded", "position"):
        raise Skip("the direction of sliding was not recorded")
    if subject.run.attrs.get("speed_from") == "stroke":
        raise Skip("which way a stroke goes was told by the sign of friction")
    friction, signal = subject.friction, _signal(subject)
    name = "friction_coefficient" if "friction_coefficient" in friction else "friction_force"
    values, error = friction[name].values, np.nan_to_num(friction[f"{name}_sem"].values)
    if not np.isfinite(values).any():
        raise Skip("no segment has a friction coefficient")
    least = limits["share"] * float(np.nanmean(np.abs(values)))
    # a signal that moves by more than its mean within a segment says nothing of the sign
    spans = subject.segments["trimmed_stop"].values - subject.segments["trimmed_start"].values
    slope = friction["trend" if name == "friction_coefficient" else "force_trend"].values
    moved = np.nan_to_num(np.abs(slope * spans))
    clear = np.maximum(np.maximum(limits["errors"] * error, moved), least)
    wrong, right = values < -clear, values > clear
    samples = subject.on_samples(np.where(wrong, FAIL, GOOD))
    if not wrong.any():
        return [Result("pass", signal, "friction opposes the motion everywhere", flags=samples)]
    first = int(np.flatnonzero(wrong)[0])
    where = subject.segment_label(first)
    text = f"friction drives the motion in {Count(wrong.sum()):segment|segments}, first in {where}"
    unit = "1" if name == "friction_coefficient" else "N"
    value, count = float(values[first]), int(wrong.sum())
    cure = _cure_of_sign(subject, right, wrong)
    if small := int((np.isfinite(values) & ~wrong & ~right).sum()):
        text += f"; in {small} more it is too small to tell"
    return [Result("fail", signal, text, value, unit, where, count, samples, cure=cure)]


def _cure_of_sign(subject: RunSubject, right: np.ndarray, wrong: np.ndarray) -> str:
    """Propose another sign only where nothing but the sign can be wrong.

    That is where all strokes that tell are turned, both ways, and their loop lies about zero: an
    offset that is larger than friction, or none that is known, turns strokes as well.
    """
    friction = subject.friction
    direction = friction["direction"].values
    method = str(friction.attrs.get("offset", ""))
    both = all((direction[wrong] == d).any() for d in (1, -1))
    if _speed_without_sign(subject) and right.any():
        return (
            "The velocity is nowhere negative, the friction force is: the speed was recorded "
            "without its sign. Name its column `set_speed` in the dialect, so that the force tells "
            "the direction, or record the position."
        )
    if right.any():
        return (
            "Only some strokes are turned, so it is not the sign of a column: look at what the "
            "zero of these segments was taken from, at the direction of sliding, and at the clocks."
        )
    if not both:
        if method == "zero load":
            return ""
        return (
            "Strokes one way do not tell a turned sign from a zero that is off by more than "
            "friction: measure both directions or a rest without load; set `sign = -1` in the "
            "dialect only if the zero is sure."
        )
    raw = subject.segment_means(_signal(subject))
    forward, backward = (float(np.nanmean(raw[direction == d])) for d in (1, -1))
    if abs(forward + backward) < abs(forward - backward):
        return ""
    return (
        "The loop does not lie about zero: its offset is larger than friction. Look at the zero "
        "first; set `sign = -1` in the dialect only if the zero is right."
    )


def _speed_without_sign(subject: RunSubject) -> bool:
    """Whether the velocity never goes below zero, as that of a tachometer that knows no way."""
    velocity = subject.signals.get("sliding_velocity")
    return velocity is not None and not (velocity < 0).any()


def _steadiness(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    friction, signal = subject.friction, _signal(subject)
    change = relative_change(friction)
    if change is None:
        raise Skip("no trend was estimated, or there is no friction to compare with")
    chance, samples = friction["trend_p_value"].values, friction["effective_samples"].values
    open_ = undecided(change, chance, samples, limits)
    sure = chance < chance_limit(samples, limits)
    graded = np.where(open_, np.nan, np.where(sure, change, 0.0))
    told = "trend within a segment"
    if not open_.any():
        return _told(by_segment(subject, signal, graded, limits, told), change)
    worst = int(np.argmax(np.where(open_, np.abs(change), -1.0)))
    where = subject.segment_label(worst)
    text = (
        f"not decided in {open_.sum()} of {Count(open_.size):segment|segments}, too few "
        "effective samples: "
        f"{change[worst]:+.2%} along {where}, {samples[worst]:.2g} effective samples, "
        f"p = {chance[worst]:.2g}"
    )
    value, count = float(change[worst]), int(open_.sum())
    doubt = Result("skipped", signal, text, value, "1", where, count, noted=True)
    if np.isnan(graded).all():
        return [doubt]
    rest = by_segment(subject, signal, graded, limits, told)
    # a part that is steady is no answer for the run; a part that is not is one
    return [doubt, *(result for result in rest if result.status != "pass")]


def _told(results: list[Result], change: np.ndarray) -> list[Result]:
    """Say how large the trends are that are none: a line through noise has a slope, too."""
    if results[0].status != "pass" or results[0].value != 0.0:
        return results
    text = (
        f"no significant trend within a segment; measured at most {np.nanmax(np.abs(change)):.2%}"
    )
    return [replace(results[0], message=text)]


def _segments(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    _signal(subject)  # without friction there is nothing to slide for: `schema` objects
    why = subject.no_segment
    if why:
        return [Result("suspect", "", why)]
    number = subject.segments.sizes["segment"]
    found = Result("pass", "", f"{Count(number):segment|segments} of constant speed")
    objections = [*_lost_strokes(subject, limits), *_uncertain(subject, limits)]
    return objections or [found]


def _uncertain(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report coefficients whose uncertainty is of their size, and larger than noise makes it."""
    friction, name = subject.friction, "friction_coefficient"
    if f"{name}_beyond_U95" not in friction:
        return []
    speed, mu = friction["sliding_speed"].values, friction[name].values
    sem, wide = (friction[f"{name}_beyond_{end}"].values for end in ("sem", "U95"))
    pairs = np.full(mu.size, -1.0)
    if "pair" in friction and friction.attrs.get("offset") in PAIRED:
        pairs = friction["pair"].values.astype(float)
    moving, shared = np.where(speed > 0, speed, 1.0), shared_error(friction)
    means = []
    for own in _loads_apart(friction):  # friction under several loads differs, and that is no error
        common = None if shared is None else shared[own]
        found = run_means(moving[own], mu[own], sem[own], wide[own], pairs[own], shared=common)
        means += [mean._replace(strokes=own[mean.strokes]) for mean in found]
    white = friction[f"{name}_std"].values / np.sqrt(np.maximum(friction["samples"].values, 1))
    bad = []
    for mean in means:
        by_noise = NORMAL * float(np.nanmean(white[mean.strokes]))
        least = max(limits["uncertain"] * abs(mean.mean), limits["known_to"], by_noise)
        if mean.u95 > least:
            bad.append(mean)
    if not bad:
        return []
    worst = max(bad, key=lambda mean: mean.u95 / max(abs(mean.mean), 1e-12))
    share = worst.u95 / max(abs(worst.mean), 1e-12)
    text = (
        f"the uncertainty of the friction coefficient is {share:.0%} of its value "
        f"({worst.mean:.3g} ± {worst.u95:.2g}, 95 % coverage) at {len(bad)} of "
        f"{Count(len(means)):speed|speeds}: friction or its zero wanders too slowly for so short a "
        "record"
    )
    cure = "Slide longer, or repeat the strokes, until the mean settles."
    return [Result("suspect", name, text, share, count=len(bad), cure=cure)]


def _loads_apart(friction: xr.Dataset) -> list[np.ndarray]:
    """Return the segments under each load, in their order."""
    every = np.arange(friction.sizes["segment"])
    if "normal_force" not in friction:
        return [every]
    load = friction["normal_force"].values
    order = np.argsort(load)
    steps = load[order][1:] > LOADS_DIFFER.value * load[order][:-1]
    return [np.sort(part) for part in np.split(every[order], np.flatnonzero(steps) + 1)]


def _lost_strokes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report strokes of which no part is a segment although the position shows that they slide."""
    segments = subject.segments
    if segments.attrs.get("velocity_source") != "position" or "stroke_middle" in segments.attrs:
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
    # of friction: a rheometer's steps of shear stress have a shear rate in place of a speed
    unknown = np.isnan(subject.friction["sliding_speed"].values)
    if unlike := subject.run.attrs.get("strokes_unlike_s"):
        often = subject.run.attrs["stroke_frequency_Hz"]
        text = (
            f"friction turns over with the {often:.3g} Hz that are stated for a part of the run "
            f"only; for {duration(unlike)} it does so otherwise, which counts as rest"
        )
        return [Result("fail", _signal(subject), text, cure=_CURE_OF_OTHER_STROKES)]
    if not unknown.any():
        known = Result("pass", "sliding_speed", "the speed of every segment is known")
        return _to_and_fro(subject) or [known]
    text = (
        f"the speed of {int(unknown.sum())} of {Count(unknown.size):segment|segments} is "
        "unknown: start, stop and rest may be inside"
    )
    where, count = subject.segment_label(int(np.argmax(unknown))), int(unknown.sum())
    told = Result("suspect", "sliding_speed", text, where=where, count=count)
    return [told, *_to_and_fro(subject)]


def _to_and_fro(subject: RunSubject) -> list[Result]:
    """Tell of segments of unknown direction whose force changes its sign again and again."""
    turned = subject.reversals
    if not turned.any():
        return []
    first, count = int(np.flatnonzero(turned)[0]), int((turned > 0).sum())
    text = (
        f"friction changes its sign {int(turned.max())} times while the direction of sliding is "
        "not known: it looks like motion to and fro, and a mean over both ways is no friction"
    )
    if often := subject.run.attrs.get("strokes_not_seen_Hz"):
        text += f"; it does not turn over with the {often:.4g} Hz that are stated"
    where, cure = subject.segment_label(first), _CURE_OF_UNKNOWN_STROKES
    return [Result("fail", _signal(subject), text, where=where, count=count, cure=cure)]


def _distance(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    distance = subject.segments["sliding_distance"].values
    if not np.isfinite(subject.contact_width):
        text = "the contact width is not known (a campaign knows it from [contact])"
        results.append(Result("skipped", "sliding_distance", text))
    elif np.isfinite(distance).any():
        share = distance / subject.contact_width
        shortest = int(np.nanargmin(share))
        text = f"the shortest slide is {share[shortest]:.3g} of the contact width"
        status = "pass" if share[shortest] >= limits["contact_widths"] else "suspect"
        where, value = subject.segment_label(shortest), float(share[shortest])
        results.append(Result(status, "sliding_distance", text, value, "1", where))
    if subject.friction_signal is None:
        return results
    periods = subject.strong_periods(limits["strength"])
    if np.isfinite(periods).any():
        fewest = int(np.nanargmin(periods))
        text = f"the fewest stick-slip periods in a segment are {periods[fewest]:.3g}"
        status = "pass" if periods[fewest] >= limits["periods"] else "suspect"
        where, value = subject.segment_label(fewest), float(periods[fewest])
        results.append(Result(status, subject.friction_signal, text, value, "1", where))
    return [*results, *_periods_at_odds(subject, limits)]


def _periods_at_odds(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Tell of steady segments that oscillate, whose drops and spectrum tell different periods."""
    slip = subject.slip
    odd = np.array([AT_ODDS in str(remark) for remark in slip["remark"].values], bool)
    odd &= slip["false_alarm_probability"].values < CHANCE
    if odd.any():
        odd &= subject.friction["steady"].values == steadiness.IS_STEADY
        odd &= subject.oscillates_strongly(limits["strength"])
    if not odd.any():
        return []
    first, count = int(np.flatnonzero(odd)[0]), int(odd.sum())
    where = subject.segment_label(first)
    said = str(slip["remark"].values[first])
    text = (
        f"no period of stick-slip is told in {Count(count):segment|segments}: in {where}, "
        f"{said[said.index(AT_ODDS) :]}"
    )
    cure = "Slide further at this speed, or look at the strokes figure which of the two it is."
    signal = subject.friction_signal or ""
    return [Result("suspect", signal, text, where=where, count=count, cure=cure)]


def _sampling(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    periods = subject.strong_periods(limits["strength"])
    if not np.isfinite(periods).any():
        return [Result("pass", _signal(subject), "no stick-slip to resolve")]
    per_period = subject.segments["samples"].values / periods
    worst = int(np.nanargmin(per_period))
    text = f"the fastest stick-slip has {per_period[worst]:.3g} samples in a period"
    status = "pass" if per_period[worst] >= limits["samples"] else "suspect"
    where, value = subject.segment_label(worst), float(per_period[worst])
    return [Result(status, _signal(subject), text, value, "1", where)]


_LINE = {
    "suspect": Limit(0.02, "1", "as much as friction coefficients usually scatter in a segment"),
    "fail": Limit(0.50, "1", "the signal is mostly disturbance"),
}
_STRENGTH = Limit(0.03, "1", "a weaker oscillation moves a mean over four periods by 0.3 %")

SLIDING_CHECKS = (
    Check(
        "segments",
        28,
        "Does the run slide at constant speed anywhere, and could anything be examined?",
        "Record position or speed, slide longer at one speed, or state `sliding_speed` in the "
        "campaign file; of what a crank drives, take the middle of each stroke "
        "(`segments.stroke_middle = 0.5` in its [[run]] takes half of it); see `drift` and "
        "`min_samples` under [segments].",
        {
            "uncertain": Limit(0.3, "1", "a third of the value: no two surfaces are told apart"),
            "known_to": Limit(0.005, "1", "a full film has 0.001 to 0.01: known to half of that"),
            "lost_strokes": Limit(
                0.05, "1", "share of the strokes; the first and the last may be cut, others not"
            ),
        },
        _segments,
    ),
    Check(
        "hum",
        18,
        "Does the mains hum in the friction signal?",
        "Look for ground loops and unshielded cables.",
        _LINE,
        _hum,
    ),
    Check(
        "resonance",
        19,
        "Does the rig itself ring?",
        "A line that stays at its frequency at any speed is the rig's; stiffen or damp it.",
        {
            **_LINE,
            "width": Limit(0.03, "1", "a line of the rig stays within 3 % of its frequency"),
            "speeds": Limit(2.0, "1", "stick-slip at twice the speed is faster by more than 3 %"),
        },
        _resonance,
    ),
    Check(
        "friction_sign",
        20,
        "Does friction oppose the motion?",
        "Set `sign = -1` for the force or the velocity in the dialect.",
        {
            "errors": Limit(3.0, "1", "friction that is zero within its error has no sign"),
            "share": Limit(0.01, "1", "nor has what is below 1 % of the run's typical friction"),
            "of_load": Limit(
                0.5,
                "1",
                "relative scatter of the load over that of friction, from which on the "
                "load makes it: cross-talk of stick-slip into the load is far smaller",
            ),  # fmt: skip
        },
        _sign,
    ),
    Check(
        "steadiness",
        21,
        "Is friction steady within each trimmed segment?",
        "Slide longer, or trim more: the mean of a trend is a mean over the run-in.",
        {
            "suspect": Limit(
                steadiness.SUSPECT_DRIFT, "1", "5 % is above the usual spread of repeats"
            ),
            "fail": Limit(steadiness.FAILING_DRIFT, "1", "the number has no meaning as a mean"),
            "chance": Limit(steadiness.SIGNIFICANT, "1", "so that noise is rarely called a trend"),
            "samples": Limit(
                steadiness.SAMPLES,
                "1",
                "fewer effective samples do not tell a trend from slow wandering",
            ),
        },
        _steadiness,
    ),
    Check(
        "distance",
        22,
        "Is the sliding distance long enough?",
        "Slide further at this speed.",
        {
            "contact_widths": Limit(
                0.01, "1", "up to about a hundredth of its width a contact shears, not slides"
            ),
            "periods": Limit(4.0, "1", "a mean over fewer periods depends on where it is cut"),
            "strength": _STRENGTH,
        },
        _distance,
    ),
    Check(
        "sampling",
        23,
        "Is stick-slip sampled fast enough?",
        "Sample faster at this speed.",
        {
            "samples": Limit(8.0, "1", "fewer than 8 in a period round off the drop"),
            "strength": _STRENGTH,
        },
        _sampling,
    ),
    Check(
        "segment_speed",
        24,
        "Is the speed of every segment known?",
        "Look at the strokes figure and set `trim` under [segments], or record position or speed.",
        {},
        _segment_speed,
    ),
)
