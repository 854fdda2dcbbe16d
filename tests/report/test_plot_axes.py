"""Every figure can be drawn in axes of the user's, beside curves of the user's own."""

import inspect

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from matplotlib.figure import Figure

import tribolab as tl
from tribolab import plot
from tribolab.core.errors import AnalysisError
from tribolab.rig.parameters import Protocol, Rig
from tribolab.studies import xu2026

OWN = "my own"


@pytest.fixture(scope="module")
def drawings():
    """Return what draws each figure of one or several panels, how many, and what it names."""
    run = tl.rig.simulate_run("Sb-S", "dry", rig=Rig(Protocol(speeds=(1e-4, 1e-3)))).noise_free
    segments = tl.find_segments(run)
    friction = tl.friction_coefficient(run, segments)
    curve = tl.measured_stribeck_curve([friction])
    psd = xu2026.psd("Sb-S", 301)
    given = {"viscosity": 1.4, "load": 310.0, "cells": 60}
    model = tl.stribeck_curve(
        xu2026.contact, psd, shear_stress=8e5, speed=np.geomspace(1e-6, 1e-3, 4), **given
    )
    fit = model[["friction_coefficient"]]
    fit["friction_coefficient_sem"] = fit["friction_coefficient_residual"] = 0.01 * (
        fit.friction_coefficient
    )
    spread = tl.fit.model_uncertainty(
        xu2026.contact, None, speed=[1e-3, 1e-1], shear_stress=0.0, **given
    )
    several = tl.stribeck_curve(
        xu2026.contact, psd, 1.4, [310.0, 910.0], 8e5, np.geomspace(1e-7, 1e-1, 19), cells=60
    )
    points = several[["friction_coefficient"]].isel(sliding_speed=slice(3, -3))
    points["friction_coefficient_sem"] = 0.02 * points.friction_coefficient
    jointly = tl.fit.fit_shear_stress_jointly(
        points, xu2026.contact, psd, 1.4, points["load"], curves=several
    )
    stated = {"tilt": {"value": "1 deg", "as": "half-width"}}
    budget = tl.metrology.uncertainty_budget(friction, stated)
    film = tl.lubrication.film_profile(xu2026.contact, psd, speed=1e-3, **given)
    factors = tl.lubrication.flow_factors(psd)
    factors = factors.dataset(factors.rms_roughness * np.geomspace(0.3, 3, 5))
    trace = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    places = tl.find_segments(trace)
    slip = tl.stick_slip(trace, places)
    pressure = xr.DataArray([1e4, 1e5], {"pressure": [1e4, 1e5]}, "pressure")
    area = tl.contact.contact_area_ratio(pressure, psd, "2 MPa").to_dataset(
        name="contact_area_ratio"
    )
    sticky = tl.contact.adhesion(pressure, psd, 2e6, 0.05, nodes=60).expand_dims(medium=["dry"])
    wide = {"separation": [1e-6, 2e-6, 3e-6]}
    pressed = xr.Dataset({"contact_pressure": ("separation", [2e5, 3e4, 5e3])}, wide)
    moduli = {f"{k}_modulus": ("angular_frequency", [1e6, 1e7]) for k in ("storage", "loss")}
    fits = pd.DataFrame(
        {
            "surface": ["Sb-S"] * 2,
            "normal_force_N": [31.0, 91.0],
            "shear_stress_Pa": [8e5, 7e5],
            "shear_stress_low_Pa": [7e5, 6e5],
            "shear_stress_high_Pa": [9e5, 8e5],
            "corrected_shear_stress_Pa": [5e5, 4e5],
            "corrected_shear_stress_error_Pa": [3e4, 3e4],
        }
    )
    over_speed = {"shear_stress": [6e5, 6.1e5], "shear_stress_std": [1e4, 1e4]}
    stresses = xr.Dataset(
        {k: ("sliding_speed", v) for k, v in over_speed.items()}, {"sliding_speed": [1e-5, 1e-3]}
    )
    at_starts = {"static_friction_coefficient": [0.5, 0.6], "waiting_time": [1e-5, 1e-4]}
    at_starts |= {"static_friction_coefficient_sem": [0.01, 0.01], "peak": [1, 0]}
    at_starts |= {"friction_coefficient": [0.4, 0.4]}
    starts = xr.Dataset({k: ("start_of_sliding", v) for k, v in at_starts.items()})
    turns = xr.Dataset(
        {"friction_coefficient": ("cycle", [0.3, 0.31]), "time": ("cycle", [0.5, 1.5])}
        | {"mean_friction_coefficient": 0.305, "trend": 0.01, "trend_p_value": 1e-3},
        {"cycle": [1, 2]},
    )
    pair = {"condition": ["dry"] * 2, "sliding_speed_m_s": [1e-5, 1e-4], "first": [0.5, 0.4]}
    pair |= {"difference": [0.1, 0.0], "low": [0.05, -0.1], "high": [0.15, 0.1]}
    pair |= {
        "low_90": [0.06, -0.08],
        "high_90": [0.14, 0.08],
        "verdict": ["different", "undecided"],
    }
    beside = pd.DataFrame(pair | {"quantity": ["rms_slope"] * 2, "of": ["Sb-S", "Sb-R"]})
    pair |= {"mean": [0.5, 0.4], "repeatability_std": [0.01, 0.02], "between_day_std": 0.01}
    spreads = pd.DataFrame(pair)
    dates = {"when": ["2026-01-01T00:00:00"] * 2, "quantity": "zero", "unit": "N", "signal": ""}
    dates |= dict.fromkeys(("low", "high", "smoothed", "smoothed_low", "smoothed_high"), 0.0)
    chart = pd.DataFrame(dates | {"value": [0.1, 0.2], "baseline": [True, False]})
    wanted = beside.assign(runs=[3.0, 5.0], cheapest_runs=[2.0, 4.0])
    return {
        "runs_needed": (lambda **k: plot.runs_needed(wanted, **k), 1, "dry"),
        "control": (lambda **k: plot.control(chart, **k), 1, "weighted mean"),
        "uncertainty_budget": (lambda **k: plot.uncertainty_budget(budget, **k), 1, "combined"),
        "precision": (lambda **k: plot.precision(spreads, **k), 1, "between day"),
        "differences": (lambda **k: plot.differences(beside, **k), 1, "dry"),
        "forest": (lambda **k: plot.forest(beside, **k), 1, "90 %"),
        "stribeck": (lambda **k: plot.stribeck(curve, model, **k), 1, "model"),
        "half_loop": (lambda **k: plot.half_loop(friction, **k), 1, "half loop"),
        "spectra": (lambda **k: plot.spectra({"Sb-S": psd}, **k), 1, "Sb-S"),
        "profiles": (
            lambda **k: plot.profiles({"Sb-S": tl.rig.scans("Sb-S", 1, length=1e-3)}, **k),
            1,
            "Sb-S",
        ),
        "modulus": (
            lambda **k: plot.modulus(xr.Dataset(moduli, {"angular_frequency": [1, 1e3]}), **k),
            1,
            "storage modulus",
        ),
        "viscoelastic": (lambda **k: plot.viscoelastic({"Sb-S": model}, **k), 1, "Sb-S"),
        "contact_area": (lambda **k: plot.contact_area({"Sb-S": area}, **k), 1, "Sb-S"),
        "adhesive_area": (
            lambda **k: plot.adhesive_area({"Sb-S": area}, {"Sb-S": sticky}, **k), 1, "dry",
        ),
        "effective_work": (
            lambda **k: plot.effective_work({"Sb-S": sticky.isel(pressure=0)}, **k), 1, "dry",
        ),
        "gaps": (
            lambda **k: plot.gaps({"Sb-S": tl.contact.gap_distribution(4e4, psd, 2e6)}, **k),
            1,
            "Sb-S",
        ),
        "line_pressure": (
            lambda **k: plot.line_pressure(
                {"Sb-S": tl.contact.rough_line_contact(310.0, xu2026.contact, psd, points=101)}, **k
            ),
            1,
            "Sb-S",
        ),
        "contact_separation": (
            lambda **k: plot.contact_separation(
                {"Sb-S": pressed.assign_attrs(rms_roughness_m=1e-6)}, **k
            ),
            1,
            "Sb-S",
        ),
        "shear_stress": (lambda **k: plot.shear_stress(fits, **k), 1, "as fitted"),
        "friction_factor_effect": (
            lambda **k: plot.friction_factor_effect({"Sb-S": model}, **k), 1, "without",
        ),
        "friction_spread": (
            lambda **k: plot.friction_spread(curve.assign_attrs(surface="Sb-S"), **k), 2,
            "measured",
        ),
        "shear_stress_over_speed": (
            lambda **k: plot.shear_stress_over_speed({"Sb-S": stresses}, **k), 1, "Sb-S",
        ),
        "static_friction": (lambda **k: plot.static_friction({"dry": starts}, **k), 1, "dry"),
        "cycles": (lambda **k: plot.cycles({"dry": turns}, **k), 1, "dry"),
        "slip_traces": (
            lambda **k: plot.slip_traces([plot.Trace("dry", trace, places, None, 0)], **k),
            1,
            "dry",
        ),
        "waveform_map": (
            lambda **k: plot.waveform_map({"dry": tl.friction.stick_slip_curve([slip])}, **k),
            1,
            "sawtooth stick-slip",
        ),
        "master_curve": (
            lambda **k: plot.master_curve([model], [1.0], names=["glycerol"], **k), 1, "glycerol",
        ),
        "mixed_curve": (lambda **k: plot.mixed_curve(fit, model, **k), 2, "viscous part"),
        "joint_fit": (lambda **k: plot.joint_fit(jointly, **k), 2, "310 N/m"),
        "lubrication_factors": (
            lambda **k: plot.lubrication_factors({"Sb-S": factors}, **k), 2, "Sb-S",
        ),
        "film_profiles": (lambda **k: plot.film_profiles([film], **k), 3, ""),
        "slip_events": (lambda **k: plot.slip_events({"dry": slip}, **k), 3, "dry"),
        "slip_spectra": (
            lambda **k: plot.slip_spectra({"dry": (slip, 0)}, **k), 1, "red and white noise",
        ),
        "slip_spectrogram": (lambda **k: plot.slip_spectrogram({"dry": slip}, **k), 1, ""),
        "model_sensitivity": (lambda **k: plot.model_sensitivity(spread, **k), 2, "model"),
        "trace": (lambda **k: plot.trace(run, segments, friction, **k), 3, "mean"),
        "strokes": (lambda **k: plot.strokes(run, segments, friction, **k), 2, "forward"),
        "run": (lambda **k: plot.run(run, **k), len(run.data_vars), ""),
    }  # fmt: skip


