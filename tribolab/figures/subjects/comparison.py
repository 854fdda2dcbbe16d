"""Figures that compare two campaigns, and control charts of an instrument."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from tribolab.core.errors import AnalysisError
from tribolab.core.untyped import Arguments
from tribolab.figures.colours import BLUE, GREY, ORANGE, VERMILLION
from tribolab.figures.plotted import plotted
from tribolab.figures.spec import Axis, FigureSpec, Key, Mark, Panel, Series, Style
from tribolab.figures.subjects.curves import SPEED_AXIS

_LOG_ABOVE = 300.0  # relative difference [%] above which the scale is logarithmic
_SPREAD = 0.06  # relative shift in speed between conditions, so that their points do not overlap


@plotted()
def differences(points: pd.DataFrame) -> FigureSpec:
    """Draw the relative difference between two measured curves against speed.

    Bars: simultaneous 95 % intervals of all differences; filled points differ. Values are relative
    to the first curve.

    Parameters
    ----------
    points
        As in `tribolab.comparison.comparison.Comparison`: ``condition``, ``sliding_speed_m_s``,
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
            if not part.any():
                continue
            look: Arguments = {"colour": number, "open": open_, "columns": {}}
            if not any(one.label == str(condition) for one in series):
                look["columns"] = numbers
            series.append(
                Series(
                    str(condition), (speed * shift)[part], (100 * value / scale)[part], "points",
                    error=np.nan_to_num((100 * (high - value) / scale)[part]),
                    error_below=np.nan_to_num((100 * (value - low) / scale)[part]), **look,
                )
            )  # fmt: skip
    reach = max(np.abs(np.asarray(one.y, float)).max() for one in series)
    y = Axis("relative difference", "%", linear_below=10.0 if reach > _LOG_ABOVE else None)
    return FigureSpec(
        title="Relative difference",
        note="Bars: simultaneous 95 % intervals for all differences; filled: different.",
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
    """Draw the relative differences between two campaigns as a forest plot.

    Thin bars: 95 %; thick pale ones: 90 %, the level at which equivalence is decided.

    Parameters
    ----------
    quantities
        As in `tribolab.comparison.comparison.Comparison`: ``quantity``, ``of``, ``first``,
        ``difference``, ``low`` and ``high`` of 95 %, ``low_90`` and ``high_90``.
    names
        Names of the two campaigns, for the label of the axis.

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
    """Draw a control chart: one quantity of an instrument against time, with control limits.

    Open points: baseline; red points: values that a rule signals as unusual.

    Parameters
    ----------
    table
        Data of one chart, as `tribolab.comparison.instrument_history.InstrumentHistory` gives:
        ``when``, ``value``, ``quantity``, ``unit``, ``baseline``, ``low``, ``high``, ``smoothed``,
        ``smoothed_low``, ``smoothed_high`` and ``signal``.

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
    # without a range of days, as for a single campaign, one day on either side
    room = 0.06 * np.ptp(days) or 1.0
    date = Axis("date", "date", view=(float(days.min() - room), float(days.max() + room)))
    y = Axis(quantity, "" if unit == "1" else unit)
    return FigureSpec(
        title=f"{quantity} over time",
        panels=(Panel(date, y, name="control"),),
        series=tuple(replace(one, name=quantity) if one.columns else one for one in series),
    )
