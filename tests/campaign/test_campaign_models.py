"""The whole loop with a model: rig, files, spectrum, curve, fit; reuse, failures, the report."""

import html
import json
import re
from pathlib import Path
from types import SimpleNamespace

import jsonschema
import numpy as np
import pandas as pd
import pytest
import xarray as xr

import tribolab
from tribolab.app.terminal import outcome_lines
from tribolab.app.truth.friction import TruthComparison
from tribolab.app.truth.known import DemoComparison
from tribolab.app.truth.lines import truth_lines
from tribolab.app.truth.shear_stress import compare_shear_stress
from tribolab.campaign.models.shear_stress import model_and_points
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import AnalysisError, ConfigError
from tribolab.fit.shear_stress import fit_shear_stress
from tribolab.fit.spectrum_error import shear_stress_shift
from tribolab.friction.coefficient.repeatability import pooled_repeatability
from tribolab.reading.netcdf.netcdf import read_netcdf, write_netcdf
from tribolab.records.models.model_words import is_described, judgement, stress_interval
from tribolab.records.part_records import ModelRecord
from tribolab.records.parts import ModelOutcome
from tribolab.report.document.models import ModelRow
from tribolab.report.page_figures.models import model_specs
from tribolab.report.results import write_report
from tribolab.rig import Protocol, Rig, simulate_campaign
from tribolab.studies import xu2026

SPEEDS = (1e-5, 1e-4, 4.64e-4, 2.15e-3)
SCHEMA = Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json"


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("loop") / "campaign"
    rig = Rig(Protocol(speeds=SPEEDS))
    file = simulate_campaign(folder, 5, small=True, surfaces=("Sb-S",), n_scans=2, rig=rig)
    # without the dry runs: they have no model
    text = re.sub(
        r'\n\[\[run\]\]\nfiles = "[^"]*_dry_.*?(?=\n\[|\Z)', "", file.read_text(), flags=re.S
    )
    file.write_text(text, "utf-8")
    return file


@pytest.fixture(scope="module")
def outcome(campaign):
    folder = campaign.parent / "first"
    folder.mkdir()
    made = process(load_campaign(campaign), folder)
    write_report(made)
    return made


@pytest.mark.slow
def test_the_docs_name_every_table_and_folder_that_a_run_leaves(outcome):
    text = (SCHEMA.parents[1] / "docs/results.md").read_text("utf-8")
    listed = text.partition("Results, and how they are computed")[2].partition("\n## ")[0]
    tables = [path.name for path in (outcome.folder / "tables").glob("*.csv")]
    files = [path.name for path in outcome.folder.iterdir() if path.is_file()]
    folders = [f"{path.name}/" for path in outcome.folder.iterdir() if path.is_dir()]
    assert {"stick_slip.csv", "shear_stress.csv"} <= set(tables)
    assert [name for name in tables + folders + files if name not in listed] == []
    assert "--tables parquet" in listed


def changed(campaign, extra, name):
    """Write the campaign file again with a table more, and an empty folder for its results."""
    file = campaign.with_name(f"{name}.toml")
    file.write_text(campaign.read_text("utf-8") + extra, "utf-8")
    folder = campaign.parent / name
    folder.mkdir()
    return load_campaign(file), folder


@pytest.mark.slow
def test_the_shear_stress_that_went_in_comes_back(outcome):
    """Within 10 % with the scanned spectrum and 5 % with the true one, and within the intervals."""
    (model,) = outcome.models
    true = dict(xu2026.surface("Sb-S").shear_stress)[31.0]
    (row,) = compare_shear_stress(outcome, outcome.folder.parent).to_dict("records")
    assert row["true_Pa"] == true
    assert abs(row["relative_difference"]) < 0.10
    assert row["found_low_Pa"] < true < row["found_high_Pa"]
    root = read_netcdf(outcome.folder / model.data_file)
    fit = fit_shear_stress(
        read_netcdf(outcome.folder / f"data/{model.curve}.nc"),
        xu2026.contact,
        xu2026.psd("Sb-S"),
        1.4,
        310.0,
        common_error=root.attrs["repeatability"] / np.sqrt(2),
        common_freedom=root.attrs["freedom"],
    )
    assert fit.shear_stress == pytest.approx(true, rel=0.05)
    assert abs(fit.shear_stress - true) < fit.half_interval


