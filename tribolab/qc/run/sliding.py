"""Checks on sliding: disturbances, steadiness, and uncertainty of the friction coefficient."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from tribolab.core.coverage import NORMAL
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.friction.coefficient import limits as of_trends
from tribolab.friction.coefficient.steadiness import chance_limit, relative_change, undecided
from tribolab.friction.oscillation.spectrum.lines import Line
from tribolab.friction.points.strokes import pairs_of, run_means, shared_error
from tribolab.friction.segments.limits import DETECTION
from tribolab.friction.zero.limits import LOADS_DIFFER
from tribolab.qc.register import Check, Result, Skip
from tribolab.qc.run.friction_sign import FRICTION_SIGN
from tribolab.qc.run.per_segment import segment_results, status_of
from tribolab.qc.run.strokes import DISTANCE, SAMPLING, SEGMENT_SPEED, find_lost_strokes
from tribolab.qc.run.subject import RunSubject


def _hum(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    hum = [line for line in subject.sliding_lines if line.mains]
    return _strongest(subject, hum, limits, "mains hum")


def _resonance(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    lines = [line for line in subject.sliding_lines if not line.mains]
    frequency = np.array([line.frequency for line in lines])
    speed = np.array([line.speed for line in lines])
    fixed = []
    for line in lines:
        # the frequency of stick-slip depends on speed, that of a resonance does not
        alike = speed[np.abs(np.log(frequency / line.frequency)) < limits["width"]]
        if alike.max() >= limits["speeds"] * alike.min():
            fixed.append(line)
    return _strongest(subject, fixed, limits, "a resonance")


def _strongest(
    subject: RunSubject, lines: list[Line], limits: Mapping[str, float], kind: str
) -> list[Result]:
    name = subject.required_friction_signal
    if not lines:
        return [Result("pass", name, f"no line of {kind}", 0.0)]
    worst = max(lines, key=lambda line: line.amplitude)
    share = worst.amplitude / subject.typical_friction
    where = subject.segment_label(worst.segment)
    text = f"{kind} at {worst.frequency:.4g} Hz, {share:.2%} of the typical friction, {where}"
    return [Result(status_of(share, limits), name, text, share, "1", where, noted=True)]


def _steadiness(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    friction, signal = subject.friction, subject.required_friction_signal
    change = relative_change(friction)
    if change is None:
        raise Skip("no trend was estimated, or there is no friction to compare with")
    chance, samples = friction["trend_p_value"].values, friction["effective_samples"].values
    open_ = undecided(change, chance, samples, limits)
    sure = chance < chance_limit(samples, limits)
    graded = np.where(open_, np.nan, np.where(sure, change, 0.0))
    title = "trend within a segment"
    if not open_.any():
        return _add_largest_change(segment_results(subject, signal, graded, limits, title), change)
    worst = int(np.argmax(np.where(open_, np.abs(change), -1.0)))
    where = subject.segment_label(worst)
    text = (
        f"not decided in {open_.sum()} of {Count(open_.size):segment|segments}, because there are "
        f"too few effective samples: {change[worst]:+.2%} along {where}, {samples[worst]:.2g} "
        "effective samples, "
        f"p = {chance[worst]:.2g}"
    )
    value, count = float(change[worst]), int(open_.sum())
    doubt = Result("skipped", signal, text, value, "1", where, count, noted=True)
    if np.isnan(graded).all():
        return [doubt]
    rest = segment_results(subject, signal, graded, limits, title)
    # one unsteady segment makes the whole run unsteady
    return [doubt, *(result for result in rest if result.status != "pass")]


def _add_largest_change(results: list[Result], change: np.ndarray) -> list[Result]:
    """Add the largest measured change to the message if no trend is significant."""
    if results[0].status != "pass" or results[0].value != 0.0:
        return results
    text = (
        f"no significant trend within a segment; measured at most {np.nanmax(np.abs(change)):.2%}"
    )
    return [replace(results[0], message=text)]


def _segments(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    _ = subject.required_friction_signal  # without a friction signal, the check `schema` objects
    why = subject.missing_segment_reason
    if why and subject.is_ramp:
        text = (
            "speed-ramp test: the zero offset of the friction force is not subtracted; it shifts "
            "the whole curve and is not included in ±"
        )
        cure = "Record a rest without load, or ramps in both directions, for the zero."
        return [Result("suspect", "", text, cure=cure)]
    if why:
        return [Result("suspect", "", why)]
    number = subject.segments.sizes["segment"]
    found = Result("pass", "", f"{Count(number):segment|segments} of constant speed")
    objections = [*find_lost_strokes(subject, limits), *_uncertain(subject, limits)]
    return objections or [found]


def _uncertain(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report friction coefficients with a large U95 that is not due to noise."""
    friction, name = subject.friction, "friction_coefficient"
    if f"{name}_beyond_U95" not in friction:
        return []
    speed, mu = friction["sliding_speed"].values, friction[name].values
    sem, wide = (friction[f"{name}_beyond_{end}"].values for end in ("sem", "U95"))
    pairs = pairs_of(friction)
    moving, shared = np.where(speed > 0, speed, 1.0), shared_error(friction)
    means = []
    for own in _load_groups(friction):  # friction may depend on the load
        common = None if shared is None else shared[own]
        found = run_means(moving[own], mu[own], sem[own], wide[own], pairs[own], shared=common)
        means += [mean._replace(strokes=own[mean.strokes]) for mean in found]
    white = friction[f"{name}_std"].values / np.sqrt(np.maximum(friction["samples"].values, 1))
    bad = []
    for mean in means:
        own = white[mean.strokes]
        by_noise = NORMAL * float(np.nanmean(own)) if np.isfinite(own).any() else 0.0
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
        f"{Count(len(means)):speed|speeds}: friction or its zero drifts slowly, and the record "
        "is too short to average it out"
    )
    cure = "Slide longer, or repeat the strokes, until the mean settles."
    return [Result("suspect", name, text, share, count=len(bad), cure=cure)]


