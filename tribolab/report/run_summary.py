"""What the report says of one run: its figures and its numbers, made by a worker."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.errors import AnalysisError, told
from tribolab.friction.segments.find import why_no_segment
from tribolab.report.figure_files import DRAWING, save_figure
from tribolab.report.judgement import SURE, not_decided
from tribolab.report.tables import friction_table
from tribolab.report.traces import as_text, finer_trace, flagged_spans, trace
from tribolab.report.wording import SPREAD_OF, SYMBOLS, UNITS, plain_value
from tribolab.words import duration, explain, many, percent, span, speeds

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from tribolab.campaign.outcome import RunOutcome

_SPEED_TOLERANCE = 0.1


@dataclass(frozen=True)
class RunTask:
    """A run to describe, the folder of the results, and what its traces may have.

    `points` of each signal are shown at once; the finer trace, into which the page zooms, may
    have `fine_size` characters.
    """

    run: RunOutcome
    folder: Path
    points: int = 4000
    fine_size: int = 0

    @property
    def key(self) -> str:
        """What the run's own files are called."""
        return Path(self.run.data_file).stem


@dataclass(frozen=True)
class RunSummary:
    """What a worker hands back: numbers ready for report.json, the table, the findings."""

    name: str
    facts: dict[str, Any]
    table: pd.DataFrame
    findings: tuple[dict[str, str], ...]
    key: str = ""
    trace: str = ""  # for the page, as JSON
    fine: str = ""  # with more points, as JSON


def summarise_run(task: RunTask) -> RunSummary:
    """Open a run's data file, draw its figures into the results, and collect its numbers."""
    from tribolab.io.netcdf import read_groups

    path = task.folder / task.run.data_file
    with DRAWING:
        parts = read_groups(path, ("run", "segments", "friction", "stick_slip"))
        run, segments, friction, slip = parts.values()
        findings = _findings(task.run.name, run, segments, friction)
        figures = _figures(task, run, segments, friction, findings)
        packed, fine = _traces(task, run, segments, friction, findings)
    table = friction_table(friction)
    facts = {
        **_of_record(run),
        **_of_friction(friction),
        "position_range_m": position_range(segments),
        "stick_slip": stick_slip_of(slip),
        "omitted": _omitted(segments),
        "segments": table.to_dict("records"),
        "figures": figures,
        "flagged": flagged_spans(run),
    }
    return RunSummary(
        task.run.name, plain_value(facts), table, tuple(findings), task.key, packed, fine
    )


def position_range(segments: xr.Dataset) -> list[float] | None:
    """Return the part of the track that counts [m], where the campaign file names one."""
    ends = [segments.attrs.get(f"position_{end}_m") for end in ("low", "high")]
    return None if None in ends else [float(end) for end in ends]


def main_quantity(friction: xr.Dataset) -> str:
    """Return the quantity that the report speaks of: mu, else the half loop, else the force."""
    for name in ("friction_coefficient", "half_loop", "friction_force"):
        if name in friction and np.isfinite(np.asarray(friction[name], float)).any():
            return name
    return "friction_coefficient"


def _of_record(run: xr.Dataset) -> dict[str, Any]:
    time = np.asarray(run["time"], float)
    attrs = run.attrs
    shift = {k: float(v) for k, v in attrs.items() if k in _SHIFT and not isinstance(v, str)}
    return {
        "instrument": str(attrs.get("instrument", "")),
        "quality": str(attrs.get("quality", "")),
        "checks": [
            {key: row[key] for key in ("check", "status", "variable", "message", "value", "unit")}
            for row in attrs.get("findings", [])
        ],
        "recorded_at": str(attrs.get("recorded_at", "")),
        "duration_s": float(time[-1] - time[0]) if time.size else 0.0,
        "samples": int(time.size),
        "signals": sorted(str(name) for name in run.data_vars if run[name].dims == ("time",)),
        "columns_not_used": [c for c in str(attrs.get("columns_not_used", "")).split("; ") if c],
        "clock_shift_s": shift.get("clock_shift_s"),
        "clock_shift_uncertainty_s": shift.get("clock_shift_uncertainty_s"),
        "clock_shift_source": str(attrs.get("clock_shift_source", "")),
        "history": str(attrs.get("history", "")),
    }


