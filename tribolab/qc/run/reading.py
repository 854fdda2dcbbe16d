"""Checks on how a file was read: lost rows, and missing information."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.errors import AnalysisError
from tribolab.core.limit import Limit
from tribolab.core.wording import Count
from tribolab.friction.segments.strokes import find_strokes
from tribolab.qc.register import Check, Result, Skip
from tribolab.qc.run.subject import RunSubject
from tribolab.reading.runs.force_ratio import LARGEST, SMALLEST


def _rows_left_out(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    attrs = subject.run.attrs
    if "rows_in_file" not in attrs:
        raise Skip("the number of rows in the file is not known")
    results = []
    for log, variable in (("", "time"), ("companion_", "companion log")):
        rows = int(attrs.get(f"{log}rows_in_file", 0))
        lost = int(attrs.get(f"{log}rows_left_out", 0))
        share = lost / rows if rows else 0.0
        if not lost:
            if rows:
                results.append(Result("pass", variable, "every row was read", 0.0))
            continue
        text = f"{lost} of {Count(rows):row|rows} ({share:.2%}) left out: "
        text += str(attrs.get(f"{log}rows_left_out_why", ""))
        status = "fail" if share > limits["fail"] else "suspect"
        status = status if share > limits["suspect"] else "pass"
        results.append(Result(status, variable, text, share, count=lost, noted=True))
    return results + _uncovered_rows(subject, limits)


def _uncovered_rows(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    alone = subject.about.rows_not_covered
    if not alone:
        return []
    share = alone / (alone + subject.time.size)
    seconds = alone * float(median(np.diff(subject.time)))
    odd = share > limits["suspect"] and seconds > limits["not_covered"]
    text = f"{Count(alone):row|rows} ({share:.2%}, some {seconds:.3g} s) at the ends are left out, "
    text += "because the companion log does not cover them"
    cure = "Check that both logs are complete and of this run, and that the clock shift is right."
    return [
        Result(
            "suspect" if odd else "pass",
            "companion log",
            text,
            share,
            count=alone,
            noted=odd,
            cure=cure,
        )
    ]


def _assumed_values(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    attrs = subject.run.attrs
    results = []
    if "forces_left_out" in attrs:
        text = f"left out: {attrs['forces_left_out']}".replace("_", " ")
        results.append(Result("suspect", "friction_force", text))
    if "assumed" in attrs:
        text = "not in the file, taken from the instrument's description: "
        text += str(attrs["assumed"]).replace("_", " ")
        results.append(Result("pass", "settings", text, noted=True))
    results += _stated_strokes(subject, limits)
    with contextlib.suppress(Skip):  # without friction there is nothing to compare
        results += _recorded_coefficient(subject, limits) + _impossible_coefficient(subject)
    if results:
        return results
    raise Skip("no value was assumed for the file")


def _stated_strokes(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report a number of strokes in the file that the position signal contradicts."""
    attrs = subject.run.attrs
    stated_values = [float(attrs.get(name, np.nan)) for name in _STATED]
    if not np.isfinite(stated_values).any() or "position" not in subject.run:
        return []
    try:
        strokes = find_strokes(subject.run)
    except AnalysisError:
        return []
    lasted = np.diff(subject.time[strokes.first])[strokes.usual]
    if not lasted.size:
        return []
    length, lasts = float(median(strokes.length[strokes.usual])), float(median(lasted))
    # the stated speed may be the mean of a stroke, or the peak of a sine
    speed = float(np.clip(stated_values[-1], length / lasts, 0.5 * np.pi * length / lasts))
    found = (length, 0.5 / lasts, 0.5 * int(strokes.usual.sum()), speed)
    words = ("{0:.4g} mm strokes", "{0:.4g} Hz", "{0:.0f} cycles", "{0:.3g} mm/s")
    results = []
    for stated, measured, text, unit in zip(
        stated_values, found, words, (1e3, 1.0, 1.0, 1e3), strict=True
    ):
        apart = abs(measured - stated) / stated if stated > 0 else np.nan
        if not np.isfinite(apart):
            continue
        beyond = apart > limits["apart"] and abs(measured - stated) > (text == words[2])
        text_of_both = f"the file states {text.format(unit * stated)}, its position signal shows "
        text_of_both += text.format(unit * measured)
        results.append(
            Result("suspect" if beyond else "pass", "position", text_of_both, apart, cure=_STROKES)
        )
    return results