def _load_groups(friction: xr.Dataset) -> list[np.ndarray]:
    """Return the indices of the segments at each load, from the smallest load to the largest."""
    every = np.arange(friction.sizes["segment"])
    if "normal_force" not in friction:
        return [every]
    load = friction["normal_force"].values
    order = np.argsort(load)
    steps = load[order][1:] > LOADS_DIFFER.value * load[order][:-1]
    return [np.sort(part) for part in np.split(every[order], np.flatnonzero(steps) + 1)]


_LINE = {
    "suspect": Limit(0.02, "1", "usual scatter of friction coefficients in a segment"),
    "fail": Limit(0.50, "1", "the signal is mostly disturbance"),
}

SLIDING_CHECKS = (
    Check(
        "segments",
        28,
        "Are there segments of constant speed, and could any check be evaluated?",
        "Record position or speed, slide longer at one speed, or state `sliding_speed` "
        "in the campaign file. With a crank drive, use the middle of each stroke "
        "(`segments.stroke_middle = 0.5` in [[run]] uses half of it). See also `drift` "
        "and `min_samples` below, in `[qc] limits.segments`.",
        {
            **DETECTION,
            "uncertain": Limit(
                0.3, "1", ("if U95 is a third of µ, surfaces cannot be distinguished")
            ),
            "known_to": Limit(
                0.005, "1", ("U95 that is always accepted: full-film friction is 0.001 to 0.01")
            ),
            "lost_strokes": Limit(
                0.05, "1", "fraction of the strokes; only the first and the last may be incomplete"
            ),
        },
        _segments,
    ),
    Check(
        "hum",
        18,
        "Is there mains hum in the friction signal?",
        "Look for ground loops and unshielded cables.",
        _LINE,
        _hum,
    ),
    Check(
        "resonance",
        19,
        "Does the rig resonate?",
        "A spectral line at the same frequency at all speeds is a resonance of the rig. "
        "Stiffen or damp it.",
        {
            **_LINE,
            "width": Limit(0.03, "1", "a resonance of the rig is constant within 3 %"),
            "speeds": Limit(
                2.0, "1", "at twice the speed the stick-slip frequency changes by more than 3 %"
            ),
        },
        _resonance,
    ),
    FRICTION_SIGN,
    Check(
        "steadiness",
        21,
        "Is friction steady within each trimmed segment?",
        "Slide longer, or trim more: with a trend, the mean includes the running-in.",
        {
            "suspect": of_trends.SUSPECT_DRIFT,
            "fail": of_trends.FAILING_DRIFT,
            "chance": of_trends.TREND_BY_CHANCE,
            "samples": of_trends.MIN_EFFECTIVE_SAMPLES,
        },
        _steadiness,
    ),
    DISTANCE,
    SAMPLING,
    SEGMENT_SPEED,
)
