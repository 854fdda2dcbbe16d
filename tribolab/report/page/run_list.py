"""Rows of the page's list of runs: state, friction, deviation from the repeats, trace."""

from __future__ import annotations

import json
import re
import statistics
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from tribolab.core.wording import signed_percent
from tribolab.records.judgement import check_words, is_bad, is_odd, status_word, why
from tribolab.records.wording import UNITS, error_text
from tribolab.report.page.sparkline import spark_path
from tribolab.report.page_figures.points import MAX_SPEED_RATIO, RunPoint, at_speed
from tribolab.report.plain import plain_speed

_ODD = "odd"
_ALL, _STEADY = "all speeds", "steady"
_DIGITS = 6  # decimals for sorting by deviation: two repeats deviate equally, but for rounding
STATES = {
    "failed": "not used: could not be read",
    "rejected": "not used: a check failed",
    "rejected by hand": "not used",
    "kept": "result of an earlier analysis",
    _ODD: "used, but differs from its repeats",
    "suspect": "used, but a check raised a doubt",
    "accepted": "doubted by a check, accepted by hand",
    "done": "no doubt",
}


class ListedRun(NamedTuple):
    """Row of one run; `values` has its friction and deviation as texts, for each speed.

    `place` is its position in the report, from 1; `spark` the outline of its trace as SVG path;
    `worst` its rank in the order of severity, from 0.
    """

    run: Mapping[str, Any]
    place: int
    state: str
    why: str
    values: tuple[tuple[str, str], ...]
    spark: str
    worst: int = 0

    @property
    def packed(self) -> str:
        """Friction and deviation at each speed, as JSON."""
        return json.dumps(self.values, ensure_ascii=False, separators=(",", ":"))


class RunList(NamedTuple):
    """Rows, worst first; speeds to choose from; and index of the speed that is shown first."""

    rows: tuple[ListedRun, ...]
    speeds: tuple[str, ...]
    shown: int


def listed_runs(
    runs: Sequence[Mapping[str, Any]],
    points: Mapping[str, Sequence[RunPoint]],
    traces: Mapping[str, Mapping[str, Any]],
) -> RunList:
    """Return the rows of all runs, worst first: by state, then by deviation from the repeats.

    Parameters
    ----------
    runs
        As in report.json; short entries suffice.
    points
        Friction against speed, by name of the run.
    traces
        Coarse trace from `tribolab.records.runs.traces`, by name of the run.
    """
    speeds = _speeds(points)
    means = {run["name"]: _means(run, points.get(run["name"], ()), speeds) for run in runs}
    shown_as = tuple(map(plain_speed, speeds)) or (_ALL,)
    if any(len(run["running_in"]) == 1 for run in runs):
        shown_as = _STEADY, *shown_as
        means = {run["name"]: [_steady(run), *means[run["name"]]] for run in runs}
    off = _deviations(runs, means)
    shown = 0 if _STEADY in shown_as else _most_common_speed(list(means.values()))
    suspect = [
        {row["check"] for row in run["checks"] if row["status"] == "suspect"} for run in runs
    ]
    common = set.intersection(*suspect) if len(runs) > 1 else set()
    rows = []
    for place, run in enumerate(runs, start=1):
        name, unit = run["name"], UNITS.get(run["quantity"] or "", "")
        values = tuple(
            (error_text(mu, None, unit) if mu is not None else "", signed_percent(deviation))
            for mu, deviation in zip(means[name], off[name], strict=True)
        )
        spark = spark_path(traces[name]) if name in traces else ""
        rows.append(ListedRun(run, place, _state(run), _reason(run, common), values, spark))
    order = sorted(rows, key=lambda row: _rank(row, off[row.run["name"]][shown]))
    ranked = tuple(row._replace(worst=rank) for rank, row in enumerate(order))
    return RunList(ranked, shown_as, shown)


def _reason(run: Mapping[str, Any], common: Collection[str]) -> str:
    """Return the reason for the state of a run, shortened if all runs have it."""
    reason = why(run)
    name, _, message = reason.partition(": ")
    shared = name in map(check_words, common)
    return f"all runs: {re.split('[:;.] ', message)[0]}" if shared else reason


def _state(run: Mapping[str, Any]) -> str:
    """Return the state of a run in words; "odd" if it contradicts its repeats."""
    word = status_word(run)
    return _ODD if is_odd(run) and word in ("done", "suspect") else word


def _rank(row: ListedRun, off: float | None) -> tuple[int, float]:
    return list(STATES).index(row.state), -round(abs(off or 0.0), _DIGITS)


def _speeds(points: Mapping[str, Sequence[RunPoint]]) -> list[float]:
    """Return the speeds of all runs, increasing; speeds within 10 % count as one."""
    speeds: list[float] = []
    for speed in sorted({point.speed for of_run in points.values() for point in of_run}):
        if speed > (MAX_SPEED_RATIO * speeds[-1] if speeds else 0):
            speeds.append(speed)
    return speeds


def _most_common_speed(means: Sequence[Sequence[float | None]]) -> int:
    """Return the index of the speed with values from most runs; if several, the middle one."""
    counts = [sum(value is not None for value in column) for column in zip(*means, strict=True)]
    best = [place for place, count in enumerate(counts) if count == max(counts)]
    return best[len(best) // 2] if best else 0


def _mean(points: Sequence[RunPoint]) -> float | None:
    return statistics.fmean(point.mu for point in points) if points else None


def _means(
    run: Mapping[str, Any], points: Sequence[RunPoint], speeds: Sequence[float]
) -> list[float | None]:
    return [_mean(at_speed(points, speed)) for speed in speeds] or [_overall(run)]


def _steady(run: Mapping[str, Any]) -> float | None:
    """Return the steady (else the mean) friction of a run at one speed; None at several speeds."""
    if len(run["running_in"]) != 1:
        return None
    (settled,) = run["running_in"]
    steady: float | None = settled["steady_friction_coefficient"]
    return settled["mean_friction_coefficient"] if steady is None else steady


def _overall(run: Mapping[str, Any]) -> float | None:
    return next((found["value"] for found in run["highlights"]), None)


def _deviations(
    runs: Sequence[Mapping[str, Any]], means: Mapping[str, Sequence[float | None]]
) -> dict[str, list[float | None]]:
    """Return the relative deviation of each run from the median of its repeats, per speed."""
    conditions: dict[tuple[Any, ...], list[Mapping[str, Any]]] = {}
    for run in runs:
        key = run["surface"], run["medium"], run["nominal_normal_force_N"], run["quantity"]
        conditions.setdefault(key, []).append(run)
    off: dict[str, list[float | None]] = {}
    for (surface, medium, *_), members in conditions.items():
        usable = [means[run["name"]] for run in members if not is_bad(run)]
        for run in members:
            row: list[float | None] = []
            for place, mu in enumerate(means[run["name"]]):
                known = [of_run[place] for of_run in usable if of_run[place] is not None]
                alone = len(members) < 2 or not (surface or medium) or len(known) < 1
                middle = statistics.median(v for v in known if v is not None) if known else 0.0
                row.append(None if mu is None or alone or not middle else mu / middle - 1)
            off[run["name"]] = row
    return off
