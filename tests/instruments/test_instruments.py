"""Instruments whose files were not at hand: files made as published readers of them have it."""

from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.dialect.find import known_dialects, recognise

RNG = np.random.default_rng(4)
N = 4000
T = np.arange(N) * 0.01
MU = 0.2

NTR = (
    "Time [s]\tDistance [m]\tlaps\tSequence ID\tCycle ID\tMax linear speed [m/s]\t"
    "Nominal Load [mN]\tµ\t{}\tNormal force [mN]\tFriction force [mN]\tPenetration depth [µm]"
)
TRB3 = (
    "Time [s]\tDistance [m]\tLaps\tSequence ID\tCycle ID\tMax Linear Speed [m/s]\t"
    "Nominal Load [N]\tµ\t{}\tFriction Force [N]\tTemperature [°C]\tHumidity [%]\t"
    "Penetration Depth [µm]"
)
RTEC = (
    "Step, Timestamp, RecipeStep, DAQ.Fz (N),DAQ.Fx (N),DAQ.COF (),Rotary.Velocity (rpm),"
    "XYZ.Z Depth (mm),XYZ.Z Position (mm),Rotary.Angle (deg),"
)


def lines(columns, delimiter="\t", end="\n"):
    rows = zip(*(np.broadcast_to(c, N) for c in columns), strict=True)
    return end.join(delimiter.join(f"{v:.6f}" for v in row) for row in rows) + end


def strokes():
    """Position [mm] and sign of a triangular motion of 20 mm at 5 mm/s, and friction [mN]."""
    phase = (T * 5 / 20) % 2
    position = 20 * np.where(phase < 1, phase, 2 - phase) + 1e-3 * RNG.standard_normal(N)
    sign = np.where(phase < 1, 1.0, -1.0)
    return position, sign


def friction(run):
    mu = tl.friction_coefficient(run, tl.find_segments(run, trim=0.1))["friction_coefficient"]
    return np.abs(mu.values[np.isfinite(mu.values)])


