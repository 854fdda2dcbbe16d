"""A picture on the page shows what the live figure in its place shows: axes, limits, bars."""

import json
from dataclasses import replace

import numpy as np
import pytest
from report_pages import DRAW_ALL, OPEN_ALL, figures_of, live_of

from tribolab.figures.axes import comparable
from tribolab.figures.page.plain_data import plain_data
from tribolab.figures.page.still import first_view
from tribolab.figures.spec import Axis, FigureSpec, Panel, Series, legend


@pytest.fixture(scope="module")
def whole(flagged_results):
    """All results."""
    return flagged_results


@pytest.mark.slow
def test_axes_show_what_is_seen_and_bars_end_where_values_end(browser, results):
    figure = {
        "panels": [{"x": {"label": "gap", "log": True, "decades": 2}, "y": {"log": True}}],
        "series": [{"label": "a", "x": [1e-6, 1, 10, 100], "y": [1e9, 2, 1, 0.5]}],
    }
    stress = {
        "panels": [{"x": {"label": "load", "unit": "N"}, "y": {"label": "stress", "least": 0}}],
        "series": [{"label": "a", "x": [31], "y": [0.2], "style": "points", "error": [0.5]}],
    }
    drawing = "(() => {{ const it = new report.Chart(document.querySelector('#card-1'));"
    drawing += "it.data = {}; return {} }})()"
    with browser.page(results / "report.html") as page:
        low, high = page.run(drawing.format(json.dumps(figure), "it.range('y', 0)"))
        # what lies outside the gaps that are seen has no part in the height
        assert np.log10(0.25) < low < np.log10(0.5) and np.log10(2) < high < np.log10(4)
        low, high = page.run(drawing.format(json.dumps(stress), "it.range('x', 0)"))
        assert low < 20 and high > 42
        bars = page.run(drawing.format(json.dumps(stress), "it.traces()[0].error_y"))
        assert (bars["array"], bars["arrayminus"]) == ([0.5], [0.2])


LIMITS = (
    "(() => {{ const {{ _fullLayout: layout }} = {};"
    "return Object.fromEntries(Object.keys(layout).filter(name => /^[xy]axis\\d*$/.test(name))"
    ".map(name => [name, [layout[name].type === 'log', ...layout[name].range]])) }})()"
)


def assert_seen_alike(figure, limits):
    """The picture of a figure shows what the live figure does: type and limits of all axes."""
    for number, pair in enumerate(first_view(figure)[1]):
        for side, scale in zip("xy", pair, strict=True):
            log, low, high = limits[f"{side}axis{number + 1 if number else ''}"]
            told = f"{figure.id}, {side} of panel {number}"
            assert scale.log == log, told
            assert (scale.low, scale.high) == pytest.approx((low, high), abs=1e-3 * (high - low)), (
                told
            )


@pytest.mark.slow
def test_a_picture_shows_what_the_live_figure_shows_at_first(browser, whole):
    figures = {name: live_of(data) for name, data in figures_of(whole).items() if "panels" in data}
    assert len(figures) >= 5
    with browser.page(whole / "report.html") as page:
        page.run(OPEN_ALL)
        page.run(DRAW_ALL)
        for name, figure in figures.items():
            limits = page.run(LIMITS.format(f"document.querySelector('#{name} .plot')"))
            assert_seen_alike(figure, limits)


def figure_of(*series, x=None, y=None):
    """A figure of made-up series, in as many panels as they say."""
    panel = Panel(x or Axis("x"), y or Axis("y"))
    count = 1 + max(one.panel for one in series)
    return FigureSpec("made", "", "", "", "", (panel,) * count, series)


WIDE = [1e-6, 1e-4, 1e-2]