@pytest.mark.slow
def test_the_shear_stress_stands_for_both_theories_of_the_area(outcome):
    """The corrected area is larger by a fifth to two fifths, the stress lower by as much."""
    report = json.loads((outcome.folder / "report.json").read_text())
    fits = pd.DataFrame([model["fit"] for model in report["models"]])
    assert set(fits["area"]) == {"persson"}
    assert set(fits["other_area"]) == {"corrected"}
    ratio = fits["shear_stress_other_area_Pa"] / fits["shear_stress_Pa"]
    assert np.all((ratio > 0.71) & (ratio < 0.83))


def test_the_data_file_has_curve_fit_profiles_factors_and_band(outcome):
    (model,) = outcome.models
    assert model.parts == ("curve", "fit", "profiles", "factors", "uncertainty", "left_out")
    file = outcome.folder / model.data_file
    curve, fit, profiles = (read_netcdf(file, part) for part in ("curve", "fit", "profiles"))
    assert curve.sizes["sliding_speed"] == 33
    np.testing.assert_allclose(curve.sliding_speed[[0, -1]], [1e-9, 0.1], rtol=1e-12)
    assert abs(curve.load_balance).max() < 1e-8
    miss = fit.friction_coefficient - fit.friction_coefficient_model
    np.testing.assert_allclose(miss, fit.friction_coefficient_residual, atol=1e-12)
    carried = (profiles.contact_pressure + profiles.fluid_pressure).values
    for x, p in zip(profiles.x.values, carried, strict=True):  # the load, by the trapezium
        assert np.trapezoid(p, x) == pytest.approx(310.0, rel=2e-3)
    for proof in ("residual", "load_balance", "flux_variation"):  # of every profile
        assert profiles[proof].dims == ("sliding_speed",)
        assert abs(profiles[proof]).max() < 1e-6
    assert (profiles.iterations > 0).all()
    assert profiles.attrs["cells"] == curve.attrs["cells"] == 160
    low, high = shear_stress_shift(read_netcdf(file, "uncertainty"))
    assert -0.5 < low < 0 < high < 0.5


@pytest.mark.slow
def test_a_model_names_the_files_of_its_curve_and_of_its_spectrum(outcome):
    (model,) = outcome.models
    root = read_netcdf(outcome.folder / model.data_file).attrs
    pairs = dict(zip(root["source"].split("; "), root["source_sha256"].split("; "), strict=True))
    used = {(Path(name).name, checksum) for name, checksum, _ in outcome.sources}
    assert {(Path(name).name, checksum) for name, checksum in pairs.items()} == used
    assert root["groups"].split("; ") == list(model.parts)


@pytest.mark.slow
def test_the_report_has_the_model_in_tables_json_page_and_words(outcome):
    folder = outcome.folder
    report = json.loads((folder / "report.json").read_text())
    jsonschema.validate(report, json.loads(SCHEMA.read_text()))
    (record,) = report["models"]
    stress = read_netcdf(folder / record["data_file"], "fit").attrs["shear_stress_Pa"]
    growth, low, high, error = (
        record["fit"][f"area_enhancement{end}"] for end in ("", "_low", "_high", "_error")
    )
    assert low <= growth <= high
    # with 95 % the error reaches both bounds
    assert growth - 1.961 * error < low < high < growth + 1.961 * error
    table = pd.read_csv(folder / "tables/shear_stress.csv")
    assert record["fit"]["shear_stress_Pa"] == table.shear_stress_Pa[0] == stress
    points = pd.read_csv(folder / "tables/stribeck_model.csv")
    assert len(points) == 33
    proof = points[["residual", "load_balance", "flux_variation"]]
    assert (proof.abs() < 1e-6).all(axis=None)
    assert (points.iterations > 0).all()
    assert (points.cells == 160).all()
    files = {figure["file"] for figure in report["model_figures"]}
    names = {"joint-sb-s_glycerol", "shear_stress", "factors", "sensitivity", "sb-s_glycerol"}
    assert {f"figures/model_{name}.svg" for name in names} <= files
    page = html.unescape((folder / "report.html").read_text("utf-8"))
    assert "Agreement of model and measurement" in page
    said = record["fit"]["judgement"].split(";")[0]
    assert f"{said[:1].upper()}{said[1:]}" in page
    assert not [f for f in report["findings"] if f["severity"] == "error"]


