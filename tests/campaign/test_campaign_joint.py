"""A campaign with two loads fits them together by itself, and says what it found everywhere."""

import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pandas as pd
import pytest

import tribolab
from tribolab.campaign.joint.stage import JointFits
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import ReadError
from tribolab.lubrication.viscosity import liquid_viscosity
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.models.joint_record import JointRecord
from tribolab.records.part_records import CurveRecord, ModelRecord, SurfaceRecord
from tribolab.report.page_figures.joint import joint_specs
from tribolab.report.results import write_report
from tribolab.rig import Protocol, Rig, simulate_campaign

SCHEMA = Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json"
SPEEDS = (1e-5, 1e-4, 4.64e-4, 1e-3, 2.15e-3)
LOADS = (31.0, 211.0)
INSTRUMENT = SCHEMA.parent / "instruments/linear_slider.toml"
STATED = {  # standard uncertainties in the instrument's own file
    "speed": "2 %",
    "load": "1 %",
    "radius": "0.5 %",
    "youngs_modulus": "4 %",
    "temperature": "0.5 K",
    "water_content": "0.5 %",
}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """One surface in glycerol at two loads, one run each, on an instrument that states errors."""
    file = simulate_campaign(
        tmp_path_factory.mktemp("two loads") / "campaign",
        5,
        surfaces=("Sb-S",),
        loads=LOADS,
        n_repeats=1,
        n_scans=1,
        rig=Rig(Protocol(speeds=SPEEDS)),
    )
    text = re.sub(
        r'\n\[\[run\]\]\nfiles = "[^"]*_dry_.*?(?=\n\[|\Z)', "", file.read_text(), flags=re.S
    )
    # adhesion would take as long as all the rest
    text = re.sub(r"(?m)^work_of_adhesion.*\n", "", text)
    text = text.replace('viscosity = "1.4 Pa s"', 'temperature = "20 °C"\nwater_content = "0 %"')
    text = text.replace('instrument = "linear_slider"', 'instrument = "own.toml"')
    file.write_text(f'{text}\n[model]\nuncertainty = "none"\n', "utf-8")
    own = INSTRUMENT.read_text("utf-8").replace('name = "linear_slider"', 'name = "own"', 1)
    for name, value in STATED.items():
        own += f'\n[uncertainty.{name}]\nvalue = "{value}"\nas = "standard"\n'
    (file.parent / "own.toml").write_text(own, "utf-8")
    return load_campaign(file)


@pytest.fixture(scope="module")
def outcome(campaign, tmp_path_factory):
    made = process(campaign, tmp_path_factory.mktemp("results"))
    write_report(made, figures="none")
    return made


def record_of(outcome) -> JointRecord:
    (entry,) = outcome.store.all("joint", JointRecord)
    return entry.record


def stage_of(outcome, campaign) -> JointFits:
    curves = [entry.record for entry in outcome.store.all("curve", CurveRecord)]
    models = [entry.record for entry in outcome.store.all("model", ModelRecord)]
    surfaces = [entry.record for entry in outcome.store.all("surface", SurfaceRecord)]
    return JointFits(campaign, curves, models, surfaces, outcome.store)


@pytest.mark.slow
def test_both_loads_are_in_one_fit_beside_the_single_ones(outcome):
    record = record_of(outcome)
    assert (record.surface, record.medium, record.reason) == ("Sb-S", "glycerol", "")
    assert record.done and len(record.curves) == 2
    assert [model.parts[1] for model in outcome.models] == ["fit", "fit"]
    points, curves = (
        read_netcdf(outcome.folder / record.file, part) for part in ("points", "curves")
    )
    assert points.sizes["point"] == 2 * len(SPEEDS)
    assert curves["curve"].values.tolist() == ["31 N", "211 N"]
    off = np.log(points.friction_coefficient / points.friction_coefficient_model)
    np.testing.assert_allclose(points.relative_residual, off, atol=1e-12)
    stress = next(row for row in record.parameters if row.parameter == "shear_stress")
    single = pd.read_csv(outcome.folder / "tables/shear_stress.csv")["shear_stress_Pa"]
    assert stress.low < single.max() and single.min() < stress.high


