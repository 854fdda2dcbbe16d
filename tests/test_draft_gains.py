"""Signals in volts and counts whose worth their own name, or a line that names them, tells."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.app.file_info import file_lines
from tribolab.errors import TribolabError
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft
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


def _counts(values: np.ndarray, each: float, zero: int = 0) -> np.ndarray:
    return np.round(values * each) + zero


@pytest.mark.parametrize(
    ("name", "volts"),
    [
        ("Friction bridge (100 N = 2.0 mV/V, excitation 5 V) [mV]", FRICTION / 100 * 2 * 5),
        ("Reibkraft (10 N/V) [mV]", FRICTION / 10 * 1e3),
        ("Friction (0.5 V/N) [V]", FRICTION * 0.5),
    ],
)
def test_the_name_of_a_column_says_what_a_volt_is_worth(
    tmp_path: Path, name: str, volts: np.ndarray
) -> None:
    names = ["Time", "Position", name.rpartition(" ")[0], "Normal force"]
    units = ["s", "mm", name.rpartition("[")[2].rstrip("]"), "N"]
    file = _file(tmp_path, [";".join(names)], ";".join(units), TIME, WAY, volts, LOAD)
    run = tl.read(file)
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=2e-3)


@pytest.mark.parametrize(
    "head",
    [
        ["cell_T (tangential): 51300 counts/N", "cell_N (normal): 431.7 counts/gf"],
        ["# cella T (tangenziale): 51300 conteggi/N", "# cella N (normale): 431.7 conteggi/gf"],
        ["% cell T - Tangentialkraft, 51300 Impulse/N; cell N: Normalkraft 431.7 Impulse/gf"],
    ],
)
def test_a_line_that_names_a_column_says_what_a_count_is_worth(
    tmp_path: Path, head: list[str]
) -> None:
    label = "cella" if "cella" in head[0] else "cell"
    columns = TIME, _counts(WAY, 400), _counts(FRICTION, 51300), _counts(LOAD / 9.80665e-3, 431.7)
    head = [*head, "motor: 400 steps/mm"]
    file = _file(tmp_path, head, f"time (s);steps;{label}_T;{label}_N", *columns)
    run = tl.read(file)
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-4)
    np.testing.assert_allclose(run.normal_force, LOAD, atol=1e-3)
    np.testing.assert_allclose(run.position, WAY / 1e3, atol=1e-5)
    kept = save_draft(draft_dialect(file), tmp_path / "own.toml")
    other = [line.replace("51300", "25650") for line in head]
    again = _file(tmp_path, other, f"time (s);steps;{label}_T;{label}_N", *columns, name="b")
    np.testing.assert_allclose(tl.read(again, kept).friction_force, 2 * FRICTION, atol=2e-4)


def test_a_line_of_another_column_says_nothing(tmp_path: Path) -> None:
    columns = TIME, WAY, _counts(FRICTION, 1000), _counts(LOAD, 1000)
    file = _file(tmp_path, ["cell_A: 1000 counts/N"], "time (s);x (mm);cell_T;cell_N", *columns)
    with pytest.raises(TribolabError, match="friction"):
        tl.read(file)


def test_the_zero_of_a_load_may_lie_far_below_it(tmp_path: Path) -> None:
    """Counts that were not tared: what reads far below zero at rest is not pressed."""
    head = ["cell_T (tangential): 51300 counts/N", "cell_N (normal): 1000 counts/N"]
    columns = TIME, WAY, _counts(FRICTION, 51300), _counts(LOAD, 1000, -6000)
    run = tl.read(_file(tmp_path, head, "time (s);x (mm);cell_T;cell_N", *columns))
    segments = tl.find_segments(run)
    mu = tl.friction_coefficient(run, segments)
    assert mu.friction_coefficient.values == pytest.approx([0.3], rel=0.01)
    assert mu.normal_force.values == pytest.approx([10.0], rel=0.01)


def test_a_legend_above_the_table_says_the_units_of_its_columns(tmp_path: Path) -> None:
    head = [
        "* t - time of the logger [s];  s - position of the carriage [mm]",
        "* Fx - longitudinal force [N] (reaction, negative), Fz: vertical force (N)",
    ]
    rows = [
        f"{t:.2f}   {s:.3f}  {-f:.4f}  {-n:.4f}"
        for t, s, f, n in zip(TIME, WAY, FRICTION, LOAD, strict=True)
    ]
    file = tmp_path / "legend.prn"
    file.write_text("\n".join([*head, "* t s Fx Fz", *rows]) + "\n", encoding="utf-8")
    run = tl.read(file)
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-3)  # against the motion
    np.testing.assert_allclose(run.normal_force, LOAD, atol=1e-3)
    np.testing.assert_allclose(run.position, WAY / 1e3, atol=1e-6)


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


@pytest.mark.parametrize(
    ("above", "column", "signal"),
    [
        ("Friction: 12.5 N/V, zero 0.21 V", "Friction [V]", FRICTION / 12.5 + 0.21),
        ("Friction: 0.002 N/count, offset 118", "Friction [counts]", FRICTION / 0.002 + 118),
        ("Kanal 1: 0.002 N/enhet, nollvärde 118 enheter", "Kanal 1", FRICTION / 0.002 + 118),
        (
            "Friction: 100 N = 2.013 mV/V, 5 V, zero 0.4 mV",
            "Friction [mV]",
            FRICTION / 100 * 2.013 * 5 + 0.4,
        ),
    ],
)
def test_a_zero_beside_a_factor_is_taken_off(
    tmp_path: Path, above: str, column: str, signal: np.ndarray
) -> None:
    above = above.replace("Kanal 1:", "Kanal 1  friktionskraft")
    signal = signal if column.endswith("V]") else np.round(signal)
    names = f"Time [s];Position [mm];{column};Normal force [N]"
    file = _file(tmp_path, [above], names, TIME, WAY, signal, LOAD)
    np.testing.assert_allclose(tl.read(file).friction_force, FRICTION, atol=2e-3)
    done = _file(tmp_path, [f"{above} (subtracted)"], names, TIME, WAY, signal, LOAD, name="b")
    off = tl.read(done).friction_force - FRICTION
    assert float(off.min()) > 0.2 and float(off.max() - off.min()) < 0.01


@pytest.mark.parametrize("zero", ["0.236 N", "0.04 mV/V"])
def test_a_zero_in_another_unit_than_the_signal_is_asked_about(tmp_path: Path, zero: str) -> None:
    names = "Time [s];Position [mm];Friction [mV];Normal force [N]"
    above = f"Friction: 100 N = 2.013 mV/V, 5 V, zero {zero}"
    file = _file(tmp_path, [above], names, TIME, WAY, FRICTION, LOAD)
    with pytest.raises(TribolabError, match="what a volt of 'Friction .mV.' is worth"):
        tl.read(file)


def test_channels_with_numbers_for_names_are_what_the_text_says_of_them(tmp_path: Path) -> None:
    turns = np.where(TIME < 10, 0.0, 120.0)  # 1/min
    head = [
        "Track radius (mm)\t32,5",
        "Sampling rate (Hz)\t10",
        "Channel 1\tfriction force\tcalibration 0,00152 N/count\tzero 118 counts",
        "Channel 2\tnormal force\tcalibration 0,00305 N/count\tzero -42 counts",
        "Channel 3\trotation speed\tcalibration 0,05 rpm/count\tzero 0 counts",
    ]
    columns = (
        np.arange(1, TIME.size + 1),
        _counts(FRICTION, 1 / 0.00152, 118),
        _counts(LOAD, 1 / 0.00305, -42),
        _counts(turns, 20),
    )
    rows = ["\t".join(f"{x:.0f}" for x in row) for row in zip(*columns, strict=True)]
    file = tmp_path / "board.dat"
    file.write_text("\n".join([*head, "", "No\tChannel 1\tChannel 2\tChannel 3", *rows]) + "\n")
    run = tl.read(file)
    np.testing.assert_allclose(run.time, TIME, atol=1e-9)
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-3)
    np.testing.assert_allclose(run.normal_force, LOAD, atol=2e-3)
    np.testing.assert_allclose(
        run.sliding_velocity, turns * 2 * np.pi / 60 * 0.0325, rtol=1e-9, atol=1e-12
    )
    assert any("drafted from the file" in line for line in file_lines(file))


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


@pytest.mark.parametrize(
    ("zero", "off"),
    [
        ("Fx zero: 0.05 V (not subtracted)", 0.5),
        ("Zero friction: 0.5 N (to be subtracted)", 0.5),
        ("Fx zero: 0.05 V (subtracted)", 0.0),
    ],
)
def test_a_zero_in_a_line_of_its_own_is_taken_off_a_signal_in_volts(zero, off, tmp_path):
    names = "Time [s];Position [mm];Fx [V];Fz [V]"
    head = ["Fx: 10 N/V", "Fz: 10 N/V", zero]
    file = _file(tmp_path, head, names, TIME, WAY, FRICTION / 10 + off / 10, LOAD / 10)
    np.testing.assert_allclose(tl.read(file).friction_force, FRICTION, atol=1e-3)


def test_a_gain_that_is_stated_before_the_name_is_used(shared_data):
    run = tl.read(shared_data / "cases/gain_in_text_SOUND.csv")
    found = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(found.friction_coefficient, 0.3, rtol=0.01)


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
