"""Checks on scans in a campaign: a bad scan is named, left out or marked; the exit code tells."""

import json
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from campaigns import copied, made_and_taken_over, simulated
from report_pages import figures_of
from typer.testing import CliRunner

from tribolab import rig
from tribolab.campaign.settings.files import scan_files
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.surfaces.plan import PlannedSurface
from tribolab.campaign.surfaces.stage import SurfaceTask, process_surface
from tribolab.cli import app
from tribolab.core.errors import ConfigError
from tribolab.qc.run.checks import RUN_CHECKS
from tribolab.qc.scan import checks as scan_checks
from tribolab.qc.scan.checks import SCAN_CHECKS
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.rig.files import scan_file


def written(path, height, x):
    text = scan_file(x, height).decode()
    path.write_text(re.sub(r"# length:.*\n", "", text))


@pytest.fixture(scope="module")
def scans():
    found = rig.scans("Sb-R", 3, seed=1001, length=5e-3)
    return found.x.values, found.height.values


@pytest.fixture
def files(tmp_path, scans):
    x, heights = scans
    for number, height in enumerate(heights, start=1):
        written(tmp_path / f"sb-r_{number}.csv", height, x)
    return sorted(tmp_path.glob("*.csv"))


def planned(files, **quality):
    return PlannedSurface(
        name="Sb-R",
        data_file="data/surface_Sb-R.nc",
        patterns=(),
        files=tuple(files),
        labels=tuple(file.name for file in files),
        instrument=None,
        roughness={},
        contact=dict.fromkeys(("radius", "length", "youngs_modulus", "poisson_ratio")),
        forces=(),
        lowest_force=None,
        media=(),
        quality=quality,
        config_sha256="as it is",
    )


def processed(folder, surface):
    (folder / "data").mkdir(exist_ok=True)
    return process_surface(SurfaceTask(surface, folder)).outcome


def said(outcome, severity):
    return [finding.message for finding in outcome.findings if finding.severity == severity]


def holed(height):
    """Lift the stylus for an eighth of the scan."""
    height = height.copy()
    height[2000:3250] = np.nan
    return height


def test_names_of_checks_on_runs_and_scans_differ():
    assert not set(RUN_CHECKS) & set(SCAN_CHECKS)


def test_sound_scans_are_used_and_every_check_is_on_record(tmp_path, files):
    outcome = processed(tmp_path, planned(files))
    assert (outcome.quality, outcome.objections, outcome.unreadable) == ("pass", set(), ())
    rows = pd.DataFrame(outcome.checks)
    assert set(rows["scan"]) == {file.name for file in files}
    assert set(rows.check) == set(SCAN_CHECKS)
    raw = read_netcdf(tmp_path / outcome.data_file, group="scans")
    assert raw.height.dims == raw.height_qc.dims == ("scan", "x")
    assert raw.height.attrs["ancillary_variables"] == "height_qc height_qc_tests"


def test_the_odd_scan_is_left_out_and_named(tmp_path, files, scans):
    x, heights = scans
    written(files[1], 4 * heights[1], x)
    outcome = processed(tmp_path, planned(files))
    [failure] = said(outcome, "fail")
    assert failure.startswith("scan sb-r_2.csv has a spectrum that differs")
    assert "scan sb-r_2.csv is left out: its checks failed" in said(outcome, "note")
    assert (outcome.quality, outcome.objections, outcome.unreadable) == ("pass", {"fail"}, ())
    psd = read_netcdf(tmp_path / outcome.data_file, group="psd")
    alone = processed(tmp_path, planned([files[0], files[2]]))
    other = read_netcdf(tmp_path / alone.data_file, group="psd")
    np.testing.assert_array_equal(psd.psd_2d, other.psd_2d)


def test_flags_travel_with_the_heights_and_what_was_found_is_known_the_next_time(
    tmp_path, files, scans
):
    x, heights = scans
    stepped = heights[0].copy()
    stepped[5000:] += 3e-5
    written(files[0], stepped, x)
    surface = planned(files, skip=("repeats",))
    outcome = processed(tmp_path, surface)
    assert outcome.quality == "suspect"
    raw = read_netcdf(tmp_path / outcome.data_file, group="scans")
    bit = 1 << SCAN_CHECKS["steps"].bit
    assert np.argwhere(raw.height_qc_tests.values & bit).tolist() == [[0, 5000]]
    first, again = made_and_taken_over(tmp_path, surface)
    assert first.outcome.quality == "suspect" and first.outcome.checks and first.sources
    assert again == replace(first, outcome=replace(first.outcome, reused=True))


