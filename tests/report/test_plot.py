"""The figures: nothing lost on the way to paper, no state left behind, words with units."""

import re
import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from reporting import SPEEDS, made_curve, made_run

import tribolab as tl
from tribolab import plot
from tribolab.core.errors import AnalysisError
from tribolab.figures.colours import surface_colours
from tribolab.figures.look.style import DOUBLE_MM, SINGLE_MM
from tribolab.figures.signals import main_signal
from tribolab.units.stamping import stamp


@pytest.fixture(scope="module")
def made():
    return made_run()


def unknown_speed(run, segments, friction):
    run = run.drop_vars(["sliding_velocity", "position"])
    nan = ("segment", np.full(segments.sizes["segment"], np.nan))
    return run, segments.assign(sliding_speed=nan), friction.assign(sliding_speed=nan)


def force_only(run, segments, friction):
    keep = ["friction_force", "half_loop", "pair", "sliding_speed", "direction"]
    friction = friction[[*keep, "start", "stop", "trimmed_start", "trimmed_stop"]]
    return run.drop_vars("normal_force"), segments, friction


def texts(figure):
    return [text.get_text() for text in figure.findobj(mpl.text.Text) if text.get_text()]


samples = st.lists(st.one_of(st.floats(-1e6, 1e6), st.just(float("nan"))), min_size=1, max_size=400)


@given(y=samples, columns=st.integers(1, 60), steps=st.randoms(use_true_random=False))
@settings(max_examples=200, deadline=None)
def test_envelope_keeps_every_extreme_of_every_column(y, columns, steps):
    y = np.array(y)
    x = np.cumsum([steps.choice([0.0, 0.1, 1.0, 50.0]) for _ in y])
    short_x, short_y = plot.envelope(x, y, columns)
    assert short_x.size <= max(2 * columns, y.size if y.size <= 2 * columns else 0)
    assert (np.diff(short_x) >= 0).all()
    points = {(a, b) for a, b in zip(x, y, strict=True) if np.isfinite(b)}
    assert {(a, b) for a, b in zip(short_x, short_y, strict=True) if np.isfinite(b)} <= points
    if x[-1] == x[0]:
        return
    place = np.minimum((columns * ((x - x[0]) / (x[-1] - x[0]))).astype(int), columns - 1)
    short = np.minimum((columns * ((short_x - x[0]) / (x[-1] - x[0]))).astype(int), columns - 1)
    for column in np.unique(place):
        whole, kept = y[place == column], short_y[short == column]
        if np.isfinite(whole).any():
            assert np.nanmax(kept) == np.nanmax(whole)
            assert np.nanmin(kept) == np.nanmin(whole)
        else:
            assert np.isnan(kept).all()


def test_a_spike_of_one_sample_is_in_the_traces():
    run, segments, friction = made_run(samples=20_000)
    at = 20 + 7_777
    run["friction_force"][at] = 200.0
    spike = float(run["friction_force"][at] / run["normal_force"][at])
    shown = plot.figure_data(plot.trace(run, segments, friction))
    for panel in ("time", "distance"):
        assert shown[shown.panel == panel].friction_coefficient.max() == pytest.approx(spike)
    small = plot.figure_data(plot.strokes(run, segments, friction))
    assert small.friction_coefficient.max() == pytest.approx(spike)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [None, unknown_speed, force_only])
def test_run_figures_are_small_and_the_same_every_time(made, kind):
    parts = kind(*made) if kind else made
    for draw in (plot.trace, plot.strokes):
        first = plot.svg(draw(*parts, title="a run"))
        if kind is None:
            assert first == plot.svg(draw(*parts, title="a run"))
        assert len(first.encode()) < 150_000
        assert "<text" not in first, "letters are outlines, so no font is asked for"


def test_the_largest_run_figure_stays_below_150_kb():
    speeds = [10.0 ** (-6 + k / 3) for k in range(13)]
    parts = made_run(speeds, samples=9_000)
    for draw in (plot.trace, plot.strokes):
        assert len(plot.svg(draw(*parts)).encode()) < 150_000


@pytest.mark.slow
def test_no_setting_of_matplotlib_is_changed_and_pyplot_stays_out():
    code = """
import sys, matplotlib as mpl
sys.path.insert(0, "tests")
mpl.rcParams["font.size"] = 31
mpl.rcParams["axes.grid"] = True
before = dict(mpl.rcParams)
from reporting import made_run, made_curve
import tribolab as tl
from tribolab import plot
parts = made_run(samples=50)
for figure in (plot.trace(*parts), plot.strokes(*parts), plot.stribeck(made_curve())):
    plot.svg(figure); figure._repr_png_()
    assert not figure.axes[0].xaxis.get_gridlines()[0].get_visible()
assert dict(mpl.rcParams) == before
assert "matplotlib.pyplot" not in sys.modules
"""
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


