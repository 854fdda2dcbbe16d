"""Layouts of third-party files in a few rows; the source is named above each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError

N = 60
T = np.arange(N)
# "Step Time" is a step's duration (Phoenix TE 67, kyembot/pin-on-disk-data-analysis)
TE67 = "Step Time [s]\tTest Time [s]\tLoad [N]\tFriction Force [N]\tSpeed [m/s]\n"
# HBM catman: forces by axis
CATMAN = "Zeit\tKraft_X\tKraft_Z\tv\ns\tN\tN\tm/s\n"
THREE_PINS = "Load per pin: 10 N\nNumber of pins: 3\nMean track radius: 20 mm\nrpm 100\n\n"
RING = "Mean ring radius [mm];20\nAxial load [N];30\nSpeed [rpm];100\n\n"
# liampond/EgbertsTribometer: six axes without units, the load in the file's name
SIX_AXES = "Sampling fequency [Hz]:\t100\tx-velocity [mm/s]: \t100\nFx\tFy\tFz\n"


def rows(*columns: np.ndarray | float, mark: str = "\t") -> str:
    table = np.column_stack([np.broadcast_to(column, N) for column in columns])
    return "".join(mark.join(f"{x:.5g}" for x in row) + "\n" for row in table)


@pytest.mark.parametrize(
    ("name", "text", "coefficient", "speed"),
    [
        ("te67.txt", TE67 + rows(3600.0, T, 60.0, 6.0, 0.15), 0.1, 0.15),
        ("catman.asc", CATMAN + rows(T / 50, -4.0, 20.0, 0.01), -0.2, 0.01),
        (
            "pins.txt",
            THREE_PINS + "Time [s]\tTorque [Nm]\n" + rows(T, 0.12),
            0.2,
            np.pi * 100 / 30 * 0.02,
        ),
        (
            "ring.csv",
            RING + "Time [s];Friction torque [Nm]\n" + rows(T, 0.12, mark=";"),
            0.2,
            np.pi * 100 / 30 * 0.02,
        ),
    ],
)
def test_friction_and_speed_follow_without_a_question(
    name: str, text: str, coefficient: float, speed: float, tmp_path: Path
) -> None:
    (tmp_path / name).write_text(text)
    run = tl.read(tmp_path / name)
    np.testing.assert_allclose(run.friction_force / run.normal_force, coefficient, rtol=1e-4)
    np.testing.assert_allclose(run.sliding_velocity, speed, rtol=1e-4)


def test_axes_without_units_are_in_the_unit_of_the_load_that_one_of_them_reads(
    tmp_path: Path,
) -> None:
    file = tmp_path / "PAO_20N_100mms.txt"
    drag = 2 * np.sign(np.sin(T))
    file.write_text(SIX_AXES + rows(drag, 0.1 * drag, -20.3))
    units = {c.label: c.unit for c in tl.draft_dialect(file).understood.columns if c.used}
    assert units == {"Fx": "N", "Fz": "N"}
    other = tmp_path / "PAO_200N_100mms.txt"  # what it reads is no 200 N
    other.write_text(file.read_text())
    with pytest.raises(ReadError, match="in which unit"):
        tl.read(other)


def test_a_force_is_no_coefficient_though_it_is_called_friction(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("t (s),F friction,F normal,v (mm/s)\n" + rows(T, 4.0, 20.0, 10.0, mark=","))
    with pytest.raises(ReadError, match="'F friction': friction_force, in which unit"):
        tl.read(file)


def test_traces_side_by_side_want_a_pitch_and_nothing_else(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("Profile 1 [µm],Profile 2 [µm]\n" + rows(np.sin(T), np.cos(T), mark=","))
    with pytest.raises(ReadError) as refused:
        tl.read_scans(file)
    assert "pitch" in str(refused.value)
    assert "Unclear" not in str(refused.value)


def test_micrometres_of_nanoscope_are_a_unit(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text("Distance(~m)\tHeight(nm)\n" + rows(0.02 * T, np.sin(T / 9)))
    assert tl.read_scans(file).attrs["pitch_m"] == pytest.approx(2e-8)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Specimen,Static COF,Kinetic COF\n1,0.32,0.28\n2,0.31,0.27\nMean,0.32,0.28\n", "results"),
        ("Angular Frequency,Storage Modulus,Loss Modulus\n1,50,9\n2,60,8\n4,70,7\n", "modulus"),
    ],
)
def test_tables_that_are_no_run_are_called_what_they_are(
    text: str, said: str, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(ReadError, match=f"a table of .*{said}"):
        tl.read(tmp_path / "a.csv")


def test_a_point_among_decimal_commas_is_named(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    line = "{}\t4,1\t20,5\t0,0{}\n".format
    lines = "".join(line(n, 10 + n) for n in range(N))
    file.write_text("Time [s]\tFx [N]\tFz [N]\tv [m/s]\n" + lines.replace("0,030", "0.030"))
    with pytest.raises(ReadError, match="'0.030'") as refused:
        tl.read(file)
    assert "quotation" not in str(refused.value)


def test_a_position_is_in_the_unit_in_which_it_spans_the_stated_track(tmp_path: Path) -> None:
    file = tmp_path / "a_20N_b.txt"
    head = SIX_AXES.replace("\nFx", "\tTrack length [mm]:\t5\nFx").replace("Fz", "Fz\tx-Position")
    way = 2500 + 2500 * np.sin(2 * np.pi * T / 30)
    file.write_text(head + rows(np.sign(np.cos(T / 5)), 0.3, -20.3, way))
    assert np.ptp(tl.read(file).position.values) == pytest.approx(0.005, rel=0.02)
