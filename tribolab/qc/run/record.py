"""Checks on the time and on each signal, sample by sample."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tribolab.arrays.chunks import anywhere, one_by_one
from tribolab.arrays.scratch import filled
from tribolab.core.errors import AnalysisError, shown
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.friction.oscillation.spectrum.noise import quantisation_step
from tribolab.qc import signals
from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT, uniform
from tribolab.qc.register import OBJECTIONS, Check, Result, Skip, sample_result
from tribolab.qc.run import schema, timing
from tribolab.qc.run.subject import RunSubject
from tribolab.reading.dialect.formula import names_in, parse_formula

_DEAD_CHANNEL = 0.10  # share of missing samples; a tenth of a signal can be whole segments


def _schema(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    run = subject.run
    results = [Result("suspect", "", text, cure=cure) for text, cure in schema.missing_signals(run)]
    for name, unit in schema.wrong_units(run).items():
        results.append(Result("fail", name, f"{name} is in '{shown(unit)}', not in SI"))
    for name, span in one_by_one(schema.ranges().items()):
        if name not in run:
            continue
        flags = schema.flag_range(run[name].values, span)
        text = f"{{count:value|values}} outside {span.low:g} to {span.high:g}: "
        text += f"{span.reason}; {{where}}"
        results.append(sample_result(name, flags, subject.time, text))
    if "normal_force" in run:
        share = schema.tensile_share(run["normal_force"].values)
        if share > limits["pulled"]:
            text = f"the normal force is negative in {share:.0%} of the loaded samples"
            results.append(Result("fail", "normal_force", text, share))
    return results


def _time_order(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    flags = timing.time_order(subject.time)
    text = "time does not increase at {count:sample|samples}, {where}"
    return [sample_result("time", flags, subject.time, text)]


def _time_gaps(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    time = subject.time
    flags = timing.time_gaps(time, limits["intervals"], _step_changes(subject))
    if not anywhere(lambda part: part == SUSPECT, flags):
        return [sample_result("time", flags, time, "")]
    lost = timing.lost_time(time, flags)
    longest = float(timing.lengths_of_gaps(time, flags).max())
    text = f"{{count:gap|gaps}} in time, the longest {longest:.4g} s, {{where}}"
    # no segment extends across a long pause, and the parts between pauses are complete
    parts = np.diff(np.concatenate([[0], np.flatnonzero(flags == SUSPECT), [flags.size]]))
    if lost > limits["lost"] and np.median(parts) < limits["whole"]:
        flags = np.where(flags == SUSPECT, FAIL, flags).astype(np.int8)
    return [sample_result("time", flags, time, text, value=lost)]


def _time_jitter(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    flags = timing.time_jitter(subject.time, limits["scatter"])
    text = "the sampling interval varies over {count:sample|samples}, {where}"
    return [sample_result("time", flags, subject.time, text)]


def _rate_changes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    time = subject.time
    cuts = []
    for part in subject.slices if subject.sliding else []:
        cut = timing.rate_change(time[part], limits["factor"])
        if cut is not None:
            cuts.append(part.start + cut)
    if cuts:
        flags = filled(time.size, GOOD, np.int8)
        flags[cuts] = SUSPECT
        text = "the sampling rate changes within a segment {count:time|times}, {where}"
        return [sample_result("time", flags, time, text)]
    places = timing.rate_changes(time, limits["factor"])
    text, where = "one sampling rate", ", ".join(f"t = {time[p]:.6g} s" for p in places[:5])
    if places.size:
        text = f"the sampling rate changes {Count(places.size):time|times}"
        text += f", never within a trimmed segment: {where}" + (" ..." if places.size > 5 else "")
    seen, flags = places.size > 0, uniform(time.size, GOOD)
    return [Result("pass", "time", text, float(places.size), where=where, flags=flags, noted=seen)]


_COUNTER = 0.1  # share of the samples above which a changing number counts turns, not steps


def _step_changes(subject: RunSubject) -> np.ndarray:
    """Return the indices of samples at which a step or cycle of the instrument begins."""
    changed = np.zeros(subject.time.size, dtype=bool)
    for name in ("step", "cycle"):
        if name in subject.run:
            label = subject.run[name].values
            other = label[1:] != label[:-1]
            if other.sum() < _COUNTER * other.size:
                changed[1:] |= other
    return np.flatnonzero(changed)


def _restarts(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    joined = subject.about.clock_joined
    joins = [Result("pass", "time", joined, noted=True)] if joined else []
    if not {"step", "cycle"} & set(subject.run):
        if joined:
            return joins
        raise Skip("the file has no step or cycle numbers")
    changes = _step_changes(subject)
    if not changes.size:
        return joins or [Result("pass", "step", "one step", 1.0)]
    text = f"the file contains {changes.size + 1} steps"
    where = ", ".join(f"t = {subject.time[c]:.6g} s" for c in changes[:5])
    where += " ..." if changes.size > 5 else ""
    text += f"; the first one ends at {where}"
    return [Result("pass", "step", text, float(changes.size + 1), where=where, noted=True), *joins]


def _missing(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    for name, values in one_by_one(subject.signals.items()):
        flags = signals.missing(values)
        count = int(np.isnan(values).sum())
        share = count / values.size
        if count == 0:
            results.append(Result("pass", name, "nothing missing", 0.0, flags=flags))
            continue
        status = "fail" if share > limits["fail"] else "suspect"
        if share <= limits["suspect"]:
            status = "pass"
        first = int(np.flatnonzero(np.isnan(values))[0])
        where = f"first at t = {subject.time[first]:.6g} s (sample {first})"
        text = f"{Count(count):sample|samples} ({share:.2%}) without a value, {where}"
        results.append(Result(status, name, text, share, "1", where, count, flags, noted=True))
    return results


def _stuck(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    text = "{count:sample is|samples are} constant for longer than noise allows, {where}"
    # forces that are computed from a load stated in the file
    stated = subject.about.derived
    results = []
    for name, values in one_by_one(subject.force_signals.items()):
        steady = bool(np.nanmin(values) == np.nanmax(values))
        if name in stated and (steady or _is_stated(subject, name)):
            good = uniform(values.size, GOOD)
            reason = f"{'constant during the whole run: ' if steady else ''}stated and not measured"
            results.append(Result("pass", name, reason, 0.0, flags=good))
            continue
        if name == "normal_force" and _is_set(subject, values):
            good = uniform(values.size, GOOD)
            reason = "constant during the run while friction changes: a set-point or a dead "
            reason += "sensor. Name the column of a set-point set_normal_force"
            results.append(Result("suspect", name, reason, 0.0, flags=good))
            continue
        flags = _drop_rests(subject, values, signals.stuck(values, limits["chance"]))
        results.append(sample_result(name, flags, subject.time, text, fail_share=limits["fail"]))
    return results


def _drop_rests(subject: RunSubject, values: np.ndarray, flags: np.ndarray) -> np.ndarray:
    """Return flags without those at zeros outside segments, where an unloaded sensor reads 0."""
    if not (subject.sliding and (flags == SUSPECT).any()):
        return flags
    return np.where((values == 0) & ~subject.segment_mask, np.int8(GOOD), flags)


def _is_set(subject: RunSubject, load: np.ndarray) -> bool:
    """Return whether the load is a set-point: constant and not 0, while friction varies."""
    if not (np.nanmin(load) == np.nanmax(load) != 0):
        return False
    others = [values for name, values in subject.force_signals.items() if name != "normal_force"]
    return any(np.nanmin(values) < np.nanmax(values) for values in others)


def _is_stated(subject: RunSubject, name: str) -> bool:
    """Return whether a force is computed from stated values only, which may change by step."""
    formula = subject.about.derived.get(name)
    if formula is None or formula == "stated":
        return formula is not None
    return not names_in(parse_formula(formula)) & set(subject.about.columns_used)


def _saturation(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    for name, values in one_by_one(subject.force_signals.items()):
        if _is_stated(subject, name):
            reason = "stated and not measured"
            results.append(Result("pass", name, reason, 0.0, flags=uniform(values.size, GOOD)))
            continue
        flags = _drop_rests(subject, values, signals.saturation(values))
        ends = f"{np.nanmax(values):.6g} or {np.nanmin(values):.6g} {subject.unit(name)}"
        text = f"{{count:sample is|samples are}} clipped at the end of the range ({ends}), "
        text += "{where}"
        results.append(sample_result(name, flags, subject.time, text, fail_share=limits["fail"]))
    return results


def _quantisation(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    for name, values in one_by_one(subject.force_signals.items()):
        if np.nanmin(values) == np.nanmax(values):
            results.append(Result("pass", name, "one value for all of the run", 0.0))
            continue
        if _is_stated(subject, name):
            results.append(Result("pass", name, "stated and not measured", 0.0))
            continue
        step, noise = quantisation_step(values), subject.noise(name)
        if step == 0:
            text = "values do not repeat: no quantisation visible"
            results.append(Result("pass", name, text, 0.0))
            continue
        typical = subject.typical_size(name)
        ratio = step / typical if typical > 0 else float("inf")
        coarse = step > limits["steps"] * max(noise, 1e-300) and ratio > limits["share"]
        text = (
            f"the resolution is {step:.4g} {subject.unit(name)}, {ratio:.2%} of the signal; "
            f"the noise is {noise:.4g} {subject.unit(name)}"
        )
        results.append(Result("suspect" if coarse else "pass", name, text, ratio))
    return results


def _spikes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    results = []
    joins = _step_borders(subject)
    for name, values in one_by_one(subject.force_signals.items()):
        flags = signals.spikes(values, limits["noise"])
        flags[joins] = NOT_EVALUATED  # the samples before belong to another step
        text = "{count:sample is an isolated outlier|samples are isolated outliers}, {where}"
        result = sample_result(name, flags, subject.time, text, fail_share=limits["fail"])
        if result.status in OBJECTIONS:
            moved = _mean_shift(values, flags)
            if moved > limits["mean"]:
                text = f"{result.message}; they change the mean magnitude by {moved:.1%}"
                result = replace(result, message=text, cure=_MOVED)
            elif _sticks_and_slips(subject):
                result = replace(result, cure=_SLIPS)
        results.append(result)
    return results


def _step_borders(subject: RunSubject) -> np.ndarray:
    """Return the samples on both sides of each start of a step or of a continued record."""
    starts = np.flatnonzero(timing.time_gaps(subject.time) == SUSPECT)
    steps = subject.run.get("step")
    if steps is not None:
        starts = np.concatenate([starts, np.flatnonzero(np.diff(steps.values)) + 1])
    return np.unique(np.clip(np.concatenate([starts - 1, starts]), 0, subject.time.size - 1))


def _mean_shift(values: np.ndarray, flags: np.ndarray) -> float:
    """Return the relative change of a signal's mean magnitude by its outliers."""
    places = np.flatnonzero((flags == SUSPECT) | (flags == FAIL))
    before, after = np.maximum(places - 1, 0), np.minimum(places + 1, values.size - 1)
    usual = 0.5 * (values[before] + values[after])
    size = float(np.nansum(np.abs(values))) - float(np.nansum(np.abs(values[places])))
    size += float(np.nansum(np.abs(usual)))
    return abs(float(np.nansum(values[places] - usual))) / size if size > 0 else 0.0