def test_axes_have_quantities_with_symbols_and_units(made):
    figure = plot.trace(*made)
    labels = [axes.get_xlabel() + "|" + axes.get_ylabel() for axes in figure.axes]
    assert labels[0].endswith(r"$\mu = F_x/F_{\mathrm{N}}$")
    assert labels[1] == r"time $t$ (s)|velocity $v$ (m/s)"
    assert "(m)" in labels[2]
    axes = plot.stribeck(made_curve()).axes[0]
    assert axes.get_xlabel() == r"sliding speed $v$ (m/s)"
    assert axes.get_ylabel() == r"friction coefficient $\mu$"
    assert axes.get_xscale() == "log"


def test_force_is_drawn_in_newton_where_no_load_was_recorded(made):
    parts = force_only(*made)
    assert plot.trace(*parts).axes[0].get_ylabel() == "friction force\n" + r"$F_x$ (N)"
    shown = plot.figure_data(plot.half_loop(parts[2]))
    assert shown.half_loop_N.tolist() == pytest.approx(parts[2]["half_loop"].values[::2].tolist())
    assert "(N)" in plot.stribeck(parts[2]).axes[0].get_ylabel()


def test_widths_are_those_of_a_journal(made):
    inches = 1 / 25.4
    assert plot.trace(*made).get_figwidth() == pytest.approx(DOUBLE_MM * inches)
    assert plot.strokes(*made).get_figwidth() == pytest.approx(DOUBLE_MM * inches)
    assert plot.stribeck(made_curve()).get_figwidth() == pytest.approx(SINGLE_MM * inches)
    for figure in (plot.trace(*made), plot.strokes(*made), plot.stribeck(made_curve())):
        sizes = {text.get_fontsize() for text in figure.findobj(mpl.text.Text) if text.get_text()}
        assert 7 <= min(sizes) and max(sizes) <= 9


def test_no_text_runs_into_another(monkeypatch):
    speeds = [10.0 ** (-6 + k / 3) for k in range(13)]
    curves = [made_curve(speeds, 1 / k, load=60.0 * k - 29) for k in (1, 2, 3, 4)]
    parts = made_run(speeds, samples=100)
    drawn, draw = [], mpl.text.Text.draw
    monkeypatch.setattr(
        mpl.text.Text, "draw", lambda text, to: (drawn.append(text), draw(text, to))
    )
    for figure in (plot.trace(*parts), plot.strokes(*parts), plot.stribeck(curves, title="Sb-R")):
        drawn.clear()
        with plot.paper_style():
            canvas = FigureCanvasAgg(figure)
            canvas.draw()
            boxes = [
                (text.get_text(), text.get_window_extent(canvas.get_renderer()).shrunk(0.97, 0.85))
                for text in dict.fromkeys(drawn)
                if text.get_text() and text.get_visible()
            ]
        assert len(boxes) > 10
        for number, (text, box) in enumerate(boxes):
            assert figure.bbox.containsx(box.x0) and figure.bbox.containsx(box.x1), text
            for other, other_box in boxes[number + 1 :]:
                assert not box.overlaps(other_box), f"{text!r} runs into {other!r}"


def test_offset_that_was_found_is_removed_from_the_trace(made):
    run, segments, friction = made
    shifted = run.assign(friction_force=run["friction_force"] + 5.0)
    found = friction.assign(
        friction_force_offset=("segment", np.full(segments.sizes["segment"], 5.0))
    )
    np.testing.assert_allclose(
        main_signal(shifted, found).values, main_signal(run, friction).values, atol=1e-12
    )


def test_ratio_is_left_out_where_nothing_is_pressed(made):
    run, _, friction = made
    load = run["normal_force"].values.copy()
    load[:20] = 0.01
    unloaded = run.assign(normal_force=("time", load))
    ratio = main_signal(unloaded, friction).values
    assert np.isnan(ratio[:20]).all() and np.isfinite(ratio[20:]).all()


def test_distance_panel_ends_at_the_distance_slid(made):
    shown = plot.figure_data(plot.trace(*made))
    slid = shown[shown.panel == "distance"].sliding_distance_m
    assert slid.max() == pytest.approx(2 * len(SPEEDS) * 2e-3, rel=0.02)


def test_strokes_have_a_panel_per_speed_slowest_first(made):
    shown = plot.figure_data(plot.strokes(*made))
    assert list(dict.fromkeys(shown.panel)) == ["1 µm/s", "46.4 µm/s", "10 mm/s"]
    assert shown.distance_over_length.between(0, 1).all()
    means = shown.groupby("series").friction_coefficient.median()
    assert (means > 0.7).all(), "backward strokes count positive too"


