"""Runs whose segments are an instrument's steps of unknown speed: what is said of them."""

import io
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from rich.console import Console

from tribolab.app import terminal
from tribolab.app.commands.campaign import show_outcome
from tribolab.app.result_tables import outcome_table
from tribolab.campaign import curves
from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.qc.run.checks import check_run
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.part_records import CurveRecord
from tribolab.records.runs.run_facts import friction_facts
from tribolab.report import results

TEXT = """
[campaign]
name = "steps"
raw = "{raw}"

{surface}

[[run]]
files = "cetr_umt2_MIT/*00{number}.csv"
"""
SURFACE = '[[surface]]\nname = "HEA"\n'


def steps_of_an_instrument(shared_data, folder, surface=True, number="*"):
    text = TEXT.format(
        raw=shared_data.as_posix(), surface=SURFACE if surface else "", number=number
    )
    file = folder / "campaign.toml"
    file.write_text(text + ('surface = "HEA"\n' if surface else ""), encoding="utf-8")
    return process(load_campaign(file), folder / "new")


def curves_of(outcome):
    """What is recorded of the measured curves."""
    return [entry.record for entry in outcome.store.all("curve", CurveRecord)]


@pytest.fixture(scope="module")
def together(shared_data, tmp_path_factory):
    return steps_of_an_instrument(shared_data, tmp_path_factory.mktemp("together"))


def test_repeats_without_a_speed_make_an_empty_curve_and_no_crash(together):
    (curve,) = together.curves
    assert (curve.status, curve.reason, curve.crash) == ("done", "", "")
    shown, missing = results.shown_curves(curves_of(together), {})
    assert shown == []
    assert [notice.message for notice in missing] == [
        "no measured curve: no segment has both a speed and a friction coefficient"
    ]


def test_a_mistake_of_ours_in_a_curve_is_an_error_and_traced_on_demand(
    shared_data, tmp_path, monkeypatch, capsys
):
    def broken(task):
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr(curves, "process_curve", broken)
    outcome = steps_of_an_instrument(shared_data, tmp_path, number="1")
    _, missing = results.shown_curves(curves_of(outcome), {})
    assert [notice.severity for notice in missing] == ["error"]
    assert show_outcome(outcome, debug=False) == 3
    assert "Traceback" not in capsys.readouterr().err
    assert show_outcome(outcome, debug=True) == 3
    assert "ZeroDivisionError: float division by zero" in capsys.readouterr().err


@pytest.fixture(scope="module")
def said(together):
    """What the checks said of each run: {run: {check: row}}."""
    return {
        run.name: {
            row["check"]: row
            for row in read_netcdf(together.folder / run.data_file, group="run").attrs["findings"]
        }
        for run in together.runs
    }


def test_too_few_effective_samples_decide_nothing_of_steadiness(said):
    for checks in said.values():
        row = checks["steadiness"]
        assert row["status"] == "skipped" and row["noted"]
        assert "not decided in" in row["message"] and "effective samples" in row["message"]
    worst = said["HT-2n-6-4_2_002"]["steadiness"]
    # by which much the line falls, of the friction: -0.177 of 0.774
    assert worst["value"] == pytest.approx(-0.177 / 0.774, abs=2e-3)
    assert "-22.82%" in worst["message"] and " 1 effective samples" in worst["message"]


def test_a_speed_that_is_unknown_is_suspect_for_what_may_be_inside(said):
    for checks in said.values():
        row = checks["segment_speed"]
        assert row["status"] == "suspect"
        assert row["message"].startswith(
            "the speed of 2 of 2 segments is unknown: they may include"
        )
        assert "figure of the strokes" in row["cure"] and "`trim`" in row["cure"]


def check_of(force, **attrs):
    """What `segment_speed` and the lines of the rig say of a friction force at a set speed."""
    time = np.arange(force.size) / 200
    data = {"friction_force": ("time", force), "normal_force": ("time", np.full(force.size, 5.0))}
    run = xr.Dataset(data, {"time": time}, {"set_speed_m_s": 0.01, **attrs})
    rows = check_run(run).rows
    return {(row["check"], row["status"]): row for row in rows}


