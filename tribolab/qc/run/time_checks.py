"""Checks on the time of the samples: order, gaps, jitter, sampling rate, restarts."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.arrays.chunks import anywhere
from tribolab.arrays.scratch import filled
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.qc.flags import FAIL, GOOD, SUSPECT, uniform
from tribolab.qc.register import Check, Result, Skip, sample_result
from tribolab.qc.run import timing
from tribolab.qc.run.subject import RunSubject


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
    # segments never extend across a gap, so that gaps between long parts are harmless
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


_COUNTER = 0.1  # a number that changes in a larger share of the samples counts turns, not steps


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


TIME_CHECKS = (
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
)
