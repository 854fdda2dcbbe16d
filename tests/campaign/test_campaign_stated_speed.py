"""A speed or load that no file records, said in the campaign file, reaches friction and curve."""

import json
import shutil

import numpy as np
import pytest
from dialects import dialect_of
from typer.testing import CliRunner

from tribolab import cli
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.report.page.doubts import doubts

DIALECT = dialect_of("plain", time="t", friction_force="F", normal_force="N")
CAMPAIGN = """
[campaign]
name = "Rock"
[[run]]
files = "*.csv"
instrument = "plain.toml"
sliding_speed = "6 mm/min"
"""


def analysed(folder, dialect=DIALECT, extra=(), campaign=CAMPAIGN):
    """Process a run of forces and, where given, another column of mm/s."""
    rng = np.random.default_rng(0)
    head = "t [s],F [N],N [N]" + "".join(f",{name} [mm/s]" for name, _ in extra)
    rows = [head]
    for i in range(200):
        force, load = [3, 10] + 0.01 * rng.standard_normal(2)
        rows.append(f"{i / 10},{force:.4f},{load:.4f}" + "".join(f",{value}" for _, value in extra))
    (folder / "raw").mkdir()
    (folder / "raw" / "one.csv").write_text("\n".join(rows))
    (folder / "plain.toml").write_text(dialect)
    (folder / "campaign.toml").write_text(campaign)
    (folder / "results").mkdir()
    return process(load_campaign(folder), folder / "results")


def test_a_stated_speed_reaches_friction_and_curve(tmp_path):
    outcome = analysed(tmp_path)
    friction = read_netcdf(outcome.folder / outcome.runs[0].data_file, group="friction")
    assert friction.sliding_speed.values == pytest.approx([1e-4])
    assert friction.attrs["set_speed_source"] == "campaign file"
    curve = read_netcdf(outcome.folder / outcome.curves[0].data_file)
    assert curve.sliding_speed.values == pytest.approx([1e-4])
    assert curve.friction_coefficient.values == pytest.approx([0.3], abs=0.001)


def test_a_recorded_speed_is_used_and_compared_with_the_stated_one(tmp_path):
    column = '[[column]]\nquantity = "sliding_velocity"\nname = "v"\n'
    outcome = analysed(tmp_path, DIALECT + column, extra=[("v", 0.2)])
    friction = read_netcdf(outcome.folder / outcome.runs[0].data_file, group="friction")
    assert friction.sliding_speed.values == pytest.approx([2e-4])
    run = read_netcdf(outcome.folder / outcome.runs[0].data_file, group="run")
    [finding] = [row for row in run.attrs["findings"] if row["check"] == "velocity_set"]
    assert finding["status"] == "fail" and "from its set-point" in finding["message"]


def test_a_file_with_set_speeds_of_its_own_needs_none(tmp_path):
    column = '[[column]]\nquantity = "set_speed"\nname = "v"\n'
    [run] = analysed(tmp_path, DIALECT + column, extra=[("v", 0.2)]).runs
    assert not run.done and "remove sliding_speed" in run.reason


FORCE_ALONE = dialect_of("plain", time="t", friction_force="F")
UNDER_LOAD = CAMPAIGN + 'normal_force = "12 N"\n'


def test_a_stated_load_is_the_load_of_a_file_that_records_none(tmp_path):
    outcome = analysed(tmp_path, FORCE_ALONE, campaign=UNDER_LOAD)
    data = outcome.folder / outcome.runs[0].data_file
    friction = read_netcdf(data, group="friction")
    assert friction.friction_coefficient.values == pytest.approx([3 / 12], abs=0.001)
    assert friction.normal_force.values == pytest.approx([12])
    run = read_netcdf(data, group="run")
    assert run.attrs["derived"] == {"normal_force": "stated"}
    words = {row["message"] for row in run.attrs["findings"] if row["check"] == "stuck"}
    assert any("stated and not measured" in word for word in words)


def test_a_recorded_load_is_used_and_compared_with_the_stated_one(tmp_path):
    outcome = analysed(tmp_path, campaign=UNDER_LOAD)
    data = outcome.folder / outcome.runs[0].data_file
    friction = read_netcdf(data, group="friction")
    assert friction.friction_coefficient.values == pytest.approx([3 / 10], abs=0.001)
    assert "derived" not in read_netcdf(data, group="run").attrs


def test_a_column_of_the_set_load_is_the_load_where_none_was_measured(tmp_path):
    dialect = dialect_of("plain", time="t", friction_force="F", set_normal_force="N")
    outcome = analysed(tmp_path, dialect)
    friction = read_netcdf(outcome.folder / outcome.runs[0].data_file, group="friction")
    assert friction.friction_coefficient.values == pytest.approx([3 / 10], abs=0.001)


def test_a_load_of_many_digits_is_that_of_its_curve(tmp_path):
    """1.02 kg weigh 10.002783 N; run and curve are filed under one load, and none is missing."""
    stated = CAMPAIGN + 'normal_force = "1.02 kgf"\nsurface = "rock"\n[[surface]]\nname = "rock"\n'
    analysed(tmp_path, campaign=stated)
    shutil.rmtree(tmp_path / "results")
    assert CliRunner().invoke(cli.app, ["run", str(tmp_path)]).exit_code == 0
    told = json.loads((tmp_path / "results" / "report.json").read_text("utf-8"))
    assert [of["nominal_normal_force_N"] for of in (*told["runs"], *told["curves"])] == [10.0] * 2
    assert not [doubt for doubt in doubts(told) if "no curve" in doubt.text]
