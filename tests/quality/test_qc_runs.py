"""Whole runs: sound runs of the rig pass, and real files get the verdict a person gives."""

import datetime as dt
import json

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from tribolab import cli
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.friction.segments.find import find_segments
from tribolab.qc.run.checks import RUN_CHECKS, check_run
from tribolab.reading.run_files import read
from tribolab.rig import Protocol, Rig, simulate_campaign, simulate_run
from tribolab.rig.files import force_file, motion_file, write_run
from tribolab.units.stamping import stamp

SHORT = Rig(Protocol(speeds=(4.64e-6, 2.15e-5, 1e-4, 4.64e-4, 2.15e-3)))


def measured(folder, *words, **options):
    """Simulate a run, write its files, read them back."""
    run = simulate_run(*words, **options)
    paths = [folder / f"{run.name}_{log}.csv" for log in ("force", "motion")]
    paths[0].write_bytes(force_file(run.force_log, dt.datetime(2026, 3, 2)))
    paths[1].write_bytes(motion_file(run.motion_log, dt.datetime(2026, 3, 2)))
    return read(paths)


def objections(found):
    return {
        row["check"]: row["status"]
        for row in found.rows
        if row["status"] not in ("pass", "skipped")
    }


def message(found, check):
    return " ".join(row["message"] for row in found.rows if row["check"] == check)


CONDITIONS = [("Smooth", "dry", 31.0), ("Smooth", "glycerol", 211.0), ("Sb-R", "glycerol", 31.0)]


@pytest.mark.slow
@pytest.mark.parametrize("condition", CONDITIONS)
def test_a_sound_run_passes(tmp_path, condition):
    run = measured(tmp_path, *condition, seed=2000)
    found = check_run(run, normal_force=condition[2], contact_width="2 cm")
    assert objections(found) == {}
    assert found.status == "pass"
    skipped = {row["check"] for row in found.rows if row["status"] == "skipped"}
    # the rig's files number no steps, and say all that its dialect reads
    assert skipped == {"restarts", "said_elsewhere"}


def test_flags_cover_segments_and_leave_the_rest_unjudged(tmp_path):
    run = measured(tmp_path, "Sb-R", "dry", 31.0, rig=SHORT, seed=2003)
    shifted = run.assign(normal_force=1.05 * run.normal_force)
    found = check_run(shifted, normal_force="31 N")
    assert objections(found) == {"normal_force_error": "suspect"}
    objected = found.flagged.normal_force_qc.values == 3
    segments = find_segments(run)
    assert 0.5 < objected.mean() < 0.85  # trimmed segments
    for start, stop in zip(
        segments.trimmed_start.values, segments.trimmed_stop.values, strict=True
    ):
        inside = (run.time.values >= start) & (run.time.values <= stop)
        assert objected[inside].all()


def test_an_offset_of_the_load_cell_is_not_an_error_of_the_load(tmp_path):
    run = measured(tmp_path, "Sb-R", "dry", 31.0, rig=SHORT, seed=2004)
    shifted = run.assign(normal_force=run.normal_force + 1.4)  # 4.5 %, but seen at rest
    assert objections(check_run(shifted, normal_force=31.0)) == {}


def test_a_lone_force_log_is_suspect_for_want_of_a_speed_not_a_crash(tmp_path):
    measured(tmp_path, "Sb-R", "dry", 31.0, rig=SHORT, seed=2005)
    run = read(tmp_path / "sb-r_dry_31N_01_force.csv", pair=False)
    found = check_run(run)
    assert objections(found) == {"schema": "suspect"}
    assert "the speed is unknown" in message(found, "schema")


