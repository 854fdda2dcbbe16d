"""How long to slide and how often to repeat next time, told from the results of a pilot."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from tribolab.across.folder import open_folder
from tribolab.across.run_values import (
    CONDITION,
    SPEED,
    VALUE,
    condition_text,
    segments_of,
    speed_levels,
)
from tribolab.errors import AnalysisError
from tribolab.metrology.planning import (
    Pilot,
    cheapest_sliding_time,
    run_variance,
    runs_for_half_interval,
    runs_for_standard_error,
    upper_bound,
)
from tribolab.report.read_results import Results
from tribolab.words import many

FEW = 6  # runs of a pilot, below which its spread between runs is taken at its upper bound
LONGEST = 20  # times the pilot's sliding time, what is thought of as the longest stroke


@dataclass(frozen=True)
class MeasuringPlan:
    """How a precision is reached.

    Parameters
    ----------
    table
        A row for each condition and speed: what the pilot told (``within_std``,
        ``autocorrelation_time_s``, ``between_runs_std``, ``pilot_runs``), the ``runs`` that reach
        the goal at the pilot's ``sliding_time_s``, ``cheapest_sliding_time_s`` with
        ``cheapest_runs`` for it, and the ``time_s`` and ``cheapest_time_s`` they take in all.
    goal
        What was asked for, in words.
    setup_time
        Of each run, beside sliding [s].
    """

    table: pd.DataFrame
    goal: str
    setup_time: float


def measuring_plan(
    pilot: pd.DataFrame | Results | str | Path,
    *,
    standard_error: float | None = None,
    half_interval: float | None = None,
    assurance: float | None = None,
    setup_time: float = 600.0,
) -> MeasuringPlan:
    """Tell how many runs, and how long ones, reach a precision at each speed.

    Parameters
    ----------
    pilot
        Results folder, or table of friction, of two runs or more for each condition.
    standard_error, half_interval
        Of the mean coefficient; or of it half the 95 % interval: one of the two.
    assurance
        Chance with which the next campaign's own error is to come out as small, e.g. 0.8; without
        it that is so on average.
    setup_time
        What each run costs beside sliding [s].

    Returns
    -------
    MeasuringPlan
        See there.

    Raises
    ------
    AnalysisError
        If not one precision is asked for, or no condition has two runs.

    Notes
    -----
    Strokes of a run at one speed count as one longer stroke. What runs differ by is their variance
    less what their finite sliding explains. With assurance the error of the pilot's own variance is
    in the number of runs; without, what fewer than six runs differ by is taken at its 80 % upper
    bound, since a pilot of three may well have found half of it. The cheapest time is at most
    twenty times the pilot's.

    Examples
    --------
    >>> import pandas as pd
    >>> pilot = pd.DataFrame({
    ...     "run": list("abcdefg"), "sliding_speed_m_s": 1e-3,
    ...     "friction_coefficient": [0.5, 0.52, 0.49, 0.51, 0.5, 0.48, 0.5],
    ...     "friction_coefficient_std": 0.01, "autocorrelation_time_s": 0.1,
    ...     "trimmed_start_s": 0.0, "trimmed_stop_s": 10.0,
    ... })
    >>> measuring_plan(pilot, standard_error=0.005).table.runs.tolist()
    [7.0]
    """
    if (standard_error is None) == (half_interval is None):
        raise AnalysisError("say one precision: a standard error, or half a 95 % interval")
    goal = standard_error if standard_error is not None else half_interval
    if goal is None or not goal > 0:
        raise AnalysisError(f"a precision of {goal}: it has to be above zero")
    count = runs_for_standard_error if standard_error is not None else runs_for_half_interval
    rows = []
    for text, speed, runs in _pilots(pilot):
        told, sliding, mean = _told(runs, assured=assurance is not None)
        row = {"condition": text, SPEED: speed, "mean": mean, "pilot_runs": len(runs)}
        row |= {"within_std": told.within, "autocorrelation_time_s": told.memory}
        row |= {"between_runs_std": told.between, "sliding_time_s": sliding}
        cheapest = cheapest_sliding_time(told, setup_time, LONGEST * sliding)
        for name, each in (("", sliding), ("cheapest_", cheapest)):
            needed = count(run_variance(told, each), goal, assurance, len(runs))
            runs_needed = math.nan if needed is None else float(needed)
            row[f"{name}sliding_time_s"] = each
            row[f"{name}runs"] = runs_needed
            row[f"{name}time_s"] = runs_needed * (setup_time + each)
        rows.append(row)
    if not rows:
        raise AnalysisError(
            "no condition and speed has two runs: nothing tells what runs differ by"
        )
    words = "standard error" if standard_error is not None else "half 95 % interval"
    sure = f" with {100 * assurance:.0f} % assurance" if assurance is not None else " on average"
    return MeasuringPlan(pd.DataFrame(rows), f"{words} of {goal:g}{sure}", setup_time)


def _pilots(
    pilot: pd.DataFrame | Results | str | Path,
) -> list[tuple[str, float, pd.DataFrame]]:
    """Return condition, speed and runs of all that two runs or more measured."""
    if isinstance(pilot, pd.DataFrame):
        table, where = pilot, "table"
    else:
        folder = open_folder(pilot.folder if isinstance(pilot, Results) else pilot)
        read = folder.table("friction")
        if read is None:
            raise AnalysisError(f"{folder.path}: there is no table of friction: it has no runs")
        table, where = read, str(folder.path)
        if counting := folder.counting:
            table = table[table["run"].astype(str).isin(counting)]
    segments = segments_of(table, where)
    segments = segments.assign(
        condition=[
            condition_text(*row) for row in segments[CONDITION].itertuples(index=False, name=None)
        ],
        level=speed_levels(segments[SPEED].to_numpy(dtype=float)),
    )
    made = []
    for text in dict.fromkeys(segments["condition"].tolist()):
        own = segments[segments["condition"] == text]
        for level in np.unique(own["level"]).tolist():
            runs = _runs(own[own["level"] == level])
            if len(runs) > 1:
                made.append((str(text), float(level), runs))
    return made


def _runs(segments: pd.DataFrame) -> pd.DataFrame:
    """Mean, variance, memory and sliding time of each run at one speed."""
    known = pd.DataFrame(
        {
            "run": segments["run"],
            "mean": segments[VALUE],
            "variance": segments[f"{VALUE}_std"] ** 2,
            "memory": segments["autocorrelation_time_s"],
            "time": segments["trimmed_stop_s"] - segments["trimmed_start_s"],
        }
    )
    grouped = known.groupby("run", sort=False)
    return grouped[["mean", "variance", "memory"]].mean().join(grouped["time"].sum())


def _told(runs: pd.DataFrame, *, assured: bool) -> tuple[Pilot, float, float]:
    """Return what runs tell of the scatter, how long they slid, and their mean."""
    within = math.sqrt(float(runs["variance"].mean()))
    memory = float(np.nan_to_num(runs["memory"].mean()))
    sliding = float(runs["time"].median())
    alone = run_variance(Pilot(within, memory, 0.0), sliding)
    spread = float(runs["mean"].std(ddof=1))
    if len(runs) < FEW and not assured:  # an assurance takes the pilot's error into account
        spread = upper_bound(spread, len(runs))
    between = math.sqrt(max(0.0, spread**2 - alone))
    return Pilot(within, memory, between), sliding, float(runs["mean"].mean())


def plan_text(plan: MeasuringPlan) -> str:
    """Return what a plan comes to in one sentence."""
    runs = plan.table["cheapest_runs"]
    if runs.isna().any():
        return f"{plan.goal}: out of reach at {many(int(runs.isna().sum()), 'point')}"
    return (
        f"{plan.goal}: {runs.min():.0f} to {runs.max():.0f} runs at the cheapest sliding times, "
        f"{plan.table['runs'].min():.0f} to {plan.table['runs'].max():.0f} at those of the pilot"
    )