def test_where_no_scan_passes_all_are_used_and_marked(tmp_path, files, scans):
    x, heights = scans
    written(files[0], holed(heights[0]), x)
    strict = {"dropouts": {"fail": 0.1}}
    outcome = processed(tmp_path, planned(files[:1], limits=strict))
    assert outcome.done and outcome.quality == "fail"
    assert any("all that follows from them is marked" in text for text in said(outcome, "note"))
    quiet = processed(tmp_path, planned(files[:1], skip=("dropouts",)))
    assert quiet.quality == "pass"
    limits = {"dropouts": {"fail": 0.5, "stretch": 0.5, "suspect": 0.5, "in_a_row": 1e4}}
    assert processed(tmp_path, planned(files[:1], limits=limits)).quality == "pass"


def test_a_check_that_crashes_is_an_error_of_the_surface(tmp_path, files, monkeypatch):
    def crash(subject, limits):
        raise ZeroDivisionError("no tip")

    broken = {name: check for name, check in SCAN_CHECKS.items() if name != "tip"}
    broken["tip"] = scan_checks.Check(
        "tip", 5, "Tip?", "Mend it.", SCAN_CHECKS["tip"].limits, crash
    )
    monkeypatch.setattr(scan_checks, "SCAN_CHECKS", broken)
    outcome = processed(tmp_path, planned(files))
    assert outcome.quality == "error" and "error" in outcome.objections
    assert any("ZeroDivisionError: no tip" in text for text in said(outcome, "error"))
    assert outcome.done and outcome.unreadable == ()


def test_a_misspelt_check_on_scans_names_the_nearest(tmp_path):
    campaign = simulated(tmp_path, repeats=1, scans=True)
    for old, new in (("clippin", "clipping"), ("dropout", "dropouts")):
        text = campaign.read_text("utf-8")
        campaign.write_text(f'{text}\n[qc]\nskip = ["{old}"]\n', "utf-8")
        with pytest.raises(ConfigError, match=f"did you mean '{new}'"):
            load_campaign(campaign)
        campaign.write_text(f"{text}\n[qc.limits.repeats]\nfactr = 3\n", "utf-8")
        with pytest.raises(ConfigError, match="did you mean 'factor'"):
            load_campaign(campaign)
        campaign.write_text(text, "utf-8")


@pytest.mark.slow
def test_a_failed_scan_gives_exit_code_1_and_stands_in_every_result(tmp_path, scans):
    x, heights = scans
    made = simulated(tmp_path / "a", repeats=1, scans=True, models=True)
    campaign = copied(made, tmp_path / "b")
    [file] = scan_files(load_campaign(campaign))
    written(file, holed(heights[0]), x)
    text = campaign.read_text("utf-8")
    text = re.sub(r"(?m)^work_of_adhesion.*\n", "", text)
    text += "\n[qc.limits.dropouts]\nfail = 0.1\n"
    campaign.write_text(text, "utf-8")
    done = CliRunner().invoke(app, ["run", str(campaign), "-q", "-j", "1"])
    assert done.exit_code == 1
    assert "check failed: scans of Sb-R" in done.output
    results = campaign.parent / "results"
    table = pd.read_csv(results / "tables" / "checks.csv")
    failed = table[table.status == "fail"]
    assert failed["check"].tolist() == ["surface Sb-R"]
    assert "heights are missing" in failed.message.item()
    for name in ("roughness", "contact"):
        assert set(pd.read_csv(results / "tables" / f"{name}.csv").quality) == {"fail"}
    [surface] = json.loads((results / "report.json").read_text("utf-8"))["surfaces"]
    assert surface["quality"] == "fail"
    page = (results / "report.html").read_text("utf-8")
    assert page.count('<s>Sb-R</s> <span class="chip fail">scans: fail</span>') == 3
    [spectrum, *_] = figures_of(results)["surfaces-spectra"]["series"]
    assert spectrum["label"] == "Sb-R (bad scans)"
    campaign.write_text(text + '\n[qc]\nfail_on = "never"\n', "utf-8")
    assert CliRunner().invoke(app, ["run", str(campaign), "-q", "-j", "1"]).exit_code == 0