@pytest.mark.parametrize(
    ("log", "cure"),
    [
        ("force", "Put sb-r_dry_31N_01_motion.csv next to this file, or give both."),
        ("motion", "If the instrument writes two logs, give both"),
    ],
)
def test_the_cure_of_a_lone_log_is_the_other_log_and_not_the_dialect(tmp_path, log, cure):
    paths = write_run(simulate_run("Sb-R", "dry", rig=SHORT, seed=2005), tmp_path)
    alone, other = sorted(paths, key=lambda path: not path.stem.endswith(log))
    other.unlink()
    [row] = [row for row in check_run(read(alone)).rows if row["cure"]]
    assert row["check"] == "schema" and row["cure"].startswith(cure)


def test_models_of_the_clocks_that_share_no_sample_give_no_answer_and_no_crash(tmp_path):
    run = measured(tmp_path, "Sb-R", "dry", 31.0, rig=SHORT, seed=3, faults="one_way")
    assert objections(check_run(run))["zero_reference"] == "suspect"


# --- real files


def verdict(folder, *path):
    run = read(folder.joinpath(*path))
    found = check_run(run)
    assert found.count()["error"] == 0
    return run, found


@pytest.mark.parametrize("name", ["k1002Nm_v4300", "k168Nm_v1100", "k168Nm_v4300", "k2254Nm_v1100"])
def test_paper_on_paper_has_spikes_and_its_stick_slip_is_no_fault(shared_data, name):
    run, found = verdict(shared_data, "stickslip_paper_CeCILL-B", f"{name}.mat")
    known = objections(found)
    assert known.pop("spikes") == "suspect"
    assert known.pop("zero_reference") == "suspect"  # one way, and a coefficient without its zero
    # a slow wander on which the softest one's forty swings ride is no period of theirs
    # one stroke whose friction wanders on: three of the four are known to a third or worse
    assert known == ({} if name == "k168Nm_v1100" else {"segments": "suspect"})
    flagged = found.flagged.friction_coefficient_qc.values == 3
    values = run.friction_coefficient.values
    assert 20 < flagged.sum() < 0.01 * values.size
    # the flagged samples are what stands out from the mean of the samples beside them
    apart = np.abs(values[1:-1] - (values[:-2] + values[2:]) / 2)
    assert np.median(apart[flagged[1:-1]]) > 8 * np.median(apart)


def test_the_mains_line_of_paper_on_paper_is_named_and_too_small_to_object_to(shared_data):
    _, found = verdict(shared_data, "stickslip_paper_CeCILL-B", "k168Nm_v1100.mat")
    assert "mains hum at 49.96 Hz, 0.14% of the typical friction" in message(found, "hum")
    assert "hum" not in objections(found)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Circle_1bar", "Kidney_2bar", "O-ring257_1bar"])
def test_the_actuators_irregular_first_step_is_a_gap(shared_data, name):
    run, found = verdict(shared_data, "actuator_friction_CC0", f"{name}.csv")
    known = objections(found)
    assert known.pop("time_gaps") == "suspect"
    step = np.diff(run.time.values)
    gap = found.flagged.friction_force_qc_tests.values & (1 << 2) != 0
    early = int(np.argmax(step[:15]))  # some 0.27 s within the first dozen samples
    assert step[early] > 0.26 and gap[early + 1]
    # a seal that is not the same over the stroke, and a start-up peak, a person sees as well
    assert set(known) <= {"steadiness", "spikes"} and set(known.values()) <= {"suspect"}


def test_the_rocks_change_of_rate_is_seen_and_lies_outside_the_segments(shared_data):
    _, found = verdict(shared_data, "rock_velstep_MIT", "velstep4_BRAVA_expb819_basalt.txt")
    assert objections(found) == {"zero_reference": "suspect"}  # one way, never unloaded
    told = message(found, "rate_changes")
    assert "changes 1 time, never within a trimmed segment: t = 66.5 s" in told


@pytest.mark.parametrize("number", [1, 2, 3])
def test_the_second_header_of_cetr_is_a_step_and_not_a_gap(shared_data, number):
    _, found = verdict(shared_data, "cetr_umt2_MIT", f"HT-2n-6-4 2_00{number}.csv")
    assert "the file contains 2 steps; the first one ends at" in message(found, "restarts")
    known = objections(found)
    assert known.pop("segment_speed") == "suspect"  # start and stop lie inside its steps
    assert known.pop("segments") == "suspect"  # one pair of 86 samples each, known to a third
    assert set(known) <= {"spikes"}


