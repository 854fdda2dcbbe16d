"""The report of real instruments' files, which have no speed, no load, or a single stroke."""

import json

import pytest

from tribolab.app.run import run_campaign
from tribolab.campaign.store.catalogue import Catalogue

CAMPAIGN = """[campaign]
name = "real files"
raw = "raw"

[[run]]
files = "actuator/Circle*.csv"

[[run]]
files = "rock/*.txt"

[[run]]
files = "paper/k168*v1100.mat"

[[run]]
files = "cetr/*.csv"
cycles = true
"""
FOLDERS = {
    "actuator": "actuator_friction_CC0",
    "rock": "rock_velstep_MIT",
    "paper": "stickslip_paper_CeCILL-B",
    "cetr": "cetr_umt2_MIT",
}


@pytest.fixture(scope="module")
def results(shared_data, tmp_path_factory):
    folder = tmp_path_factory.mktemp("real")
    (folder / "raw").mkdir()
    for name, place in FOLDERS.items():
        (folder / "raw" / name).symlink_to(shared_data / place)
    (folder / "campaign.toml").write_text(CAMPAIGN)
    return run_campaign(folder / "campaign.toml", jobs=1, figures="none").folder


@pytest.fixture(scope="module")
def report(results):
    return json.loads((results / "report.json").read_text())


def by_instrument(report, name):
    return [run for run in report["runs"] if run["instrument"] == name]


@pytest.mark.slow
def test_every_run_is_shown(report, results):
    assert [run["reason"] for run in report["runs"] if run["status"] != "done"] == []
    assert [entry for entry in report["findings"] if entry["severity"] == "error"] == []
    missing = {f["run"] for f in report["findings"] if f["message"].startswith("no measured curve")}
    without = {run["name"] for run in report["runs"] if run["quantity"] == "half_loop"}
    speedless = {run["name"] for run in by_instrument(report, "cetr_umt2")}
    assert missing == without | speedless
    catalogue = Catalogue.of(results)
    for run in report["runs"]:
        trace = catalogue.trace("run", run["name"])
        assert trace is not None and json.loads(trace.coarse)["samples"] == run["samples"]


@pytest.mark.slow
def test_actuator_is_told_by_its_half_loop_in_newton(report):
    (circle,) = by_instrument(report, "pneumatic_actuator")
    assert circle["quantity"] == "half_loop"
    # the reference number was taken within 5 < x < 32 mm, here whole strokes count
    assert circle["value_min"] < 5.631 < circle["value_max"]


@pytest.mark.slow
def test_rock_has_friction_at_both_speeds_of_its_step(report):
    (rock,) = by_instrument(report, "biaxial_rock")
    marks = {mark["where"]: mark for mark in rock["highlights"]}
    assert marks["slowest"]["sliding_speed_m_s"] == pytest.approx(3.017e-6, rel=0.02)
    assert marks["fastest"]["sliding_speed_m_s"] == pytest.approx(10.031e-6, rel=0.02)
    assert marks["slowest"]["value"] == pytest.approx(0.60758, abs=2e-3)
    assert marks["fastest"]["value"] == pytest.approx(0.60796, abs=2e-3)


@pytest.mark.slow
def test_reciprocating_run_without_speed_is_averaged_over_all_strokes(report):
    (run,) = by_instrument(report, "cetr_umt2")
    assert [mark["where"] for mark in run["highlights"]] == ["all"]
    assert run["sliding_speed_min_m_s"] is None