@pytest.mark.slow
def test_what_is_the_same_is_taken_over_and_what_changed_is_not(campaign, outcome):
    same, folder = changed(campaign, "", "same")
    again = process(same, folder, previous=outcome.folder)
    assert [model.reused for model in again.models] == [True]
    other, folder = changed(
        campaign, '\n[model]\nrough_body = "moving"\nuncertainty = "none"\n', "other"
    )
    anew = process(other, folder, previous=outcome.folder)
    assert [(m.reused, "uncertainty" in m.parts) for m in anew.models] == [(False, False)]
    assert all(run.reused for run in anew.runs)


@pytest.mark.slow
def test_ranges_of_the_campaign_file_widen_the_band_and_are_shown(campaign, outcome):
    text = campaign.read_text("utf-8")
    for line, more in (
        ("viscosity =", 'viscosity_range = ["1.2 Pa s", "1.6 Pa s"]'),
        ("youngs_modulus =", 'youngs_modulus_range = ["1.4 MPa", "1.6 MPa"]'),
    ):
        text = re.sub(rf"^({line}.*)$", rf"\1\n{more}", text, flags=re.M)
    file, folder = campaign.with_name("ranges.toml"), campaign.parent / "ranges"
    text += '\n[model]\npoints = 9\narea = "corrected"\ninlet_length = "40 mm"\n'
    for name, size in (("load", "2 %"), ("radius", "1 %")):
        text += f'\n[uncertainty.{name}]\nvalue = "{size}"\nas = "standard"\n'
    file.write_text(text, "utf-8")
    folder.mkdir()
    made = process(load_campaign(file), folder, previous=outcome.folder)
    name = made.models[0].name
    rows = [one.store.get("model", name, ModelRecord).record.rows for one in (outcome, made)]
    before, after = ({row["variation"]: row for row in one.sensitivity} for one in rows)
    assert set(after) - set(before) == {"viscosity", "Young's modulus", "load", "radius"}
    ends = [float(after["load"][end].removesuffix(" N/m")) for end in ("low", "high")]
    assert ends[1] / ends[0] == pytest.approx(np.exp(2 * 1.96 * 0.02), rel=2e-3)
    assert set(before) - set(after) == {"inlet length"}  # it is stated
    model = folder / made.models[0].data_file
    for part in ("curve", "profiles"):
        assert read_netcdf(model, part).attrs["inlet_length_m"] == 0.04
        assert read_netcdf(model, part).attrs["area"] == "corrected"
    assert (after["viscosity"]["low"], after["viscosity"]["high"]) == ("1.2 Pa s", "1.6 Pa s")
    assert after["viscosity"]["largest_relative_change"] > 0.1
    assert "no viscosity_range was given" in rows[0].not_varied
    assert "range was given" not in rows[1].not_varied
    assert "liquid: Newtonian" in rows[1].not_varied


def test_terminal_page_and_report_list_what_is_not_in_the_model(outcome):
    report = json.loads((outcome.folder / "report.json").read_text())
    effects = {row["effect"] for row in report["models"][0]["not_in_model"]}
    assert {"edge load", "misalignment", "crown", "squeeze-out time", "lay"} <= effects
    page = (outcome.folder / "report.html").read_text("utf-8")
    (line,) = [line for line in outcome_lines(outcome) if line.startswith("not in the model: ")]
    assert "film ratio" in page and "regimes over viscosity" in page
    for effect in effects:
        assert effect in line
        assert f"<strong>{effect.capitalize()}</strong>" in page


