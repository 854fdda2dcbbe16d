"""Instruments whose files were not at hand: files made as published readers of them have it."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.io.dialects.find import recognise

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
