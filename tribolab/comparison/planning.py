"""Sliding time and number of repeats for a given precision, from a pilot campaign."""

from __future__ import annotations

import html
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy import special

from tribolab.comparison.folder import open_folder
from tribolab.comparison.run_values import (
    CONDITION,
    SPEED_COLUMN,
    VALUE,
    condition_text,
    segments_of,
    speed_levels,
)
from tribolab.core.errors import AnalysisError
from tribolab.core.wording import many, number, speed_text
from tribolab.metrology.planning import (
    MOST_RUNS,
    Pilot,
    cheapest_sliding_time,
    run_variance,
    runs_for_half_interval,
    runs_for_standard_error,
)
from tribolab.report.results_folder import Results

_ASSURANCE = 0.8
_TEN = 10  # number of runs for which the attainable precision is stated
LONGEST_STROKE = 20  # longest sliding time considered, relative to the pilot's


@dataclass(frozen=True)
class MeasuringPlan:
    """Number and duration of runs that reach a given precision.

    Parameters
    ----------
    table
        A row for each condition and speed: results of the pilot (``within_std``,
        ``autocorrelation_time_s``, ``between_runs_std``, ``pilot_runs``); the number of ``runs``
        that reach the goal with a probability of 50 % at the pilot's ``sliding_time_s``, and of
        ``assured_runs`` with the stated assurance; ``cheapest_sliding_time_s`` with
        ``cheapest_runs`` and ``cheapest_assured_runs``; and the total time of each, ``time_s``,
        ``assured_time_s``, ``cheapest_time_s``, ``cheapest_assured_time_s``.
    goal
        Wanted precision, in words.
    assurance
        Probability that the assured runs reach it.
    setup_time
        Time for each run besides sliding [s].
    is_interval
        Whether the goal is half a 95 % interval, else a standard error.
    """

    table: pd.DataFrame
    goal: str
    assurance: float
    setup_time: float
    is_interval: bool = False

    def _repr_html_(self) -> str:
        """Return HTML of the required precision and of the table of runs."""
        shown = self.table.to_html(index=False, float_format="{:.3g}".format)
        return f"<p><b>Runs for {html.escape(self.goal)}</b></p>{shown}"


def measuring_plan(
    pilot: pd.DataFrame | Results | str | Path,
    *,
    standard_error: float | None = None,
    half_interval: float | None = None,
    assurance: float = _ASSURANCE,
    setup_time: float = 600.0,
) -> MeasuringPlan:
    """Return the number and duration of runs needed for a precision, at each speed.

    Parameters
    ----------
    pilot
        Results folder, or table of friction, of two runs or more for each condition.
    standard_error, half_interval
        Standard error of the mean coefficient, or half its 95 % interval: one of the two.
    assurance
        Probability that the next campaign's error is as small as wanted, for the assured runs.
    setup_time
        Time for each run besides sliding [s].

    Returns
    -------
    MeasuringPlan
        The plan, with one row per condition and speed.

    Raises
    ------
    AnalysisError
        If there is not exactly one goal, the assurance is not between 0.5 and 1, or no condition
        has two runs.

    Notes
    -----
    Strokes of a run at one speed count as one longer stroke. The variance between runs is the
    variance of their means minus that explained by finite sliding time. Both numbers of runs
    include the error of the pilot's variance: a pilot of three runs can easily underestimate the
    scatter by half (`runs_for_standard_error`). The cheapest time is at most twenty times the
    pilot's.

    Examples
    --------
    >>> import pandas as pd
    >>> pilot = pd.DataFrame({
    ...     "run": list("abcdefg"), "sliding_speed_m_s": 1e-3,
    ...     "friction_coefficient": [0.5, 0.52, 0.49, 0.51, 0.5, 0.48, 0.5],
    ...     "friction_coefficient_std": 0.01, "autocorrelation_time_s": 0.1,
    ...     "trimmed_start_s": 0.0, "trimmed_stop_s": 10.0,
    ... })
    >>> plan = measuring_plan(pilot, standard_error=0.005)
    >>> plan.table.runs.tolist(), plan.table.assured_runs.tolist()
    ([7.0], [14.0])
    """
    if (standard_error is None) == (half_interval is None):
        raise AnalysisError("state one precision: a standard error, or half a 95 % interval")
    goal = standard_error if standard_error is not None else half_interval
    if goal is None or not goal > 0:
        raise AnalysisError(f"a precision of {goal}: it must be above zero")
    if not 0.5 <= assurance < 1:
        raise AnalysisError(
            f"an assurance of {assurance:g}: it is a chance from 0.5 to below 1, e.g. 0.8"
        )
    count = runs_for_standard_error if standard_error is not None else runs_for_half_interval
    rows = []
    for text, speed, runs in _pilots(pilot):
        scatter, sliding, mean = _scatter(runs)
        row = {"condition": text, SPEED_COLUMN: speed, "mean": mean, "pilot_runs": len(runs)}
        row |= {"within_std": scatter.within, "autocorrelation_time_s": scatter.memory}
        row |= {"between_runs_std": scatter.between, "sliding_time_s": sliding}
        cheapest = cheapest_sliding_time(scatter, setup_time, LONGEST_STROKE * sliding)
        for name, each in (("", sliding), ("cheapest_", cheapest)):
            row[f"{name}sliding_time_s"] = each
            for sure, chance in (("", None), ("assured_", assurance)):
                needed = count(run_variance(scatter, each), goal, chance, len(runs))
                runs_needed = math.nan if needed is None else float(needed)
                row[f"{name}{sure}runs"] = runs_needed
                row[f"{name}{sure}time_s"] = runs_needed * (setup_time + each)
        rows.append(row)
    if not rows:
        raise AnalysisError(
            "no condition and speed has two runs: the scatter between runs is unknown"
        )
    words = "standard error" if standard_error is not None else "half 95 % interval"
    return MeasuringPlan(
        pd.DataFrame(rows), f"{words} of {goal:g}", assurance, setup_time, half_interval is not None
    )