@pytest.mark.parametrize("name", ["demo_2.txt", "demo_3.txt", "demo_12.txt"])
def test_films_without_friction_are_suspect_for_that_alone(shared_data, name):
    _, found = verdict(shared_data, "pcs_mtm_ehd_MIT", name)
    assert objections(found) == {"schema": "suspect"}
    assert "no friction was recorded" in message(found, "schema")


@pytest.mark.parametrize("path", ["pcs_mtm_ehd_MIT/demo_5.txt", "pcs_mtm_ehd_MIT/trios_demo.txt"])
def test_sound_exports_of_other_instruments_pass(shared_data, path):
    # a traction coefficient of one way says nothing of its zero
    one_way = {"zero_reference": "suspect"} if "demo_5" in path else {}
    assert objections(verdict(shared_data, path)[1]) == one_way


def test_the_optical_trap_holds_its_speed_one_way_only_and_its_force_rises(shared_data):
    (file,) = (shared_data / "tdms_force_MIT").glob("*.tdms")
    known = {"zero_reference": "suspect", "steadiness": "fail"}
    assert objections(verdict(shared_data, file)[1]) == known


# --- command line


@pytest.fixture(scope="module")
def faulty(tmp_path_factory):
    folder = tmp_path_factory.mktemp("faulty") / "campaign"
    simulate_campaign(
        folder, small=True, surfaces=["Sb-R"], n_repeats=2, faults=["spikes", "sign", "restart"]
    )
    return folder / "raw" / "friction"


def tribolab_check(*words):
    return CliRunner().invoke(cli.app, ["check", *map(str, words)])


@pytest.fixture(scope="module")
def checked(faulty):
    """What the command says of all runs."""
    return tribolab_check(*sorted(faulty.glob("*.csv")), "--json")


@pytest.mark.slow
def test_the_command_checks_every_run_and_a_bad_one_stops_none(checked):
    done = checked
    told = json.loads(done.stdout)
    statuses = sorted(run["status"] for run in told["runs"])
    assert statuses == ["fail", "pass", "suspect", "unreadable"]
    assert done.exit_code == told["exit_code"] == 3
    bad = next(run for run in told["runs"] if run["status"] == "unreadable")
    assert "time goes backwards" in bad["error"] and bad["findings"] == []


@pytest.mark.slow
def test_the_commands_exit_code_is_the_level_asked_for(checked):
    by_status = {run["status"]: run["files"] for run in json.loads(checked.stdout)["runs"]}
    for status, options, code in (
        ("pass", ["--fail-on", "suspect"], 0),
        ("suspect", [], 0),
        ("suspect", ["--fail-on", "suspect", "--verbose"], 1),
        ("fail", ["--fail-on", "fail"], 1),
        ("fail", ["--fail-on", "never"], 0),
    ):
        done = tribolab_check(*by_status[status], *options)
        assert done.exit_code == code, (status, options, done.stderr)
        if status == "suspect":
            assert "spikes" in done.stdout and "Look for switching devices" in done.stdout
            assert "1 with findings" in done.stdout
            assert ("saturation" in done.stdout) == ("--verbose" in options)


def test_the_command_explains_wrong_use(faulty):
    file = next(iter(faulty.glob("*.csv")))
    done = tribolab_check(file, "--fail-on", "fial")
    assert done.exit_code == 2 and "did you mean 'fail'" in done.stderr
    done = tribolab_check(file, "--instrument", "linear_slidr")
    assert done.exit_code == 2 and "linear_slider" in done.stderr
    assert tribolab_check(faulty / "none.csv").exit_code == 3


