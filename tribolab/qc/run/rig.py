"""Checks on the rig: zeros, load, speed, and the match of two clocks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.arrays.chunks import one_by_one
from tribolab.arrays.medians import median, median_of_known
from tribolab.core.limit import Limit
from tribolab.core.wording import duration
from tribolab.friction.segments.slopes import digit, position_noise
from tribolab.qc.register import Check, Result, Skip
from tribolab.qc.run.per_segment import segment_results, status_of
from tribolab.qc.run.subject import RunSubject


def _zero_offset(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    offsets = subject.unloaded_levels("friction_force")
    if not offsets:
        raise Skip("the zero of the force was not measured: no rest without load")
    share = float(median(np.array(offsets))) / subject.typical_friction
    text = f"the zero of the force cell is off by {share:+.2%} of the friction force"
    return [Result(status_of(share, limits), "friction_force", text, share)]


def _zero_drift(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    for name in ("friction_force", "normal_force"):
        levels = subject.unloaded_levels(name)
        if len(levels) < 2:
            text = "fewer than two rests without load: drift cannot be measured"
            results.append(Result("skipped", name, text))
            continue
        force = name == "friction_force"
        scale = subject.typical_friction if force else subject.typical_normal_force
        drift = (levels[-1] - levels[0]) / scale
        text = f"the zero drifted by {drift:+.2%} of the signal from the first to the last rest"
        results.append(Result(status_of(drift, limits), name, text, float(drift)))
    return results


def _normal_force_error(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    target = subject.target_normal_force
    means = subject.segment_means("normal_force")
    levels = subject.unloaded_levels("normal_force")
    zero = float(np.mean(levels)) if levels else 0.0
    moved = _load_moves(subject, means - zero, limits)
    if not np.isfinite(target).any():
        if moved:
            return moved
        raise Skip("the set-point of the normal force is not known")
    error = (means - zero) / target - 1
    off = segment_results(
        subject, "normal_force", error, limits, ("deviation of the normal force from its set-point")
    )
    return moved if moved and off[0].status == "pass" else off


def _load_moves(
    subject: RunSubject, loads: np.ndarray, limits: Mapping[str, float]
) -> list[Result]:
    """Report a load that should be constant, but changes along the run or within a segment."""
    if "set_normal_force" in subject.run:
        return []
    parts = [part for part in subject.slices if part.stop > part.start]
    known = loads[np.isfinite(loads) & (loads > 0)]
    if not known.size:
        return []
    if known.max() > limits["programme"] * known.min():
        return _steps_without_friction(subject, loads, limits)  # the load was changed on purpose
    signal = subject.signals["normal_force"]
    first, last = parts[0], parts[-1]
    tenth = max((last.stop - last.start) // 10, 1), max((first.stop - first.start) // 10, 1)
    begins = signal[first.start : first.start + tenth[1]]
    ends = signal[last.stop - tenth[0] : last.stop]
    begin, end = float(np.nanmean(begins)), float(np.nanmean(ends))
    usual = float(np.median(known))
    noise = np.hypot(*(np.nanstd(own) / np.sqrt(own.size) for own in (begins, ends)))
    change = (end - begin) / usual
    steps = np.diff(loads) / usual if loads.size > 1 else np.zeros(1)
    if np.nanmax(np.abs(steps)) > abs(change):
        change = float(steps[np.nanargmax(np.abs(steps))])
    if abs(change) <= max(limits["change"], _CLEAR * noise / usual):
        return []
    text = (
        f"the load changes by {change:+.1%} along the run although it was set constant. If the "
        "true load was constant, the friction coefficient is wrong by the same percentage"
    )
    return [Result("suspect", "normal_force", text, change)]


def _steps_without_friction(
    subject: RunSubject, loads: np.ndarray, limits: Mapping[str, float]
) -> list[Result]:
    """Report steps of the load that the friction force at the same speed does not follow."""
    if "friction_force" not in subject.friction or np.isfinite(subject.target_normal_force).any():
        return []
    # the half loop of a pair with unequal loads would assume that friction follows the load
    zero = float(median_of_known(subject.friction["friction_force_offset"].values))
    force = np.abs(subject.segment_means("friction_force") - zero)
    speed = np.nan_to_num(subject.friction["sliding_speed"].values)
    fine = (loads > 0) & (force > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        of_load, of_force = (np.diff(np.log(own)) for own in (loads, force))
    alike = np.abs(np.diff(speed)) <= limits["same_speed"] * speed[1:]
    steps = fine[1:] & fine[:-1] & alike & (np.abs(of_load) > np.log1p(limits["fail"]))
    if not steps.any():
        return []
    follows = float(median(of_force[steps] / of_load[steps]))
    if follows >= limits["follows"]:
        return []
    worst = int(np.argmax(np.where(steps, np.abs(of_load), 0.0)))
    change, own = (float(np.expm1(part[worst])) for part in (of_load, of_force))
    where = subject.segment_label(worst + 1)
    text = (
        f"the measured load changes by {change:+.0%} to {where}, but the friction force at the "
        f"same speed by only {own:+.1%}. If the true load did not change, the friction "
        "coefficient is "
        "wrong by the same percentage"
    )
    return [Result("suspect", "normal_force", text, change, where=where, cure=_READING_STEPS)]


_READING_STEPS = (
    "Check that the load cell and its amplifier kept their range, or state the load of each step "
    "(set_normal_force)."
)
_CLEAR = 5.0  # standard errors by which the load must change to be reported


def _normal_force_scatter(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    means = subject.segment_means("normal_force")
    share = subject.segment_stds("normal_force") / np.where(means == 0, np.nan, means)
    return segment_results(subject, "normal_force", share, limits, "scatter of the normal force")


def _velocity_set(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    segments = subject.segments
    if subject.segment_about.velocity_source not in ("recorded", "position"):
        raise Skip("the speed was not measured")
    if "set_speed" in segments:
        target = np.abs(segments["set_speed"].values)
    else:
        target = np.full(segments.sizes["segment"], subject.about.set_speed_m_s)
    if not np.isfinite(target).any():
        raise Skip("the set-point of the speed is not known")
    error = segments["sliding_speed"].values / np.where(target > 0, target, np.nan) - 1
    return segment_results(
        subject, "sliding_velocity", error, limits, ("deviation of the speed from its set-point")
    )


def _velocity_position(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    if not {"sliding_velocity", "position"} <= set(subject.run):
        raise Skip("velocity and position were not both recorded")
    results = []
    if standstill := subject.segment_about.standstill_s:
        text = (
            f"the position does not change for at least {duration(standstill)} while the recorded "
            "velocity is not zero; segments and speeds are taken from the position"
        )
        results.append(
            Result("suspect", "position", text, standstill, "s", cure=_CURE_OF_STANDSTILL)
        )
    position = subject.signals["position"]
    known = np.isfinite(position)
    noise = position_noise(subject.time[known], position[known])
    slopes, error = np.array(
        [_slope(subject, part, noise) for part in one_by_one(subject.slices)]
    ).T
    if not np.isfinite(slopes).any() and not results:
        raise Skip("no position within the segments")
    # compare means: the slope is a mean over the segment, and so is the signed velocity
    velocity = subject.segment_means("sliding_velocity")
    velocity = np.where(velocity == 0, np.nan, velocity)
    # motion below the resolution of the encoder cannot be compared
    resolved = limits["errors"] * error < limits["suspect"] * np.abs(velocity)
    off = np.where(resolved, slopes / velocity - 1, np.nan)
    if results and not np.isfinite(off).any():
        return results
    results_of_segments = segment_results(
        subject, "sliding_velocity", off, limits, "deviation of d(position)/dt from the velocity"
    )
    return [*results, *results_of_segments]


def _slope(subject: RunSubject, part: slice, noise: float) -> tuple[float, float]:
    """Return a segment's velocity from the position [m/s], and its error by noise and resolution.

    Deviations from a line are not noise, because a stage that stops deviates too. The resolution
    matters if the reading hardly changes: then its error is constant and shows no noise.
    """
    time, position = subject.time[part], subject.signals["position"][part]
    good = np.isfinite(position)
    if good.sum() < 3:
        return float("nan"), float("nan")
    if not good.all():
        time, position = time[good], position[good]
    t, x = time - time.mean(), position - position.mean()
    slope = float(t @ x) / float(t @ t)
    white = noise / float(np.sqrt(t @ t))
    return slope, max(white, digit(position) / float(time[-1] - time[0]))


def _clock_shift(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    source, error = subject.about.clock_shift_source, subject.about.clock_shift_uncertainty_s
    if not source:
        raise Skip("one clock only")
    if source == "given":
        return [Result("pass", "time", "the shift between the clocks was given", unit="s")]
    if source == "none" or not np.isfinite(error):
        why = subject.about.clock_shift_refused or "the force does not follow the motion"
        text = f"the clock shift cannot be found from the signals ({why}): state clock_shift"
        return [Result("fail", "time", text, unit="s")]
    shortest = float((subject.segments["stop"] - subject.segments["start"]).min())
    share = 2.0 * error / shortest
    text = f"the clocks are matched to {2.0 * error:.3g} s, {share:.1%} of the shortest segment"
    return [Result(status_of(share, limits), "time", text, error, "s")]


_CURE_OF_STANDSTILL = (
    "Check whether the stage stopped or the encoder slipped. If the position is wrong, leave its "
    "column out in the dialect."
)

_OFF = "Calibrate or tare the instrument; check the unit stated in the file."

RIG_CHECKS = (
    Check(
        "zero_offset",
        11,
        "Is the friction force zero without sliding?",
        "Tare the force cell before loading. The offset was removed and is listed.",
        {
            "suspect": Limit(
                0.5,
                "1",
                "zeros are stable to a tenth of their value: 5 % of the friction is doubtful",
            ),
            "fail": Limit(5.0, "1", "a tenth of the zero is then half the friction"),
        },
        _zero_offset,
    ),
    Check(
        "zero_drift",
        12,
        "Is the zero of the friction force stable?",
        "Let the amplifier warm up, and measure in both directions: half loops follow a drift.",
        {
            "suspect": Limit(
                0.10,
                "1",
                "a tenth of such a drift may be irregular and is not corrected: 1 % of "
                "the friction",
            ),
            "fail": Limit(1.0, "1", "the zero changes by as much as the friction"),
        },
        _zero_drift,
    ),
    Check(
        "normal_force_error",
        13,
        "Does the normal force agree with its set-point?",
        _OFF,
        {
            "suspect": Limit(0.03, "1", "friction coefficients of Hertz contacts vary as F^-1/3"),
            "fail": Limit(0.15, "1", "half the usual step between loads"),
            "change": Limit(0.03, "1", "change along the run; force cells creep by 0.1 % or less"),
            "programme": Limit(1.4, "1", "larger load ratios are intended, as in a load programme"),
            "same_speed": Limit(0.1, "1", "friction changes by only a few per cent in this range"),
            "follows": Limit(
                0.3,
                "1",
                "smallest exponent of the load in the friction force: 1 for Amontons' "
                "law, 2/3 for a Hertz contact with constant shear stress",
            ),
        },
        _normal_force_error,
    ),
    Check(
        "normal_force_scatter",
        14,
        "Is the normal force constant?",
        "Check the load control and the flatness of the counter body.",
        {
            "suspect": Limit(0.03, "1", "three times the scatter of a good load control"),
            "fail": Limit(0.20, "1", "this is no longer one load"),
        },
        _normal_force_scatter,
    ),
    Check(
        "velocity_set",
        15,
        "Does the speed agree with its set-point?",
        _OFF,
        {
            "suspect": Limit(0.03, "1", "stages keep their speed within 1 %"),
            "fail": Limit(0.20, "1", "20 % visibly shifts the point on a Stribeck curve"),
        },
        _velocity_set,
    ),
    Check(
        "velocity_position",
        16,
        "Do velocity and position agree?",
        "One of them has a wrong scale or unit. Compare with a ruler and a watch.",
        {
            "suspect": Limit(0.03, "1", "encoder and tachometer agree within 1 %"),
            "fail": Limit(0.20, "1", "one of the two is wrong"),
            "errors": Limit(3.0, "1", "differences below three standard errors are not detectable"),
        },
        _velocity_position,
    ),
    Check(
        "clock_shift",
        17,
        "Are the clocks of the two logs matched?",
        "State clock_shift in [[run]], or record a common mark, e.g. a start.",
        {
            "suspect": Limit(
                0.10, "1", "the usual trim, 10 % of the duration, covers two standard errors"
            ),
            "fail": Limit(0.50, "1", "segments and forces no longer match"),
        },
        _clock_shift,
    ),
)
