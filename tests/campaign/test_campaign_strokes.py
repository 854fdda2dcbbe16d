"""A campaign whose slider never has a constant speed, and whose zero is read from a blank run."""

from __future__ import annotations

import numpy as np
import pytest
from dialects import dialect_of

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import ConfigError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.records.runs.run_facts import ends_of_strokes

DIALECT = dialect_of("crank", time="t", position="x", friction_force="F", normal_force="N")
MU, LOAD, OFFSET = 0.25, 10.0, 0.8


def write(folder, name, force, position):
    time = 2e-3 * np.arange(force.size)
    rng = np.random.default_rng(len(name))
    noisy = force + 0.02 * rng.standard_normal(force.size)
    rows = np.column_stack([time, 1e3 * position, noisy, np.full(force.size, LOAD)])
    head = "t [s],x [mm],F [N],N [N]"
    np.savetxt(folder / "raw" / name, rows, "%.7g", ",", header=head, comments="")


def campaign_of(folder, *, files="run_*.csv", segments="", entry=""):
    text = f'[campaign]\nname = "a crank"\n{segments}\n[[run]]\nfiles = "{files}"\n'
    text += f'instrument = "crank.toml"\n{entry}\n'
    (folder / "campaign.toml").write_text(text, "utf-8")
    return load_campaign(folder / "campaign.toml")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "raw").mkdir()
    (tmp_path / "crank.toml").write_text(DIALECT, "utf-8")
    phase = 2 * np.pi * 0.5 * 2e-3 * np.arange(8000)
    force = MU * LOAD * np.sign(np.cos(phase)) + OFFSET
    write(tmp_path, "run_1.csv", force, 5e-3 * np.sin(phase))
    return tmp_path


def results(campaign, output, previous=None):
    outcome = process(campaign, output, previous=previous)
    (run,) = outcome.runs
    return run, read_netcdf(output / run.data_file, group="friction")


def test_middles_of_strokes_are_what_a_crank_measures(folder):
    campaign = campaign_of(folder, segments='[segments]\nstroke_middle = "40 %"')
    run, friction = results(campaign, folder / "results")
    assert run.status == "done" and friction.sizes["segment"] in (13, 14, 15)
    off = (friction["friction_coefficient"] - MU) / friction["friction_coefficient_sem"]
    assert np.mean(np.abs(off.values) < 3) > 0.9
    assert friction.attrs["stroke_middle"] == 0.4
    [ends] = ends_of_strokes(friction)
    lasted = [friction[f"{part}stop"] - friction[f"{part}start"] for part in ("", "trimmed_")]
    assert ends.intervals == 2 * friction.sizes["segment"] and "middle 40 %" in ends.reason
    assert ends.duration_s == pytest.approx(float((lasted[0] - lasted[1]).sum()))
    with pytest.raises(ConfigError, match="stroke_middle"):
        campaign_of(folder, segments='[segments]\nstroke_middle = "140 %"')


@pytest.mark.parametrize("said_by", ["the campaign", "the dialect"])
def test_a_blank_run_tells_the_zero_and_a_new_one_is_read(folder, said_by):
    still = np.zeros(500)
    write(folder, "blank.csv", np.full(500, OFFSET), still)
    wanted = {"segments": '[segments]\nstroke_middle = "40 %"'}
    if said_by == "the campaign":
        wanted["entry"] = 'zero = "file blank.csv"'
    else:
        stated = DIALECT.replace('name = "F"', 'name = "F"\nzero = "file blank.csv"')
        (folder / "crank.toml").write_text(stated, "utf-8")
    run, friction = results(campaign_of(folder, **wanted), folder / "first")
    assert friction.attrs["friction_force_zero_N"] == pytest.approx(OFFSET, abs=0.005)
    assert np.abs(friction["friction_force_offset"].values).max() < 0.01
    again, _ = results(campaign_of(folder, **wanted), folder / "second", folder / "first")
    assert again.reused and not run.reused
    write(folder, "blank.csv", np.full(500, OFFSET + 0.3), still)
    anew, friction = results(campaign_of(folder, **wanted), folder / "third", folder / "second")
    assert not anew.reused
    assert friction.attrs["friction_force_zero_N"] == pytest.approx(OFFSET + 0.3, abs=0.005)


@pytest.mark.parametrize("zero", ["somewhere", "first 2 N"])
def test_a_zero_that_is_no_place_is_told_by_its_line(folder, zero):
    with pytest.raises(ConfigError, match=r"zero"):
        campaign_of(folder, entry=f'zero = "{zero}"')


def test_what_lies_before_the_first_and_after_the_last_turn_is_told(folder):
    run, _ = results(campaign_of(folder), folder / "results")
    segments = read_netcdf(folder / "results" / run.data_file, group="segments")
    reasons = segments["omitted_reason"].values.tolist()
    assert reasons[-2:] == ["before the first turn", "after the last turn"]
    covered = float((segments["stop"] - segments["start"]).sum())
    covered += float((segments["omitted_stop"] - segments["omitted_start"]).sum())
    whole = read_netcdf(folder / "results" / run.data_file, group="run")["time"].values
    assert covered == pytest.approx(whole[-1] - whole[0], rel=1e-9)