def test_nano_tribometer_linear(tmp_path):
    position, sign = strokes()
    load = 50 + 0.1 * RNG.standard_normal(N)
    force = sign * MU * load + 0.05 * RNG.standard_normal(N)
    file = tmp_path / "ntr.txt"
    columns = [T, T, T, 1, 1, 0.005, 50, force / load, position, load, force, 3]
    head = "Nano Tribometer\nLinear mode\n" + NTR.format("Linear Position [mm]")
    file.write_text(f"{head}\n{lines(columns)}", encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["instrument"] == "anton_paar_ntr_linear"
    assert float(run.normal_force.mean()) == pytest.approx(0.05, rel=1e-3)
    mu = friction(run)
    assert mu.size >= 8
    np.testing.assert_allclose(mu, MU, rtol=0.01)


def test_nano_tribometer_rotary(tmp_path):
    load = 50 + 0.1 * RNG.standard_normal(N)
    force = MU * load + 0.05 * RNG.standard_normal(N)
    file = tmp_path / "ntr.txt"
    columns = [T, T, T, 1, 1, 0.02, 50, MU, (36 * T) % 360, load, force, 3]
    head = "Nano Tribometer\nSingle-way mode\n" + NTR.format("Angle [°]")
    file.write_text(f"{head}\n{lines(columns)}", encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["instrument"] == "anton_paar_ntr_rotary"
    np.testing.assert_allclose(run.set_speed, 0.02)
    np.testing.assert_allclose(friction(run), MU, rtol=0.01)


@pytest.mark.parametrize(
    ("mode", "place"), [("linear", "Linear Position [mm]"), ("rotary", "Angle [°]")]
)
def test_pin_on_disc(mode, place, tmp_path):
    position, sign = strokes() if mode == "linear" else ((36 * T) % 360, 1.0)
    force = sign * MU * 5 + 0.01 * RNG.standard_normal(N)
    file = tmp_path / "trb3.txt"
    columns = [T, T, T, 1, 1, 0.1, 5, force / 5, position, force, 23.5, 45, 3]
    file.write_text(f"TRB3\n{TRB3.format(place)}\n{lines(columns)}", encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["instrument"] == f"anton_paar_trb3_{mode}"
    np.testing.assert_allclose(run.temperature, 296.65)
    np.testing.assert_allclose(friction(run), MU, rtol=0.01)


def test_multi_function_tribometer(tmp_path):
    """A lone CR in the settings, a comma behind each row, a footer, a clock that starts anew."""
    half = N // 2
    step = 1 + np.arange(N) // half
    load = 10 + 0.02 * RNG.standard_normal(N)
    force = MU * load + 0.01 * RNG.standard_normal(N)
    columns = [np.arange(N), T % (half * 0.01), step, load, force, MU, 60 * step, 0.01, 3, 0]
    body = lines(columns, ",", ",\n")
    head = f"Test,Operator\rpin on disc,MW\r\n{RTEC}\r\n"
    file = tmp_path / "rtec.csv"
    file.write_bytes(f'{head}{body}"TotalTime"\n"00:00:40.00"\n'.encode())
    run = tl.read(file)
    assert run.attrs["instrument"] == "rtec_mft"
    assert run.sizes["time"] == N and (np.diff(run.time) > 0).all()
    np.testing.assert_array_equal(run.step, step)
    np.testing.assert_allclose(run.rotation_speed, 2 * np.pi * step, rtol=1e-6)
    np.testing.assert_allclose(run.friction_force, force, atol=1e-6)
    depth = "Step, Timestamp, RecipeStep, DAQ.Fz (N), XYZ.Z Depth (mm), DAQ.COF (Fx),"
    body = lines([1, T, 1, load, 0.01, MU], ",", ",\n")
    file.write_bytes(f"Test\r1\r\n{depth}\r\n{body}".encode())
    fewer = tl.read(file)
    assert fewer.attrs["instrument"] == "rtec_mft" and "friction_force" not in fewer
    np.testing.assert_allclose(fewer.friction_coefficient, MU)


def test_sled_on_a_testing_machine_is_read_when_it_is_named_and_never_recognised(tmp_path):
    file = tmp_path / "Specimen_RawData_1.csv"
    rows = "".join(
        f'"{t:.3f}","{2.5 * t:.4f}","{1e-3 * f:.6f}"\n'
        for t, f in zip(T, 0.4 + 0.01 * RNG.standard_normal(N), strict=True)
    )
    file.write_text(f'"Results Table 1"\n"Time","Extension","Load"\n"(s)","(mm)","(kN)"\n{rows}')
    run = tl.read(file, "instron_sled")
    assert float(run.friction_force.mean()) == pytest.approx(0.4, rel=1e-2)
    assert float(run.position[-1]) == pytest.approx(2.5e-3 * T[-1])
    with pytest.raises(tl.TribolabError, match="no known instrument"):
        recognise(file)


LVM = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
    "Decimal_Separator\t{point}\nMulti_Headings\tNo\nX_Columns\tOne\nTime_Pref\tAbsolute\n"
    "Operator\tlab\nDate\t2023/09/21\nTime\t14:41:45.5111323470585990021\n"
    "***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t{n}\t{n}\t\n"
    "Date\t2023/09/21\t2023/09/21\t\nTime\t14:41:45.51\t14:41:45.51\t\n"
    "Y_Unit_Label\tmN\tN\t\nX_Dimension\tTime\tTime\t\nX0\t0{point}0E+0\t0{point}0E+0\t\n"
    "Delta_X\t0{point}010000\t0{point}010000\t\n***End_of_Header***\t\t\t\n"
    "X_Value\tFriction\tLoad\tComment\n"
)


@pytest.mark.parametrize("point", [".", ","])
def test_labview_measurement_is_read_by_what_stands_above_its_names(point, tmp_path):
    file = tmp_path / "log.lvm"
    force = 2000 + RNG.standard_normal(N)
    body = lines([T, force, 10]).replace(".", point)
    file.write_text(LVM.format(point=point, n=N) + body)
    run = tl.read(file)
    assert run.attrs["instrument"] == "drafted from the file"
    np.testing.assert_allclose(run.friction_force, force * 1e-3, atol=1e-9)
    np.testing.assert_allclose(run.normal_force, 10)
    assert float(run.time[-1]) == pytest.approx(T[-1])


def test_rotary_pin_on_disc_with_semicolons_is_read_by_its_header(tmp_path):
    head = (
        "Time [s];Friction force [N];Displacement [um];Temperature2 [C];Temperature1 [C];"
        "Rotational speed [rpm];Number of revolutions;"
    )
    file = tmp_path / "0.1m-s_10N.csv"
    body = lines([T, 2 + 0.01 * RNG.standard_normal(N), 3, 24, 23, 120, 2 * T], ";", ";\n")
    file.write_text(f"{head}\n{body.replace('.', ',')}")
    run = tl.read(file)
    assert float(run.friction_force.mean()) == pytest.approx(2, rel=1e-3)
    np.testing.assert_allclose(run.rotation_speed, 4 * np.pi, rtol=1e-6)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8"])
def test_intervals_of_a_rheometers_tribology_cell_are_read_by_their_header(encoding, tmp_path):
    text = "Project:\tcells\nTest:\tStribeck\nResult:\tStribeck 1\n"
    text += "Interval and data points:\t2\t50\t50\n"
    names = "Interval data:\tPoint No.\tTime\tSliding Speed\tFriction Force\tNormal Force\tStatus"
    for interval in (0, 1):
        text += f"\n{names}\n\t[]\t[s]\t[mm/s]\t[N]\t[N]\t[]\n"
        for n in range(50):
            time = 10.0 * (n + 50 * interval + 1)
            text += f"\t{n + 1}\t{time}\t{1 + interval}\t{2 + 0.01 * (n % 3)}\t10\tDy_auto\n"
    file = tmp_path / "stribeck.csv"
    file.write_bytes(text.replace("\n", "\r\n").encode(encoding))
    run = tl.read(file)
    assert run.sizes["time"] == 100
    np.testing.assert_allclose(run.sliding_velocity, np.repeat([1e-3, 2e-3], 50))
    np.testing.assert_allclose(run.normal_force, 10)


UMT_STEP = (
    "Run # 1\n{run}\nStep No. {step}\n\nStep Type Code: 0\nRadius       = 12.5\nVelocity     = 5\n"
    "Duration     = 20\nData Count   = 2000\n\n{names}\n{units}\n\n"
)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("written", ["csv", "text"])
def test_umt_exports_are_known_whichever_sign_the_load_has(written, sign, tmp_path):
    """As their published readers have it: settings, names, units, a blank line, at each step."""
    position, way = strokes()
    load = 20 + 0.05 * RNG.standard_normal(N)
    force = way * MU * load + 0.01 * RNG.standard_normal(N)
    mark = "," if written == "csv" else "  "
    text = "Created by Bruker Data Viewer ver.2.20 05/12/22 14:43:46\n" if mark != "," else "UMT\n"
    half = N // 2
    for step, part in enumerate((slice(0, half), slice(half, N)), start=1):
        names, units = ["T", "Fx", "Fz", "Z", "Ff", "COF"], ["sec", "N", "N", "mm", "N"]
        text += UMT_STEP.format(
            run="Run date 12 May 2022", step=step, names=mark.join(names), units=mark.join(units)
        )
        clock = T[part] - T[part][0]
        table = [clock, force[part], sign * load[part], clock, np.abs(force[part]), MU + clock]
        text += "".join(
            mark.join(f"{v:.6f}" for v in row) + "\n" for row in zip(*table, strict=True)
        )
        text += "\n"
    file = tmp_path / "umt.csv"
    file.write_text(text.replace("\n", "\r\n"))
    run = tl.read(file)
    known = "bruker_umt_csv" if written == "csv" else "bruker_umt_viewer_text"
    assert run.attrs["instrument"] == known
    assert run.sizes["time"] == N and (np.diff(run.time) > 0).all()
    np.testing.assert_array_equal(np.unique(run.step), [1, 2])
    np.testing.assert_allclose(run.normal_force, load, atol=1e-6)
    np.testing.assert_allclose(run.friction_force, force, atol=1e-6)


def test_a_umt_data_file_has_its_names_in_the_fourth_line(tmp_path):
    load = 50 + 0.05 * RNG.standard_normal(N)
    file = tmp_path / "umt.txt"
    head = "UMT Data File\nEB4\nrun 1\n  Time   Fx   Fz   COF\n  sec   N   N\n"
    file.write_text(head + lines([T, MU * load, -load, MU], "   "))
    run = tl.read(file)
    assert run.attrs["instrument"] == "bruker_umt_data_text"
    np.testing.assert_allclose(run.friction_force / run.normal_force, MU, rtol=1e-5)


def test_a_load_of_either_sign_has_to_be_clear(tmp_path):
    file = tmp_path / "umt.txt"
    head = "UMT Data File\nEB4\nrun 1\nTime Fx Fz\nsec N N\n"
    file.write_text(head + lines([T, 1, 10 * np.sin(T)], " "))
    with pytest.raises(tl.TribolabError, match="its sign is unknown"):
        tl.read(file)


RHEO = (
    "Project:\tcells\n\nTest:\tStribeck\n\nResult:\tStribeck 1\n\n"
    "{interval}:\t{number}\t50\n{data}:\t{names}\n{tabs}\n\t\t{units}\n"
)


def rheometer(words, names, units, delimiter="\t", point="."):
    """Two intervals as published readers of the exports have them: names, tabs, units."""
    text, columns = "", len(names.split("\t"))
    for interval in (1, 2):
        text += RHEO.format(
            interval=words[0], number=interval, data=words[1], names=names, units=units,
            tabs="\t" * columns,
        )  # fmt: skip
        for n in range(50):
            clock = 10.0 * (n + 1 + 50 * (interval - 1))
            speed, load = interval * 1e-3, 10 + 0.1 * (n % 3)
            cells = [n + 1, clock, speed, MU + 0.01 * interval, load, f"{23.0:.1f}"]
            row = "\t".join(str(c).replace(".", point) for c in cells)
            text += f"\t{row}\tDy_auto\n"
        text += "\n"
    return text.replace("\t", delimiter)


@pytest.mark.parametrize(
    ("words", "known", "delimiter", "point", "encoding"),
    [
        (("Interval and data points", "Interval data"), True, "\t", ".", "utf-16"),
        (("Interval and data points", "Interval data"), False, ",", ".", "utf-8"),
        (("Intervalo e ponto de dados", "Dados do intervalo"), False, "\t", ",", "utf-16"),
    ],
)
def test_intervals_of_a_tribology_cell_have_tabs_between_names_and_units(
    words, known, delimiter, point, encoding, tmp_path
):
    names = "Point No.\tTime\tSliding Speed\tFriction Factor\tNormal Force\tTemperature\tStatus"
    units = "[s]\t[m/s]\t[1]\t[N]\t[°C]\t"
    file = tmp_path / "stribeck.csv"
    text = rheometer(words, names, units, delimiter, point)
    file.write_bytes(text.replace("\n", "\r\n").encode(encoding))
    run = tl.read(file)
    if known:
        assert run.attrs["instrument"] == "anton_paar_mcr_tribology"
    assert run.sizes["time"] == 100
    np.testing.assert_allclose(run.sliding_velocity, np.repeat([1e-3, 2e-3], 50))
    np.testing.assert_allclose(run.friction_coefficient, np.repeat([MU + 0.01, MU + 0.02], 50))
    np.testing.assert_allclose(run.normal_force, np.tile(10 + 0.1 * (np.arange(50) % 3), 2))
    np.testing.assert_allclose(run.temperature, 296.15)
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    assert sorted({round(float(mu), 6) for mu in friction.friction_coefficient}) == [
        pytest.approx(MU + 0.01),
        pytest.approx(MU + 0.02),
    ]


def test_a_zwick_sled_is_read_when_it_is_named(tmp_path):
    file = tmp_path / "probe_1.TRA"
    rows = "".join(f"{t:.3f};{2.5 * t:.4f};{0.4:.6f}\n" for t in T).replace(".", ",")
    head = '"Prüfzeit";"Traversenweg";"Standardkraft"\n"s";"mm";"N"\n'
    file.write_text(head + rows, encoding="latin-1")
    run = tl.read(file, "zwick_sled")
    np.testing.assert_allclose(run.friction_force, 0.4)
    assert float(run.position[-1]) == pytest.approx(2.5e-3 * T[-1])


def test_a_machine_that_logs_slower_than_it_strokes_gives_the_mean_speed(tmp_path):
    """High-frequency reciprocating rigs write a row per second with stroke and frequency."""
    seconds = np.arange(600.0)
    head = "Time (s),Load (N),Frequency (Hz),Stroke (mm),Temperature (°C),Film (%),COF"
    file = tmp_path / "hfrr.csv"
    wobble = 1 + 0.004 * np.sin(seconds)
    columns = [seconds, 1.96, 50, 1.0 * wobble, 60, 40 + wobble, 0.15 + 1e-3 * wobble]
    rows = zip(*(np.broadcast_to(c, 600) for c in columns), strict=True)
    text = f"Drive: sine\n{head}\n" + "".join(",".join(f"{v:.6f}" for v in r) + "\n" for r in rows)
    file.write_text(text, encoding="utf-8")
    run = tl.read(file)
    assert run.attrs["set_speed_m_s"] == pytest.approx(2 * 1e-3 * 50, rel=1e-3)
    assert "position" not in run
    np.testing.assert_allclose(run.electrical_contact_resistance, 0.4 + 0.01 * wobble, rtol=1e-4)


@pytest.mark.parametrize("drive", ["sine", "constant"])
def test_a_stroke_and_a_frequency_in_columns_make_the_speed_of_fast_records(drive, tmp_path):
    time = np.arange(0, 40, 0.01)
    phase = 2 * np.pi * 0.5 * time
    force = MU * 10 * np.sign(np.cos(phase)) + 0.02 * RNG.standard_normal(time.size)
    rows = "".join(f"{t:.2f};10;0.5;10.0;{f:.5f}\n" for t, f in zip(time, force, strict=True))
    file = tmp_path / "srv.csv"
    head = "Time [s];Load [N];Frequency [Hz];Stroke [mm];Friction force [N]"
    file.write_text(f"Drive: {drive}\n{head}\n{rows}")
    speed = np.abs(tl.read(file).sliding_velocity)
    top = np.pi * 0.5 * 10e-3 if drive == "sine" else 2 * 0.5 * 10e-3
    assert float(np.percentile(speed, 98)) == pytest.approx(top, rel=0.01)


def test_a_stroke_that_is_ramped_in_a_run_is_refused(tmp_path):
    file = tmp_path / "srv.csv"
    rows = "".join(f"{t};10;50;{1 + t / 50};0.1\n" for t in range(100))
    head = "Time [s];Load [N];Frequency [Hz];Stroke [mm];COF"
    file.write_text(f"Drive: sine\n{head}\n{rows}")
    with pytest.raises(tl.TribolabError, match="part the run where it changes"):
        tl.read(file)


def test_each_instrument_stands_in_the_docs_with_where_its_layout_is_from():
    table = (Path(__file__).parents[2] / "docs" / "instruments.md").read_text(encoding="utf-8")
    rows = [line for line in table.splitlines() if line.startswith("| `")]
    assert {row.split("`")[1] for row in rows} == set(known_dialects())
    assert all(len(row.split(" | ")) == 4 for row in rows)
