"""Check whether friction opposes the motion."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.core.attributes import SegmentAttributes
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.friction.oscillation.regularity import SLIP_KINDS
from tribolab.friction.oscillation.waveform import CLASSES
from tribolab.qc.flags import FAIL, GOOD
from tribolab.qc.register import Check, Result, Skip
from tribolab.qc.run.subject import RunSubject


def _reversed_slip(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report stick-slip that rises fast and falls slowly: the sign of the sensor is reversed."""
    kind = subject.slip["waveform"].values
    # friction may fall slowly along a track, too, but not periodically
    reversed_ = (kind == CLASSES[3]) & (subject.slip["regularity"].values == SLIP_KINDS[0])
    reversed_ &= ~_follows_load(subject, limits["of_load"])
    if not reversed_.sum() > 0.5 * np.isin(kind, CLASSES[1:]).sum():
        return []
    first = int(np.flatnonzero(reversed_)[0])
    where, count = subject.segment_label(first), int(reversed_.sum())
    text = (
        f"friction falls slowly and rises sharply in {Count(count):segment|segments}, as "
        "stick-slip does if the sign of the sensor is reversed"
    )
    return [Result("suspect", subject.required_friction_signal, text, where=where, count=count)]


def _follows_load(subject: RunSubject, least: float) -> np.ndarray:
    """Return a mask of the segments in which friction varies because the load varies."""
    name = subject.required_friction_signal
    if "normal_force" not in subject.signals or name != "friction_force":
        return np.zeros(len(subject.slices), bool)
    load, friction = (
        (subject.segment_stds(own), np.abs(subject.segment_means(own)))
        for own in ("normal_force", name)
    )
    return load[0] * friction[1] > least * friction[0] * load[1]


def _sign(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    try:
        sense = _reversed_slip(subject, limits)
    except Skip:  # the other part of the check reports that there is no friction
        sense = []
    try:
        return [*_opposes(subject, limits), *sense]
    except Skip:
        if sense:
            return sense
        raise


def _opposes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    if subject.segment_about.velocity_source not in ("recorded", "position"):
        raise Skip("the direction of sliding was not recorded")
    if subject.about.speed_from == "stroke":
        raise Skip("the direction of strokes was taken from the sign of friction")
    friction, signal = subject.friction, subject.required_friction_signal
    name = "friction_coefficient" if "friction_coefficient" in friction else "friction_force"
    values, error = friction[name].values, np.nan_to_num(friction[f"{name}_sem"].values)
    if not np.isfinite(values).any():
        raise Skip("no segment has a friction coefficient")
    least = limits["share"] * float(np.nanmean(np.abs(values)))
    # if a signal changes by more than its mean within a segment, its sign is unclear
    spans = subject.segments["trimmed_stop"].values - subject.segments["trimmed_start"].values
    slope = friction["trend" if name == "friction_coefficient" else "force_trend"].values
    moved = np.nan_to_num(np.abs(slope * spans))
    clear = np.maximum(np.maximum(limits["errors"] * error, moved), least)
    wrong, right = values < -clear, values > clear
    samples = subject.sample_flags(np.where(wrong, FAIL, GOOD))
    if not wrong.any():
        return [Result("pass", signal, "friction opposes the motion everywhere", flags=samples)]
    first = int(np.flatnonzero(wrong)[0])
    where = subject.segment_label(first)
    text = f"friction drives the motion in {Count(wrong.sum()):segment|segments}, first in {where}"
    unit = "1" if name == "friction_coefficient" else "N"
    value, count = float(values[first]), int(wrong.sum())
    cure = _cure_of_sign(subject, right, wrong)
    if small := int((np.isfinite(values) & ~wrong & ~right).sum()):
        text += f"; in {small} more, friction is too small to decide"
    return [Result("fail", signal, text, value, unit, where, count, samples, cure=cure)]


def _cure_of_sign(subject: RunSubject, right: np.ndarray, wrong: np.ndarray) -> str:
    """Return the remedy for a wrong sign: reverse it, unless there may be another cause.

    Reversal is the remedy if all clear strokes are reversed, in both directions, and the loop is
    centred on zero: an offset larger than friction reverses strokes as well.
    """
    friction = subject.friction
    direction = friction["direction"].values
    method = SegmentAttributes.from_attrs(friction.attrs).offset
    both = all((direction[wrong] == d).any() for d in (1, -1))
    if _unsigned_speed(subject) and right.any():
        return (
            "The velocity is never negative but the friction force is, so the speed was recorded "
            "without its sign. Name its column `set_speed` in the dialect (the force gives the "
            "direction), or record the position."
        )
    if right.any():
        return (
            "Only some strokes are reversed, so the sign of a column is not the cause. Check the "
            "zero of these segments, the direction of sliding, and the clocks."
        )
    if not both:
        if method == "zero load":
            return ""
        return (
            "One direction alone cannot distinguish a wrong sign from a zero error larger than "
            "friction: measure both directions or an unloaded rest; set `sign = -1` in the "
            "dialect only if the zero is reliable."
        )
    raw = subject.segment_means(subject.required_friction_signal)
    forward, backward = (float(np.nanmean(raw[direction == d])) for d in (1, -1))
    if abs(forward + backward) < abs(forward - backward):
        return ""
    return (
        "The loop is not centred on zero: its offset is larger than friction. Check the zero "
        "first; set `sign = -1` in the dialect only if the zero is right."
    )


def _unsigned_speed(subject: RunSubject) -> bool:
    """Return whether a recorded velocity is never negative, as from a tachometer."""
    velocity = subject.signals.get("sliding_velocity")
    return velocity is not None and not (velocity < 0).any()


FRICTION_SIGN = Check(
    "friction_sign",
    20,
    "Does friction oppose the motion?",
    "Set `sign = -1` for the force or the velocity in the dialect.",
    {
        "errors": Limit(
            3.0, "1", ("the sign of friction that is zero within its error is unreliable")
        ),
        "share": Limit(
            0.01, "1", ("the sign of friction below 1 % of the run's typical value is unreliable")
        ),
        "of_load": Limit(
            0.5,
            "1",
            "relative scatter of the load divided by that of friction; above it, the load causes "
            "the scatter of friction, as cross-talk of stick-slip into the load is far smaller",
        ),  # fmt: skip
    },
    _sign,
)
