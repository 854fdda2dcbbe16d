"""Faults of the virtual rig: found by their checks, told in the truth, harmless to the rest."""

import datetime as dt
from functools import cache

import numpy as np
import pytest
import xarray as xr

from tribolab.app.checks import check_files
from tribolab.core.errors import ConfigError, ReadError
from tribolab.qc.register import STATUSES
from tribolab.qc.run.checks import RUN_CHECKS, check_run
from tribolab.reading.run_files import read
from tribolab.rig import (
    FAULTS,
    Protocol,
    Rig,
    inject,
    read_truth,
    scans,
    simulate_campaign,
    simulate_run,
)
from tribolab.rig.faults import known_fault
from tribolab.rig.files import fixed_table, force_file, motion_file
from tribolab.rig.scans.faulty import SCAN_FAULTS_BY_NAME, write_faulty_scans

SHORT = Rig(Protocol(speeds=(4.64e-6, 2.15e-5, 1e-4, 4.64e-4, 2.15e-3)))


def condition(fault):
    return (fault.surface or "Sb-R", fault.medium or "dry", 31.0)


@cache
def sound_run(*where):
    return simulate_run(*where, seed=3001, rig=SHORT)


def write(folder, run):
    paths = [folder / f"{run.name}_{log}.csv" for log in ("force", "motion")]
    paths[0].write_bytes(force_file(run.force_log, dt.datetime(2026, 3, 2)))
    paths[1].write_bytes(motion_file(run.motion_log, dt.datetime(2026, 3, 2)))
    return paths


def test_every_check_has_a_fault_that_it_finds():
    # the rig always logs its speed, and its dialect reads every row and assumes nothing: measured
    # files and those of other instruments show what is said where that is not so
    others = {"segment_speed", "rows_left_out", "said_elsewhere"}
    assert {fault.check for fault in FAULTS.values()} == set(RUN_CHECKS) - others
    for name, fault in FAULTS.items():
        assert fault.name == name and fault.what.endswith(".")
        assert fault.severity in ("suspect", "fail", "unreadable")


@pytest.mark.slow
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_found_by_its_check(tmp_path, name):
    fault = FAULTS[name]
    run = simulate_run(*condition(fault), seed=3000, rig=SHORT, faults=name)
    paths = write(tmp_path, run)
    if fault.severity == "unreadable":
        with pytest.raises(ReadError, match="time goes backwards"):
            read(paths)
        return
    # where the check is not about the two logs, the clocks are told: matching them takes longest,
    # and tests/detection/detection_table.py does it for every fault
    matched = fault.check.startswith("clock") or name == "wrong_motion"
    shift = None if matched else run.facts["clock_shift_at_middle_s"]
    found = check_run(read(paths, clock_shift=shift), normal_force=31.0)
    statuses = {row["status"] for row in found.rows if row["check"] == fault.check}
    assert max(map(STATUSES.index, statuses)) >= STATUSES.index(fault.severity)
    assert found.count()["error"] == 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 3])
def test_a_load_of_the_wrong_sign_is_readable_whatever_zero_the_cell_drew(tmp_path, seed):
    """The cells of seeds 0 and 3 read above zero even when no load is on."""
    rig = Rig(Protocol(speeds=(1e-4,)))
    sound = simulate_run("Sb-R", "dry", 31.0, seed=seed, rig=rig)
    assert (sound.force_log.normal_force.min() > 0) == (seed in (0, 3))
    struck = inject(sound, "load_sign")
    run = read(write(tmp_path, struck))
    assert run.normal_force.min() < -29
    found = check_run(run, normal_force=31.0)
    assert "fail" in {row["status"] for row in found.rows if row["check"] == "schema"}
    assert struck.facts["faults"][0]["severity"] == "fail"


@pytest.mark.slow
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_drawn_from_its_seed_and_leaves_the_run_beneath_alone(name):
    where = condition(FAULTS[name])
    sound = sound_run(*where)
    kept = sound.force_log.copy(deep=True), sound.motion_log.copy(deep=True)
    one, again = (simulate_run(*where, seed=3001, rig=SHORT, faults=name) for _ in range(2))
    xr.testing.assert_identical(one.force_log, again.force_log)
    xr.testing.assert_identical(one.motion_log, again.motion_log)
    assert one.facts == again.facts
    changed = not (
        one.force_log.identical(sound.force_log) and one.motion_log.identical(sound.motion_log)
    )
    assert changed
    xr.testing.assert_identical(one.noise_free, sound.noise_free)
    assert one.segments.equals(sound.segments)
    inject(sound, name, 5)
    xr.testing.assert_identical(sound.force_log, kept[0])
    xr.testing.assert_identical(sound.motion_log, kept[1])


def test_faults_add_up_and_are_listed_in_order():
    run = simulate_run("Sb-R", "dry", rig=SHORT, faults=["zero_offset", "spikes"])
    first, second = run.facts["faults"]
    assert (first["name"], second["name"]) == ("zero_offset", "spikes")
    sound = simulate_run("Sb-R", "dry", rig=SHORT)
    added = run.force_log.friction_force.values - sound.force_log.friction_force.values
    assert np.median(added) == pytest.approx(first["offset_N"])
    apart = np.flatnonzero(np.abs(added - first["offset_N"]) > 1)
    assert apart.tolist() == second["rows"]


