"""Figures of surfaces and contacts show the numbers they were given, and keep their looks."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex

from tribolab import plot
from tribolab.core.errors import AnalysisError
from tribolab.figures.colours import PALETTE, surface_colours
from tribolab.units.stamping import stamp

NAMES = ("Smooth", "Sb-S", "Sb-R")
COLOURS = {name: PALETTE[place] for name, place in surface_colours(NAMES).items()}


def spectrum(level, measured=(10, 30)):
    q = np.geomspace(1e3, 1e9, 41)
    c = level * np.minimum(1, (q / 1e5) ** -4.0)
    origin = np.full(q.size, 2, "int8")
    origin[: measured[1]] = 0
    origin[: measured[0]] = 1
    data = {
        "psd_2d": ("wavenumber", c),
        "psd_2d_low": ("wavenumber", 0.8 * c),
        "psd_2d_high": ("wavenumber", 1.3 * c),
        "origin": ("wavenumber", origin),
    }
    return stamp(xr.Dataset(data, {"wavenumber": q}))


def contact(level):
    p = np.geomspace(1e3, 1e6, 31)
    area = np.tanh(level * p / 1e6)
    data = {
        f"contact_area_ratio{end}": ("pressure", factor * area)
        for end, factor in (("", 1.0), ("_low", 0.9), ("_high", 1.1))
    }
    return stamp(xr.Dataset(data, {"pressure": p}))


def adhesive(level, media=("glycerol", "dry")):
    curve = contact(level)[["contact_area_ratio"]]
    medium = xr.DataArray(list(media), dims="medium", name="medium")
    return xr.concat([curve * (1.2 + 0.1 * k) for k in range(len(media))], medium)


def loads(forces=(31.0, 91.0)):
    forces = np.array(forces)
    data = {"pressure": ("load", 7.5e3 * np.sqrt(forces)), "normal_force": ("load", forces)}
    return stamp(xr.Dataset(data, {"load": 10 * forces}))


def work(level):
    zeta = np.geomspace(1, 1e6, 50)
    value = level * np.stack([1 - 1 / zeta, 1.2 * (1 - 1 / zeta)])
    return xr.Dataset(
        {"effective_work_of_adhesion": (("medium", "wavenumber"), value)},
        {
            "medium": ["glycerol", "dry"],
            "wavenumber": 423 * zeta,
            "magnification": ("wavenumber", zeta),
        },
    )


def gap(scale):
    u = np.geomspace(1e-13, 1e-3, 200)
    density = 0.9 / scale * np.exp(-u / scale)
    return stamp(xr.Dataset({"gap_density": ("gap", density)}, {"gap": u}), cutoff_m=1e-9)


def line(width):
    x = np.linspace(-8e-3, 8e-3, 101)
    return xr.Dataset({"x": ("point", x), "pressure": ("point", 5e4 * np.exp(-((x / width) ** 2)))})


def apart(height):
    over = np.linspace(0.1, 6, 40)
    return xr.Dataset(
        {"contact_pressure": ("separation", 1e5 * np.exp(-1.8 * over))},
        {"separation": height * over},
        {"rms_roughness_m": height},
    )


def stress(level):
    v = np.geomspace(1e-6, 1e-2, 13)
    values = {"shear_stress": 1e5 * level * v**0.02, "shear_stress_std": 1e4 + 0 * v}
    return xr.Dataset({k: ("sliding_speed", y) for k, y in values.items()}, {"sliding_speed": v})


def friction(level):
    v = np.geomspace(1e-7, 1e-1, 31)
    return xr.Dataset(
        {"friction_coefficient": ("sliding_speed", level * v**0.2)}, {"sliding_speed": v}
    )


def each(make, levels=(1.0, 2.0, 4.0)):
    return {name: make(level) for name, level in zip(NAMES, levels, strict=True)}


FIGURES = {
    "spectra": lambda: plot.spectra(each(spectrum, (1e-22, 2e-22, 1e-20)), title="Spectra"),
    "contact_area": lambda: plot.contact_area(each(contact), loads()),
    "adhesive_area": lambda: plot.adhesive_area(each(contact), each(adhesive), loads()),
    "effective_work": lambda: plot.effective_work(each(work, (0.05, 0.06, 0.07))),
    "effective_work_relative": lambda: plot.effective_work(
        each(work, (0.05, 0.06, 0.07)), relative_to={"dry": 0.064, "glycerol": 0.051}
    ),
    "gaps": lambda: plot.gaps(each(gap, (1e-6, 3e-6, 1e-5))),
    "line_pressure": lambda: plot.line_pressure(
        each(line, (2e-3, 3e-3, 4e-3)), (np.array([-4e-3, 0, 4e-3]), np.array([0, 5.3e4, 0]))
    ),
    "modulus": lambda: plot.modulus(
        xr.Dataset(
            {
                "storage_modulus": ("angular_frequency", [1e6, 1e7]),
                "loss_modulus": ("angular_frequency", [0.0, 1e6]),
            },
            {"angular_frequency": [1.0, 1e5]},
        )
    ),
    "viscoelastic": lambda: plot.viscoelastic(each(friction)),
    "contact_separation": lambda: plot.contact_separation(each(apart, (1e-6, 3e-6, 1e-5))),
    "shear_stress_over_speed": lambda: plot.shear_stress_over_speed(each(stress)),
}


@pytest.fixture(scope="module", params=list(FIGURES))
def figure(request):
    return FIGURES[request.param]()


def overlaps(one, other):
    return (
        min(one.x1, other.x1) - max(one.x0, other.x0) > 0.5
        and min(one.y1, other.y1) - max(one.y0, other.y0) > 0.5
    )


def test_nothing_overlaps_or_leaves_the_figure(figure):
    with plot.paper_style():
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        renderer = canvas.get_renderer()
    [axes] = figure.axes
    texts = [t for t in figure.texts if t.get_text()] + [axes.xaxis.label, axes.yaxis.label]
    ticks = {
        name: [t for t in axis.get_ticklabels() if t.get_text() and t.get_visible()]
        for name, axis in (("x", axes.xaxis), ("y", axes.yaxis))
    }
    legend = axes.get_legend()
    boxes = {f"text {t.get_text()}": t.get_window_extent(renderer) for t in texts}
    for t in legend.get_texts():
        boxes[f"legend {t.get_text()}"] = t.get_window_extent(renderer)
    boxes["axes"] = axes.get_window_extent(renderer)
    low, high = axes.get_xlim()
    shown = [t for t in ticks["x"] if low <= t.get_position()[0] <= high]
    for t in shown:
        boxes[f"tick {t.get_position()[0]}"] = t.get_window_extent(renderer)
    names = list(boxes)
    for k, name in enumerate(names):
        for other in names[k + 1 :]:
            assert not overlaps(boxes[name], boxes[other]), f"{name} on {other}"
    whole = figure.bbox
    for name, box in boxes.items():
        assert box.x0 >= -1 and box.x1 <= whole.x1 + 1, f"{name} leaves the figure"
        assert box.y0 >= -1 and box.y1 <= whole.y1 + 1, f"{name} leaves the figure"


def test_figure_hands_out_its_numbers_with_units(figure):
    numbers = plot.figure_data(figure)
    assert len(numbers) >= 2
    assert {"panel", "series"} < set(numbers.columns)
    assert numbers.drop(columns=["panel", "series"]).notna().any().all()


def test_figure_is_the_same_bytes_again(figure):
    assert plot.svg(figure) == plot.svg(figure)


@pytest.mark.parametrize(
    "name", ["spectra", "contact_area", "gaps", "viscoelastic", "contact_separation"]
)
def test_every_surface_has_its_own_colour_and_name(name):
    [axes] = FIGURES[name]().axes
    named = {
        handle.get_text(): to_hex(proxy.get_color()).upper()
        for handle, proxy in zip(
            axes.get_legend().get_texts(), axes.get_legend().get_lines(), strict=True
        )
    }
    assert {key: named[key] for key in NAMES} == COLOURS


def test_spectrum_is_drawn_whole_and_its_parts_are_told_apart():
    figure = plot.spectra({"Sb-R": spectrum(1e-20)})
    full, dashed = figure.axes[0].lines[:2]
    assert (full.get_linestyle(), dashed.get_linestyle()) == ("-", "--")
    drawn = [np.isfinite(line.get_ydata()) for line in (full, dashed)]
    assert drawn[0].sum() == 20
    assert (drawn[0] | drawn[1]).all()
    assert (drawn[0] & drawn[1]).sum() == 2  # they meet where one goes over into the other
    rows = plot.figure_data(figure)
    np.testing.assert_array_equal(rows.psd_2d_m4, spectrum(1e-20).psd_2d)


def test_dry_is_dashed_and_no_adhesion_is_dotted():
    [axes] = plot.adhesive_area({"A": contact(1)}, {"A": adhesive(1)}).axes
    legend = axes.get_legend()
    styles = {
        text.get_text(): line.get_linestyle()
        for text, line in zip(legend.get_texts(), legend.get_lines(), strict=True)
    }
    assert styles["A"] == styles["glycerol"] == "-" and styles["dry"] == "--"
    (dotted,) = (line for line in legend.get_lines() if line.get_label() == "no adhesion")
    assert dotted._unscaled_dash_pattern[1][0] < 2


def test_two_liquids_have_two_styles():
    found = {"A": adhesive(1, ("water", "glycerol", "oil", "dry"))}
    lines = plot.adhesive_area({}, found).axes[0].lines[:4]
    assert len({str(line._unscaled_dash_pattern) for line in lines}) == 4


def test_hertz_pressures_are_marked_with_their_forces():
    figure = plot.contact_area({"A": contact(1)}, loads())
    marks = [line.get_xdata()[0] for line in figure.axes[0].lines if len(line.get_xdata()) == 2]
    np.testing.assert_allclose(sorted(marks), 1e-6 * loads().pressure)
    texts = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert "Hertz at 31, 91 N" in texts
    many = plot.contact_area({"A": contact(1)}, loads(range(10, 80, 10)))
    assert "Hertz" in [text.get_text() for text in many.axes[0].get_legend().get_texts()]


def test_gap_figure_shows_shares_of_the_area():
    figure = plot.gaps({"A": gap(1e-6)})
    u, share = figure.axes[0].lines[0].get_data()
    density = np.interp(u, 1e6 * gap(1e-6)["gap"], gap(1e-6).gap_density)
    np.testing.assert_allclose(share, 1e-6 * u * density, rtol=1e-6)
    assert np.trapezoid(share, np.log(u)) == pytest.approx(0.9, rel=0.01)
    assert u.min() >= 1e-3  # nothing below an atom


def test_pressure_profiles_are_drawn_in_megapascal_over_millimetres():
    figure = plot.line_pressure({"A": line(3e-3)})
    x, p = figure.axes[0].lines[0].get_data()
    np.testing.assert_allclose(x, 1e3 * line(3e-3)["x"])
    np.testing.assert_allclose(p, 1e-6 * line(3e-3)["pressure"])
    assert "(mm)" in figure.axes[0].get_xlabel() and "(MPa)" in figure.axes[0].get_ylabel()


def test_names_from_files_are_harmless():
    figure = plot.contact_area({"$\\frac{1$ <b>": contact(1)})
    assert "svg" in plot.svg(figure)


def test_no_spectrum_is_an_error():
    with pytest.raises(AnalysisError, match="nothing to draw"):
        plot.spectra({})