@pytest.mark.slow
def test_what_the_instruments_file_states_reaches_models_and_the_joint_fit(outcome, campaign):
    liquid = liquid_viscosity("glycerol", "20 °C").uncertainty(0.5, 0.005)
    assert liquid > 0.1
    for file in (outcome.folder / "data").glob("model_*.nc"):
        curve = read_netcdf(file, "curve")
        assert curve.attrs["abscissa_error"] == pytest.approx(np.hypot(liquid, 0.02))
        assert curve.model_input.values.tolist() == ["load", "radius", "youngs_modulus"]
        assert (np.abs(curve.model_part).max("sliding_speed") > 0).all()
    row = next(row for row in record_of(outcome).parameters if row.parameter == "viscosity")
    assert np.log(row.prior_high / row.prior_low) / (2 * 1.959964) == pytest.approx(liquid)
    (task,) = stage_of(outcome, campaign).plan()
    assert task.speed_error == pytest.approx(0.02)
    # the campaign's own file counts before it
    stated = campaign.uncertainty.model_validate({"speed": {"value": "3 %", "as": "standard"}})
    (task,) = stage_of(outcome, campaign.model_copy(update={"uncertainty": stated})).plan()
    assert task.speed_error == pytest.approx(0.03)


@pytest.mark.slow
def test_tables_report_page_and_figure_say_the_same(outcome):
    record, folder = record_of(outcome), outcome.folder
    report = json.loads((folder / "report.json").read_text())
    jsonschema.validate(report, json.loads(SCHEMA.read_text()))
    (reported,) = report["joint_fits"]
    assert [row["value"] for row in reported["parameters"]] == [
        row.value for row in record.parameters
    ]
    compared = pd.DataFrame(reported["models"])
    names = ["power law of speed and load", "constant shear stress", "no friction factors"]
    assert compared["model"].tolist() == [*names, "corrected area"]
    assert compared["words"].iloc[0] == "the reference"
    page = (folder / "report.html").read_text("utf-8")
    assert "All loads in one fit" in page and record.parameters[0].words in page
    assert 'id="model-joint-sb-s_glycerol"' in page
    (spec,) = joint_specs([record], ["Sb-S"], folder)
    assert "2 curves" in spec.alt
    assert {series.label for series in spec.series} == {"31 N", "211 N"}


@pytest.mark.slow
def test_a_joint_fit_of_the_same_curves_is_taken_over(outcome, campaign, tmp_path):
    outcome.store.save()
    again = process(campaign, tmp_path, previous=outcome.folder)
    curves = [entry.record for entry in again.store.all("curve", CurveRecord)]
    models = [entry.record for entry in again.store.all("model", ModelRecord)]
    surfaces = [entry.record for entry in again.store.all("surface", SurfaceRecord)]
    stage = JointFits(campaign, curves, models, surfaces, again.store)
    (task,) = stage.plan()
    assert stage.known(task, 0) == record_of(outcome)
    assert (tmp_path / task.file).is_file()
    # a model that is made anew is another
    one_load = {"curves": curves, "models": models[:1], "surfaces": surfaces}
    (bare,) = JointFits(campaign, **one_load, store=again.store).plan()
    assert bare.fingerprint != task.fingerprint
    settings = campaign.model.model_copy(update={"joint": False})
    chosen = campaign.model_copy(update={"model": settings})
    assert JointFits(chosen, **one_load, store=again.store).plan() == []


@pytest.mark.slow
def test_a_fit_that_is_not_possible_is_a_note_with_the_reason(outcome, campaign):
    stage = stage_of(outcome, campaign)
    (task,) = stage.plan()
    gone = task.__class__(**vars(task) | {"measured": ("data/none.nc", "data/none.nc")})
    with pytest.raises(ReadError) as caught:
        stage.work(gone)
    record = stage.failed(gone, caught.value)
    assert record.status == "failed" and record.reason and record.parameters == ()
