"""Inertia of a moving mass: taken out where it is stated, found where the data tell."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr
from layouts.motion import Leg, carried_out, crank
from layouts.record import Sensors, recorded

import tribolab as tl
from tribolab.campaign.settings.load import load_campaign
from tribolab.core.errors import AnalysisError, ReadError
from tribolab.reading.runs.inertia import acceleration
from tribolab.records.runs.traces import decimated_trace
from tribolab.rig import DryLaw

LOAD = 20.0


def made(motion, mass, seed=0, *, by="sliding_velocity", sign=1.0):
    """A run with a moving mass [kg], and what its sensors would show without."""
    sensors = Sensors(normal_offset=0.0, offset=0.0)
    law = DryLaw(0.35, 0.04)
    record = recorded(motion, law, LOAD, seed=seed, sensors=sensors, moving_mass=mass)
    rng = np.random.default_rng([seed, 1])
    signal = {"sliding_velocity": motion.velocity, "position": motion.position}[by]
    noise = {"sliding_velocity": 0.003, "position": 1e-4}[by]
    signal = signal + noise * np.abs(signal).max() * rng.standard_normal(signal.size)
    data = {"friction_force": sign * record.friction_force, "normal_force": record.normal_force}
    run = xr.Dataset({k: ("time", v) for k, v in (data | {by: signal}).items()},
                     {"time": motion.time}, {"source": "made"})  # fmt: skip
    return run, sign * (record.friction_force - mass * motion.acceleration)


def strokes(rate=200.0):
    """Both ways at constant speed, with ramps of 2 m/s2."""
    legs = [Leg(0.0, 1.0)] + [Leg(way * 0.1, 1.0) for _ in range(6) for way in (1, -1)]
    return carried_out(legs, rate, 0.1)


@pytest.mark.parametrize("by", ["sliding_velocity", "position"])
@pytest.mark.parametrize(("mass", "frequency"), [(1.2, 5.0), (0.3, 12.0)])
def test_the_mass_under_a_crank_is_found_within_its_error(mass, frequency, by):
    off = []
    for seed in range(6):
        motion = crank(10e-3, frequency, 40, 100 * frequency)
        known = tl.friction.moving_mass(made(motion, mass, seed, by=by)[0])
        assert known.pairs > 35 and known.error < 0.01 * mass
        off.append((known.mass - mass) / known.error)
    assert np.abs(off).max() < 4 and 0.3 < np.sqrt(np.mean(np.square(off))) < 2


def test_data_that_do_not_tell_a_mass_change_nothing():
    still = made(crank(10e-3, 5.0, 40, 500.0), 0.0)[0]
    even = made(strokes(), 3.0)[0]  # friction builds up in the ramps as the inertia does
    once = made(carried_out([Leg(0.0, 1.0), Leg(0.1, 5.0)], 200.0), 3.0)[0]
    light = made(crank(10e-3, 0.5, 40, 50.0), 1.0)[0]  # 0.05 N of 7 N
    for run in (still, even, once, light, still.drop_vars("friction_force")):
        assert tl.friction.moving_mass(run) is None
        assert tl.friction.without_inertia(run).identical(run)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_stated_mass_is_taken_out_of_ramps_however_the_force_is_counted(sign):
    run, wanted = made(strokes(), 3.0, sign=sign)
    mended = tl.friction.without_inertia(run, "3 kg")
    before, after = (np.abs(r["friction_force"].values - wanted) for r in (run, mended))
    ramps = np.abs(strokes().acceleration) > 0
    assert before[ramps].mean() > 2.0 * 3.0 * 0.45  # 6 N, and none in the ramp's first sample
    assert after[ramps].mean() < 0.1 * before[ramps].mean()
    assert np.median(after[~ramps]) < 0.05
    assert mended.attrs["inertial_force_largest_N"] == pytest.approx(6.0, rel=0.1)
    assert (mended["friction_force"] + mended["inertial_force"]).values == pytest.approx(
        run["friction_force"].values
    )
    with pytest.raises(AnalysisError, match="taken out of the run before"):
        tl.friction.without_inertia(mended, 3.0)


def test_the_derivatives_of_a_parabola_are_exact_and_noise_is_told():
    time = np.linspace(0, 2, 801)
    for name, values in (("position", 1.5 * time**2), ("sliding_velocity", 3.0 * time)):
        assert acceleration({name: values}, time, 1e-3).value == pytest.approx(3.0)
    noise = 1e-3 * np.random.default_rng(0).standard_normal(time.size)
    for name in ("position", "sliding_velocity"):
        known = acceleration({name: noise}, time, 0.0, widest=10)
        assert known.half_window == 10
        assert known.error == pytest.approx(known.value[20:-20].std(), rel=0.35)
    assert acceleration({"position": np.full(801, np.nan)}, time, 1.0) is None


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*in the instrument's file:FutureWarning")
def test_a_campaign_states_a_mass_or_finds_it_and_says_so(tmp_path):
    (tmp_path / "raw").mkdir()
    run = made(crank(10e-3, 5.0, 40, 500.0), 1.2, by="position")[0]
    units = ("Time [s]", "Friction force [N]", "Normal force [N]", "Position [m]")
    rows = np.column_stack([run.time, run["friction_force"], run["normal_force"], run["position"]])
    for name in ("found", "stated"):
        np.savetxt(tmp_path / "raw" / f"{name}.csv", rows, "%.7g", ",", header=",".join(units),
                   comments="")  # fmt: skip
    (tmp_path / "campaign.toml").write_text(
        '[campaign]\nname = "inertia"\nraw = "raw"\n[segments]\nstroke_middle = "40 %"\n'
        '[[run]]\nfiles = "found.csv"\n[[run]]\nfiles = "stated.csv"\nmoving_mass = "2 kg"\n'
    )
    with pytest.warns(FutureWarning, match="write moving_mass in the instrument's file"):
        assert load_campaign(tmp_path).run[1].moving_mass == 2.0
    tl.run_campaign(tmp_path / "campaign.toml", jobs=1, figures="none")
    findings = (tmp_path / "results" / "tables" / "checks.csv").read_text()
    assert "that of 2 kg (stated) is taken out: up to" in findings
    assert "kg (force in phase with the acceleration, 39 pairs of strokes) is taken" in findings
    again = tl.read(tmp_path / "results" / "data" / "found.nc")
    assert again.attrs["moving_mass_kg"] == pytest.approx(1.2, rel=0.01)
    assert again["inertial_force"].attrs["units"] == "N"
    report = json.loads((tmp_path / "results" / "report.json").read_text(encoding="utf-8"))
    assert "that of 2 kg (stated) is taken out" in report["runs"][1]["inertia"]
    drawn = decimated_trace(again, tl.find_segments(again), None, 300)["signals"]
    assert [signal["label"] for signal in drawn][-1] == "inertia"


def test_a_mass_without_motion_is_refused_with_the_cure(tmp_path):
    file = tmp_path / "force.csv"
    file.write_text("Time [s],Fx [N]\n" + "\n".join(f"{n / 10},1" for n in range(30)))
    with pytest.raises(ReadError, match=r"no position or velocity.*leave moving_mass out"):
        tl.read(file, moving_mass="1 kg")