@pytest.mark.slow
def test_a_measured_contact_area_gives_its_shear_stress_beside_the_theory_s(campaign, outcome):
    text = campaign.read_text("utf-8").replace("[[run]]\n", '[[run]]\ncontact_area = "7.4 cm^2"\n')
    file = campaign.with_name("camera.toml")
    file.write_text(text, "utf-8")
    folder = campaign.parent / "camera"
    folder.mkdir()
    made = process(load_campaign(file), folder, previous=outcome.folder)
    write_report(made, figures="none")
    (model,) = json.loads((folder / "report.json").read_text())["models"]
    (before,) = json.loads((outcome.folder / "report.json").read_text())["models"]
    fit = model["fit"]
    assert fit["measured_area_m2"] == pytest.approx(7.4e-4)
    assert before["fit"]["measured_area_m2"] is None
    # Hertz: 7.43 mm x 100 mm at 31 N
    assert fit["hertz_area_m2"] == pytest.approx(7.434e-4, rel=1e-3)
    points = read_netcdf(folder / made.models[0].data_file, "fit")
    mu = float(points.friction_coefficient[0])
    assert fit["measured_shear_stress_Pa"] == pytest.approx(mu * 31 / 7.4e-4, rel=0.01)
    # at the lowest speed nearly all friction is solid: sigma times the real area
    nominal = fit["shear_stress_Pa"] * fit["real_area_m2"] / fit["hertz_area_m2"]
    assert fit["measured_shear_stress_Pa"] == pytest.approx(nominal, rel=0.15)
    assert "Measured area (mm²)" in (folder / "report.html").read_text("utf-8")
    assert "Measured area (mm²)" not in (outcome.folder / "report.html").read_text("utf-8")


@pytest.mark.slow
def test_a_model_that_fails_or_is_not_wanted_stops_nothing(campaign, outcome, monkeypatch):
    text = campaign.read_text("utf-8")
    file = campaign.with_name("radius.toml")
    file.write_text(re.sub(r"radius = .*\n", "", text), "utf-8")
    folder = campaign.parent / "radius"
    folder.mkdir()
    made = process(load_campaign(file), folder, previous=outcome.folder)
    (model,) = made.models
    assert (model.status, model.reason) == ("skipped", "[contact] wants radius")
    assert all(curve.done for curve in made.curves)

    off, folder = changed(campaign, "\n[model]\ncompute = false\n", "off")
    assert process(off, folder, previous=outcome.folder).models == ()

    def refuse(*given, **more):
        raise AnalysisError("at 1 m/s: no film was found; take more cells")

    monkeypatch.setattr("tribolab.campaign.models.analysis.solve_curve", refuse)
    other, folder = changed(campaign, "\n[model]\npoints = 9\n", "failing")
    made = process(other, folder, previous=outcome.folder)
    (model,) = made.models
    assert (model.status, model.data_file) == ("failed", "")
    assert model.reason == "at 1 m/s: no film was found; take more cells"
    assert all(curve.done for curve in made.curves)
    write_report(made, figures="none")
    (found,) = pd.read_csv(folder / "tables/checks.csv").query("status == 'fail'").message
    assert found == f"no model: {model.reason}"


@pytest.mark.slow
def test_speeds_that_are_not_in_order_are_refused_with_the_line(campaign):
    with pytest.raises(ConfigError, match=r"slowest and fastest: 1 m/s is not below 0\.1 m/s"):
        changed(campaign, '\n[model]\nslowest = "1 m/s"\n', "order")


def test_repeatability_is_pooled_over_conditions():
    rng = np.random.default_rng(1)
    levels = [1 + 0.01 * rng.standard_normal(2) for _ in range(400)]
    spread, freedom = pooled_repeatability([*levels, np.array([1.0])])
    assert freedom == 400
    assert spread == pytest.approx(0.01, rel=0.1)
    assert pooled_repeatability([np.array([1.0])]) == (0.0, 0)


def curve_of_one_factor(factor):
    """A measured curve that is the model's times a factor, without scatter."""
    speed = np.array(SPEEDS)
    curve = tribolab.stribeck_curve(xu2026.contact, xu2026.psd("Sb-S"), 1.4, 310.0, 1e6, speed)
    mu = factor * curve.friction_coefficient.values
    data = {"friction_coefficient": mu, "friction_coefficient_sem": 1e-3 * mu}
    coords = {"sliding_speed": speed}
    return xr.Dataset({k: ("sliding_speed", v) for k, v in data.items()}, coords), curve


