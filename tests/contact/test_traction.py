"""Machines whose two bodies turn: entrainment speed, slide-roll ratio and traction curves."""

import json
from dataclasses import replace

import numpy as np
import pytest

import tribolab as tl
from tribolab.app.run import run_campaign
from tribolab.contact.geometry import LineContact
from tribolab.core.errors import AnalysisError
from tribolab.friction.traction import stribeck_part, traction_curves
from tribolab.lubrication.parameters import Interface
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.rig import MiniTraction, simulate_mini_traction
from tribolab.rig.mini_traction import mini_traction_text
from tribolab.studies import xu2026

MACHINE = MiniTraction(traction_ratios=(0.25, 0.5, 1.0), noise=0.01, level=0.01)
LINE = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)


def friction_of(folder, machine, seed=1):
    file = folder / f"run_{seed}.txt"
    file.write_text(mini_traction_text(machine, seed), "utf-8")
    run = tl.read(file)
    return tl.friction_coefficient(run, tl.find_segments(run))


def test_the_sliding_speed_as_abscissa_gives_the_same_film_and_friction():
    psd, ratio, rolling = xu2026.psd("Sb-S"), 0.5, np.array([1e-4, 1e-3])
    over_rolling = tl.stribeck_curve(
        LINE, psd, 1.4, 310.0, Interface(1e6, slide_roll=ratio), rolling
    )
    sliding = Interface(1e6, slide_roll=ratio, abscissa="sliding_speed")
    over_sliding = tl.stribeck_curve(LINE, psd, 1.4, 310.0, sliding, ratio * rolling)
    assert over_sliding.friction_coefficient.dims == ("sliding_speed",)
    for name in ("friction_coefficient", "minimum_separation", "friction_coefficient_pressure"):
        assert over_sliding[name].values == pytest.approx(over_rolling[name].values, rel=1e-9)
    with pytest.raises(AnalysisError, match="nothing slides in pure rolling"):
        Interface(slide_roll=0.0, abscissa="sliding_speed")


def test_stribeck_and_traction_steps_of_one_file_are_told_apart(tmp_path):
    friction = friction_of(tmp_path, MACHINE)
    (part,), ratio = stribeck_part([friction])
    assert ratio == pytest.approx(0.5)
    assert np.abs(part["slide_roll_ratio"].values) == pytest.approx(0.5)
    traction = traction_curves([friction])
    assert traction["slide_roll_ratio"].values == pytest.approx(MACHINE.traction_ratios)
    assert traction["rolling_speed"].values == pytest.approx(0.05)
    truth = [
        float(MACHINE.friction(np.array(0.05), ratio, MACHINE.viscosity))
        for ratio in MACHINE.traction_ratios
    ]
    assert traction["friction_coefficient"].values == pytest.approx(truth, rel=0.06)


def test_a_file_without_traction_steps_has_no_traction_curve(tmp_path):
    machine = MiniTraction(traction_ratios=(), noise=0.0, level=0.0)
    friction = friction_of(tmp_path, machine)
    assert traction_curves([friction]).point.size == 0
    bare = friction.drop_vars("slide_roll_ratio")
    assert stribeck_part([bare])[1] is None
    with pytest.raises(AnalysisError, match="slide-roll ratio"):
        traction_curves([bare])


def test_the_real_file_has_the_slide_roll_ratio_of_its_only_step(shared_data):
    run = tl.read(shared_data / "pcs_mtm_ehd_MIT/demo_5.txt")
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    (part,), ratio = stribeck_part([friction])
    assert ratio == pytest.approx(1.0, abs=0.01)
    assert np.median(part["rolling_speed"].values) == pytest.approx(0.1, rel=0.01)


@pytest.mark.slow
def test_a_campaign_has_curve_model_and_traction_over_the_entrainment_speed(tmp_path):
    machine = replace(MACHINE, speeds=(3e-4, 2e-3, 2e-2, 0.3))
    file = simulate_mini_traction(tmp_path, 1, machine=machine)
    text = '[model]\nuncertainty = "none"\npoints = 9\nslowest = "0.1 mm/s"\nfastest = "0.3 m/s"\n'
    file.write_text(file.read_text("utf-8") + text, "utf-8")
    run_campaign(file, figures="none")
    report = json.loads((tmp_path / "results/report.json").read_text("utf-8"))
    (curve,), (model,) = report["curves"], report["models"]
    rolling = [point["rolling_speed_m_s"] for point in curve["points"]]
    sliding = [point["sliding_speed_m_s"] for point in curve["points"]]
    assert np.divide(sliding, rolling) == pytest.approx(0.5)
    assert max(rolling) == pytest.approx(0.3, rel=1e-3)
    fit = read_netcdf(tmp_path / "results" / model["data_file"], "fit")
    assert fit.attrs["slide_roll_ratio"] == pytest.approx(0.5)
    assert fit.attrs["shear_stress_Pa"] == pytest.approx(MACHINE.shear_stress, rel=0.1)
    computed = read_netcdf(tmp_path / "results" / model["data_file"], "traction")
    measured = [point["friction_coefficient"] for point in curve["traction"]]
    assert computed["friction_coefficient"].values == pytest.approx(measured, rel=0.15)
    page = (tmp_path / "results/report.html").read_text("utf-8")
    assert "entrainment speed at SRR 50 %" in page and "friction over the slide-roll ratio" in page