KINDS = {
    "bars of errors, band": figure_of(
        Series("a", WIDE, [1.0, 0.2, 0.01], "points", error=[0.1, 0.1, 0.02]),
        Series("b", WIDE, [1e-9, 0.1, 0.1], "band", high=[90.0, 0.3, 0.2]),
        x=Axis("v", log=True),
        y=Axis("mu", log=True),
    ),
    "decades": figure_of(Series("a", WIDE, [1e-7, 1.0, 2.0]), y=Axis("y", log=True, decades=3)),
    "least": figure_of(
        Series("a", [31.0], [0.2], "points", error=[0.5]), y=Axis("stress", "MPa", least=0.0)
    ),
    "compared with others": figure_of(
        Series("a", WIDE, [1.0, 0.2, 0.01], "points"),
        x=Axis("v", log=True, include=(1e-8, 1e-3)),
        y=Axis("mu", log=True, include=(1e-3, 2.0)),
    ),
    "compared, linear": figure_of(Series("a", WIDE, WIDE), y=Axis("y", include=(-2.0, 1.0))),
    "panels": figure_of(
        Series("a", [1.0, 2.0], [2.0, 2.1]), Series("b", [0.0, 9.0], [-3, 4], panel=1)
    ),
    "bars": figure_of(
        Series("a", [0.5, 20.0], ["one", "another"], "bars"),
        Series("b", [3.0, 70.0], ["another", "third"], "bars"),
        x=Axis("change", "%", log=True),
        y=Axis(""),
    ),
    "bars, linear": figure_of(Series("a", [5.0, 20.0], ["one", "another"], "bars"), y=Axis("")),
    "names": figure_of(
        Series("a", WIDE, ["c", "b", "a"], "points"), x=Axis("v", log=True), y=Axis("")
    ),
}


def test_figures_that_are_compared_show_the_same_and_all_of_it():
    x, y = Axis("v", log=True), Axis("mu", log=True)
    one, other = (
        figure_of(Series("a", WIDE, mu, "points", error=errors), x=x, y=y)
        for mu, errors in (([1.0, 0.2, 0.01], [0.5, 0.1, 0.001]), ([2.0, 2.0, 1.5], [0.1] * 3))
    )
    panel = comparable([(figure.panels[0], figure.series) for figure in (one, other)])
    assert panel.x.include == (1e-6, 1e-2)
    assert panel.y.include == pytest.approx((0.009, 2.1))
    seen = [first_view(replace(figure, panels=(panel,)))[1] for figure in (one, other)]
    assert seen[0] == seen[1]


def test_a_band_has_a_name_in_the_legend_where_no_line_has_it():
    band = Series("model", WIDE, WIDE, "band", high=WIDE)
    line, points = Series("model", WIDE, WIDE), Series("measured", WIDE, WIDE, "points")
    assert legend([band, line, points]) == {"model": line, "measured": points}
    own = replace(band, label="uncertainty")
    assert list(legend([own, line, replace(band, label="")])) == ["model", "uncertainty"]


@pytest.mark.slow
def test_a_picture_of_any_kind_has_the_limits_of_the_live_figure(browser, results):
    drawing = (
        "(async () => {{ await report.charts.plotly(); const place = document.createElement('div');"
        "const it = new report.Chart(document.querySelector('#card-1')); it.data = {};"
        "await Plotly.newPlot(place, it.traces(), it.layout()); return {} }})()"
    )
    with browser.page(results / "report.html") as page:
        for kind, figure in KINDS.items():
            limits = page.run(
                drawing.format(json.dumps(plain_data(figure)), LIMITS.format("place"))
            )
            assert_seen_alike(replace(figure, id=kind), limits)


@pytest.mark.parametrize(
    ("y", "low", "high"),
    [([0.32004], 0.15, 0.7), ([0.32, 0.3200006], 0.15, 0.7), ([0.3199, 0.3201], 0.26, 0.4)],
)
def test_one_point_or_noise_in_a_last_digit_does_not_fill_an_axis(y, low, high):
    points = Series("a", [1e-3] * len(y), y, style="points", error=[6e-5] * len(y))
    axes = (Axis("v", log=True), Axis("mu", log=True))
    figure = FigureSpec("one", "one", "", "", "", (Panel(*axes),), (points,))
    across, up = first_view(figure)[1][0]
    assert 10**across.low < 0.6e-3 and 10**across.high > 1.6e-3
    assert low < 10**up.low < 0.3 and 0.34 < 10**up.high < high
