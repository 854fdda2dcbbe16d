"""Figures for planning: uncertainty budget, repeatability, number of runs needed."""

from __future__ import annotations

import numpy as np
import pandas as pd

from tribolab.core.errors import AnalysisError
from tribolab.figures.colours import BLUE, ORANGE
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Panel, Series
from tribolab.figures.subjects.curves import SPEED_AXIS
from tribolab.metrology.budget_result import UncertaintyBudget

_MIN_SHARE = 1e-3  # contributions below this share of the largest one have no bar
_SPREAD = 0.06  # relative shift in speed, so that two points at one speed do not overlap


@plotted()
def uncertainty_budget(budget: UncertaintyBudget, at: int | None = None) -> FigureSpec:
    """Draw a bar for each contribution to the uncertainty of one friction coefficient.

    Bars: effect of one standard uncertainty of each part on the friction coefficient, in per cent
    of it, the largest on top; at the bottom the combined standard uncertainty, with the words
    "statistical only" if no calibration uncertainty was given.

    Parameters
    ----------
    budget
        From `tribolab.metrology.uncertainty_budget`.
    at
        Index of the segment or speed; None for a typical one.

    Examples
    --------
    >>> import tribolab as tl, xarray as xr
    >>> values = {"friction_coefficient": 0.05, "friction_coefficient_sem": 4e-4}
    >>> values |= {"normal_force": 50.0, "direction": 1}
    >>> friction = xr.Dataset({name: ("segment", [value]) for name, value in values.items()})
    >>> stated = {"tilt": {"value": "0.5 deg", "as": "half-width"}}
    >>> figure = uncertainty_budget(tl.metrology.uncertainty_budget(friction, stated))
    >>> tl.plot.figure_data(figure).part.tolist()
    ['combined', 'noise and known zero of the run', 'tilt']
    """
    table = budget.table(at)
    mu = abs(table.attrs["friction_coefficient"])
    share = 100 * table["contribution"].to_numpy() / mu
    kept = share >= _MIN_SHARE * share[:-1].max(initial=0.0)
    names, share = table.index[kept].to_numpy(dtype=str).tolist()[::-1], share[kept][::-1]
    if "statistical only" in budget.caveats:
        names[0] += " (statistical only)"
    x = Axis("standard uncertainty", "% of µ", include=(0.0,), column="contribution_percent")
    numbers = {"part": np.array(names), "contribution_percent": share}
    return FigureSpec(
        title="Contributions to the uncertainty",
        panels=(Panel(x, Axis("", column="part"), name="parts"),),
        series=(
            Series("combined", share[:1], names[:1], "bars", ORANGE, name="parts", columns=numbers),
            Series("parts", share[1:], names[1:], "bars", BLUE, columns={}),
        ),
        rows=True,
    )


_ASSURED = {"runs": "assured_runs", "cheapest_runs": "cheapest_assured_runs"}


@plotted()
def runs_needed(table: pd.DataFrame) -> FigureSpec:
    """Draw the number of runs that reach a wanted precision, against speed.

    Filled: runs that slide as long as those of the pilot; open: runs of the cheapest sliding time;
    bars up to the number of runs that reaches the precision with assurance.

    Parameters
    ----------
    table
        As in `tribolab.comparison.planning.MeasuringPlan`: ``condition``, ``sliding_speed_m_s``,
        ``runs`` and ``cheapest_runs``; ``assured_runs`` and ``cheapest_assured_runs`` if known.

    Raises
    ------
    AnalysisError
        If there are no points.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> table = pd.DataFrame({"condition": ["dry"], "sliding_speed_m_s": [1e-3], "runs": [7.0]})
    >>> figure_data(runs_needed(table.assign(cheapest_runs=5.0))).cheapest_runs.dropna().tolist()
    [5.0]
    """
    if table.empty:
        raise AnalysisError("there is nothing to draw: the plan has no points")
    series = []
    for number, (condition, rows) in enumerate(table.groupby("condition", sort=False)):
        speed = rows["sliding_speed_m_s"].to_numpy(dtype=float)
        for name, shift in (("runs", 1 - _SPREAD), ("cheapest_runs", 1 + _SPREAD)):
            value, sure = rows[name].to_numpy(dtype=float), _ASSURED[name]
            numbers = {"sliding_speed_m_s": speed, name: value}
            error = np.zeros(0)
            if sure in rows:
                numbers[sure] = rows[sure].to_numpy(dtype=float)
                error = np.nan_to_num(numbers[sure] - value)
            series.append(
                Series(
                    str(condition), shift * speed, value, "points", number, error=error,
                    error_below=0 * error, open=name != "runs", joined=True, columns=numbers,
                )
            )  # fmt: skip
    return FigureSpec(
        title="Runs needed",
        note="Filled: as long as the pilot's runs; open: of the cheapest sliding time. Bars: up to "
        "the number of runs with the stated assurance.",
        panels=(Panel(SPEED_AXIS, Axis("runs", include=(0.0,)), name="runs"),),
        series=tuple(series),
        keys=(Key("as long as the pilot", "points"), Key("cheapest time", "points", open=True)),
    )


@plotted()
def precision(table: pd.DataFrame) -> FigureSpec:
    """Draw standard deviations within and between mounts, days etc. against speed.

    All are in per cent of the mean.

    Parameters
    ----------
    table
        As in `tribolab.comparison.repeat_study.Repeatability`: ``sliding_speed_m_s``, ``mean``,
        ``repeatability_std``, ``between_..._std`` and ``reproducibility_std``; a row without a
        speed is omitted.

    Raises
    ------
    AnalysisError
        If there is no speed.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> table = pd.DataFrame({
    ...     "sliding_speed_m_s": [1e-4], "mean": [0.5], "repeatability_std": [0.01],
    ...     "between_mount_std": [0.02], "reproducibility_std": [0.0224],
    ... })
    >>> figure_data(precision(table)).relative_standard_deviation.round(4).tolist()
    [0.02, 0.04, 0.0448]
    """
    rows = table[np.isfinite(table["sliding_speed_m_s"])]
    if rows.empty:
        raise AnalysisError("there is nothing to draw: no speed has a standard deviation")
    speed = rows["sliding_speed_m_s"].to_numpy(dtype=float)
    texts = {"repeatability": "within", "reproducibility": "all together"}
    series = []
    for number, name in enumerate(c for c in map(str, rows) if c.endswith("_std")):
        words = name.removesuffix("_std").replace("_", " ")
        value = rows[name].to_numpy(dtype=float) / rows["mean"].abs().to_numpy(dtype=float)
        numbers = {"sliding_speed_m_s": speed, "relative_standard_deviation": value}
        series.append(
            Series(texts.get(words, words), speed, 100 * value, "points", number, joined=True,
                   open=words == "reproducibility", name=words, columns=numbers)
        )  # fmt: skip
    return FigureSpec(
        title="Repeatability and reproducibility",
        panels=(
            Panel(
                SPEED_AXIS,
                Axis("standard deviation", "% of the mean", include=(0.0,)),
                name="precision",
            ),
        ),  # fmt: skip
        series=tuple(series),
    )