def test_a_run_that_never_holds_its_speed_is_suspect_and_says_so():
    time = np.arange(2000) / 100
    ramp = xr.Dataset(
        {
            "sliding_velocity": ("time", 1e-3 * (1 + time)),
            "friction_force": ("time", 3 + 0.01 * np.random.default_rng(0).standard_normal(2000)),
        },
        {"time": time},
    )
    found = check_run(ramp)
    assert found.status == "suspect"
    assert "speed-ramp test" in message(found, "segments")


def test_a_run_of_which_nothing_was_examined_is_suspect():
    run = xr.Dataset({"friction_force": ("time", np.ones(50))}, {"time": np.arange(50.0)})
    found = check_run(run, skip=[name for name in RUN_CHECKS if name != "segments"])
    assert found.status == "suspect"
    assert "every check was skipped" in message(found, "segments")


def test_checks_and_results_tell_the_same_periods_whatever_drifts():
    rng = np.random.default_rng(5)
    t = 0.01 * np.arange(20_000)
    load = 30 * (1 + 0.2 * np.sin(2 * np.pi * 3.25 * t / t[-1]))  # three slow waves of the load
    saw = 0.05 * (0.7 * t % 1.0)
    for wave, periods in ((0.0, np.nan), (saw, 140.0)):
        data = {
            "normal_force": ("time", load + 0.05 * rng.standard_normal(t.size)),
            "friction_force": ("time", load * (0.5 + wave) + 0.05 * rng.standard_normal(t.size)),
            "sliding_velocity": ("time", np.full(t.size, 1e-4)),
        }
        run = stamp(xr.Dataset(data, {"time": t}))
        slip = stick_slip(run, find_segments(run))
        rows = {row["check"]: row for row in check_run(run, contact_width=1e-3).rows}
        if np.isnan(periods):
            assert slip["waveform"].item() == "smooth sliding"
            assert rows["sampling"]["message"] == "no stick-slip to resolve"
        else:
            assert rows["distance"]["value"] == slip["periods"].item()
            assert rows["sampling"]["value"] == pytest.approx(100 / 0.7, rel=0.02)


def test_distance_tells_that_drops_and_spectrum_are_at_odds():
    """Only of a segment that is steady and oscillates strongly, by a line that is no chance."""
    t = 0.01 * np.arange(4000)
    rng = np.random.default_rng(3)
    wave = 0.05 * np.sin(2 * np.pi * 0.5 * t)
    data = {
        "friction_coefficient": ("time", 0.5 + wave + 0.002 * rng.standard_normal(t.size)),
        "sliding_velocity": ("time", np.full(t.size, 1e-4)),
    }
    run = stamp(xr.Dataset(data, {"time": t}))
    segments = find_segments(run)
    slip = stick_slip(run, segments)
    odd = "not decided: the spectrum tells a period of 2 s, the drops are 5 s apart"
    said = slip.assign(remark=("segment", np.array([odd], dtype=object)))
    chance = said.assign(false_alarm_probability=("segment", [0.5]))
    doubts = {
        name: [
            row["message"]
            for row in check_run(run, segments, slip=found).rows
            if row["check"] == "distance" and row["status"] == "suspect"
        ]
        for name, found in (("as it is", slip), ("at odds", said), ("by chance", chance))
    }
    assert len(doubts["at odds"]) == 1
    assert "the period of stick-slip is not determined in 1 segment" in doubts["at odds"][0]
    assert doubts["as it is"] == doubts["by chance"] == []


def test_a_speed_without_sign_beside_a_signed_force_is_told_with_what_to_state():
    rng = np.random.default_rng(0)
    t = 0.02 * np.arange(4000)
    way = np.select([t % 20 < 8, (t % 20 >= 10) & (t % 20 < 18)], [1.0, -1.0])
    data = {
        "friction_force": ("time", 5 * way + 0.3 + 0.02 * rng.standard_normal(t.size)),
        "normal_force": ("time", 10 + 0.01 * rng.standard_normal(t.size)),
        "sliding_velocity": ("time", 1e-3 * np.abs(way)),
    }
    run = stamp(xr.Dataset(data, {"time": t}))
    told = [row for row in check_run(run).rows if row["check"] == "friction_sign"]
    assert told[0]["status"] == "fail"
    assert "Name its column `set_speed` in the dialect" in told[0]["cure"]
    # and that is right: the force tells the direction, and the loop its zero
    stated = check_run(run.rename(sliding_velocity="set_speed"))
    assert stated.status == "pass"


