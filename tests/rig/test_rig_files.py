"""The simulated campaign on disk: reproducible, complete, small, and never written over."""

import datetime as dt
import hashlib
import tomllib
from decimal import Decimal

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tribolab import rig
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import ConfigError, ReadError
from tribolab.rig.files import fixed_table, force_file, motion_file

TINY = {"small": True, "surfaces": ["Smooth"], "n_repeats": 1}


def digests(folder):
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return rig.simulate_campaign(tmp_path_factory.mktemp("rig") / "new", seed=3, small=True).parent


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    """Digests of a tiny campaign's files."""
    folder = tmp_path_factory.mktemp("tiny") / "one"
    return digests(rig.simulate_campaign(folder, seed=1, **TINY).parent)


def test_same_seed_gives_the_same_bytes(tiny, tmp_path):
    again, different = (
        digests(rig.simulate_campaign(tmp_path / name, seed=seed, **TINY).parent)
        for name, seed in (("again", 1), ("other", 2))
    )
    assert tiny == again
    raw = [name for name in tiny if name.startswith("raw")]
    assert raw and all(tiny[name] != different[name] for name in raw)


@pytest.mark.slow
def test_processes_change_nothing(tiny, tmp_path):
    two = rig.simulate_campaign(tmp_path / "two", seed=1, jobs=2, **TINY).parent
    assert tiny == digests(two)


def test_a_run_does_not_depend_on_what_else_is_made(campaign, tmp_path):
    alone = rig.simulate_campaign(tmp_path / "alone", seed=3, **TINY).parent
    name = "raw/profiles/smooth_1.csv"
    assert (alone / name).read_bytes() == (campaign / name).read_bytes()
    table = "truth/smooth_glycerol_31N_01.csv"
    assert (alone / table).read_bytes() == (campaign / table).read_bytes()


def test_every_raw_file_is_named_by_the_campaign_once(campaign):
    plan = tomllib.loads((campaign / "campaign.toml").read_text())
    raw = campaign / plan["campaign"]["raw"]
    found = [path for run in plan["run"] for path in raw.glob(run["files"])]
    found += [path for surface in plan["surface"] for path in raw.glob(surface["scans"])]
    assert sorted(found) == sorted(path for path in raw.rglob("*") if path.is_file())
    assert len(set(found)) == len(found)
    for run in plan["run"]:
        files = sorted(path.name for path in raw.glob(run["files"]))
        forces = [name for name in files if name.endswith("_force.csv")]
        assert len(forces) == 2
        assert {name.replace("_force", "_motion") for name in forces} <= set(files)
        assert run["surface"] in {surface["name"] for surface in plan["surface"]}
        assert run["medium"] in plan["medium"]
        assert run["instrument"] == "linear_slider"


@pytest.mark.slow
def test_full_campaign_is_three_surfaces_five_conditions_two_repeats(tmp_path):
    # nothing but the protocol is shortened
    brief = rig.Rig(rig.Protocol(speeds=(1e-2,)))
    calls = []
    path = rig.simulate_campaign(
        tmp_path / "all", rig=brief, n_scans=1, progress=lambda *step: calls.append(step)
    )
    plan = tomllib.loads(path.read_text())
    assert len(plan["run"]) == 15
    assert len(list((path.parent / "raw" / "friction").glob("*_force.csv"))) == 30
    assert calls[-1] == ("simulate", 33, 33)
    dry = [run["normal_force"] for run in plan["run"] if run["medium"] == "dry"]
    assert dry == ["31 N"] * 3
    name = "sb-r_glycerol_211N_02"
    assert rig.read_truth(path.parent).facts["runs"][name]["normal_force_N"] == 211


def test_a_full_run_stays_under_3_megabytes_and_the_demo_under_120():
    run = rig.simulate_run("Smooth", "dry", 31.0, seed=1)
    date = dt.datetime(2026, 3, 2, 9, 12, 31)
    size = len(force_file(run.force_log, date)) + len(motion_file(run.motion_log, date))
    assert size < 3e6
    assert 30 * 1.1 * size + 9 * 1e6 < 120e6  # at higher loads a digit more


