"""Checks on what the rig did: load, speed, zero points, and whether the segments say enough."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT
from tribolab.qc.lines import find_lines, mains_harmonic
from tribolab.qc.register import Check, Limit, Result
from tribolab.qc.subject import RunSubject

_NO_SEGMENTS = "no segment of constant speed was found"


def _skip(variable: str, why: str) -> list[Result]:
    return [Result("skipped", variable, why)]


def grade(values: np.ndarray, suspect: float, fail: float) -> np.ndarray:
    """Flag values by two limits on their magnitude.

    Examples
    --------
    >>> grade(np.array([0.01, -0.2, np.nan]), 0.02, 0.1)
    array([1, 4, 2], dtype=int8)
    """
    size = np.abs(values)
    flags = np.where(size > fail, FAIL, np.where(size > suspect, SUSPECT, GOOD)).astype(np.int8)
    flags[np.isnan(values)] = NOT_EVALUATED
    return flags


def _by_segment(
    subject: RunSubject,
    variable: str,
    values: np.ndarray,
    limits: Mapping[str, float],
    what: str,
) -> list[Result]:
    """Turn one number for each segment into a result whose flags cover the samples."""
    flags = grade(values, limits["suspect"], limits.get("fail", np.inf))
    if (flags == NOT_EVALUATED).all():
        return _skip(variable, f"{what}: nothing to compare with")
    samples = np.full(subject.time.size, NOT_EVALUATED, np.int8)
    for part, flag in zip(subject.slices, flags, strict=True):
        samples[part] = flag
    bad = np.flatnonzero((flags == SUSPECT) | (flags == FAIL))
    worst = int(np.nanargmax(np.abs(values)))
    if bad.size == 0:
        text = f"{what}: at most {abs(values[worst]):.2%}"
        return [Result("pass", variable, text, float(values[worst]), flags=samples)]
    where = f"{subject.segment_label(worst)}"
    status = "fail" if (flags[bad] == FAIL).any() else "suspect"
    text = f"{what}: {values[worst]:+.2%} in {where}; {bad.size} of {flags.size} segments"
    return [Result(status, variable, text, float(values[worst]), "1", where, bad.size, samples)]


def _zero_offset(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    offsets = subject.unloaded_levels("friction_force")
    force = subject.mean_force
    if not offsets or not np.isfinite(force) or force == 0:
        return _skip("friction_force", "the zero of the force was not measured: no unloaded rest")
    share = float(np.median(offsets)) / force
    text = f"the force cell's zero lies {share:+.2%} of the friction force off"
    status = "pass"
    if abs(share) > limits["suspect"]:
        status = "fail" if abs(share) > limits["fail"] else "suspect"
    return [Result(status, "friction_force", text, share)]


def _zero_drift(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    for name in ("friction_force", "normal_force"):
        levels = subject.unloaded_levels(name)
        scale = subject.mean_force if name == "friction_force" else subject.mean_normal_force
        if len(levels) < 2 or not np.isfinite(scale) or scale == 0:
            results += _skip(name, "fewer than two unloaded rests: no drift to be seen")
            continue
        drift = (levels[-1] - levels[0]) / scale
        status = "pass"
        if abs(drift) > limits["suspect"]:
            status = "fail" if abs(drift) > limits["fail"] else "suspect"
        text = f"the zero moved by {drift:+.2%} of the signal from the first to the last rest"
        results.append(Result(status, name, text, float(drift)))
    return results


def _normal_force_error(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    target = subject.target_normal_force
    means = subject.segment_means("normal_force")
    if means.size == 0:
        return _skip("normal_force", _NO_SEGMENTS)
    if not np.isfinite(target).any():
        return _skip("normal_force", "the set-point of the normal force is not known")
    return _by_segment(
        subject, "normal_force", means / target - 1, limits, "normal force off its set-point"
    )


def _normal_force_scatter(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    means, scatter = subject.segment_means("normal_force"), subject.segment_stds("normal_force")
    if means.size == 0:
        return _skip("normal_force", _NO_SEGMENTS)
    return _by_segment(
        subject, "normal_force", scatter / means, limits, "scatter of the normal force"
    )


def _velocity_set(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    if subject.segments.sizes["segment"] == 0:
        return _skip("sliding_velocity", _NO_SEGMENTS)
    if "set_speed" not in subject.segments or subject.segments.velocity_source == "set speed":
        return _skip("sliding_velocity", "no set-point of the speed beside a measured speed")
    ratio = subject.segments["sliding_speed"] / np.abs(subject.segments["set_speed"])
    return _by_segment(
        subject, "sliding_velocity", ratio.values - 1, limits, "speed off its set-point"
    )


def _velocity_position(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    if not {"sliding_velocity", "position"} <= set(subject.run):
        return _skip("sliding_velocity", "velocity and position were not both recorded")
    if not subject.slices:
        return _skip("sliding_velocity", _NO_SEGMENTS)
    slopes = np.array([_slope(subject, part) for part in subject.slices])
    speed = subject.segments["sliding_speed"].values * subject.segments["direction"].values
    return _by_segment(
        subject, "sliding_velocity", slopes / speed - 1, limits, "d(position)/dt off the velocity"
    )


def _slope(subject: RunSubject, part: slice) -> float:
    time, position = subject.time[part], subject.signals["position"][part]
    good = np.isfinite(position)
    if good.sum() < 3:
        return float("nan")
    t = time[good] - time[good].mean()
    return float(t @ position[good] / (t @ t))


def _clock_shift(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    attrs = subject.run.attrs
    if "clock_shift_source" not in attrs:
        return _skip("time", "one clock only")
    source = str(attrs["clock_shift_source"])
    if source == "given":
        return [Result("pass", "time", "the shift between the clocks was given", unit="s")]
    error = float(attrs.get("clock_shift_uncertainty_s", np.nan))
    if source == "none" or not np.isfinite(error):
        text = "the shift between the clocks could not be told from the signals"
        return [Result("fail", "time", text, unit="s")]
    shortest = float(np.min(subject.durations, initial=np.inf))
    share = error / shortest
    text = f"the clocks are matched to {error:.3g} s, {share:.1%} of the shortest segment"
    status = "pass"
    if share > limits["suspect"]:
        status = "fail" if share > limits["fail"] else "suspect"
    return [Result(status, "time", text, error, "s")]


def _lines(subject: RunSubject, limits: Mapping[str, float], mains: bool) -> list[Result]:
    name = subject.friction_signal
    if name is None:
        return []
    looked, worst, where = 0, None, ""
    seen: dict[int, list[float]] = {}
    for number, part in enumerate(subject.slices):
        time, values = subject.time[part], subject.signals[name][part]
        if values.size < 256:
            continue
        rate = (values.size - 1) / (time[-1] - time[0])
        if rate < 2 * 65.0:
            continue
        looked += 1
        level = abs(float(np.mean(values)))
        resolution = 2 * rate / values.size
        for line in find_lines(time, values, lowest=5.0):
            is_mains = bool(mains_harmonic(line.frequency, resolution, rate))
            if is_mains != mains or line.amplitude < limits["suspect"] * level:
                continue
            if not mains:
                # stick-slip moves with the speed; an instrument's line stays where it is
                key = round(np.log(line.frequency) / 0.03)
                seen.setdefault(key, []).append(subject.speed_of(number))
                speeds = seen[key] + seen.get(key - 1, []) + seen.get(key + 1, [])
                if max(speeds) < 2 * min(speeds):
                    continue
            share = line.amplitude / level
            if worst is None or share > worst[0]:
                worst = (share, line.frequency)
                where = subject.segment_label(number)
    if looked == 0:
        return _skip(name, "sampled too slowly to resolve such lines")
    kind = "mains hum" if mains else "a resonance"
    if worst is None:
        return [Result("pass", name, f"no line of {kind} above the limit", 0.0)]
    share, frequency = worst
    status = "fail" if share > limits["fail"] else "suspect"
    text = f"{kind} at {frequency:.4g} Hz with an amplitude of {share:.2%} of the mean, {where}"
    return [Result(status, name, text, share, "1", where)]


def _hum(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    return _lines(subject, limits, mains=True)


def _resonance(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    return _lines(subject, limits, mains=False)


def _sign(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    name = (
        "friction_coefficient" if "friction_coefficient" in subject.friction else ("friction_force")
    )
    source = subject.segments.attrs.get("velocity_source")
    if subject.segments.sizes["segment"] == 0:
        return _skip(name, _NO_SEGMENTS)
    if source not in ("recorded", "position"):
        return _skip(name, "the direction of sliding was not recorded")
    values, error = subject.friction[name].values, subject.friction[f"{name}_sem"].values
    wrong = values < -limits["errors"] * np.nan_to_num(error)
    samples = np.full(subject.time.size, NOT_EVALUATED, np.int8)
    for part, bad in zip(subject.slices, wrong, strict=True):
        samples[part] = FAIL if bad else GOOD
    if not wrong.any():
        return [Result("pass", name, "friction opposes the motion everywhere", flags=samples)]
    first = int(np.flatnonzero(wrong)[0])
    where = subject.segment_label(first)
    text = f"friction drives the motion in {int(wrong.sum())} segments, first in {where}"
    value = float(values[first])
    unit = "1" if name == "friction_coefficient" else "N"
    return [Result("fail", name, text, value, unit, where, int(wrong.sum()), samples)]


def _steadiness(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    friction = subject.friction
    if friction.sizes["segment"] == 0:
        return _skip("friction_coefficient", _NO_SEGMENTS)
    name = next((n for n in ("friction_coefficient", "friction_force") if n in friction), None)
    if name is None or "trend_change" not in friction:
        return _skip("friction_coefficient", "no friction was recorded")
    change = friction["trend_change"].values / np.abs(friction[name].values)
    significant = friction["trend_p_value"].values < limits["chance"]
    change = np.where(significant, change, np.sign(change) * 0.0)
    return _by_segment(subject, name, change, limits, "trend within a segment")


def _distance(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    distance = subject.segments["sliding_distance"].values
    if distance.size == 0:
        return _skip("sliding_distance", _NO_SEGMENTS)
    if not np.isfinite(distance).any():
        return _skip("sliding_distance", "no sliding distance is known")
    results = []
    if np.isfinite(subject.contact_width):
        share = distance / subject.contact_width
        shortest = int(np.nanargmin(share))
        text = f"the shortest slide is {share[shortest]:.3g} of the contact width"
        status = "pass" if share[shortest] >= limits["contact_widths"] else "suspect"
        where = subject.segment_label(shortest)
        value = float(share[shortest])
        results.append(Result(status, "sliding_distance", text, value, "1", where))
    else:
        results += _skip("sliding_distance", "the contact width is not known")
    periods = np.array([subject.periods(number) for number in range(distance.size)])
    if np.isfinite(periods).any():
        fewest = int(np.nanargmin(periods))
        text = f"the fewest stick-slip periods in a segment are {periods[fewest]:.3g}"
        status = "pass" if periods[fewest] >= limits["periods"] else "suspect"
        where = subject.segment_label(fewest)
        value = float(periods[fewest])
        results.append(Result(status, "sliding_distance", text, value, "1", where))
    return results


def _sampling(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    counts = subject.segments["samples"].values
    periods = np.array([subject.periods(number) for number in range(counts.size)])
    if counts.size == 0:
        return _skip("friction_force", _NO_SEGMENTS)
    if not np.isfinite(periods).any():
        return [Result("pass", "friction_force", "no stick-slip to resolve")]
    per_period = counts / periods
    worst = int(np.nanargmin(per_period))
    text = f"the fastest stick-slip has {per_period[worst]:.3g} samples in a period"
    status = "pass" if per_period[worst] >= limits["samples"] else "suspect"
    where = subject.segment_label(worst)
    return [Result(status, "friction_force", text, float(per_period[worst]), "1", where)]


_OFF = "Calibrate or zero the instrument; check what the file calls its unit."

SLIDING_CHECKS = (
    Check(
        "zero_offset",
        11,
        "Does the friction force read zero when nothing slides?",
        "Zero the force cell before loading. The offset was removed, and is listed.",
        {
            "suspect": Limit(0.10, "1", "a tenth is removed well only if it stays the same"),
            "fail": Limit(1.0, "1", "an offset as large as the signal hides a change of range"),
        },
        _zero_offset,
    ),
    Check(
        "zero_drift",
        12,
        "Does the zero stay where it was?",
        "Let the amplifier warm up; measure strokes both ways, whose half loop drops a drift.",
        {
            "suspect": Limit(0.02, "1", "2 % is as much as repeats usually differ"),
            "fail": Limit(0.20, "1", "a fifth of the signal is no longer a correction"),
        },
        _zero_drift,
    ),
    Check(
        "normal_force_error",
        13,
        "Is the normal force what it was set to?",
        _OFF,
        {
            "suspect": Limit(0.03, "1", "friction coefficients of Hertz contacts go as F^-1/3"),
            "fail": Limit(0.15, "1", "half the step to the next load that is usually chosen"),
        },
        _normal_force_error,
    ),
    Check(
        "normal_force_scatter",
        14,
        "Does the load control hold the normal force?",
        "Check the control loop and the flatness of the counter body.",
        {
            "suspect": Limit(0.03, "1", "three times what a good control leaves"),
            "fail": Limit(0.20, "1", "the load is not one load any more"),
        },
        _normal_force_scatter,
    ),
    Check(
        "velocity_set",
        15,
        "Is the speed what it was set to?",
        _OFF,
        {
            "suspect": Limit(0.03, "1", "stages keep their speed to 1 %"),
            "fail": Limit(0.20, "1", "a fifth moves the point on a Stribeck curve visibly"),
        },
        _velocity_set,
    ),
    Check(
        "velocity_position",
        16,
        "Do velocity and position agree?",
        "One of the two has a wrong scale or unit; compare with a ruler and a watch.",
        {
            "suspect": Limit(0.03, "1", "encoder and tachometer agree to 1 %"),
            "fail": Limit(0.20, "1", "one of the two is wrong"),
        },
        _velocity_position,
    ),
    Check(
        "clock_shift",
        17,
        "Are the clocks of the two logs matched?",
        "Give the shift (clock_shift), or record a common mark such as a start and a stop.",
        {
            "suspect": Limit(0.05, "1", "half of the trim of 10 % at each end"),
            "fail": Limit(0.50, "1", "segments and forces no longer belong together"),
        },
        _clock_shift,
    ),
    Check(
        "hum",
        18,
        "Does the mains hum in the friction signal?",
        "Look for ground loops and unshielded cables.",
        {
            "suspect": Limit(0.01, "1", "1 % of the signal: seen in spectra, not yet in means"),
            "fail": Limit(0.50, "1", "the signal is mostly hum"),
        },
        _hum,
    ),
    Check(
        "resonance",
        19,
        "Does the rig itself ring?",
        "A line that stays at its frequency at any speed is the rig's; stiffen or damp it.",
        {
            "suspect": Limit(0.01, "1", "1 % of the signal: seen in spectra, not yet in means"),
            "fail": Limit(0.50, "1", "the signal is mostly the rig's own motion"),
        },
        _resonance,
    ),
    Check(
        "friction_sign",
        20,
        "Does friction oppose the motion?",
        "Set `sign = -1` for the force or the velocity in the dialect.",
        {"errors": Limit(3.0, "1", "friction that is zero within its error has no sign")},
        _sign,
    ),
    Check(
        "steadiness",
        21,
        "Is friction steady within each trimmed segment?",
        "Slide longer, or trim more: the mean of a trend is a mean over the run-in.",
        {
            "suspect": Limit(0.05, "1", "5 % is above the usual spread of repeats"),
            "fail": Limit(0.50, "1", "the number has no meaning as a mean"),
            "chance": Limit(0.01, "1", "so that noise is rarely called a trend"),
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
                0.03, "1", "asperities (tens of um) renew many times; shear takes about as much"
            ),
            "periods": Limit(4.0, "1", "a mean over fewer periods depends on where it is cut"),
        },
        _distance,
    ),
    Check(
        "sampling",
        23,
        "Is stick-slip sampled fast enough?",
        "Sample faster at this speed.",
        {"samples": Limit(8.0, "1", "fewer than 8 in a period round off the drop")},
        _sampling,
    ),
)
