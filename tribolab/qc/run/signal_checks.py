"""Checks on each signal, sample by sample: missing, stuck, clipped, coarse, outlying values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tribolab.arrays.chunks import one_by_one
from tribolab.core.errors import AnalysisError
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.friction.oscillation.spectrum.noise import noise_level, quantisation_step
from tribolab.qc import signals
from tribolab.qc.flags import FAIL, GOOD, NOT_EVALUATED, SUSPECT, uniform
from tribolab.qc.register import OBJECTIONS, Check, Result, Skip, sample_result
from tribolab.qc.run.subject import RunSubject
from tribolab.qc.run.timing import time_gaps
from tribolab.reading.dialect.formula import names_in, parse_formula


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
    """Return flags without those on zeros outside segments: an unloaded sensor reads 0 there."""
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
    """Return whether a force is computed only from stated values, e.g. one load for each step."""
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
        step, noise = quantisation_step(values), noise_level(values)
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
    """Return indices of the samples before and after each start of a step, or gap in time."""
    starts = np.flatnonzero(time_gaps(subject.time) == SUSPECT)
    steps = subject.run.get("step")
    if steps is not None:
        starts = np.concatenate([starts, np.flatnonzero(np.diff(steps.values)) + 1])
    return np.unique(np.clip(np.concatenate([starts - 1, starts]), 0, subject.time.size - 1))


def _mean_shift(values: np.ndarray, flags: np.ndarray) -> float:
    """Return by what share the outliers change the mean magnitude of a signal."""
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
_STRONG = 0.03  # standard deviation divided by friction, above which an oscillation is stick-slip


def _sticks_and_slips(subject: RunSubject) -> bool:
    try:
        return bool(np.isfinite(subject.strong_periods(_STRONG)).any())
    except (Skip, AnalysisError):
        return False


SIGNAL_CHECKS = (
    Check(
        "missing",
        6,
        "Are values missing?",
        "Look for error codes and empty cells in these rows of the file.",
        {
            "suspect": Limit(1e-3, "1", "single missing samples do not affect a mean"),
            "fail": Limit(0.10, "1", "if a tenth is missing, whole segments are affected"),
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
