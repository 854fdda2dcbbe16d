"""Numbers that describe one run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribolab.arrays.medians import median
from tribolab.core.attributes import RunAttributes, SegmentAttributes
from tribolab.core.wording import many, percent
from tribolab.friction.coefficient.steadiness import chance_limit
from tribolab.friction.decisions.rejected import kept
from tribolab.friction.oscillation.waveform import NOT_CLEAR, NOT_LOOKED_AT, oscillating
from tribolab.friction.points.strokes import pairs_of, run_means, wider_error
from tribolab.records.frames import friction_columns, plain_rows
from tribolab.records.runs.decision_rows import decision_rows
from tribolab.records.runs.run_record import CheckRow, Highlight, LeftOut, RunFacts, Waveform
from tribolab.records.runs.same_speed import segments_by_speed
from tribolab.records.runs.traces import flagged_spans
from tribolab.records.runs.trends import undecided_segments
from tribolab.records.wording import SPREAD_OF, plain_value

if TYPE_CHECKING:
    import xarray as xr

    from tribolab.qc.findings import FindingRow

_SPEED_FROM = {
    "stroke": "stroke and frequency",
    "rotation": "rotation and radius",
    "stated": "what the file states, not measured",
}


def facts_of(
    run: xr.Dataset,
    segments: xr.Dataset,
    friction: xr.Dataset,
    slip: xr.Dataset,
    as_found: xr.Dataset | None = None,
) -> RunFacts:
    """Return the numbers that describe a run.

    Parameters
    ----------
    run, segments, friction, slip
        The run with the flags and the findings of its checks (time), and its results (segment).
    as_found
        Friction without a person's decisions, if any.
    """
    decided = () if as_found is None else decision_rows(friction, as_found, findings_of(run))
    return replace(
        _record_facts(run, friction_facts(friction)),
        decisions=decided,
        position_range_m=position_range(segments),
        stick_slip=stick_slip_of(slip),
        omitted=(*left_out(segments), *ends_of_strokes(segments)),
        segments=plain_rows(friction_columns(friction)),
        uncertainty_says=SegmentAttributes.from_attrs(friction.attrs).uncertainty_says,
        flagged=tuple(flagged_spans(run)),
    )


def position_range(segments: xr.Dataset) -> tuple[float, float] | None:
    """Return the used part of the track [m], if the campaign file states one."""
    low, high = (segments.attrs.get(f"position_{end}_m") for end in ("low", "high"))
    return None if low is None or high is None else (float(low), float(high))


def main_quantity(friction: xr.Dataset) -> str:
    """Return the main quantity of the report: mu, else the half loop, else the force."""
    for name in ("friction_coefficient", "half_loop", "friction_force"):
        if name in friction and np.isfinite(np.asarray(friction[name], float)).any():
            return name
    return "friction_coefficient"


def _record_facts(run: xr.Dataset, facts: RunFacts) -> RunFacts:
    """Return the facts extended by those of the run itself."""
    time = np.asarray(run["time"], float)
    about = RunAttributes.from_attrs(run.attrs)
    clock = {k: float(v) for k, v in run.attrs.items() if k in _CLOCK and not isinstance(v, str)}
    return replace(
        facts,
        instrument=about.instrument,
        quality=about.quality,
        checks=tuple(
            CheckRow(
                row["check"],
                row["status"],
                row["variable"],
                row["message"],
                plain_value(row["value"]),
                row["unit"],
                row.get("decision", ""),
            )
            for row in findings_of(run)
        ),
        recorded_at=about.recorded_at,
        duration_s=float(time[-1] - time[0]) if time.size else 0.0,
        samples=int(time.size),
        signals=tuple(sorted(str(n) for n in run.data_vars if run[n].dims == ("time",))),
        columns_not_used=tuple(filter(None, about.columns_not_used.split("; "))),
        time_origin_s=clock.get("time_origin_s"),
        clock_shift_s=clock.get("clock_shift_s"),
        clock_shift_uncertainty_s=clock.get("clock_shift_uncertainty_s"),
        clock_shift_source=about.clock_shift_source,
        inertia=inertia_text(run.attrs),
        history=about.history,
    )


def findings_of(run: xr.Dataset) -> list[FindingRow]:
    """Return the results of the checks on a run as plain rows."""
    return RunAttributes.from_attrs(run.attrs).findings


_CLOCK = ("time_origin_s", "clock_shift_s", "clock_shift_uncertainty_s")


def friction_facts(friction: xr.Dataset) -> RunFacts:
    """Return facts from a run's friction; the other facts have their defaults.

    Rejected segments are ignored, unless all are rejected.
    """
    friction = counting(friction)
    name = main_quantity(friction)
    value = np.asarray(friction[name], float) if name in friction else np.array([])
    of = SPREAD_OF.get(name, name)
    std = values_of(friction, f"{of}_std", value.size)
    speed = values_of(friction, "sliding_speed", value.size)
    finite = np.isfinite(value)
    scatter = std[finite] / np.abs(value[finite])
    scatter = scatter[np.isfinite(scatter)]

    def column(name: str) -> np.ndarray:
        return values_of(friction, name, value.size)

    strokes = _Strokes(
        speed,
        value,
        std,
        wider_error(column, of, "sem"),
        wider_error(column, of, "U95"),
        column(f"{of}_shared_sem"),
        pairs_of(friction),
    )
    about = SegmentAttributes.from_attrs(friction.attrs)
    levels = value[finite]
    if np.isfinite(
        about.stroke_middle
    ):  # first a mean per speed, as one of hundreds of strokes has little weight
        levels = np.array([value[part].mean() for part in segments_by_speed(speed, finite)])
    return RunFacts(
        quantity=name,
        offset=about.offset,
        trim=plain_value(about.trim) if np.isnan(about.stroke_middle) else None,
        velocity_source=_speed_text(about),
        sliding_speed_min_m_s=plain_value(np.nanmin(speed, initial=np.inf)),
        sliding_speed_max_m_s=plain_value(np.nanmax(speed, initial=-np.inf)),
        value_min=plain_value(levels.min()) if levels.size else None,
        value_max=plain_value(levels.max()) if levels.size else None,
        relative_scatter=float(median(scatter)) if scatter.size else None,
        relative_drift=plain_value(drift_of(friction, value)),
        unsteady_segments=int((values_of(friction, "steady", value.size) == 0).sum()),
        highlights=tuple(_highlights(strokes)),
    )


def _speed_text(about: SegmentAttributes) -> str:
    """Return the source of the speed, and the part of each stroke used, as text."""
    source, middle = about.velocity_source, about.stroke_middle
    if source == "recorded":
        source = _SPEED_FROM.get(about.speed_from, source)
    used = f"; of each whole stroke the middle {middle:.0%} is used" if middle > 0 else ""
    return f"{source}{used}"


def inertia_text(attrs: Mapping[str, Any]) -> str:
    """Return text on the inertia of a moving mass in the friction force; "" if unknown.

    Parameters
    ----------
    attrs
        Attributes of the run.
    """
    if "moving_mass_kg" not in attrs:
        return ""
    error = attrs.get("moving_mass_sem_kg")
    sure = f"; the mass has a standard error of {error:.2g} kg" if error is not None else ""
    largest = f"{attrs['inertial_force_largest_N']:.3g}"
    mass = f"{attrs['moving_mass_kg']:.4g} kg ({attrs['moving_mass_source']})"
    return f"that of {mass} is taken out: up to {largest} N{sure}"


def stick_slip_of(slip: xr.Dataset) -> Waveform:
    """Return the waveform class of a run and where it occurs, for the table of runs.

    Parameters
    ----------
    slip
        From `tribolab.friction.oscillation.slip_segments.stick_slip`.
    """
    # imported late for a quick start
    from tribolab.friction.oscillation.slip_curve import STEADY_SLIDING, stick_slip_curve

    curve = stick_slip_curve([slip])
    over_speed = bool(curve.sizes["sliding_speed"])
    kind = (curve if over_speed else slip)["waveform"].values.astype(str)
    kind = kind[kind != NOT_LOOKED_AT]
    if not kind.size:
        return Waveform(NOT_LOOKED_AT, "")
    moving = oscillating(kind)
    if not moving.any() and (kind == NOT_CLEAR).any():
        what = "speed" if over_speed else "segment"
        count = f"{(kind == NOT_CLEAR).sum()} of {many(kind.size, what)}"
        return Waveform(NOT_CLEAR, f"{'at' if over_speed else 'in'} {count}")
    if not moving.any():  # without a speed, a segment may be a rest
        return Waveform(STEADY_SLIDING, "" if over_speed else "if it slides: speed not known")
    names, counts = np.unique(kind[moving], return_counts=True)
    ordered = [str(name) for name in names[np.argsort(-counts, kind="stable")]]
    detail = f"at {moving.sum()} of {many(kind.size, 'speed')}"
    if not over_speed:
        detail = f"in {moving.sum()} of {many(kind.size, 'segment')}"
    if ordered[1:]:
        detail += f"; also {', '.join(ordered[1:])}"
    return Waveform(ordered[0], detail)


def counting(friction: xr.Dataset) -> xr.Dataset:
    """Return the segments used for the numbers of a run."""
    left = kept(friction)
    return left if left.sizes["segment"] else friction


def drift_of(friction: xr.Dataset, value: np.ndarray) -> float | None:
    """Return the largest significant change along a segment, relative to typical friction.

    As in the check on steadiness, it is relative to the run's friction, because that of a fast
    segment in a liquid can be almost zero. None if a trend is undecided.
    """
    size = friction.sizes["segment"]
    change = values_of(friction, "trend_change", size)
    if "force_trend" in friction and "trend_change" not in friction:
        lasted = values_of(friction, "trimmed_stop", size) - values_of(
            friction, "trimmed_start", size
        )
        change = values_of(friction, "force_trend", size) * lasted
    typical = np.abs(value[np.isfinite(value)])
    if not np.isfinite(change).any() or not (typical > 0).any():
        return None
    change = change / typical.mean()
    chance, samples = (values_of(friction, n, size) for n in ("trend_p_value", "effective_samples"))
    sure = chance < chance_limit(samples)
    if not sure.any() and undecided_segments(change, chance, samples).any():
        return None
    return float(np.nanmax(np.abs(change[sure]), initial=0.0))


def values_of(data: xr.Dataset, name: str, size: int) -> np.ndarray:
    """Return a variable as floats; NaN if missing."""
    return np.asarray(data[name], float) if name in data else np.full(size, np.nan)


class _Strokes(NamedTuple):
    """Strokes of a run in temporal order; values in the unit of its quantity."""

    speed: np.ndarray
    value: np.ndarray
    std: np.ndarray
    sem: np.ndarray
    u95: np.ndarray
    shared: np.ndarray
    pairs: np.ndarray


def _highlights(strokes: _Strokes) -> list[Highlight]:
    """Return the mean over the strokes at the lowest, the middle and the highest speed."""
    speed, known = strokes.speed, np.isfinite(strokes.value)
    if not (known & (speed > 0)).any():  # one group of all strokes
        speed = np.ones(speed.size)
    means = run_means(
        speed, strokes.value, strokes.sem, strokes.u95, strokes.pairs, shared=strokes.shared
    )
    if not means:
        return []
    chosen = {0: "slowest", len(means) - 1: "fastest"}
    if len(means) > 2:
        chosen[len(means) // 2] = "middle"
    chosen[0] = "all" if speed is not strokes.speed else "slowest"
    return [
        Highlight(
            where=word,
            sliding_speed_m_s=plain_value(float(np.mean(strokes.speed[means[k].strokes]))),
            value=plain_value(means[k].mean),
            std=plain_value(float(np.sqrt(np.mean(strokes.std[means[k].strokes] ** 2)))),
            sem=plain_value(means[k].sem),
            U95=plain_value(means[k].u95),
            segments=int(means[k].strokes.size),
        )
        for k, word in sorted(chosen.items())
    ]


def times_of_strokes(segments: xr.Dataset) -> tuple[float, float]:
    """Return the total duration of the strokes, and of the parts used [s]."""
    whole, used = (
        float((segments[f"{part}stop"] - segments[f"{part}start"]).sum())
        for part in ("", "trimmed_")
    )
    return whole, used


def ends_of_strokes(segments: xr.Dataset) -> list[LeftOut]:
    """Return the parts of the strokes outside a chosen middle, as a row."""
    share = SegmentAttributes.from_attrs(segments.attrs).stroke_middle
    if np.isnan(share) or not segments.sizes["segment"]:
        return []
    whole, used = times_of_strokes(segments)
    reason = f"ends of strokes, outside the middle {percent(share)} of the way"
    return [LeftOut(reason, 2 * segments.sizes["segment"], whole - used)]


def left_out(segments: xr.Dataset) -> list[LeftOut]:
    """Return the omitted parts of a run, a row for each reason."""
    if "omitted_reason" not in segments:
        return []
    reasons = np.asarray(segments["omitted_reason"]).astype(str)
    lengths = np.asarray(segments["omitted_stop"], float) - np.asarray(segments["omitted_start"])
    return [
        LeftOut(
            reason=reason,
            intervals=int((reasons == reason).sum()),
            duration_s=plain_value(float(lengths[reasons == reason].sum())),
        )
        for reason in dict.fromkeys(reasons.tolist())
    ]