def test_files_say_what_the_logs_say(tmp_path):
    run = rig.simulate_run("Sb-S", rig=rig.Rig(rig.Protocol(speeds=(1e-4, 1e-2))), seed=8)
    date = dt.datetime(2026, 3, 2, 9, 12, 31)
    (tmp_path / "force.csv").write_bytes(force_file(run.force_log, date))
    (tmp_path / "motion.csv").write_bytes(motion_file(run.motion_log, date))
    text = (tmp_path / "force.csv").read_text()
    assert text.startswith("# Linear slider, force log\n# date: 2026-03-02T09:12:31\n")
    force = pd.read_csv(tmp_path / "force.csv", comment="#")
    assert list(force) == ["Time [s]", "Fx [N]", "Fz [N]"]
    np.testing.assert_allclose(force["Time [s]"], run.force_log.time, atol=1e-9)
    np.testing.assert_allclose(force["Fx [N]"], run.force_log.friction_force, atol=0.51e-3)
    np.testing.assert_allclose(force["Fz [N]"], run.force_log.normal_force, atol=0.51e-3)
    motion = pd.read_csv(tmp_path / "motion.csv", comment="#", sep=";")
    scales = {"Position [mm]": "position", "Velocity [mm/s]": "sliding_velocity"}
    scales["Set speed [mm/s]"] = "set_speed"
    assert list(motion) == ["Time [s]", *scales]
    for column, name in scales.items():
        np.testing.assert_allclose(motion[column] * 1e-3, run.motion_log[name], atol=1e-13)


def test_the_campaign_says_that_it_is_simulated_and_whose_roughness_it_has(campaign):
    note = load_campaign(campaign).campaign.note
    assert "virtual rig" in note and "spectra are not published" in note


def test_truth_reads_back(campaign):
    truth = rig.read_truth(campaign)
    assert sorted(truth.segments) == sorted(truth.facts["runs"])
    for name, table in truth.segments.items():
        assert (campaign / "raw" / "friction" / f"{name}_force.csv").is_file()
        assert len(table) == 6
        assert set(table.direction) == {1, -1}
        assert (table.stop_s > table.start_s).all()
        assert abs(truth.facts["runs"][name]["clock_shift_s"]) <= 2
    dry = truth.segments["smooth_dry_31N_01"]
    assert dry.stick_slip.tolist() == ["sawtooth"] * 4 + ["none"] * 2
    assert dry.stick_slip_wavelength_m.isna().tolist() == [False] * 4 + [True] * 2
    assert "stand-in" in truth.facts["surfaces"]["Smooth"]["origin"]


def test_truth_of_a_measured_campaign_is_an_error(tmp_path):
    with pytest.raises(ReadError, match="only simulated campaigns have a truth"):
        rig.read_truth(tmp_path)


def test_nothing_is_ever_overwritten(tmp_path):
    (tmp_path / "mine.txt").write_text("precious")
    with pytest.raises(ConfigError, match="not an empty folder"):
        rig.simulate_campaign(tmp_path)
    with pytest.raises(ConfigError, match="not an empty folder"):
        rig.simulate_campaign(tmp_path / "mine.txt")
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_an_empty_folder_is_filled(tmp_path):
    (tmp_path / "empty").mkdir()
    assert rig.simulate_campaign(tmp_path / "empty", **TINY).is_file()


def test_an_interrupted_simulation_leaves_nothing(tmp_path):
    def stop(stage, done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rig.simulate_campaign(tmp_path / "half", progress=stop, **TINY)
    assert list(tmp_path.iterdir()) == []


@given(st.lists(st.integers(-(10**10), 10**10), min_size=1, max_size=20), st.integers(0, 6))
def test_numbers_are_written_with_fixed_decimals(counts, decimals):
    numbers = np.array(counts) / 10**decimals
    text = fixed_table([(numbers, decimals), (-numbers, decimals)], ";").decode()
    exact = [Decimal(count).scaleb(-decimals) for count in counts]
    expected = [f"{n:.{decimals}f};{-n if n else abs(n):.{decimals}f}" for n in exact]
    assert text == "\n".join(expected) + "\n"