def test_an_error_that_all_points_share_is_in_the_error_bar():
    """A curve one common error too high is fitted one common error too high."""
    measured, curve = curve_of_one_factor(1.02)
    bare = tribolab.stribeck_curve(
        xu2026.contact, xu2026.psd("Sb-S"), 1.4, 310.0, 0.0, curve.sliding_speed.values
    )
    given = (measured, xu2026.contact, xu2026.psd("Sb-S"), 1.4, 310.0)
    fit = fit_shear_stress(*given, curve=bare, common_error=0.02, common_freedom=10)
    assert fit.shear_stress - 1e6 == pytest.approx(fit.common_error, rel=0.03)
    assert fit.half_interval > 2 * fit.common_error
    alone = fit_shear_stress(*given, curve=bare)
    assert alone.shear_stress == fit.shear_stress
    assert alone.shear_stress - 1e6 < fit.half_interval
    assert fit.half_interval == pytest.approx(
        np.hypot(alone.half_interval, 2.228 * fit.common_error), rel=1e-3
    )


def described(residual, **attrs):
    """Fit group of a curve whose model misses it by `residual`."""
    residual = np.asarray(residual, dtype=float)
    speed = np.geomspace(1e-6, 1e-2, residual.size)
    known = {
        "shear_stress_Pa": 1e6,
        "chi_square_p_value": 0.5,
        "runs_p_value": 0.5,
        "valid_speed_low_m_s": speed[0],
        "valid_speed_high_m_s": speed[-1],
    }
    data = {
        "friction_coefficient": 1 + residual,
        "friction_coefficient_residual": residual,
        "friction_coefficient_residual_u": np.full(residual.size, 0.003),
        "friction_coefficient_sem": np.full(residual.size, 0.003),
        "used": np.ones(residual.size),
    }
    data = {name: ("sliding_speed", values) for name, values in data.items()}
    return xr.Dataset(data, {"sliding_speed": speed}, known | attrs)


def test_the_words_follow_the_residuals():
    good = judgement(described([0.001, -0.002, 0.001, -0.001, 0.002]))
    assert good.startswith("the model describes the curve within the errors")
    assert "largest at 1 mm/s" not in good
    bad = judgement(
        described(
            [0.2, 0.15, 0.01, -0.01, -0.02],
            chi_square_p_value=1e-9,
            runs_p_value=0.01,
            valid_speed_low_m_s=1e-4,
            valid_speed_high_m_s=1e-2,
        )
    )
    assert bad.startswith("the model fits to within ")
    assert "the residuals exceed the error bars and vary systematically with speed" in bad
    assert "one shear stress describes 100 µm/s to 10 mm/s" in bad
    assert "more than 10 % of the friction at 1 µm/s to 10 µm/s" in bad
    assert "largest at 1 µm/s, where the measurement is 0.2 above the model's 1" in bad
    both = judgement(
        described([0.2, 0.3, 0.01, 0.15, 0.2], valid_speed_low_m_s=1e-4, valid_speed_high_m_s=1e-4)
    )
    assert "friction at 1 µm/s to 10 µm/s and at 1 mm/s to 10 mm/s" in both
    far = judgement(described([0.9, 0.8, -0.01, -0.02], chi_square_p_value=0.0))
    assert far.startswith("the model does not describe this curve: off by up to 47 %")
    # a miss of a few hundredths of the height, where friction is lowest, is a factor of thirty
    low = described([0.001, -0.001, 0.0, -0.3], chi_square_p_value=0.0)
    low["friction_coefficient"][-1] = 0.01
    assert judgement(low).startswith(
        "the model does not describe this curve: off by up to a factor of 31"
    )
    low["friction_coefficient_residual_u"][-1] = 0.2
    assert is_described(judgement(low))
    none = judgement(described([0.5] * 4, shear_stress_Pa=-1.0))
    assert none.startswith("no shear stress describes this curve")
    assert "the model's" not in none and "see stick-slip and sliding mode" in none
    assert [is_described(words) for words in (good, bad, far, none)] == [True, True, False, False]