@pytest.mark.parametrize("in_sliding", [False, True])
def test_zeros_before_the_sliding_are_no_end_of_the_range(in_sliding):
    """Each step of a disc starts without torque; what is cut off is cut off in sliding, too."""
    rng = np.random.default_rng(2)
    speed = np.tile(np.concatenate([np.linspace(0, 1e-3, 10), np.full(400, 1e-3)]), 8)
    force = np.abs(3 + 0.01 * rng.standard_normal(speed.size))
    force[speed == 0] = 0.0
    if in_sliding:
        force[300::410] = 0.0
    run = xr.Dataset(
        {"sliding_velocity": ("time", speed), "friction_force": ("time", force)},
        {"time": np.arange(speed.size) / 20},
    )
    found = check_run(run)
    assert ("end of the range" in message(found, "saturation")) == in_sliding


@pytest.mark.parametrize(("factor", "status"), [(1.0, "pass"), (1.2, "suspect")])
def test_a_recorded_coefficient_that_its_forces_do_not_give_is_told(factor, status):
    """The arm of a lever may be right in one of both alone."""
    rng = np.random.default_rng(4)
    sign = np.repeat(np.tile([1.0, -1.0], 4), 400)
    force = 7 * sign + 0.5 + 0.02 * rng.standard_normal(sign.size)  # an offset is none of it
    run = xr.Dataset(
        {
            "sliding_velocity": ("time", 1e-3 * sign),
            "friction_force": ("time", force),
            "normal_force": ("time", 20 + 0.01 * rng.standard_normal(sign.size)),
            "friction_coefficient": ("time", factor * np.abs(force) / 20),
        },
        {"time": np.arange(sign.size) / 50},
    )
    rows = [row for row in check_run(run).rows if row["check"] == "said_elsewhere"]
    assert [row["status"] for row in rows] == [status]
    assert f"records a coefficient of {0.35 * factor:.2g}" in rows[0]["message"]


@pytest.mark.parametrize("size", [1e-5, 0.3, 30.0])
def test_a_coefficient_that_no_contact_has_is_told(size):
    rng = np.random.default_rng(4)
    run = xr.Dataset(
        {
            "sliding_velocity": ("time", np.full(400, 1e-3)),
            "friction_coefficient": ("time", size * (1 + 0.01 * rng.standard_normal(400))),
        },
        {"time": np.arange(400) / 50},
    )
    told = message(check_run(run), "said_elsewhere")
    assert ("which is impossible" in told) == (size != 0.3)


def test_where_a_record_goes_on_after_a_pause_no_sample_stands_out():
    rng = np.random.default_rng(2)
    force = 3.0 + 0.01 * rng.standard_normal(1200)
    force[::400] = 0.0  # the contact is not yet loaded
    time = 0.02 * np.arange(1200) + np.repeat([0.0, 11.0, 22.0], 400)
    speed = np.repeat([0.01, 0.02, 0.05], 400)
    signals = {"friction_force": force, "normal_force": np.full(1200, 10.0)}
    run = xr.Dataset(
        {
            name: ("time", values)
            for name, values in (signals | {"sliding_velocity": speed}).items()
        },
        {"time": time},
    )
    assert "spikes" not in objections(check_run(run, find_segments(run)))
    exceeds_spectrum = run.copy(deep=True)
    exceeds_spectrum.friction_force[600] = 9.0
    assert objections(check_run(exceeds_spectrum, find_segments(run)))["spikes"] == "suspect"
