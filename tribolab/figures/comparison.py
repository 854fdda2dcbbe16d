"""How well a number is known: budgets, repeats, plans, control charts, campaigns compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from tribolab.errors import AnalysisError
from tribolab.figures.colours import BLUE, GREY, ORANGE, VERMILLION
from tribolab.figures.curves import SPEED_AXIS
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Mark, Panel, Series, Style
from tribolab.metrology.budget_result import UncertaintyBudget
from tribolab.untyped import Arguments

_SMALL = 1e-3  # of the largest part: less is no bar
_MANIFOLD = 300.0  # %: larger differences are drawn on a logarithmic scale
_SPREAD = 0.06  # by which points of several conditions at one speed are set apart


@plotted()
def uncertainty_budget(budget: UncertaintyBudget, at: int | None = None) -> FigureSpec:
    """Draw a bar for each part of the uncertainty of one friction coefficient.

    Bars: effect of one standard uncertainty of each part on the friction coefficient, in per cent
    of it, the largest on top; at the bottom the combined standard uncertainty, with the words
    "statistical only" if no calibration uncertainty was given.

    Parameters
    ----------
    budget
        From `tribolab.uncertainty_budget`.
    at
        Number of the segment or speed, from 0; None for the typical one.

    Examples
    --------
    >>> import tribolab as tl, xarray as xr
    >>> values = {"friction_coefficient": 0.05, "friction_coefficient_sem": 4e-4}
    >>> values |= {"normal_force": 50.0, "direction": 1}
    >>> friction = xr.Dataset({name: ("segment", [value]) for name, value in values.items()})
    >>> stated = {"tilt": {"value": "0.5 deg", "as": "half-width"}}
    >>> figure = uncertainty_budget(tl.uncertainty_budget(friction, stated))
    >>> tl.plot.figure_data(figure).part.tolist()
    ['combined', 'noise and known zero of the run', 'tilt']
    """
    table = budget.table(at)
    mu = abs(table.attrs["friction_coefficient"])
    share = 100 * table["contribution"].to_numpy() / mu
    kept = share >= _SMALL * share[:-1].max(initial=0.0)
    names, share = table.index[kept].to_numpy(dtype=str).tolist()[::-1], share[kept][::-1]
    if "statistical only" in budget.says:
        names[0] += " (statistical only)"
    x = Axis("standard uncertainty", "% of µ", include=(0.0,), column="contribution_percent")
    numbers = {"part": np.array(names), "contribution_percent": share}
    return FigureSpec(
        title="Parts of the uncertainty",
        panels=(Panel(x, Axis("", column="part"), name="parts"),),
        series=(
            Series("combined", share[:1], names[:1], "bars", ORANGE, name="parts", columns=numbers),
            Series("parts", share[1:], names[1:], "bars", BLUE, columns={}),
        ),
        rows=True,
    )


@plotted()
def differences(points: pd.DataFrame) -> FigureSpec:
    """Draw the relative difference of two measured curves over speed.

    Bars contain all differences together with 95 % probability; filled points differ. Values are
    relative to the first.

    Parameters
    ----------
    points
        As in `tribolab.across.compare.Comparison`: ``condition``, ``sliding_speed_m_s``,
        ``first``, ``difference``, ``low``, ``high`` and ``verdict``.

    Raises
    ------
    AnalysisError
        If there are no points.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> points = pd.DataFrame({
    ...     "condition": ["dry"], "sliding_speed_m_s": [1e-4], "first": [0.5],
    ...     "difference": [0.05], "low": [0.02], "high": [0.08], "verdict": ["different"],
    ... })
    >>> figure_data(differences(points)).relative_difference.tolist()
    [0.1]
    """
    if points.empty:
        raise AnalysisError("there is nothing to draw: the two have no point in common")
    groups = list(points.groupby("condition", sort=False))
    series: list[Series] = []
    for number, (condition, rows) in enumerate(groups):
        shift = 1 + _SPREAD * (number - (len(groups) - 1) / 2)
        scale = rows["first"].abs().to_numpy()
        speed, value, low, high = (
            rows[name].to_numpy(dtype=float)
            for name in ("sliding_speed_m_s", "difference", "low", "high")
        )
        numbers = {"sliding_speed_m_s": speed, "relative_difference": value / scale}
        numbers |= {"low": low / scale, "high": high / scale}
        differs = rows["verdict"].isin(["different", "changed by the analysis"]).to_numpy()
        for part, open_ in ((~differs, True), (differs, False)):
            look: Arguments = {"colour": number, "open": open_, "columns": {}}
            if not any(one.label == str(condition) for one in series) and part.any():
                look["columns"] = numbers
            series.append(
                Series(
                    str(condition), (speed * shift)[part], (100 * value / scale)[part], "points",
                    error=np.nan_to_num((100 * (high - value) / scale)[part]),
                    error_below=np.nan_to_num((100 * (value - low) / scale)[part]), **look,
                )
            )  # fmt: skip
    series = [one for one in series if len(one.x)]
    reach = max(np.abs(np.asarray(one.y, float)).max() for one in series)
    y = Axis("relative difference", "%", linear_below=10.0 if reach > _MANIFOLD else None)
    return FigureSpec(
        title="Relative difference",
        note="Bars contain all differences together (95 %); filled: different.",
        panels=(Panel(SPEED_AXIS, y, name="differences"),),
        series=tuple(series),
        marks=(Mark("y", 0.0),),
        keys=(Key("different", "points"), Key("no difference shown", "points", open=True)),
    )


_WORDS = {
    "friction_coefficient": "mean friction",
    "shear_stress_Pa": "shear stress",
    "rms_roughness_m": "rms roughness",
    "rms_slope": "rms slope",
}


@plotted()
def forest(quantities: pd.DataFrame, *, names: Sequence[str] = ("first", "second")) -> FigureSpec:
    """Draw the numbers of two campaigns as relative differences, a row each: a forest plot.

    Thin bars: 95 %; thick pale ones: 90 %, the level at which equivalence is decided.

    Parameters
    ----------
    quantities
        As in `tribolab.across.compare.Comparison`: ``quantity``, ``of``, ``first``, ``difference``,
        ``low`` and ``high`` of 95 %, ``low_90`` and ``high_90``.
    names
        Of the two, for the axis.

    Raises
    ------
    AnalysisError
        If there are no numbers.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> row = {"quantity": "rms_slope", "of": "Sb-R", "first": 0.5, "difference": 0.1}
    >>> ends = {"low": 0.02, "high": 0.18, "low_90": 0.04, "high_90": 0.16}
    >>> drawn = figure_data(forest(pd.DataFrame([row | ends])))
    >>> drawn[["relative_difference", "low", "high_90"]].values.tolist()
    [[0.2, 0.04, 0.32]]
    """
    if quantities.empty:
        raise AnalysisError("there is nothing to draw: the two have no number in common")
    rows = quantities.iloc[::-1]
    scale = rows["first"].abs().to_numpy()
    ends = ("low", "high", "low_90", "high_90")
    value, low, high, low_90, high_90 = (
        rows[name].to_numpy(dtype=float) / scale for name in ("difference", *ends)
    )
    texts = [
        f"{_WORDS.get(str(name), name)}: {of}"
        for name, of in zip(rows["quantity"], rows["of"], strict=True)
    ]
    numbers = dict(zip(("relative_difference", *ends), (value, low, high, low_90, high_90),
                       strict=True))  # fmt: skip
    first, second = names
    series = tuple(
        Series(
            label, 100 * value, texts, "points", BLUE, marker=1, pale=pale,
            error=100 * (above - value), error_below=100 * (value - below),
            columns=numbers if pale else {}, name="difference",
        )
        for label, below, above, pale in (
            ("90 %", low_90, high_90, True),
            ("95 %", low, high, False),
        )
    )  # fmt: skip
    return FigureSpec(
        title="Numbers of two campaigns",
        note="Thin bars: 95 %; thick pale bars: 90 %, the level at which equivalence is decided.",
        panels=(
            Panel(
                Axis(f"({second} − {first}) / {first}", "%"),
                Axis("", column="quantity"),
                name="forest",
            ),
        ),  # fmt: skip
        series=series,
        marks=(Mark("x", 0.0),),
        width="whole",
        rows=True,
    )


@plotted()
def control(table: pd.DataFrame) -> FigureSpec:
    """Draw one quantity of an instrument over time with its control limits.

    Open points: baseline; red points: signals.

    Parameters
    ----------
    table
        Of one chart, as `tribolab.across.history.Watched` gives it: ``when``, ``value``,
        ``quantity``, ``unit``, ``baseline``, ``low``, ``high``, ``smoothed``, ``smoothed_low``,
        ``smoothed_high`` and ``signal``.

    Raises
    ------
    AnalysisError
        If there are no points.

    Examples
    --------
    >>> from tribolab.plot import figure_data
    >>> empty = dict.fromkeys(["low", "high", "smoothed", "smoothed_low", "smoothed_high"], 0.0)
    >>> row = {"when": "2026-03-02T10:00:00", "value": 0.1, "quantity": "zero", "unit": "N"}
    >>> chart = pd.DataFrame([row | empty | {"baseline": True, "signal": ""}])
    >>> figure_data(control(chart)).value.tolist()
    [0.1]
    """
    if table.empty:
        raise AnalysisError("there is nothing to draw: the chart has no points")
    when = pd.to_datetime(table["when"], format="ISO8601")
    days = ((when - pd.Timestamp(0)) / pd.Timedelta(days=1)).to_numpy(dtype=float)
    names = ("value", "low", "high", "smoothed", "smoothed_low", "smoothed_high")
    column = {name: table[name].to_numpy(dtype=float) for name in names}
    baseline = table["baseline"].to_numpy(dtype=bool)
    signal = (table["signal"] != "").to_numpy()
    lines: tuple[tuple[str, str, Style, int], ...] = (
        ("low", "limits of a point", "line", GREY),
        ("high", "limits of a point", "line", GREY),
        ("smoothed", "weighted mean", "line", ORANGE),
        ("smoothed_low", "limits of the mean", "dotted", ORANGE),
        ("smoothed_high", "limits of the mean", "dotted", ORANGE),
    )
    series = [
        Series(label, days, column[name], style, colour, thin=style == "dotted",
               columns={"days": days, **column} if name == "low" else {})
        for name, label, style, colour in lines
    ]  # fmt: skip
    for part, label, look in (
        (baseline & ~signal, "baseline", {"colour": BLUE, "open": True}),
        (~baseline & ~signal, "since", {"colour": BLUE}),
        (signal, "signal", {"colour": VERMILLION, "marker": 2}),
    ):
        own: Arguments = look
        if part.any():
            series.append(
                Series(label, days[part], column["value"][part], "points", columns={}, **own)
            )
    quantity, unit = str(table["quantity"].iloc[0]), str(table["unit"].iloc[0])
    # a single campaign has no interval to divide
    room = 0.06 * np.ptp(days) or 1.0
    date = Axis("date", "date", view=(float(days.min() - room), float(days.max() + room)))
    y = Axis(quantity, "" if unit == "1" else unit)
    return FigureSpec(
        title=f"{quantity} over time",
        panels=(Panel(date, y, name="control"),),
        series=tuple(replace(one, name=quantity) if one.columns else one for one in series),
    )


_ASSURED = {"runs": "assured_runs", "cheapest_runs": "cheapest_assured_runs"}


@plotted()
def runs_needed(table: pd.DataFrame) -> FigureSpec:
    """Draw how many runs reach a precision at each speed.

    Filled: runs that slide as long as those of the pilot; open: runs of the cheapest sliding time;
    bars up to the number of runs that reaches the precision with assurance.

    Parameters
    ----------
    table
        As in `tribolab.across.planning.MeasuringPlan`: ``condition``, ``sliding_speed_m_s``,
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
        "the number that reaches the precision with assurance.",
        panels=(Panel(SPEED_AXIS, Axis("runs", include=(0.0,)), name="runs"),),
        series=tuple(series),
        keys=(Key("as long as the pilot", "points"), Key("cheapest time", "points", open=True)),
    )


@plotted()
def precision(table: pd.DataFrame) -> FigureSpec:
    """Draw the standard deviations within and between mounts, days ... over speed.

    All of them are relative to the mean, in per cent.

    Parameters
    ----------
    table
        As in `tribolab.across.repeatability.Repeatability`: ``sliding_speed_m_s``, ``mean``,
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