_MOVED = (
    "If the value is a code for overload or for no value, list it in the dialect: `missing` under "
    "[text]."
)

_SLIPS = (
    "The contact sticks and slips. A slip shorter than a sample looks like this; record faster to "
    "resolve it. Outliers at rest are a disturbance. The mean hardly changes."
)
_STRONG = 0.03  # standard deviation over friction above which an oscillation is stick-slip


def _sticks_and_slips(subject: RunSubject) -> bool:
    try:
        return bool(np.isfinite(subject.strong_periods(_STRONG)).any())
    except (Skip, AnalysisError):
        return False


RECORD_CHECKS = (
    Check(
        "schema",
        0,
        "Do the signals exist, in SI units, and within physical limits?",
        "Correct quantity, unit, sign or scale of the column in the dialect.",
        {"pulled": Limit(0.5, "1", "bodies that are separated most of the time do not slide")},
        _schema,
    ),
    Check(
        "time_order",
        1,
        "Does time increase from sample to sample?",
        "Export the file again, or state in the dialect what to do ([time]).",
        {},
        _time_order,
    ),
    Check(
        "time_gaps",
        2,
        "Are there gaps in time?",
        "Check whether the logger lost data or paused. Segments end at long gaps.",
        {
            "intervals": Limit(5.0, "1", "late buffers cause gaps of 2 to 3 intervals"),
            "lost": Limit(
                0.2, "1", "if a fifth is missing, the record does not represent the experiment"
            ),
            "whole": Limit(100, "1", "this many samples between pauses are a separate record"),
        },
        _time_gaps,
    ),
    Check(
        "time_jitter",
        3,
        "Are the samples evenly spaced?",
        "Spectra need correct times: use a hardware clock for the logger.",
        {"scatter": Limit(0.25, "1", "larger scatter smears lines of the spectrum")},
        _time_jitter,
    ),
    Check(
        "rate_changes",
        4,
        "Does the sampling rate change within a segment?",
        "Means are weighted by time, but spectra and errors need one rate. Set the rate "
        "of the logger before the segment starts.",
        {
            "factor": Limit(
                1.5,
                "1",
                ("more than the drift of a clock, less than a step between logger settings"),
            )
        },
        _rate_changes,
    ),
    Check(
        "restarts",
        5,
        "Does the file contain several steps with separate headers or clocks?",
        "No action needed: the steps are joined as stated in the dialect.",
        {},
        _restarts,
    ),
    Check(
        "missing",
        6,
        "Are values missing?",
        "Look for error codes and empty cells in these rows of the file.",
        {
            "suspect": Limit(1e-3, "1", "single missing samples do not affect a mean"),
            "fail": Limit(_DEAD_CHANNEL, "1", "if a tenth is missing, whole segments are affected"),
        },
        _missing,
    ),
    Check(
        "stuck",
        7,
        "Does a force signal stay constant?",
        "Check cable and amplifier: a working signal has noise.",
        {
            "chance": Limit(1e-6, "1", "one false alarm in a million records"),
            "fail": Limit(
                0.01, "1", ("1 % of constant samples changes the mean by about its standard error")
            ),
        },
        _stuck,
    ),
    Check(
        "saturation",
        8,
        "Does a force signal reach the end of its range?",
        "Choose a larger amplifier range or force cell and measure again.",
        {"fail": Limit(1e-3, "1", "clipping biases the mean; a few samples do not matter")},
        _saturation,
    ),
    Check(
        "quantisation",
        9,
        "Is the converter step small compared with noise and signal?",
        "Choose a smaller amplifier range.",
        {
            "steps": Limit(2.0, "1", "noise below half a step no longer averages out"),
            "share": Limit(0.005, "1", "0.5 % of the signal is below the usual scatter"),
        },
        _quantisation,
    ),
    Check(
        "spikes",
        10,
        "Are there spikes in single samples?",
        "Look for switching devices nearby. Spikes hardly affect means, but they change extremes "
        "and spectra.",
        {
            "noise": Limit(8.0, "1", "Gaussian noise exceeds it once in 1e15 samples"),
            "fail": Limit(0.01, "1", "a disturbance of 1 % of the samples is not rare"),
            "mean": Limit(0.005, "1", "a change of the mean by 0.5 % is not negligible"),
        },
        _spikes,
    ),
)