_SHIFT = ("clock_shift_s", "clock_shift_uncertainty_s")


def _of_friction(friction: xr.Dataset) -> dict[str, Any]:
    name = main_quantity(friction)
    value = np.asarray(friction[name], float) if name in friction else np.array([])
    of = SPREAD_OF.get(name, name)
    std = _values(friction, f"{of}_std", value.size)
    speed = _values(friction, "sliding_speed", value.size)
    finite = np.isfinite(value)
    scatter = std[finite] / np.abs(value[finite])
    scatter = scatter[np.isfinite(scatter)]
    return {
        "quantity": name,
        "offset": str(friction.attrs.get("offset", "")),
        "trim": friction.attrs.get("trim"),
        "velocity_source": str(friction.attrs.get("velocity_source", "")),
        "sliding_speed_min_m_s": np.nanmin(speed, initial=np.inf),
        "sliding_speed_max_m_s": np.nanmax(speed, initial=-np.inf),
        "value_min": value[finite].min() if finite.any() else None,
        "value_max": value[finite].max() if finite.any() else None,
        "relative_scatter": float(np.median(scatter)) if scatter.size else None,
        "relative_drift": _drift(friction, value),
        "unsteady_segments": int((_values(friction, "steady", value.size) == 0).sum()),
        "highlights": _highlights(speed, value, std, _values(friction, f"{of}_sem", value.size)),
    }


def stick_slip_of(slip: xr.Dataset) -> dict[str, str]:
    """Return the class of waveform of a run and where it is seen, for the table of runs.

    Parameters
    ----------
    slip
        From `tribolab.friction.oscillation.stick_slip.stick_slip`.
    """
    from tribolab.friction.oscillation.slip_curve import STEADY, stick_slip_curve
    from tribolab.friction.oscillation.waveform import NOT_EVALUATED, UNDECIDED, oscillating

    curve = stick_slip_curve([slip])
    over_speed = bool(curve.sizes["sliding_speed"])
    kind = (curve if over_speed else slip)["waveform"].values.astype(str)
    kind = kind[kind != NOT_EVALUATED]
    if not kind.size:
        return {"class": NOT_EVALUATED, "detail": ""}
    moving = oscillating(kind)
    if not moving.any() and (kind == UNDECIDED).any():
        what = "speed" if over_speed else "segment"
        return {
            "class": UNDECIDED,
            "detail": f"{'at' if over_speed else 'in'} {(kind == UNDECIDED).sum()} of "
            f"{many(kind.size, what)}",
        }
    if not moving.any():  # without a speed, standing still may be among the sliding
        return {"class": STEADY, "detail": "" if over_speed else "if it slides: speed not known"}
    names, counts = np.unique(kind[moving], return_counts=True)
    names = [str(name) for name in names[np.argsort(-counts, kind="stable")]]
    detail = f"at {moving.sum()} of {many(kind.size, 'speed')}"
    if not over_speed:
        detail = f"in {moving.sum()} of {many(kind.size, 'segment')}"
    if names[1:]:
        detail += f"; also {', '.join(names[1:])}"
    return {"class": names[0], "detail": detail}