_STATED = ("stated_stroke_m", "stated_stroke_frequency_Hz", "stated_cycles", "stated_speed_m_s")
_STROKES = (
    "One of the two has a wrong scale, unit or sampling rate, which makes the speed wrong; or the "
    "record contains only part of the test."
)


def _impossible_coefficient(subject: RunSubject) -> list[Result]:
    """Report a friction coefficient that is impossibly large or small."""
    if not subject.sliding or "friction_coefficient" not in subject.friction:
        return []
    values = np.abs(subject.friction["friction_coefficient"].values)
    known = values[np.isfinite(values)]
    size = float(median(known)) if known.size else 0.0
    if size == 0 or SMALLEST <= size <= LARGEST:
        return []
    text = f"the friction coefficient is {size:.3g}, which is impossible"
    cure = "Check that friction and load are not swapped, that their units are right, and that a "
    cure += "recorded coefficient is not in percent."
    return [Result("suspect", "friction_coefficient", text, size, cure=cure)]


def _recorded_coefficient(subject: RunSubject, limits: Mapping[str, float]) -> list[Result]:
    """Report a recorded coefficient that differs from the ratio of the forces in the segments."""
    run = subject.run
    if not ({"friction_coefficient", "friction_force"} <= set(run.variables) and subject.sliding):
        return []
    if "normal_force" not in run or "friction_coefficient" not in subject.friction:
        return []
    recorded = np.abs(subject.segment_means("friction_coefficient"))
    # either with or without the zero: the file's coefficient may include it
    raw = np.abs(subject.segment_means("friction_force"))
    raw = raw / np.abs(subject.segment_means("normal_force"))
    found = np.abs(subject.friction["friction_coefficient"].values)
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.minimum(np.abs(recorded / raw - 1), np.abs(recorded / found - 1))
    known = np.isfinite(apart) & (recorded > 0)
    if not known.any():
        return []
    middle = float(median(apart[known]))
    levels = (float(median(values[known])) for values in (recorded, found))
    text = "the file records a coefficient of {:.4g}, its forces give {:.4g}".format(*levels)
    if middle <= limits["apart"]:
        return [Result("pass", "friction_coefficient", text, middle)]
    return [
        Result(
            "suspect",
            "friction_coefficient",
            f"{text}, which is used",
            middle,
            cure="Find out which is right: only one of them may include a gain, a lever arm or the "
            "set load. To use the recorded coefficient, remove the 'friction_force' column "
            "from the instrument's description.",
        )
    ]


READING_CHECKS = (
    Check(
        "rows_left_out",
        25,
        "Was every row of the file read?",
        "State in the dialect how to keep all rows (restart, on_repeat, end).",
        {
            "suspect": Limit(
                0.01, "1", "one incomplete row or a few repeated time stamps are no loss"
            ),
            "fail": Limit(0.10, "1", "a tenth of the record contains whole segments"),
            "not_covered": Limit(5.0, "s", "two logs are started within some seconds"),
        },
        _rows_left_out,
    ),
    Check(
        "said_elsewhere",
        27,
        "Do default values apply to this file, and do redundant data in it agree?",
        "State the values of this machine in a copy of the instrument's dialect: the "
        "default of its [[value]].",
        {"apart": Limit(0.1, "1", "filter and zero of an instrument cause smaller differences")},
        _assumed_values,
    ),
)