FIGURES = [
    name
    for name in plot.__all__
    if "Figure" in str(inspect.signature(getattr(plot, name)).return_annotation) and name != "draw"
]


@pytest.mark.slow
@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_drawn_in_the_users_axes_and_joins_the_users_legend(drawings, name):
    draw, count, named = drawings[name]
    taken = inspect.signature(getattr(plot, name)).parameters
    before = dict(mpl.rcParams)
    figure = Figure(layout="constrained")
    if "ax" in taken:
        axes = figure.subplots()
        axes.plot([2e-5, 2e-4], [0.5, 0.6], label=OWN)
        drawn = draw(ax=axes, **({"title": "A title"} if "title" in taken else {}))
        low, high = axes.get_xlim()
        assert low <= 2e-5 < 2e-4 <= high
        legend = [text.get_text() for text in axes.get_legend().get_texts()]
        assert OWN in legend and any(named in text for text in legend)
        assert len(set(legend)) == len(legend)
    else:
        panels = np.atleast_1d(figure.subplots(1, count))
        drawn = draw(axes=panels)
        again = panels[0].get_legend_handles_labels()[1]
        assert named == "" or any(named in text for text in again)
        with pytest.raises(AnalysisError, match=f"axes: {count} (is|are) wanted"):
            draw(axes=[*panels, panels[0]])
    assert drawn is figure
    figure.canvas.draw()
    assert dict(mpl.rcParams) == before
    pd.testing.assert_frame_equal(plot.figure_data(figure), plot.figure_data(draw()))


def test_what_is_drawn_later_comes_into_sight_and_into_the_legend(drawings):
    axes = Figure().subplots()
    drawings["stribeck"][0](ax=axes)
    axes.plot([1e-9, 1.0], [0.1, 9.0], label=OWN)
    axes.legend()
    assert axes.get_xlim()[0] < 1e-9 and axes.get_ylim()[1] > 9
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["model", "measured", OWN]
