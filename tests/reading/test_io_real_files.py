"""Real instruments' files read as what they are, against numbers computed independently."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.runs.file_facts import file_facts
from tribolab.reading.runs.read_run import read_log

REAL = {
    "actuator_friction_CC0/Circle_1bar.csv": ("pneumatic_actuator", 7139),
    "actuator_friction_CC0/Kidney_2bar.csv": ("pneumatic_actuator", 6056),
    "actuator_friction_CC0/O-ring257_1bar.csv": ("pneumatic_actuator", 5828),
    "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt": ("biaxial_rock", 5849),
    "cetr_umt2_MIT/HT-2n-6-4 2_001.csv": ("cetr_umt2", 217),
    "pcs_mtm_ehd_MIT/demo_5.txt": ("pcs_mtm", 1000),
    "pcs_mtm_ehd_MIT/demo_2.txt": ("pcs_ehd", 21),
    "pcs_mtm_ehd_MIT/demo_3.txt": ("pcs_ehd", 42),
    "pcs_mtm_ehd_MIT/demo_12.txt": ("pcs_ehd", 94),
    "pcs_mtm_ehd_MIT/trios_demo.txt": ("ta_trios", 2899),
    "stickslip_paper_CeCILL-B/k168Nm_v4300.mat": ("paper_stick_slip", 7521),
    "tdms_force_MIT/TDMSSample.tdms": ("optical_trap_tdms", 2618),
}


@pytest.mark.parametrize(("file", "expected"), REAL.items())
def test_each_real_file_is_recognised_by_content_and_read_whole(shared_data, file, expected):
    run = tl.read(shared_data / file)
    assert (run.attrs["instrument"], run.sizes["time"]) == expected
    assert run["time"].values[0] == 0.0
    assert (np.diff(run["time"]) > 0).all()
    assert all(run[name].attrs["units"] for name in run.variables)
    assert len(run.attrs["source_sha256"]) == 64


def test_a_file_is_recognised_without_its_name_and_extension(shared_data, tmp_path):
    for number, file in enumerate(REAL):
        copy = tmp_path / f"unnamed{number}"
        copy.write_bytes((shared_data / file).read_bytes())
        assert tl.read(copy).attrs["instrument"] == REAL[file][0]


@pytest.mark.parametrize("ends", [b"\n", b"\r", b"\r\r\n"])
def test_line_ends_do_not_change_what_is_read(shared_data, tmp_path, ends):
    for file in ("cetr_umt2_MIT/HT-2n-6-4 2_001.csv", "actuator_friction_CC0/Circle_1bar.csv"):
        original = tl.read(shared_data / file)
        copy = tmp_path / "copy.csv"
        copy.write_bytes((shared_data / file).read_bytes().replace(b"\r\n", ends))
        assert tl.read(copy).drop_attrs().identical(original.drop_attrs())


def test_actuator_columns_come_out_in_si_units(shared_data):
    file = shared_data / "actuator_friction_CC0/Circle_1bar.csv"
    raw, run = np.loadtxt(file), tl.read(file)
    np.testing.assert_array_equal(run["friction_force"], raw[:, 6])
    np.testing.assert_array_equal(run["position"], raw[:, 4] / 1000)
    np.testing.assert_array_equal(run["time"], raw[:, 0] / 1000)
    np.testing.assert_allclose(run["ambient_pressure"], raw[:, 5] * 1e5, rtol=1e-15)


def test_rock_velocity_step_has_the_reference_friction_on_both_sides(shared_data):
    run = tl.read(shared_data / "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt")
    assert run.attrs["time_origin_s"] == 11607.7
    raw = run["time"].values + run.attrs["time_origin_s"]
    sides = [(raw <= 11676.75, 0.60758, 0.00071), (raw >= 11676.75, 0.60796, 0.00091)]
    for side, mean, deviation in sides:
        friction = run["friction_coefficient"].values[side]
        tenth = len(friction) // 10
        trimmed = friction[tenth:-tenth]
        assert trimmed.mean() == pytest.approx(mean, abs=6e-6)
        assert trimmed.std(ddof=1) == pytest.approx(deviation, abs=6e-6)
    assert "sliding_velocity" not in run  # pointwise dx/dt is useless here


def test_cetr_forces_are_gram_force_with_load_turned_positive(shared_data):
    run = tl.read(shared_data / "cetr_umt2_MIT/HT-2n-6-4 2_001.csv")
    assert float(run["normal_force"][0]) == pytest.approx(198.963455e-3 * 9.80665, rel=1e-12)
    # the file's own rectified COF
    assert abs(float(run["friction_force"][0] / run["normal_force"][0])) == pytest.approx(
        0.038619, abs=1e-6
    )
    assert run.attrs["set_normal_force_N"] == pytest.approx(0.2 * 9.80665)
    assert run.attrs["velocity_setting"] == "240"  # no unit in the file: no speed is invented
    assert "sliding_velocity" not in run and "position" not in run
    assert np.unique(run["step"]).tolist() == [1, 2]


def test_cetr_cycles_become_one_run_by_the_moments_they_started(shared_data):
    files = sorted((shared_data / "cetr_umt2_MIT").glob("*.csv"))
    run = tl.read(files[::-1])  # in any order
    assert run.sizes["time"] == sum(tl.read(file).sizes["time"] for file in files)
    first = run["time"].where(run["cycle"] == 2, drop=True)
    assert float(first[0]) == pytest.approx(4.83)  # 12:21:58.029 -> 12:22:02.859
    strokes = {(int(c), int(s)) for c, s in zip(run["cycle"], run["step"], strict=True)}
    assert strokes == {(c, s) for c in (1, 2, 3) for s in (1, 2)}


def test_mtm_takes_the_measured_one_of_two_columns_with_the_same_name(shared_data):
    run = tl.read(shared_data / "pcs_mtm_ehd_MIT/demo_5.txt")
    ratio = run["friction_force"] / run["normal_force"]
    assert float(ratio[0]) == pytest.approx(0.0955, abs=5e-5)  # the file's traction coefficient
    assert float(run["sliding_velocity"][0]) == 0.1002
    assert float(run["slide_roll_ratio"][0]) == pytest.approx(1.00196)
    assert float(run["temperature"][0]) == pytest.approx(98.5 + 273.15)
    assert run.attrs["recorded_at"] == "2016-08-19T09:48:51"
    assert run.attrs["zero_traction_force_N"] == 0.1467


def test_ehd_steps_keep_their_numbers_and_their_distance_in_time(shared_data):
    run = tl.read(shared_data / "pcs_mtm_ehd_MIT/demo_12.txt")
    assert np.unique(run["step"]).tolist() == [3, 7, 11]
    second = run["time"].where(run["step"] == 7, drop=True)
    # 13:55 -> 14:37; both clocks: 17 s and 16 s after the step's start
    assert float(second[0]) == 42 * 60 - 1
    assert float(run["film_thickness"][0]) == pytest.approx(46.0e-9)
    assert "Traction Force [N] (no values)" in run.attrs["columns_not_used"]


def test_rheometer_steps_follow_one_another(shared_data):
    run = tl.read(shared_data / "pcs_mtm_ehd_MIT/trios_demo.txt")
    assert float(run["shear_stress"][0]) == pytest.approx(4.26396)
    np.testing.assert_allclose(run["viscosity"], run["shear_stress"] / run["shear_rate"], rtol=2e-4)
    assert np.unique(run["step"]).tolist() == [1, 2, 3, 4]


def test_paper_stick_slip_has_stiffness_and_speed_from_the_file_name(shared_data):
    reference = {
        "k168Nm_v1100": (168.0, 1.1e-3, 0.33409, 0.03671),
        "k168Nm_v4300": (168.0, 4.3e-3, 0.5039, 0.04133),
        "k1002Nm_v4300": (1002.0, 4.3e-3, 0.2918, 0.05044),
        "k2254Nm_v1100": (2254.0, 1.1e-3, 0.33516, 0.04292),
    }
    for name, (stiffness, speed, mean, deviation) in reference.items():
        run = tl.read(shared_data / f"stickslip_paper_CeCILL-B/{name}.mat")
        assert run.attrs["stiffness_N_m"] == stiffness
        assert run.attrs["set_speed_m_s"] == pytest.approx(speed)
        assert float(run["friction_coefficient"].mean()) == pytest.approx(mean, abs=5e-5)
        assert float(run["friction_coefficient"].std(ddof=1)) == pytest.approx(deviation, abs=1e-5)


def test_tdms_marks_divide_the_run_into_steps(shared_data):
    run = tl.read(shared_data / "tdms_force_MIT/TDMSSample.tdms")
    assert float(run["friction_force"][0]) == pytest.approx(0.10374007e-12)
    assert float(run["position"][0]) == pytest.approx(10.99567146e-6)
    begins = run["time"].where(run["step"] == 1, drop=True)
    assert float(begins[0]) + run.attrs["time_origin_s"] == pytest.approx(1.378, abs=0.02)
    assert run.attrs["step_labels"].startswith("F,d curve: Start; F,d curve: End")


def test_a_run_is_described_without_hiding_what_was_not_used(shared_data):
    path = shared_data / "cetr_umt2_MIT/HT-2n-6-4 2_001.csv"
    told = file_facts(read_log(path), path)
    assert told["instrument"] == "cetr_umt2" and told["rows"] == 217
    assert told["columns"]["normal_force"]["label"] == "Fz [gf]"
    assert "COF" in told["not_used"]
    assert told["interval_s"] == pytest.approx(0.02, abs=1e-4)
    assert told["steps"] == 2 and told["metadata"]["velocity_setting"] == "240"


def test_reading_leaves_the_raw_file_alone(shared_data, tmp_path):
    copy = tmp_path / "run.csv"
    copy.write_bytes((shared_data / "actuator_friction_CC0/Circle_1bar.csv").read_bytes())
    before = (copy.stat().st_mtime_ns, copy.read_bytes())
    tl.read(copy)
    assert (copy.stat().st_mtime_ns, copy.read_bytes()) == before
    assert sorted(Path(tmp_path).iterdir()) == [copy]