def _pilots(
    pilot: pd.DataFrame | Results | str | Path,
) -> list[tuple[str, float, pd.DataFrame]]:
    """Return condition, speed and runs of each pilot, which needs at least two runs."""
    if isinstance(pilot, pd.DataFrame):
        table, where = pilot, "table"
    else:
        folder = open_folder(pilot.folder if isinstance(pilot, Results) else pilot)
        table, where = folder.friction(), str(folder.path)
        if counting := folder.counting:
            table = table[table["run"].astype(str).isin(counting)]
    segments = segments_of(table, where)
    segments = segments.assign(
        condition=[
            condition_text(*row) for row in segments[CONDITION].itertuples(index=False, name=None)
        ],
        level=speed_levels(segments[SPEED_COLUMN].to_numpy(dtype=float)),
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
    """Return mean, variance, correlation time and sliding time of each run at one speed."""
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


def _scatter(runs: pd.DataFrame) -> tuple[Pilot, float, float]:
    """Return the scatter between and within runs, their sliding time, and their mean."""
    within = math.sqrt(float(runs["variance"].mean()))
    memory = float(np.nan_to_num(runs["memory"].mean()))
    sliding = float(runs["time"].median())
    alone = run_variance(Pilot(within, memory, 0.0), sliding)
    spread = float(runs["mean"].std(ddof=1))
    between = math.sqrt(max(0.0, spread**2 - alone))
    return Pilot(within, memory, between), sliding, float(runs["mean"].mean())


def plan_text(plan: MeasuringPlan) -> str:
    """Return the summary of a plan in one sentence."""
    table = plan.table
    beyond = int(table["runs"].isna().sum())
    if beyond:
        return (
            f"{plan.goal}: not achievable at {beyond} of {many(len(table), 'point')}, where more "
            f"than {MOST_RUNS} runs are needed. {_missing(plan)}"
        )
    sure = f"{100 * plan.assurance:.0f} %"
    return (
        f"{plan.goal}: {_span(table['runs'])} as long as the pilot's reach it with a chance of 50 "
        f"%, {_span(table['assured_runs'])} do so with a chance of {sure}; of the cheapest "
        f"sliding times {_span(table['cheapest_runs'])} and {_span(table['cheapest_assured_runs'])}"
    )


def _missing(plan: MeasuringPlan) -> str:
    """Return a text on the worst point, with the precision that ten runs would reach there."""
    rows = plan.table[plan.table["runs"].isna()].to_dict("records")
    scatter, worst = max(
        (
            math.sqrt(
                run_variance(
                    Pilot(
                        row["within_std"], row["autocorrelation_time_s"], row["between_runs_std"]
                    ),
                    row["sliding_time_s"],
                )
            ),
            index,
        )
        for index, row in enumerate(rows)
    )
    row = rows[worst]
    factor = float(special.stdtrit(_TEN - 1, 0.975)) if plan.is_interval else 1.0
    place = ", ".join(filter(None, (row["condition"], speed_text(row[SPEED_COLUMN]))))
    return (
        f"Worst: {place}, one run scatters by {number(scatter)} (standard deviation); {_TEN} runs "
        f"reach {number(factor * scatter / math.sqrt(_TEN))}. Ask for that, or first find why runs "
        "differ"
    )


def _span(runs: pd.Series) -> str:
    """Return the smallest and largest attainable number of runs as text."""
    low, high = runs.min(), runs.max()
    if not math.isfinite(low):
        return "runs out of reach"
    text = many(int(low), "run") if low == high else f"{low:.0f} to {high:.0f} runs"
    return text + (" (out of reach at some points)" if runs.isna().any() else "")
