"""Signals in volts and counts whose worth their own name, or a line that names them, tells."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import TribolabError
from tribolab.reading.unknown.proposal.questions import GuessedError

TIME = np.arange(600) / 10
WAY = np.interp(TIME, [0, 10, 60], [0, 0, 100])  # mm, 2 mm/s
FRICTION = np.where(TIME < 10, 0.0, 3.0) + 0.01 * np.sin(TIME)  # N
LOAD = np.where(TIME < 5, 0.0, 10.0) + 0.02 * np.cos(TIME)


def _file(folder: Path, head: list[str], names: str, *columns: np.ndarray, name: str = "a") -> Path:
    rows = [";".join(f"{x:.5f}" for x in row) for row in zip(*columns, strict=True)]
    file = folder / f"{name}.csv"
    file.write_text("\n".join([*head, names, *rows]) + "\n", encoding="utf-8")
    return file


def test_what_turns_is_a_crank_where_the_text_says_so(tmp_path: Path) -> None:
    time = np.arange(0, 30, 0.01)
    force = 2 * np.sign(np.cos(2 * np.pi * time)) + 0.05 * np.sin(17 * time)
    columns = time, np.full(time.size, 60.0), force, np.full(time.size, 10.0)
    names = "Time (s);n motor (rpm);F roz (N);Carga (N)"
    file = _file(tmp_path, ["Tribómetro biela-manivela", "Carrera: 30 mm"], names, *columns)
    segments = tl.find_segments(tl.read(file))
    assert np.median(segments.sliding_speed.values) == pytest.approx(0.09, rel=0.01)
    file = _file(tmp_path, ["Tribómetro biela-manivela"], names, *columns, name="b")
    assert "drive" in tl.read(file).attrs


@pytest.mark.parametrize("name", ["averaging_10", "reduction_10", "factor_in_text"])
def test_text_that_changes_numbers_is_asked_about(name, shared_data):
    with pytest.raises(GuessedError, match="as they stand|every sample is taken"):
        tl.read(shared_data / f"cases/{name}.csv")


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("Mean of 10 samples", "every sample is taken"),
        ("Downsampling: every 10th sample", "every sample is taken"),
        ("Decimation factor 5", "every sample is taken"),
        ("Correction factor: 0.98", "not times"),
        ("Tare load: 2 N", "was taken off the load"),
        ("Friction offset: 0.5 N", "was taken off the signal"),
    ],
)
def test_a_line_that_changes_numbers_is_never_ignored(said, asked, tmp_path):
    names = "Friction force [N];Normal force [N];Position [mm]"
    file = _file(tmp_path, ["Sampling rate: 10 Hz", said], names, FRICTION, LOAD, WAY)
    with pytest.raises(GuessedError, match=asked):
        tl.read(file)


@pytest.mark.parametrize("said", ["Gear ratio: 10", "Pulley ratio: 2", "Getriebe i = 10"])
def test_a_gear_between_motor_and_disc_is_asked_about(said, tmp_path):
    names = "Time [s];Friction force [N];Normal force [N];Motor speed [rpm]"
    file = _file(tmp_path, ["Track radius: 20 mm", said], names, TIME, FRICTION, LOAD, TIME)
    with pytest.raises(GuessedError, match="not divided by"):
        tl.read(file)


def test_a_gain_that_is_stated_before_the_name_is_used(shared_data):
    run = tl.read(shared_data / "cases/gain_in_text_SOUND.csv")
    found = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(found.friction_coefficient, 0.3, rtol=0.01)


@pytest.mark.parametrize(
    ("line", "asked"),
    [
        ("Bridge: 100 N = 2.0 mV/V, 5 V", "what a volt of 'Fx .V.' is worth.*'Bridge: 100 N = 2.0"),
        ("Fx: 10 N/V, zero 0.05 V", "without 'Fx: 10 N/V, zero 0.05 V'"),
        ("Fx: 10 N/V\nFriction offset: 0.5 N", "was taken off the signal"),
    ],
)
def test_a_calibration_that_is_not_applied_is_quoted(line, asked, tmp_path):
    names = "Time [s];Position [mm];Fx [V];Normal force [N]"
    file = _file(tmp_path, [line], names, TIME, WAY, FRICTION / 10, LOAD)
    with pytest.raises(GuessedError, match=asked):
        tl.read(file)


@pytest.mark.parametrize(
    "said",
    [
        *("Kraft mit 1,25 multiplizieren", "forces: divide by 2.5", "Load scaled with 3"),
        *("Friction force x 1.25", "All forces to be doubled", "Kräfte in Zehntel N"),
    ],
)
def test_a_sentence_that_multiplies_is_asked_about(said, tmp_path):
    rows = "\n".join(f"{0.1 * n:.1f},0.3,1,2" for n in range(50))
    head = f"{said}\nTime [s],Friction force [N],Normal force [N],Velocity [mm/s]\n"
    (tmp_path / "run.csv").write_text(head + rows + "\n", "utf-8")
    with pytest.raises(GuessedError, match="not as the file says"):
        tl.read(tmp_path / "run.csv")


@pytest.mark.parametrize(("name", "start"), [("a_zero_no_offset", 0.0), ("c_epoch_offset", 1.7e9)])
def test_declared_records_are_read_to_their_last_digit(name, start, shared_data):
    run = tl.read(shared_data / f"cases/{name}.bin")
    assert run.sizes["time"] == 20000 and run.attrs["time_origin_s"] == start
    np.testing.assert_allclose(np.diff(run.time), 1e-3, atol=3e-7)
    found = tl.friction_coefficient(run, tl.find_segments(run))
    assert float(abs(found.friction_coefficient).mean()) == pytest.approx(0.25, abs=0.06)


@pytest.mark.parametrize("said", ["Image 512 x 512", "Friction test, 100 double strokes"])
def test_a_size_or_a_count_multiplies_nothing(said, tmp_path):
    rows = "\n".join(f"{0.1 * n:.1f},0.3,1,2" for n in range(50))
    head = f"{said}\nTime [s],Friction force [N],Normal force [N],Velocity [mm/s]\n"
    (tmp_path / "run.csv").write_text(head + rows + "\n", "utf-8")
    assert tl.read(tmp_path / "run.csv").friction_force[0] == 0.3


def test_a_zero_without_a_colon_is_asked_about(tmp_path):
    rows = "\n".join(f"{0.1 * n:.1f},0.3,1,2" for n in range(50))
    head = "Offset Fx 0.5 N\nTime [s],Fx [N],Fz [N],Velocity [mm/s]\n"
    (tmp_path / "run.csv").write_text(head + rows + "\n", "utf-8")
    with pytest.raises(GuessedError, match="Offset Fx 0.5 N"):
        tl.read(tmp_path / "run.csv")


def test_volts_with_a_stated_factor_and_rate_are_a_run(tmp_path):
    head = "Sampling rate: 100 Hz\nFriction calibration: 4 N/V\nLoad: 12 N\nSpeed: 20 mm/s\n"
    (tmp_path / "daq.txt").write_text(f"{head}\nFriction (V)\n" + "1.0\n0.9\n1.1\n" * 30)
    assert tl.read(tmp_path / "daq.txt").friction_force[0] == pytest.approx(4.0)


def test_a_table_of_other_things_is_called_that(tmp_path):
    (tmp_path / "plane.csv").write_text("mass,angle,pull\nkg,deg,N\n0.5,5,1.9\n0.5,10,2.3\n" * 1)
    with pytest.raises(TribolabError, match="a table of mass, angle, pull"):
        file_lines(tmp_path / "plane.csv")


def test_forces_without_units_are_a_run_whose_units_are_asked_for(tmp_path):
    rows = "".join(f"{n % 7 - 3}\t{-20 - n % 3}\t{n * 10}\n" for n in range(60))
    (tmp_path / "axes.txt").write_text(f"Sampling rate: 100 Hz\nFx\tFz\tx-Position\n{rows}")
    with pytest.raises(GuessedError, match="column 1 'Fx'.*in which unit"):
        tl.read(tmp_path / "axes.txt")