def test_the_truth_of_a_campaign_tells_where_each_fault_is(tmp_path):
    wanted = ["slow_logger", "hum", "gaps"]
    folder = tmp_path / "faulty"
    simulate_campaign(folder, small=True, n_repeats=1, seed=4, faults=wanted)
    runs = read_truth(folder).facts["runs"]
    told = {name: [f["name"] for f in fact.get("faults", [])] for name, fact in runs.items()}
    assert sorted(sum(told.values(), [])) == sorted(wanted)
    assert max(map(len, told.values())) == 1
    assert told["smooth_dry_31N_01"] == ["slow_logger"]  # the only one that has such stick-slip
    # a run that was not struck is the same as in a campaign without faults
    simulate_campaign(tmp_path / "sound", small=True, n_repeats=1, seed=4)
    for name, faults in told.items():
        raw = [
            (tmp_path / kind / "raw/friction" / f"{name}_force.csv").read_bytes()
            for kind in ("faulty", "sound")
        ]
        assert (raw[0] == raw[1]) == (not faults)


@pytest.mark.parametrize("name", SCAN_FAULTS_BY_NAME)
def test_a_fault_of_scans_survives_its_file_and_is_found_where_the_truth_says(tmp_path, name):
    clean = scans("Sb-R", SCAN_FAULTS_BY_NAME[name].fewest, seed=5, length=6e-3)
    told = write_faulty_scans(clean, [name], tmp_path, 5)
    assert told
    for one in check_files(sorted(tmp_path.iterdir())):
        for fault in told.get(one.name, {"faults": []})["faults"]:
            found = {r["status"] for r in one.rows if r["check"] == fault["check"]}
            assert max(map(STATUSES.index, found)) >= STATUSES.index(fault["severity"])
        if one.name not in told:
            assert one.status == "pass"


def test_a_campaign_takes_faults_of_scans_and_tells_which_file_has_them(tmp_path):
    one_speed = Rig(Protocol(speeds=(2.15e-3,)))
    wanted = ["odd_scan", "scan_dropouts", "dropouts"]
    for folder, faults in (("faulty", wanted), ("sound", [])):
        simulate_campaign(
            tmp_path / folder, small=True, n_repeats=1, seed=4, rig=one_speed, faults=faults
        )
    facts = read_truth(tmp_path / "faulty").facts
    odd, spotty = facts["scans"]
    assert odd.startswith("smooth_") and spotty == "sb-r_1.csv"
    assert facts["scans"][odd]["faults"] == [
        {
            "name": "odd_scan",
            "what": SCAN_FAULTS_BY_NAME["odd_scan"].what,
            "severity": "fail",
            "check": "repeats",
        }
    ]
    of_runs = [fault["name"] for run in facts["runs"].values() for fault in run.get("faults", [])]
    assert of_runs == ["dropouts"]
    profiles = tmp_path / "faulty/raw/profiles"
    # one is no odd one: the surface got as many scans as it takes
    assert len(list(profiles.glob("smooth_*.csv"))) == 3
    assert b",\n" in (profiles / spotty).read_bytes()
    assert b",\n" not in (tmp_path / "sound/raw/profiles" / spotty).read_bytes()
    assert read_truth(tmp_path / "sound").facts["scans"] == {}


def test_a_wrong_name_lists_every_fault_as_the_help_promises(tmp_path):
    with pytest.raises(ConfigError, match="known are") as told:
        simulate_campaign(tmp_path / "x", faults="?")
    listed = str(told.value).partition("known are ")[2].split(", ")
    assert listed == sorted({*FAULTS, *SCAN_FAULTS_BY_NAME})
    with pytest.raises(ConfigError, match=f"known are {', '.join(sorted(FAULTS))}$"):
        known_fault("?")


def test_what_cannot_be_is_refused_with_a_reason(tmp_path):
    with pytest.raises(ConfigError, match="did you mean 'spikes'"):
        simulate_run(rig=SHORT, faults="spike")
    with pytest.raises(ConfigError, match="Smooth dry only, not on Sb-R dry"):
        simulate_run("Sb-R", "dry", rig=SHORT, faults="slow_logger")
    with pytest.raises(ConfigError, match="2 are wanted"):
        simulate_run("Sb-R", "dry", rig=Rig(Protocol(speeds=(2.15e-3,))), faults="resonance")
    with pytest.raises(ConfigError, match="no such run"):
        simulate_campaign(tmp_path / "x", small=True, surfaces=["Sb-R"], faults=["slow_logger"])
    assert list(tmp_path.iterdir()) == []


def test_a_missing_value_is_an_empty_cell():
    values = np.array([1.25, np.nan, -0.5])
    assert fixed_table([(values, 2), (values, 1)], ",") == b"1.25,1.2\n,\n-0.50,-0.5\n"