def test_friction_that_helps_the_motion_is_never_drawn_as_a_model(tmp_path):
    measured, curve = curve_of_one_factor(1.0)
    fluid = curve.friction_coefficient_couette + curve.friction_coefficient_pressure
    measured["friction_coefficient"] = 0.5 * fluid
    measured["friction_coefficient_std"] = measured.friction_coefficient_sem
    found = fit_shear_stress(measured, xu2026.contact, xu2026.psd("Sb-S"), 1.4, 310.0)
    assert found.shear_stress < 0
    fit = model_and_points(found, measured)
    np.testing.assert_allclose(fit.friction_coefficient_model, fluid)
    np.testing.assert_allclose(fit.friction_coefficient_residual, -0.5 * fluid)
    assert not fit.friction_coefficient_solid.any()
    figure = tribolab.plot.mixed_curve(fit, curve, surface="Sb-S")
    drawn = tribolab.plot.figure_data(figure)
    assert drawn.series.unique().tolist() == [
        "viscous part", "measured", "measured minus viscous part"
    ]  # fmt: skip

    write_netcdf(fit, tmp_path / "m.nc", group="fit")
    write_netcdf(curve, tmp_path / "m.nc", group="curve")
    labels = {"surface": "Sb-S", "medium": "glycerol", "status": "done", "data_file": "m.nc"}
    parts = ("curve", "fit")
    models = [
        ModelOutcome(name=f"m{load:g}", curve="c", normal_force=load, parts=parts, **labels)
        for load in (31.0, 91.0)
    ]
    rows = [ModelRow(model=one, fit={"shear_stress_Pa": -1.0}, curve=()) for one in models]
    (spec,) = (one for one in model_specs(rows, ["Sb-S"], tmp_path) if one.series)
    assert "No shear stress describes this curve" in spec.note and "solid line:" not in spec.note
    assert "dotted: the model's viscous part" in spec.note and spec.loads == [31.0, 91.0]
    assert not any(series.label == "model" for series in spec.series)


def test_no_bar_of_a_shear_stress_goes_below_zero_and_the_numbers_are_kept():
    table = pd.DataFrame({"surface": "Smooth", "normal_force_N": [31.0, 91.0]})
    for name, values in {
        "shear_stress_Pa": [0.12e6, 0.3e6],
        "shear_stress_low_Pa": [-0.092e6, 0.2e6],
        "shear_stress_high_Pa": [0.335e6, 0.4e6],
        "corrected_shear_stress_Pa": [0.1e6, 0.25e6],
        "corrected_shear_stress_error_Pa": [0.1e6, 0.05e6],
    }.items():
        table[name] = values
    figure = tribolab.plot.shear_stress(table)
    bars = [
        box for one in figure.axes[0].containers for lines in one[2] for box in lines.get_segments()
    ]
    assert min(end for bar in bars for _, end in bar) == pytest.approx(0.0, abs=1e-12)
    assert max(end for bar in bars for _, end in bar) == pytest.approx(0.4)
    kept = tribolab.plot.figure_data(figure).shear_stress_low_Pa
    assert kept.tolist() == [-0.092e6, 0.2e6]
    assert stress_interval(-0.092e6, 0.335e6) == "up to 0.335: it may be zero"


def test_the_demo_says_which_curves_the_model_does_not_describe(tmp_path):
    (tmp_path / "tables").mkdir()
    words = ["no shear stress describes this curve: …", "the model describes the curve: …"]
    fits = pd.DataFrame({"surface": ["Smooth", "Smooth", "Sb-S"], "judgement": [*words, words[1]]})
    fits.loc[1, "judgement"] = (
        "the model does not describe this curve: off by up to 85 % of the peak friction"
    )
    fits.to_csv(tmp_path / "tables/shear_stress.csv")
    fitted = pd.DataFrame({"relative_difference": [0.01], "within_interval": [1]})
    runs = TruthComparison(pd.DataFrame(), 1, 1, 0, 0, 1.0, 1.0)
    compared = DemoComparison(tmp_path, runs, pd.DataFrame(), fitted)
    said = "\n".join(truth_lines(compared, SimpleNamespace(folder=tmp_path)))
    assert "1 of 1 within their 95 % intervals (2 curves of Smooth are not described" in said
