"""Notices on one run: decisions, objections of checks, peculiarities."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.attributes import RunAttributes, SegmentAttributes
from tribolab.core.wording import duration, many, percent
from tribolab.friction.coefficient.steadiness import chance_limit
from tribolab.friction.oscillation import limits
from tribolab.friction.oscillation.critical_stiffness import STIFFNESS
from tribolab.friction.oscillation.waveform import CLASSES, NOT_LOOKED_AT
from tribolab.friction.segments.no_segment import why_no_segment
from tribolab.records.parts import Notice
from tribolab.records.runs.decision_rows import decision_notices
from tribolab.records.runs.notice_words import (
    DOUBTFUL_COLUMNS,
    LEFT_OUT,
    RUNNING_IN,
    STEPS,
    STICK_SLIP,
    STROKE_ENDS,
)
from tribolab.records.runs.run_facts import (
    counting,
    drift_of,
    findings_of,
    inertia_text,
    left_out,
    main_quantity,
    position_range,
    times_of_strokes,
    values_of,
)
from tribolab.records.runs.run_record import DecisionRow
from tribolab.records.runs.run_steps import steps_that_differ
from tribolab.records.runs.running_in_record import RunningIn

if TYPE_CHECKING:
    import xarray as xr


_NUMBER = re.compile(r"\d[\d.]*")
_RESULTS = (
    "each row is a result of the instrument's own at one speed: no error is known within the run, "
    "only from repeats"
)


def notices_of(
    name: str,
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset,
    decisions: Sequence[DecisionRow] = (),
    slip: xr.Dataset | None = None,
    running_in: Sequence[RunningIn] = (),
) -> list[Notice]:
    """Return the notices on a run from its decisions, checks and results."""
    notices = decision_notices(name, decisions)
    notices += [
        _check_notice(name, row)
        for row in findings_of(run)
        if row["status"] not in ("pass", "skipped") or row.get("noted")
    ]

    def say(severity: str, where: str, message: str) -> None:
        notices.append(Notice(severity, name, where, message))

    friction = counting(friction)
    count = friction.sizes["segment"]
    listed = any(row["check"] == "segments" for row in findings_of(run))
    if not listed and (why := why_no_segment(segments)):
        say("suspect", "segments", f"{why}.")
    quantity = main_quantity(friction)
    values = values_of(friction, quantity, count)
    if quantity in friction and count:
        if missing := int(np.isnan(values).sum()):
            say("suspect", "friction", f"{many(missing, 'segment')} of {count} without a number")
        if quantity == "friction_coefficient" and (against := int((values < 0).sum())):
            text = f"{many(against, 'segment')} of {count} with friction along the motion (µ < 0)"
            say("suspect", "friction", text + "; is the sign of the force or the offset right?")
    # counted as in the check on steadiness and the page's table
    limit = chance_limit(values_of(friction, "effective_samples", count))
    drift = int((values_of(friction, "trend_p_value", count) < limit).sum())
    if drift:
        text = f"{many(drift, 'segment')} of {count} with a significant trend"
        largest = drift_of(friction, values) if quantity in friction else None
        if largest:
            text += f", at most {percent(largest)} of the typical friction"
        say("note", "friction", text)
    for each in running_in:
        if each.text:
            say("suspect" if each.is_unsteady else "note", RUNNING_IN, f"{each.text}.")
    if quantity == "friction_coefficient" and quantity in friction:
        if differ := steps_that_differ(friction, values):
            say("suspect", STEPS, differ)
    for text in _remarks(friction):
        say("note", "friction", text)
    offset = SegmentAttributes.from_attrs(friction.attrs).offset
    if offset.startswith("none"):
        say("note", "friction", f"offset of the force: {offset}")
    if (track := position_range(segments)) is not None:
        low, high = (f"{1e3 * end:.4g}" for end in track)
        text = f"everything outside positions {low} to {high} mm of each stroke"
        say("note", STROKE_ENDS, text)
    about, reading = (
        SegmentAttributes.from_attrs(segments.attrs),
        RunAttributes.from_attrs(run.attrs),
    )
    if (share := about.stroke_middle) > 0 and segments.sizes["segment"]:
        whole, used = times_of_strokes(segments)
        strokes = many(segments.sizes["segment"], "stroke")
        text = f"the ends of {strokes}, outside the middle {percent(share)} of the length"
        slow = ", because sliding is slow there" if (whole - used) / whole > 1 - share else ""
        time = f"{duration(whole - used)} of {duration(whole)}"
        say("note", STROKE_ENDS, f"{text} (they take {time}{slow})")
    for entry in left_out(segments):
        text = f"{many(entry.intervals, 'interval')}, {duration(entry.duration_s)}"
        say("note", LEFT_OUT, f"{entry.reason}: {text}")
    if inertia := inertia_text(run.attrs):
        say("note", "inertia", inertia)
    if slip is not None and (distance := distance_to_critical(slip)):
        say("note", STICK_SLIP, distance)
    if reading.columns_not_used:
        say("note", "columns", f"not used: {reading.columns_not_used}")
    if reading.left_out:
        say("note", DOUBTFUL_COLUMNS, f"left out, as no result needs them: {reading.left_out}")
    if about.rows_are == "points":
        say("note", "rows", _RESULTS)
    return notices


def _remarks(friction: xr.Dataset) -> list[str]:
    """Return remarks on single segments; those that differ only by numbers appear once."""
    if "remark" not in friction:
        return []
    alike: dict[str, list[tuple[int, str]]] = {}
    remarks = friction["remark"].values.astype(str)
    numbers = friction["segment"].values if "segment" in friction.coords else range(remarks.size)
    for number, remark in zip(numbers, remarks, strict=True):
        for text in filter(None, remark.split("; ")):
            alike.setdefault(_NUMBER.sub("", text), []).append((int(number) + 1, text))
    return [
        f"segment {first}: {text}" + (f" (and {many(count, 'more segment')})" if count else "")
        for (first, text), count in ((rows[0], len(rows) - 1) for rows in alike.values())
    ]


def _check_notice(name: str, row: Mapping[str, Any]) -> Notice:
    where = f"{row['check']} {row['variable']}".strip()
    if decision := row.get("decision", ""):
        return Notice("note", name, where, f"{decision}: {row['status']}: {row['message']}.")
    severity = "note" if row["status"] in ("pass", "skipped") else row["status"]
    return Notice(severity, name, where, f"{row['message']}. {row['cure']}".strip(". ") + ".")


def distance_to_critical(slip: xr.Dataset) -> str:
    """Return a text on the ratio of the stated rig stiffness to the critical one; "" if not stated.

    Parameters
    ----------
    slip
        From `tribolab.friction.oscillation.slip_segments.stick_slip`, with the attributes of the
        run.

    Notes
    -----
    Bounds are medians over the segments. With a moving mass m, ``k_c`` is higher by up to
    ``2 m v^2/D_c^2`` (b up to 3 a): the memory length D_c [m] below which this matters is stated.
    """
    rig = float(slip.attrs.get(STIFFNESS, np.nan))
    kinds = slip["waveform"].values.astype(str)
    kinds = kinds[kinds != NOT_LOOKED_AT]
    if np.isnan(rig) or not kinds.size:
        return ""
    stated = f"stiffness of the rig {rig:.4g} N/m"
    if (kinds == CLASSES[0]).all():
        return f"{stated}: above the critical stiffness, because friction is steady at all speeds"
    steepest = slip["loading_stiffness"].values
    if (steepest > limits.MIN_SLOPE_OVER_STIFFNESS.value * rig).any():
        return (
            f"{stated}, but the force rises by {np.nanmax(steepest):.4g} N/m during sticks, which "
            "is impossible with such a soft rig. Check the stiffness and the gain of the force"
        )
    low, high = (slip[f"critical_stiffness_{end}"].values for end in ("low", "high"))
    known = np.isfinite(low)
    if not known.any():
        return f"{stated}; too few cycles of regular stick-slip to compare it with the critical one"
    ends = float(median(low[known])), float(median(high[known]))
    if np.isfinite(ends[1]):
        shares, upper = f"{rig / ends[1]:.2g} to {rig / ends[0]:.2g}", f"to {ends[1]:.3g} N/m"
    else:
        shares, upper = f"less than {rig / ends[0]:.2g}", "N/m or more"
    text = f"{stated}: {shares} of the critical stiffness ({ends[0]:.3g} {upper})"
    mass = float(slip.attrs.get("moving_mass_kg", np.nan))
    if np.isnan(mass):
        return text
    fastest = float(slip["sliding_speed"].values[known].max())
    length = 1e6 * fastest * np.sqrt(2 * mass / (limits.MIN_RISE_BY_MASS.value * ends[0]))
    return f"{text}; {mass:.3g} kg raise it if the memory length is below {length:.2g} um"