def test_a_force_that_turns_to_and_fro_without_a_direction_is_no_friction():
    rng = np.random.default_rng(3)
    noise = 0.02 * rng.standard_normal(8000)
    sine = np.tanh(8 * np.sin(2 * np.pi * 2.0 * np.arange(8000) / 200))
    rows = check_of(sine + 0.1 + noise)
    told = rows["segment_speed", "fail"]
    assert "changes its sign" in told["message"] and "reciprocating" in told["message"]
    assert "stroke and frequency" in told["cure"]
    assert ("resonance", "pass") in rows  # the strokes themselves are no line of the rig
    # a force of one sign, or that turns once, is friction as before
    for force in (1.0 + noise, np.where(np.arange(8000) < 4000, 1.0, -1.0) + noise):
        assert ("segment_speed", "fail") not in check_of(force)


def test_a_trend_that_can_be_told_is_still_told_and_many_samples_show_that_there_is_none():
    time = np.arange(4000) / 100
    noise = 0.02 * np.random.default_rng(0).standard_normal(time.size)
    for slope, status, words in (
        (0.0, "pass", "no significant trend within a segment; measured at most 0."),
        (0.1, "suspect", "+8."),
    ):
        mu = 0.5 * (1 + slope * (time / 40 - 0.5)) + noise
        data = {"friction_coefficient": ("time", mu)}
        data["sliding_velocity"] = ("time", np.full(time.size, 1e-3))
        found = check_run(xr.Dataset(data, {"time": time}))
        (row,) = (row for row in found.rows if row["check"] == "steadiness")
        assert row["status"] == status and words in row["message"]


def test_the_report_shows_no_drift_of_zero_where_it_was_not_decided(together):
    for run in together.runs:
        friction = read_netcdf(together.folder / run.data_file, group="friction")
        assert friction_facts(friction).relative_drift is None


def printed(outcome):
    """Rows of the table on the command line, each split into its cells."""
    out = Console(width=160, record=True, file=io.StringIO())
    out.print(outcome_table(outcome))
    rows = out.export_text().splitlines()
    return [re.split(r"\s{2,}", row.strip()) for row in rows if row.strip()]


def errors_of(outcome, run):
    friction = read_netcdf(outcome.folder / run.data_file, group="friction")
    return friction["friction_coefficient_U95"].values.tolist()


def test_friction_is_printed_where_the_speed_is_unknown(together):
    (heading, row) = printed(together)
    assert heading[0] == "surface"
    load, friction = "1.961 N", "0.768 to 0.785"
    assert heading[-1] == "± U95"
    own = [v for run in together.runs for v in errors_of(together, run)]
    error = f"at most {max(own):.2g} (within the run)"
    assert row == ["HEA", "–", load, "3", "6", "speed unknown", friction, error]


def test_a_run_of_no_surface_stands_under_its_own_name(shared_data, tmp_path):
    outcome = steps_of_an_instrument(shared_data, tmp_path, surface=False, number="[12]")
    heading, *rows = printed(outcome)
    assert heading[:2] == ["run", "surface"]
    assert [row[:4] for row in rows] == [[run.name, "–", "–", "1.961 N"] for run in outcome.runs]
    assert [row[4:7] for row in rows] == 2 * [["1", "2", "speed unknown"]]
    assert all(float(row[7]) == pytest.approx(0.776, abs=0.01) for row in rows)


def test_every_objection_is_printed_with_its_reason_and_at_most_a_handful(together):
    lines = [line for line in terminal.outcome_lines(together) if "suspect" in line]
    assert len(lines) == 3
    for run, line in zip(together.runs, lines, strict=True):
        assert line.startswith(f"suspect: {run.name}: ")
        assert "segment speed: the speed of 2 of 2 segments is unknown" in line
    many = replace(together, runs=4 * together.runs)
    lines = [line for line in terminal.outcome_lines(many) if "suspect" in line]
    assert len(lines) == 6
    first, second, *_ = (run.name for run in together.runs)
    assert lines[0].startswith(f"suspect: {first}, {first}: ")
    assert lines[1].startswith(f"suspect: {second}, {second}: ")
    assert " 5 more, see " in lines[-1] and lines[-1].endswith("checks.csv")