def test_many_strokes_of_one_speed_are_thinned_and_the_panel_says_so():
    parts = made_run([1e-3] * 20, samples=60)
    words = texts(plot.strokes(*parts))
    assert any(text.startswith("1 mm/s (12 of 40)") for text in words)


def test_unknown_speeds_number_the_segments(made):
    parts = unknown_speed(*made)
    assert "no. 1" in texts(plot.trace(*parts))
    figure = plot.stribeck(parts[2])
    assert "number of the segment" in figure.axes[0].get_xlabel()
    assert plot.figure_data(figure).segment.tolist() == [1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize("errors", ["U95", "std"])
def test_error_bars_are_u95_or_on_request_the_standard_deviation(errors):
    curve = made_curve()
    curve["friction_coefficient_U95"] = 2.3 * curve.friction_coefficient_sem
    figure = plot.stribeck(curve, errors=errors)
    [bars] = [c for c in figure.axes[0].collections if hasattr(c, "get_segments")]
    reach = np.array([np.ptp(s[:, 1]) / 2 for s in bars.get_segments()])
    np.testing.assert_allclose(reach, curve[f"friction_coefficient_{errors}"].values)


def test_an_unknown_kind_of_error_bar_is_an_error_that_names_the_known_ones():
    with pytest.raises(AnalysisError, match="'sem' is not known; take 'U95' or 'std'"):
        plot.stribeck(made_curve(), errors="sem")


@pytest.mark.parametrize("points", [1, 2, 13])
def test_stribeck_draws_any_number_of_points(points):
    figure = plot.stribeck(made_curve(np.logspace(-6, -2, points)))
    assert len(plot.figure_data(figure)) == points
    low, high = figure.axes[0].get_xlim()
    assert low < 1e-6 and high > np.logspace(-6, -2, points)[-1]


def test_a_curve_is_drawn_once_however_many_runs_it_is_the_mean_of():
    curve = made_curve()
    curve["run_friction_coefficient"] = curve.friction_coefficient.expand_dims(run=["a", "b", "c"])
    assert len(plot.figure_data(plot.stribeck(curve))) == curve.sizes["sliding_speed"]
    apart = curve[["friction_coefficient"]] * xr.DataArray([1.0, 2.0], dims="run")
    assert len(plot.figure_data(plot.stribeck(apart))) == 2 * curve.sizes["sliding_speed"]


def test_a_flat_curve_is_not_cut_by_the_axis():
    names = ("friction_coefficient", "friction_coefficient_std", "friction_coefficient_sem")
    values = ([0.6074, 0.6080], [0.0, 0.0], [0.0001, 0.0002])
    data = {n: ("sliding_speed", v) for n, v in zip(names, values, strict=True)}
    figure = plot.stribeck(xr.Dataset(data, {"sliding_speed": [1e-5, 1e-4]}))
    axes = figure.axes[0]
    figure.draw_without_rendering()
    y, top = axes.transData.transform((1e-4, 0.6082))[1], axes.bbox.y1
    # half a marker of 4.2 pt and its edge fit between the highest error bar and the frame
    assert axes.get_ylim()[0] == 0 and top - y > 2.6 * figure.dpi / 72


def test_stribeck_leaves_nan_out_and_refuses_nothing_at_all():
    curve = made_curve()
    curve["friction_coefficient"][1] = np.nan
    assert len(plot.figure_data(plot.stribeck(curve))) == 2
    curve["friction_coefficient"][:] = np.nan
    with pytest.raises(AnalysisError, match="nothing to draw"):
        plot.stribeck(curve)


def test_surfaces_keep_their_colour_and_dry_is_dashed():
    named = surface_colours(["Smooth", "Sb-S", "Sb-R", "a", "b"])
    assert len(set(named.values())) == 5
    wet, dry = made_curve(surface="Sb-S"), made_curve(surface="Sb-S", medium="dry", mu=1)
    lines = {
        line.get_label(): line
        for line in plot.stribeck([wet, dry]).axes[0].get_lines()
        if not str(line.get_label()).startswith("_")
    }
    assert lines["dry"].get_linestyle() == "--" and lines["glycerol"].get_linestyle() == "-"
    assert lines["dry"].get_color() == lines["glycerol"].get_color() == "#0072B2"
    assert lines["dry"].get_markerfacecolor() == "white"


def test_loads_of_one_surface_differ_in_shade_and_marker():
    curves = [made_curve(load=load) for load in (31.0, 91.0, 151.0)]
    lines = [
        line
        for line in plot.stribeck(curves).axes[0].get_lines()
        if not str(line.get_label()).startswith("_")
    ]
    assert [line.get_label() for line in lines] == ["31 N", "91 N", "151 N"]
    assert len({line.get_color() for line in lines}) == 3
    assert len({line.get_marker() for line in lines}) == 3


def test_model_is_a_line_and_measurement_then_is_points():
    model = made_curve(np.logspace(-6, -2, 50))
    lines = plot.stribeck(made_curve(), model).axes[0].get_lines()
    shown = {str(line.get_label()): line for line in lines}
    assert shown["model"].get_linestyle() == "-" and shown["model"].get_marker() == "None"
    assert {line.get_linestyle() for name, line in shown.items() if name != "model"} == {"None"}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["$", "a$b$c", r"\frac{", "运行", "a\nb\x00c", "<script>", "x" * 300]
)
def test_any_name_can_be_drawn(made, name):
    curves = [made_curve(surface=name), made_curve(surface="Sb-R")]
    for figure in (plot.strokes(*made, title=name), plot.stribeck(curves, title=name)):
        text = plot.svg(figure)
        assert text.startswith("<?xml") and "<script" not in text


