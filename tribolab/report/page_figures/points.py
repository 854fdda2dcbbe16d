"""Mean friction of each run at each speed, and the error bars of a curve with their source."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from tribolab.core.wording import many, number
from tribolab.friction.points.strokes import run_means, wider_error
from tribolab.friction.zero.of_run import PAIRED
from tribolab.records.parts import Row, number_of
from tribolab.records.wording import error_text
from tribolab.report.plain import plain_speed

_MAX_NAMED = 4  # most runs named in a tooltip
MAX_SPEED_RATIO = 1.1  # speeds that differ by at most this factor count as one


class RunPoint(NamedTuple):
    """Mean friction `mu` of one run at one speed [m/s], and `within`: its U95 within the run."""

    run: str
    speed: float
    mu: float
    within: float | None
    effective_samples: float
    segments: int
    load: float | None = None  # assigned load [N] of a run with several loads


class PointError(NamedTuple):
    """U95 of a point of a curve (`size`), its source, and the errors within and between runs."""

    size: float | None
    source: str
    within: float | None
    scatter: float | None


def run_points(
    name: str, segments: Sequence[Row], offset: str = "", filed: Mapping[float, float] | None = None
) -> list[RunPoint]:
    """Return the mean friction of one run at each of its speeds.

    Parameters
    ----------
    name
        Name of the run.
    segments
        Rows of its segments, as in report.json.
    offset
        Method of offset removal; with "half loop", two strokes are one observation.
    filed
        Assigned load [N] of each measured load [N] of a run with several loads; each point has one.

    Examples
    --------
    >>> rows = [{"sliding_speed_m_s": v, "friction_coefficient": mu, "pair": 0,
    ...          "friction_coefficient_sem": .01, "effective_samples": 50.}
    ...         for v, mu in ((1e-3, .8), (1.01e-3, .9))]
    >>> [(round(p.mu, 3), round(p.within, 2), p.effective_samples) for p in run_points("r", rows)]
    [(0.85, 0.64, 100.0)]
    >>> [round(p.within, 4) for p in run_points("r", rows, "half loop")]
    [0.0196]
    """
    if filed:
        parts: dict[float, list[Row]] = {}
        for row in segments:
            if (load := number_of(row, "normal_force_N")) is not None:
                parts.setdefault(filed[_nearest(filed, load)], []).append(row)
        return [
            point._replace(load=load)
            for load, rows in parts.items()
            for point in run_points(name, rows, offset)
        ]
    # manually rejected segments appear in the tables only
    rows = [row for row in segments if not row.get("rejected")]
    rows.sort(key=lambda row: number_of(row, "start_s") or 0.0)

    def column(key: str) -> np.ndarray:
        return np.array([number_of(row, key) for row in rows], float)

    name_of = "friction_coefficient"
    sem, wide = (wider_error(column, name_of, end) for end in ("sem", "U95"))
    pairs = column("pair") if offset in PAIRED else np.full(len(rows), -1.0)
    samples = np.nan_to_num(column("effective_samples"))
    means = run_means(
        column("sliding_speed_m_s"),
        column(name_of),
        sem,
        wide,
        pairs,
        shared=column(f"{name_of}_shared_sem"),
    )
    return [
        RunPoint(
            name,
            mean.speed,
            mean.mean,
            mean.u95 if np.isfinite(mean.u95) else None,
            float(samples[mean.strokes].sum()),
            int(mean.strokes.size),
        )
        for mean in means
    ]


def _nearest(loads: Iterable[float], load: float) -> float:
    return min(loads, key=lambda other: max(other, load) / max(min(other, load), 1e-9))


def of_curve(points: Iterable[RunPoint], load: float | None) -> list[RunPoint]:
    """Return the points at a given load [N], and those of runs without an assigned load."""
    return [point for point in points if point.load in (None, load)]


def at_speed(points: Sequence[RunPoint], speed: float) -> list[RunPoint]:
    """Return the points whose speed is within 10 % of a given speed [m/s]."""
    return [
        point
        for point in points
        if speed / MAX_SPEED_RATIO <= point.speed <= speed * MAX_SPEED_RATIO
    ]


def point_error(row: Mapping[str, Any], points: Sequence[RunPoint]) -> PointError:
    """Return the U95 of a point of a curve with its source, and the errors within and between runs.

    Parameters
    ----------
    row
        Row of the table of measured curves.
    points
        Points of its runs at this speed.

    Returns
    -------
    PointError
        ``size``, the expanded uncertainty of the point (95 % coverage); ``within``, the usual U95
        within one run; ``scatter``, the standard deviation of the runs.

    Examples
    --------
    >>> row = {"friction_coefficient_U95": 0.06, "friction_coefficient_between": 0.04, "runs": 4}
    >>> point_error(row, [RunPoint("a", 1e-3, 0.8, 0.01, 50.0, 2)])
    PointError(size=0.06, source='between runs', within=0.01, scatter=0.04)
    >>> point_error({"friction_coefficient_U95": 0.01, "runs": 1}, []).source
    'within the run'
    """
    runs = int(row.get("runs") or 1)
    own = [point.within for point in points if point.within is not None]
    within = math.sqrt(sum(e * e for e in own) / len(own)) if own else None
    source = "between runs" if runs > 1 else "within the run"
    scatter = row.get("friction_coefficient_between") if runs > 1 else None
    return PointError(row.get("friction_coefficient_U95"), source, within, scatter)


def describe_point(
    row: Mapping[str, Any], error: PointError, points: Sequence[RunPoint], text: str = ""
) -> str:
    """Return the tooltip of a point of a curve: speed, µ ± U95, repeats, samples and runs.

    `text` names a contribution that the uncertainty omits.
    """
    speed, mu = row["sliding_speed_m_s"], row["friction_coefficient"]
    lines = [f"v = {plain_speed(speed)}", f"µ = {error_text(mu, error.size)} (U95, {error.source})"]
    runs = int(row.get("runs") or 1)
    if runs > 1:
        lines.append(f"mean of {runs} runs")
        if error.scatter is not None:
            lines.append(f"scatter of the runs: {number(error.scatter, 2)}")
        if error.within is not None:
            lines.append(f"U95 within one run: {number(error.within, 2)}")
    else:
        lines.append("between runs: not known, one run")
    lines += [text] * bool(text)
    if points:
        samples = sum(point.effective_samples for point in points)
        count = sum(point.segments for point in points)
        lines += [many(count, "segment"), f"{samples:.0f} independent samples"]
        names = [point.run for point in points]
        # a line for each name, because long lines of a tooltip are cut
        lines += names[:_MAX_NAMED] + (
            [f"and {len(names) - _MAX_NAMED} more"] * (len(names) > _MAX_NAMED)
        )
    return "\n".join(lines)
