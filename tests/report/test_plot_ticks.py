"""Ticks of logarithmic axes: few, in plain text, and where matplotlib would set them."""

import numpy as np
import pytest
from matplotlib.ticker import LogLocator

from tribolab.figures.look.decades import SmallTicks, few_ticks, power_of_ten
from tribolab.figures.look.style import new_figure, paper_style
from tribolab.plot import svg


@pytest.mark.parametrize(
    ("value", "text"),
    [(1e-12, "10⁻¹²"), (1.0, "10⁰"), (1000.0, "10³"), (0.0, ""), (20.0, "20")],
)
def test_a_decade_is_plain_text(value, text):
    assert power_of_ten(value) == text


def panel(low, high, small=True):
    with paper_style():
        figure = new_figure(86, 60)
        axes = figure.add_subplot(xscale="log", yscale="log")
        axes.plot([low, high], [low, high])
        for axis in (axes.xaxis, axes.yaxis):
            few_ticks(axis, low, high, small=small)
        axes.set_xlim(low, high)
    return figure, axes


def small_ticks(axes):
    return [artist for artist in axes.get_children() if isinstance(artist, SmallTicks)]


def test_small_ticks_stand_at_2_to_9_on_both_sides():
    figure, axes = panel(1e-3, 1e-1)
    svg(figure)
    across, up = small_ticks(axes)
    wanted = np.outer([1e-3, 1e-2], np.arange(2, 10)).ravel()
    for mark, edge in zip(across.marks, (0, 1), strict=True):
        x, y = mark.get_data()
        assert np.allclose(np.sort(x), wanted) and set(y) == {edge}
    assert {*up.marks[1].get_data()[0]} == {1}


def test_over_many_decades_there_is_one_small_tick_in_each():
    figure, axes = panel(1e-9, 1e3)
    svg(figure)
    x, _ = small_ticks(axes)[0].marks[0].get_data()
    assert np.allclose(np.log10(x), np.round(np.log10(x))) and len(x) == 13


def test_small_ticks_follow_the_limits_of_the_axis():
    figure, axes = panel(1e-3, 1e-1)
    svg(figure)
    axes.set_xlim(1e-2, 1e-1)
    svg(figure)
    x, _ = small_ticks(axes)[0].marks[0].get_data()
    assert x.min() >= 1e-2 and len(x) == 8


def test_labels_are_those_of_the_decades_and_no_formula():
    figure, axes = panel(1e-3, 1e-1)
    svg(figure)
    shown = [label.get_text() for label in axes.get_xticklabels()]
    assert {"10⁻³", "10⁻²", "10⁻¹"} <= set(shown) and not any("$" in text for text in shown)
    assert isinstance(axes.xaxis.get_major_locator(), LogLocator)
    assert not small_ticks(panel(1e-3, 1e-1, small=False)[1])


def test_a_figure_saved_twice_is_the_same_to_the_byte():
    figure, _ = panel(1e-3, 1e-1)
    figure.axes[0].set_xlabel(r"speed $v_\mathrm{max}$ (m s$^{-1}$)")
    assert svg(figure) == svg(figure)
