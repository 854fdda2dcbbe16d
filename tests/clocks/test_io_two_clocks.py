"""Two logs with two clocks become one run on the force log's clock."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.clocks.shift import estimate_clock_shift
from tribolab.reading.runs.file_facts import describe_companion
from tribolab.reading.runs.logs import group_files

FASTEST = 1e-3  # s, sample period of the fastest strokes


def protocol():
    """Edges [s], velocities [m/s] and sample rates [Hz] of strokes there and back."""
    edges, velocities, rates = [0.0, 10.0, 15.0], [0.0, 0.0], [10.0, 100.0]
    for v in np.logspace(-6, -2, 13):
        rate = max(10.0, 1000.0 * np.sqrt(v / 1e-2))
        for direction in (1, -1):
            edges += [edges[-1] + max(20e-6 / v, 1.0), edges[-1] + max(20e-6 / v, 1.0) + 1.0]
            velocities += [direction * v, 0.0]
            rates += [rate, rate]
    return np.array([*edges, edges[-1] + 10.0]), np.array([*velocities, 0.0]), [*rates, 10.0]


def clock(rng, begin, end):
    edges, _, rates = protocol()
    parts = [
        (t := np.arange(a, b, 1 / r)) + rng.uniform(-0.2, 0.2, len(t)) / r
        for a, b, r in zip(edges[:-1], edges[1:], rates, strict=True)
    ]
    time = np.sort(np.concatenate(parts))
    return time[(time > begin) & (time < edges[-1] - end)]


def velocity(time):
    edges, velocities, _ = protocol()
    k = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, len(velocities) - 1)
    ramp = np.minimum(time - edges[k], edges[k + 1] - time) / 0.05
    return velocities[k] * np.clip(ramp, 0, 1)


def logs(seed, shift, noise=0.3, begin=3.0):
    rng = np.random.default_rng(seed)
    force_time, motion_time = clock(rng, 0.0, 0.0), clock(rng, begin, 2.0)
    v = velocity(force_time)
    mu = 0.3 + 0.015 * np.log10(np.abs(v) + 1e-7)
    force = 31.0 * mu * np.tanh(v / 1e-7) + 0.5 + noise * rng.normal(size=len(v))
    return force_time, force, motion_time - shift, velocity(motion_time)


@pytest.mark.slow
@pytest.mark.parametrize("shift", [0.0, 0.3331, -1234.5])
def test_a_known_shift_is_found_to_two_samples_of_the_fastest_strokes(shift):
    estimate = estimate_clock_shift(*logs(1, shift))
    assert abs(estimate.shift - shift) < 2 * FASTEST
    assert abs(estimate.shift - shift) < 4 * estimate.uncertainty < 4 * FASTEST
    assert "motion" in estimate.ways  # the starts are 1.9 standard errors apart


def test_noise_as_strong_as_friction_widens_the_stated_uncertainty():
    quiet, loud = (estimate_clock_shift(*logs(2, 0.8, noise)) for noise in (0.3, 8.0))
    assert abs(loud.shift - 0.8) < 2 * loud.uncertainty < 0.1
    assert loud.uncertainty > quiet.uncertainty
    assert loud.explained < quiet.explained


@pytest.mark.parametrize("kind", ["noise", "wander", "drift", "wave", "constant"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_force_that_does_not_follow_the_motion_gives_no_shift(kind, seed):
    rng = np.random.default_rng(seed)
    time, force, motion_time, v = logs(seed, 0.5)
    white = rng.normal(size=len(force))
    forces = {
        "noise": white,
        "wander": white.cumsum(),
        "drift": 0.1 * time + white,
        "wave": np.sin(time / 60 + seed) + 0.05 * white,
        "constant": np.ones(len(force)),
    }
    assert estimate_clock_shift(time, forces[kind], motion_time, v) is None


def test_a_table_at_rest_gives_no_shift():
    time, force, motion_time, v = logs(1, 0.5)
    assert estimate_clock_shift(time, force, motion_time, 0 * v) is None


def write_logs(folder, shift, seed=1, stem="sb-r_glycerol_31N_01"):
    force_time, force, motion_time, v = logs(seed, shift)
    position = np.concatenate([[0], np.cumsum(np.diff(motion_time) * v[1:])])
    set_speed = np.abs(protocol()[1])[
        np.clip(np.searchsorted(protocol()[0], motion_time + shift, side="right") - 1, 0, 54)
    ]
    head = "# Linear slider, {} log\n# date: 2026-03-02T09:12:31\n"
    table = np.column_stack([force_time, force, np.full(len(force), 31.0)])
    np.savetxt(
        folder / f"{stem}_force.csv", table, "%.5f", ",", comments="",
        header=head.format("force") + "Time [s],Fx [N],Fz [N]",
    )  # fmt: skip
    table = np.column_stack([motion_time, 1e3 * position, 1e3 * v, 1e3 * set_speed])
    np.savetxt(
        folder / f"{stem}_motion.csv", table, "%.7f", ";", comments="",
        header=head.format("motion") + "Time [s];Position [mm];Velocity [mm/s];Set speed [mm/s]",
    )  # fmt: skip
    return folder / f"{stem}_force.csv", folder / f"{stem}_motion.csv"


@pytest.mark.parametrize("shift", [1.25, -1.6])
def test_the_companion_log_is_found_and_brought_onto_the_force_clock(tmp_path, shift):
    force_log, _ = write_logs(tmp_path, shift)
    run = tl.read(force_log)
    assert run.attrs["clock_shift_source"] == "estimated"
    assert abs(run.attrs["clock_shift_s"] - shift) < 2 * FASTEST
    assert 0 < run.attrs["clock_shift_uncertainty_s"] < 2 * FASTEST
    assert run.attrs["set_normal_force_N"] == 31.0
    assert run.attrs["source"] == "sb-r_glycerol_31N_01_force.csv; sb-r_glycerol_31N_01_motion.csv"
    raw = run["time"].values + run.attrs["time_origin_s"]
    true = velocity(raw)
    moving = (true != 0) & (velocity(raw - 0.25) == true) & (velocity(raw + 0.25) == true)
    np.testing.assert_allclose(run["sliding_velocity"].values[moving], true[moving], atol=1e-9)
    # set-points are held, never interpolated
    apart = np.abs(run["set_speed"].values[:, None] - np.abs(protocol()[1]))
    assert apart.min(axis=1).max() < 1e-10
    assert not any(np.isnan(run[name]).any() for name in run.data_vars)


def test_only_the_part_that_both_logs_cover_is_kept(tmp_path):
    files = write_logs(tmp_path, 0.5)
    run = tl.read(files, clock_shift=0.5)
    alone = tl.read(files[0], pair=False)
    assert "sliding_velocity" not in alone
    assert run.attrs["time_origin_s"] == pytest.approx(3.0, abs=0.2)
    assert run["time"].values[0] == 0.0
    kept = alone.isel(
        time=alone["time"] + alone.attrs["time_origin_s"] >= run.attrs["time_origin_s"]
    )
    np.testing.assert_array_equal(
        kept["friction_force"].values[: run.sizes["time"]], run["friction_force"]
    )


def test_a_given_shift_is_taken_as_it_is_and_in_any_order_of_files(tmp_path):
    files = write_logs(tmp_path, 0.5)
    given = [tl.read(order, clock_shift="700 ms") for order in (files, files[::-1])]
    for run in given:
        assert run.attrs["clock_shift_s"] == 0.7 and run.attrs["clock_shift_source"] == "given"
    assert given[0].drop_attrs().identical(given[1].drop_attrs())
    named = tl.read(files, "linear_slider", clock_shift=0.7)
    assert named.drop_attrs().identical(given[0].drop_attrs())


def test_a_shift_that_parts_the_logs_is_refused(tmp_path):
    with pytest.raises(ReadError, match="do not overlap.*correct clock_shift="):
        tl.read(write_logs(tmp_path, 0.5), clock_shift=1e6)


def test_a_missing_companion_is_told_in_the_run(tmp_path):
    force_log, motion_log = write_logs(tmp_path, 0.5)
    motion_log.unlink()
    assert tl.read(force_log).attrs["companion_missing"] == motion_log.name
    assert describe_companion(force_log) == {"missing": motion_log.name}


def test_a_motion_log_has_no_companion_whichever_of_both_instruments_is_named(tmp_path):
    _, motion_log = write_logs(tmp_path, 0.5)
    assert describe_companion(motion_log) == describe_companion(motion_log, "linear_slider") == {}


def test_logs_without_friction_fall_back_on_the_dates_and_say_so(tmp_path):
    force_log, motion_log = write_logs(tmp_path, 0.5)
    lines = force_log.read_text().splitlines()
    table = np.loadtxt(lines[3:], delimiter=",")
    rng = np.random.default_rng(1)
    table[:, 1] = rng.normal(size=len(table))
    rows = [",".join(f"{number:.5f}" for number in row) for row in table]
    force_log.write_text("\n".join([*lines[:3], *rows]))
    moved = motion_log.read_text().replace("09:12:31", "09:12:33", 1)
    motion_log.write_text(moved)
    run = tl.read(force_log)
    assert run.attrs["clock_shift_source"] == "none"
    assert np.isnan(run.attrs["clock_shift_uncertainty_s"])
    first = float(moved.splitlines()[3].split(";")[0])
    assert run.attrs["clock_shift_s"] == pytest.approx(table[0, 0] + 2.0 - first)


def test_files_are_grouped_by_the_names_that_the_dialects_state(tmp_path):
    names = ["b_motion.csv", "a_force.csv", "c_force.csv", "b_force.csv", "x.mat", "a_motion.csv"]
    paths = [tmp_path / name for name in names]
    groups = [[path.name for path in group] for group in group_files(paths)]
    assert groups == [
        ["b_force.csv", "b_motion.csv"],
        ["a_force.csv", "a_motion.csv"],
        ["c_force.csv"],
        ["x.mat"],
    ]
    assert sum(map(len, group_files(paths, "cetr_umt2"))) == len(names)
    assert all(len(group) == 1 for group in group_files(paths, "cetr_umt2"))


@pytest.mark.slow
def test_the_rigs_clocks_are_brought_together_although_friction_turns_over_slowly(tmp_path):
    import json

    from tribolab.rig.campaign import simulate_campaign

    simulate_campaign(tmp_path, seed=5, small=True)
    truth = json.loads((tmp_path / "truth/truth.json").read_text())["runs"]
    assert len(truth) >= 4
    for name, true in truth.items():
        run = tl.read(tmp_path / f"raw/friction/{name}_force.csv")
        assert run.attrs["clock_shift_source"] == "estimated"
        # one clock runs faster than the other, and the shift is that at the fast strokes
        drift = abs(true["clock_rate"]) * float(run["time"][-1])
        error = abs(run.attrs["clock_shift_s"] - true["clock_shift_at_middle_s"])
        assert error < 2 * run.attrs["clock_shift_uncertainty_s"] + drift / 2
        assert run.attrs["clock_shift_uncertainty_s"] < 0.011
