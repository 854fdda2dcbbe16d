"""Friction over speed, run by run, and what the error bars of a curve hold."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from tribolab.records.parts import Row, number_of
from tribolab.records.wording import with_error
from tribolab.report.plain import plain_speed
from tribolab.words import many, number

_WIDENED = 1.2  # an error so much larger than the scatter alone holds what few runs do not tell
_SAME = 1.1  # speeds within this ratio are one, as in the measured curves


class RunPoint(NamedTuple):
    """Mean friction of one run at one speed [m/s], its error within the run, and its samples."""

    run: str
    speed: float
    mu: float
    within: float | None
    effective_samples: float
    segments: int


class PointError(NamedTuple):
    """The error of a point of a curve: the larger one that is known, and what it holds."""

    size: float | None
    holds: str
    within: float | None
    between: float | None


def run_points(name: str, segments: Sequence[Row]) -> list[RunPoint]:
    """Return mean friction over speed of one run.

    Parameters
    ----------
    name
        Of the run.
    segments
        Rows of its segments, as in report.json.

    Examples
    --------
    >>> rows = [{"sliding_speed_m_s": v, "friction_coefficient": mu,
    ...          "friction_coefficient_sem": .01, "effective_samples": 50.}
    ...         for v, mu in ((1e-3, .8), (1.01e-3, .9), (1e-2, .5))]
    >>> [(round(p.mu, 3), round(p.within, 4), p.effective_samples) for p in run_points("r", rows)]
    [(0.85, 0.0071, 100.0), (0.5, 0.01, 50.0)]
    """
    known = []
    for row in segments:
        speed, mu = number_of(row, "sliding_speed_m_s"), number_of(row, "friction_coefficient")
        # a segment that a person rejected stands in the tables, and no number rests on it
        if speed is not None and mu is not None and speed > 0 and not row.get("rejected"):
            known.append((float(speed), float(mu), row))
    known.sort(key=lambda entry: entry[0])
    groups: list[list[tuple[float, float, Row]]] = []
    for entry in known:
        if groups and entry[0] <= _SAME * groups[-1][-1][0]:
            groups[-1].append(entry)
        else:
            groups.append([entry])
    return [_point(name, group) for group in groups]


def _point(name: str, group: list[tuple[float, float, Row]]) -> RunPoint:
    errors = [number_of(row, "friction_coefficient_sem") for _, _, row in group]
    known = [error for error in errors if error is not None]
    within = math.sqrt(sum(e * e for e in known)) / len(known) if known else None
    samples = sum(float(number_of(row, "effective_samples") or 0) for _, _, row in group)
    speed = sum(v for v, _, _ in group) / len(group)
    mu = sum(value for _, value, _ in group) / len(group)
    return RunPoint(name, speed, mu, within, samples, len(group))


def at_speed(points: Sequence[RunPoint], speed: float) -> list[RunPoint]:
    """Return the points at a speed of a curve."""
    return [point for point in points if speed / _SAME <= point.speed <= speed * _SAME]


def point_error(row: Mapping[str, Any], points: Sequence[RunPoint]) -> PointError:
    """Return the error of a point of a curve.

    Parameters
    ----------
    row
        Of the table of measured curves.
    points
        Of its runs at this speed.

    Returns
    -------
    PointError
        ``within``, of the mean, from the samples of each run; ``between``, of the mean, from the
        scatter of the runs; ``size`` is the larger of what is known, with repeats at least the
        curve's own standard error.

    Examples
    --------
    >>> row = {"friction_coefficient_sem": 0.03, "friction_coefficient_between": 0.04, "runs": 4}
    >>> point_error(row, [RunPoint("a", 1e-3, 0.8, 0.01, 50.0, 2)])
    PointError(size=0.03, holds='between runs', within=0.01, between=0.02)
    >>> point_error({"friction_coefficient_sem": 0.01, "runs": 1}, []).holds
    'within the run'
    """
    runs = int(row.get("runs") or 1)
    sem, scatter = row.get("friction_coefficient_sem"), row.get("friction_coefficient_between")
    own = [point.within for point in points if point.within is not None]
    within = math.sqrt(sum(e * e for e in own)) / len(own) if own else None
    between = None if runs < 2 or scatter is None else scatter / math.sqrt(runs)
    known = [error for error in (sem, within, between) if error is not None]
    size = max(known, default=None)
    holds = "between runs" if runs > 1 else "within the run"
    if runs > 1 and within is not None and within == size:
        holds = "within the runs"
    return PointError(size, holds, within, between)


def told(row: Mapping[str, Any], error: PointError, points: Sequence[RunPoint]) -> str:
    """Return what the pointer reads at a point of a curve, a line for each thing."""
    speed, mu = row["sliding_speed_m_s"], row["friction_coefficient"]
    lines = [f"v = {plain_speed(speed)}", f"µ = {with_error(mu, error.size)} ({error.holds})"]
    if error.within is not None:
        lines.append(f"within the run: ± {number(error.within, 2)}")
    runs = int(row.get("runs") or 1)
    if error.between is not None:
        lines.append(f"between {runs} runs: ± {number(error.between, 2)}")
        if error.size is not None and error.size > _WIDENED * error.between:
            lines.append(f"widened: {runs} runs tell little of the spread")
    elif runs == 1:
        lines.append("between runs: not known, one run")
    if points:
        samples = sum(point.effective_samples for point in points)
        count = sum(point.segments for point in points)
        lines.append(f"{many(count, 'segment')}, {samples:.0f} independent samples")
        names = [point.run for point in points]
        shown = names[:4] + ([f"and {len(names) - 4} more"] if len(names) > 4 else [])
        lines.append(", ".join(shown))
    return "\n".join(lines)


def run_error(
    points: Sequence[Mapping[str, Any]], speed: float | None, within: float | None
) -> tuple[float | None, str]:
    """Return the error of one run's friction: the larger one that is known, and what it holds.

    Parameters
    ----------
    points
        Rows of the measured curve that the run belongs to; empty where there is none.
    speed
        At which [m/s].
    within
        Standard error within the run.

    Examples
    --------
    >>> row = {"sliding_speed_m_s": 1e-3, "friction_coefficient_between": 0.04, "runs": 2}
    >>> run_error([row], 1.01e-3, 0.01), run_error([], 1e-3, 0.01)
    ((0.04, 'between runs'), (0.01, 'within the run'))
    """
    for row in points:
        at, scatter = row["sliding_speed_m_s"], row.get("friction_coefficient_between")
        near = speed is not None and bool(at) and at / _SAME <= speed <= at * _SAME
        if near and scatter is not None and scatter > (within or 0.0):
            return scatter, "between runs"
    return within, "within the run"