def _drift(friction: xr.Dataset, value: np.ndarray) -> float | None:
    """Return the largest significant change along a segment, of the run's typical friction.

    Measured as the check on steadiness does: at high speed in a liquid hardly any friction is
    left to divide by. None where there may be one that could not be told from chance.
    """
    size = friction.sizes["segment"]
    change = _values(friction, "trend_change", size)
    if "force_trend" in friction and "trend_change" not in friction:
        lasted = _values(friction, "trimmed_stop", size) - _values(friction, "trimmed_start", size)
        change = _values(friction, "force_trend", size) * lasted
    typical = np.abs(value[np.isfinite(value)])
    if not np.isfinite(change).any() or not (typical > 0).any():
        return None
    change = change / typical.mean()
    chance, samples = (_values(friction, n, size) for n in ("trend_p_value", "effective_samples"))
    sure = chance < SURE
    if not sure.any() and not_decided(change, chance, samples).any():
        return None
    return float(np.nanmax(np.abs(change[sure]), initial=0.0))


def _values(data: xr.Dataset, name: str, size: int) -> np.ndarray:
    return np.asarray(data[name], float) if name in data else np.full(size, np.nan)


def _highlights(
    speed: np.ndarray, value: np.ndarray, std: np.ndarray, sem: np.ndarray
) -> list[dict[str, Any]]:
    """Mean at the slowest, the middle and the fastest speed, over the strokes at that speed."""
    fine = np.flatnonzero(np.isfinite(value))
    known = fine[np.isfinite(speed[fine]) & (speed[fine] > 0)]
    groups = [("all", fine)] if fine.size and not known.size else []
    if known.size:
        order = known[np.argsort(speed[known], kind="stable")]
        breaks = np.diff(np.log(speed[order])) > np.log1p(_SPEED_TOLERANCE)
        parts = np.split(order, np.flatnonzero(breaks) + 1)
        chosen = {0: "slowest", len(parts) - 1: "fastest"}
        if len(parts) > 2:
            chosen[len(parts) // 2] = "middle"
        chosen[0] = "slowest"
        groups = [(word, parts[k]) for k, word in sorted(chosen.items())]
    return [
        {
            "where": word,
            "sliding_speed_m_s": float(np.mean(speed[index])),
            "value": float(np.mean(value[index])),
            "std": float(np.sqrt(np.mean(std[index] ** 2))),
            # independent strokes: the error of their mean
            "sem": float(np.sqrt(np.sum(sem[index] ** 2)) / index.size),
            "segments": int(index.size),
        }
        for word, index in groups
    ]


def _omitted(segments: xr.Dataset) -> list[dict[str, Any]]:
    if "omitted_reason" not in segments:
        return []
    reasons = np.asarray(segments["omitted_reason"]).astype(str)
    lengths = np.asarray(segments["omitted_stop"], float) - np.asarray(segments["omitted_start"])
    return [
        {
            "reason": reason,
            "intervals": int((reasons == reason).sum()),
            "duration_s": float(lengths[reasons == reason].sum()),
        }
        for reason in dict.fromkeys(reasons.tolist())
    ]


def _findings(
    name: str, run: xr.Dataset, segments: xr.Dataset, friction: xr.Dataset
) -> list[dict[str, str]]:
    found: list[dict[str, str]] = [
        {
            "severity": "note" if row["status"] in ("pass", "skipped") else row["status"],
            "run": name,
            "where": f"{row['check']} {row['variable']}".strip(),
            "message": f"{row['message']}. {row['cure']}".strip(". ") + ".",
        }
        for row in run.attrs.get("findings", [])
        if row["status"] not in ("pass", "skipped") or row.get("noted")
    ]

    def say(severity: str, where: str, message: str) -> None:
        found.append({"severity": severity, "run": name, "where": where, "message": message})

    count = segments.sizes["segment"]
    told = any(row["check"] == "segments" for row in run.attrs.get("findings", []))
    if not told and (why := why_no_segment(segments)):
        say("suspect", "segments", f"{why}.")
    quantity = main_quantity(friction)
    values = _values(friction, quantity, count)
    if quantity in friction and count:
        if missing := int(np.isnan(values).sum()):
            say("suspect", "friction", f"{many(missing, 'segment')} of {count} without a number")
        if quantity == "friction_coefficient" and (against := int((values < 0).sum())):
            text = f"{many(against, 'segment')} of {count} with friction along the motion (µ < 0)"
            say("suspect", "friction", text + "; is the sign of the force or the offset right?")
    # as the check on steadiness and the page's table count them
    drift = int((_values(friction, "trend_p_value", count) < SURE).sum())
    if drift:
        text = f"{many(drift, 'segment')} of {count} with a significant trend"
        largest = _drift(friction, values) if quantity in friction else None
        if largest:
            text += f", at most {percent(largest)} of the typical friction"
        say("note", "friction", text)
    if str(friction.attrs.get("offset", "")).startswith("none"):
        say("note", "friction", f"offset of the force: {friction.attrs['offset']}")
    if (track := position_range(segments)) is not None:
        low, high = (f"{1e3 * end:.4g}" for end in track)
        say("note", "left out", f"what lies outside positions {low} to {high} mm of each stroke")
    for entry in _omitted(segments):
        text = f"{many(entry['intervals'], 'interval')}, {duration(entry['duration_s'])}"
        say("note", "left out", f"{entry['reason']}: {text}")
    if unused := str(run.attrs.get("columns_not_used", "")):
        say("note", "columns", f"not used: {unused}")
    return found


def _figures(
    task: RunTask,
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset,
    findings: list[dict[str, str]],
) -> list[dict[str, str]]:
    from tribolab import plot

    name, made = task.run.name, []
    drawn: list[tuple[str, Callable[[], Figure], str]] = [
        ("trace", lambda: plot.trace(run, segments, friction, title=name), _TRACE)
    ]
    if segments.sizes["segment"]:
        drawn += [("strokes", lambda: plot.strokes(run, segments, friction, title=name), _STROKES)]
    if main_quantity(friction) == "half_loop":
        drawn += [("half_loop", lambda: plot.half_loop(friction, title=name), _HALF_LOOP)]
    for kind, draw, caption in drawn:
        file = f"figures/{task.key}_{kind}.svg"
        alt = f"Run {name}: {_words(friction)} {caption}"
        try:
            saved = save_figure(draw(), task.folder, file, caption, alt)
        except Exception as error:  # recorded: a figure that fails must not cost the report
            text = f"could not be drawn: {explain(error)[0]}"
            findings.append(
                {"severity": "error", "run": name, "where": f"figure {kind}", "message": text}
            )
            continue
        made.append(saved | {"kind": kind})
    return made


def _traces(
    task: RunTask,
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset,
    findings: list[dict[str, str]],
) -> tuple[str, str]:
    """Return the trace for the page, and a finer one to zoom into, if any."""
    try:
        coarse = as_text(trace(run, segments, friction, task.points))
        return coarse, finer_trace(run, segments, friction, task.points, task.fine_size)
    except AnalysisError as error:  # recorded, as above
        text = f"no trace to show: {told(error, 'campaign')}"
        findings.append(
            {"severity": "error", "run": task.run.name, "where": "trace", "message": text}
        )
        return "", ""


_TRACE = (
    "Trace over time, sliding velocity, and trace over the distance slid in the segments. Shaded: "
    "segments, their trimmed ends paler. Extremes of every pixel column are drawn."
)
_STROKES = (
    "Every stroke over its own length, slowest speed first; both directions count positive in "
    "their own direction. Each panel has its own scale, fitted to the part that counts."
)
_HALF_LOOP = "Half the force difference of each pair of strokes, and their mean."


def _words(friction: xr.Dataset) -> str:
    name = main_quantity(friction)
    values = [] if name not in friction else np.asarray(friction[name], float).tolist()
    speed = _values(friction, "sliding_speed", len(values)).tolist()
    return (
        f"{many(friction.sizes['segment'], 'segment')} at {speeds(speed)}, "
        f"{SYMBOLS[name]} from {span(values, UNITS[name])}."
    )