def test_a_run_without_friction_is_refused_with_what_it_has():
    run = stamp(xr.Dataset({"position": ("time", [0.0, 1.0])}, {"time": [0.0, 1.0]}))
    with pytest.raises(AnalysisError, match="has position"):
        main_signal(run)


def test_a_notebook_gets_a_picture(made):
    assert plot.trace(*made)._repr_png_().startswith(b"\x89PNG")


def test_traces_are_shifted_by_round_numbers_that_leave_them_apart():
    run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    segments = tl.find_segments(run)
    higher = run.assign(friction_coefficient=run.friction_coefficient + 3.21)
    stack = [plot.Trace(name, one, segments, None, 0) for name, one in
             (("higher", higher), ("lower", run), ("again", run))]  # fmt: skip
    figure = plot.slip_traces(stack)
    drawn = dict(list(plot.figure_data(figure).groupby("series")))
    assert drawn["higher"]["shift"].eq(0).all()
    words = " ".join(text.get_text() for text in figure.axes[0].get_legend().get_texts())
    top = -np.inf
    for name, shape in (("higher", 3.21), ("lower", 0.0), ("again", 0.0)):
        curve, shift = drawn[name], drawn[name]["shift"].iloc[0]
        mean = (curve.shifted - shift).mean() - shape
        assert mean == pytest.approx((drawn["higher"].shifted - 3.21).mean(), abs=0.01)
        assert curve.shifted.min() > top
        top = curve.shifted.max()
        assert not shift or f"shifted up by {shift:g}" in words


def test_error_bars_by_themselves_are_drawn_as_they_are(made):
    curve = made_curve(surface="Sb-R")
    figure = plot.friction_spread(curve)
    kept = plot.figure_data(figure)
    assert kept.friction_coefficient_std.tolist() == curve.friction_coefficient_std.values.tolist()
    [bars] = [lines for box in figure.axes[0].containers for lines in box[2]]
    heights = [np.ptp(bar[:, 1]) for bar in bars.get_segments()]
    assert heights == pytest.approx((2 * curve.friction_coefficient_std).values)
    lower = figure.axes[1].get_lines()[0].get_ydata()
    assert lower == pytest.approx(curve.friction_coefficient_std.values)
    bare = curve.drop_vars("friction_coefficient_std")
    with pytest.raises(AnalysisError, match="no curve has a standard deviation"):
        plot.friction_spread(bare)


def test_long_names_beside_stick_slip_stay_on_the_paper():
    run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    segments, name = tl.find_segments(run), "10 µm/s, velstep4_BRAVA_expb819_basalt"
    slip = tl.stick_slip(run, segments)
    stack = [plot.Trace(label, run, segments, None, 0, "basalt") for label in ("dry", name)]
    for figure in (
        plot.slip_traces(stack),
        plot.waveform_map({name: tl.friction.stick_slip_curve([slip])}),
        plot.slip_spectrogram({name: slip}),
    ):
        canvas = FigureCanvasAgg(figure)
        drawn = [t for t in figure.findobj(mpl.text.Text) if "basalt" in t.get_text()]
        assert drawn and "…" not in drawn[0].get_text()  # whole, the speed first
        for text in drawn:
            box = text.get_window_extent(canvas.get_renderer())
            assert box.x0 >= 0 and box.x1 <= figure.bbox.x1


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["pdf", "ps"])
def test_no_font_is_embedded_as_type_3_which_journals_refuse(tmp_path, ending):
    figure = plot.stribeck(made_curve())
    written = plot.save(figure, tmp_path / f"curve.{ending}").read_bytes()
    assert re.search(rb"/(FontFile2|FontType 42)", written)
    assert not re.search(rb"/Type3|/FontType 3", written)
