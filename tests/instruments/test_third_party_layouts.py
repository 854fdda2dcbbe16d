"""Layouts of third-party files in a few rows; the source is named above each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import ReadError
from tribolab.reading.moduli import read_modulus_table

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
    units = {c.label: c.unit for c in tl.reading.draft_dialect(file).understood.columns if c.used}
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


def test_rows_that_begin_with_their_number_have_no_name_for_it(tmp_path: Path) -> None:
    # xlook of biaxial rigs (jrleeman/LeemanNatComm2016)
    names = "LP_Disp Shr_stress nor_disp Nor_stress Time mu".split()
    units = "mic MPa micron MPa sec .".split()
    text = (
        "number of records = 60\n" + "".join(f"{'col ' + str(n):>12}" for n in range(1, 7)) + "\n"
    )
    for cells in (names, units, ["60 recs"] * 6):
        text += "     " + "".join(f"{cell:>12}" for cell in cells) + "\n"
    for n in T:
        row = (4000 + 10 * 0.1 * n, 3.6, -700 - n, 6.0, 2500 + 0.1 * n, 0.6)
        text += f"{n + 800:5d}" + "".join(f"{x:12.6g}" for x in row) + "\n"
    (tmp_path / "p.txt").write_text(text)
    run = tl.read(tmp_path / "p.txt")
    np.testing.assert_allclose(run.shear_stress / run.normal_stress, 0.6, rtol=1e-4)
    np.testing.assert_allclose(run.friction_coefficient, 0.6)
    assert run.attrs["speed_from"] == "position"
    assert float(np.gradient(run.position, run.time).mean()) == pytest.approx(10e-6, rel=1e-3)


def test_wear_on_a_disc_is_not_the_distance_slid(tmp_path: Path) -> None:
    # T-11: "Displacement [um]" is the wear, which grows as the revolutions do
    head = "Time [s];Friction force [N];Displacement [um];Rotational speed [rpm];Revolutions;\n"
    lines = rows(T, 2.5, 0.1 * T, 190.0, T * 190 / 60, mark=";").replace("\n", ";\n")
    (tmp_path / "T11_0.1m-s_10N.csv").write_text(head + lines)
    run = tl.read(tmp_path / "T11_0.1m-s_10N.csv")
    assert "position" not in run and run.attrs["speed_from"] == "set speed"
    np.testing.assert_allclose(run.set_speed, 0.1)  # next to a steady rotation, from the name
    np.testing.assert_allclose(run.normal_force, 10.0)


def test_a_speed_in_the_name_of_the_file_is_asked_about(tmp_path: Path) -> None:
    # Bruker UMT (Dichimanaym/Tribometer-Data-Processing): "Rotary.Position" is an angle
    file = tmp_path / "a_Rotary_3N_75mm-s.csv"
    file.write_text("Timestamp,DAQ.COF,Rotary.Position\n" + rows(T / 10, 0.2, 200 + T, mark=","))
    with pytest.raises(ReadError, match="'75mm-s' is the sliding speed all along") as refused:
        tl.read(file)
    assert "Rotary" not in str(refused.value).partition("Unclear")[2].split("tribolab")[0]


COMPEND = "Stroke (mm)\t5\n\nTest started at 10:02:11\n\tTest Time (s)\tLoad (N)\tFrequency (Hz)\t"


@pytest.mark.parametrize(
    ("event", "read"),
    [('Fast data in       =HYPERLINK("n1-h001.tsv")', N), ("Load changed to 20 N", 20)],
)
def test_rows_below_an_event_go_on_unless_it_sets_something(
    event: str, read: int, tmp_path: Path
) -> None:
    # Phoenix TE 77 (Compend 2000): a row of means every few seconds at 10 Hz
    head = COMPEND + "Stroke (mm)\tFriction Force (N)\t\n"
    lines = rows(10 * T, 100.0, 10.0, 5.0, 12.0 + 0.1 * np.sin(T)).splitlines(keepends=True)
    lines = ["\t" + line.replace("\n", "\t\n") for line in lines]
    lines.insert(20, event + "\n")
    file = tmp_path / "n1.tsv"
    file.write_text(head + "".join(lines) + "Test finished\n")
    if read != N:
        with pytest.raises(ReadError, match="40 rows below it are not read"):
            tl.read(file)
        return
    run = tl.read(file)
    assert run.sizes["time"] == N
    assert run.attrs["set_speed_m_s"] == pytest.approx(0.1)


def test_a_friction_of_twelve_is_a_force(tmp_path: Path) -> None:
    file = tmp_path / "n1-h001.tsv"
    drag = 12 * np.sign(np.sin(T))
    # Phoenix TE 77, fast data
    head = "High speed data\nRate (Hz)\t1000\n\nHSD Stroke\tHSD Friction\tHSD Force Input\n"
    file.write_text(head + rows(np.sin(T), drag, 0.1))
    with pytest.raises(ReadError, match="'HSD Friction': friction_force, in which unit"):
        tl.read(file)


def test_the_angle_of_a_crank_asks_for_its_stroke(tmp_path: Path) -> None:
    file = tmp_path / "crank.csv"
    angle = 36.0 * T % 360
    drag = 3 * np.sign(np.cos(np.radians(angle)))
    head = "Time [s],Crank angle [deg],Speed [rpm],Friction force [N],Normal force [N]\n"
    file.write_text(head + rows(T / 10, angle, 60.0, drag, 10.0, mark=","))
    (missing,) = [line for line in file_lines(file) if "missing:" in line]
    assert "the length of the stroke" in missing


SWEEP = "Variables\tAngular Frequency\tStorage Modulus\tLoss Modulus\n\trad/s\tPa\tPa\n"


@pytest.mark.parametrize(
    ("geometry", "factor"),
    [("40 mm parallel plate", 3.0), ("Compression, parallel plates", 1.0), ("", 1.0)],
)
def test_a_rheometer_that_turns_plates_measures_a_shear_modulus(
    geometry: str, factor: float, tmp_path: Path
) -> None:
    # TRIOS: the names say "Storage Modulus", the header which geometry
    lines = "".join(f"Data point\t{w}\t{1000 + w}\t{200 + w}\n" for w in (1, 2, 5, 10))
    (tmp_path / "a.csv").write_text(f"Filename\ta\nGeometry name\t{geometry}\n{SWEEP}{lines}")
    table = read_modulus_table(tmp_path / "a.csv")
    np.testing.assert_allclose(table.storage, factor * np.array([1001, 1002, 1005, 1010]))


def test_names_behind_a_word_are_those_of_the_numbers_below_them(tmp_path: Path) -> None:
    # RheoCompass (imewei/rheojax): "Interval data:" has no cell in the rows
    head = "Interval and data points:\t1\t4\nInterval data:\tAngular Frequency\tG'\tG''\tTorque\n"
    lines = "".join(f"{w}\t{1000 + w}\t{200 + w}\t1\n" for w in (1, 2, 5, 10))
    file = tmp_path / "a.csv"
    file.write_text(f"{head}\t[rad/s]\t[Pa]\t[Pa]\t[mNm]\n{lines}")
    table = read_modulus_table(file)
    np.testing.assert_allclose(table.angular_frequency, [1, 2, 5, 10])
    np.testing.assert_allclose(table.loss, 3 * np.array([201, 202, 205, 210]))


def test_a_coefficient_that_the_forces_prove_is_that_of_its_place(tmp_path: Path) -> None:
    # blanks part the names from their units, too: the word 'mu' is the fifth, its column the third
    force = 3 + 0.1 * np.sin(T)
    lines = rows(T / 10, force, force / 10, 10.0, 5.0, mark="  ")
    (tmp_path / "a.txt").write_text("Time [s]  Ft [N]  mu  Fn [N]  v [mm/s]\n" + lines)
    run = tl.read(tmp_path / "a.txt")
    np.testing.assert_allclose(run.friction_coefficient, force / 10, rtol=1e-3)
