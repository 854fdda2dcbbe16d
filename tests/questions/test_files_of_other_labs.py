"""Files of public repositories nobody tuned for: each layout is that of the file named."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import ReadError
from tribolab.friction.segments.find import find_segments
from tribolab.friction.segments.no_segment import why_no_segment
from tribolab.reading.folder_content import contents_of
from tribolab.reading.unknown.proposal.draft import draft_dialect
from tribolab.reading.unknown.proposal.questions import questions

ROWS = 200


def write(file, head, columns, sep=","):
    rows = "\n".join(sep.join(f"{x:.6g}" for x in row) for row in zip(*columns, strict=True))
    file.write_text(head + rows + "\n", "utf-8")
    return file


def level(value, seed=0, rows=ROWS):
    return value * (1 + 0.01 * np.random.default_rng(seed).standard_normal(rows))


def test_names_that_end_in_the_tag_of_their_logger_are_known(tmp_path):
    """LaboratoireMecaniqueLille/Braking_Tribometer_Processing, lj2.csv."""
    head = "t(s), Fnlj(N), Ftlj(N), Tdisque1\n"
    time = 0.01 * np.arange(ROWS)
    file = write(tmp_path / "lj2.csv", head, [time, level(500), level(200, 1), 20 + time])
    run = tl.read(file)
    assert float(run.friction_force.mean() / run.normal_force.mean()) == pytest.approx(
        0.4, rel=0.01
    )


def test_the_only_force_next_to_a_torque_is_asked_about_as_the_load(tmp_path):
    """LaboratoireMecaniqueLille/Braking_Tribometer_Processing, lj1.csv."""
    head = "t(s), lj1_C(Nm), lj1_F(N), lj1_rpm(t/min)\n"
    time = 0.01 * np.arange(ROWS)
    columns = [time, level(20), level(500, 1), level(1500, 2)]
    asked = questions(draft_dialect(write(tmp_path / "lj1.csv", head, columns)))
    assert [(q.about, "is the load" in q.guess) for q in asked] == [("column 3 'lj1_F(N)'", True)]


@pytest.mark.parametrize(
    ("step", "moved", "asked"), [(0.1, False, 0), (1 / 60, False, 1), (0.1, True, 1)]
)
def test_a_clock_of_decimal_seconds_is_asked_about_only_if_a_speed_depends_on_it(
    step, moved, asked, tmp_path
):
    """Dichimanaym/Tribometer-Data-Processing, a Bruker UMT's 'Timestamp' without a unit."""
    head = "Timestamp,DAQ.COF" + (",Position (mm)" if moved else "") + "\n"
    time = 0.168 + step * np.arange(ROWS)
    columns = [time, level(0.15), *([2 * time] if moved else [])]
    draft = draft_dialect(write(tmp_path / "umt.csv", head, columns))
    assert sum("time is in" in question.guess for question in questions(draft)) == asked


@pytest.mark.parametrize("steady", [True, False])
def test_a_stated_speed_needs_no_radius_if_the_rotation_is_steady(steady, tmp_path):
    """A T-11 pin-on-disc tester: 191 rpm, and 0.1 m/s in the name of the file."""
    head = "Time [s];Friction force [N];Rotational speed [rpm]\n"
    turns = level(191, 1) if steady else np.linspace(20, 400, ROWS)
    columns = [0.1 * np.arange(ROWS), level(2.5), turns]
    file = write(tmp_path / "T11_0.1m-s_10N.csv", head, columns, ";")
    run = tl.read(file)
    assert (run.attrs["speed_from"] == "set speed") is steady
    assert ("set_speed_m_s" in run.attrs) is steady


@pytest.mark.parametrize(("contact", "asked"), [("", 1), ("Contact: ball on disc\n", 0)])
def test_the_axial_force_of_a_rheometer_is_asked_about(contact, asked, tmp_path):
    head = contact + "Time [s],Friction Coefficient [1],Sliding Speed [mm/s],Normal Force [N],"
    head += "Torque [mN·m],Gap [mm]\n"
    speed = np.geomspace(0.1, 100, ROWS)
    columns = [np.arange(ROWS), level(0.3), speed, level(5, 1), level(7, 2), level(2, 3)]
    draft = draft_dialect(write(tmp_path / "mcr.csv", head, columns))
    assert sum("three plates" in question.guess for question in questions(draft)) == asked


@pytest.mark.parametrize("filled", [True, False])
def test_of_a_rheometer_that_writes_all_columns_the_filled_ones_count(filled, tmp_path):
    """bsaintmichel/read-rheol, sample_Malvern.csv."""
    head = "Shear stress(Pa);Shear rate(s-¹);Frequency(Hz);"
    head += "Shear modulus (elastic component)(Pa);Shear modulus (viscous component)(Pa)\n"
    rows = [f";;{f:.3f};400;60" if filled else f"{f:.3f};50;;;" for f in np.geomspace(0.1, 10, 20)]
    (tmp_path / "kinexus.csv").write_text(head + "\n".join(rows).replace(".", ","), "utf-8")
    if filled:
        assert "storage  1.2e+03 Pa" in "\n".join(file_lines(tmp_path / "kinexus.csv"))
    else:
        with pytest.raises(ReadError, match="holds a flow curve"):
            file_lines(tmp_path / "kinexus.csv")


def test_a_map_that_numbers_its_points_has_the_stated_pitch(tmp_path):
    """jarredclloyd/GeochemistryTools.jl, an Olympus OLS5000's area."""
    heights = np.round(12 + np.add.outer(np.sin(np.arange(20)), np.cos(np.arange(30) / 4)), 3)
    table = "DataLine," + ",".join(f"POS = {k}" for k in range(30)) + "\n"
    table += "\n".join(f"{n}," + ",".join(f"{z:.3f}" for z in row) for n, row in enumerate(heights))
    file = tmp_path / "area.csv"
    file.write_text("Pitch: 0.625 um\nZResolution,0.001,[um]\n" + table + "\n", "utf-8")
    scan = tl.read_scans(file)
    assert scan.sizes == {"y": 20, "x": 30}
    assert float(scan.x[1] - scan.x[0]) == pytest.approx(0.625e-6)
    assert np.ptp(scan.height.values) == pytest.approx(1e-6 * np.ptp(heights))
    file.write_text("ZResolution,0.001,[um]\n" + table + "\n", "utf-8")
    with pytest.raises(ReadError, match="how far its points lie apart"):
        tl.read_scans(file)


def test_comments_may_list_the_names_and_units_of_columns(tmp_path):
    """stemarcotti/AFM-data-plot, force curves of a JPK NanoWizard."""
    head = "# springConstant: 0.045\n# columns: time lateralForce normalForce\n# units: s nN uN\n"
    columns = [0.1 * np.arange(ROWS), level(3), level(10, 1)]
    draft = draft_dialect(write(tmp_path / "jpk.txt", head, columns, " "))
    assert draft.labels == ["time", "lateralForce", "normalForce"]
    assert [c.read_unit for c in draft.understood.columns] == ["s", "nN", "uN"]


def test_strokes_with_few_samples_say_how_fast_to_record():
    time = 0.02 * np.arange(3000)
    phase = 2 * np.pi * 5 * time + 0.3  # 5 Hz at 50 samples a second
    signals = {"position": 0.01 * np.sin(phase), "friction_force": 3 * np.cos(phase)}
    run = xr.Dataset({name: ("time", x) for name, x in signals.items()}, {"time": time})
    assert "a stroke has 5 samples" in (why := why_no_segment(find_segments(run)))
    assert "record at 150 Hz or more" in why


def test_a_log_that_broke_off_counts_as_its_siblings_do(tmp_path):
    columns = [0.1 * np.arange(ROWS), level(2), level(10, 1)]
    for number in (1, 2):
        write(tmp_path / f"run_{number}.csv", "t [s],Ff [N],Fn [N]\n", columns)
    (tmp_path / "run_3.csv").write_text("aborted: sensor fault\n", "utf-8")
    (tmp_path / "notes.txt").write_text("as agreed\n", "utf-8")
    found = {path.name: what for path, what in contents_of(sorted(tmp_path.iterdir())).items()}
    assert found["run_3.csv"] == "run" and found["notes.txt"] == "scan"


def info(file, *options):
    return CliRunner().invoke(cli.app, ["info", str(file), *options]).output


def test_what_options_state_is_missing_by_their_names(tmp_path):
    columns = [0.1 * np.arange(ROWS), level(2), level(90, 1)]
    file = write(tmp_path / "log.csv", "t [s],Friction [N],n [rpm]\n", columns)
    assert "missing: the radius of the track, for the sliding speed: --radius 15mm" in info(file)
    assert "missing: the load: --load 20N" in info(file)
    said = info(file, "--load", "20 N", "--radius", "15mm")
    assert f"tribolab run {file} --load '20 N' --radius 15mm (its results)" in said


@pytest.mark.parametrize(
    ("names", "asked"),
    [
        ("t [s],CH1 [N],CH2 [N]", "hold it: column 2 'CH1 [N]' or column 3 'CH2 [N]'?"),
        ("t [s],Ft,n [rpm]", "friction_force, in which unit: N, mN or gf?"),
    ],
)
def test_no_option_is_offered_if_more_than_options_is_missing(names, asked, tmp_path):
    """msritj79/data_processing, the channels of a Kyowa logger."""
    columns = [0.1 * np.arange(ROWS), level(2), level(90, 1)]
    said = info(write(tmp_path / "log.csv", names + "\n", columns))
    assert asked in said and "Missing: the load\n" in said
    assert "State --" not in said and "(a force)" not in said


@pytest.mark.parametrize("ratio", [1.0, 1.3])
def test_a_negative_force_next_to_its_own_positive_coefficient_is_turned(ratio, tmp_path):
    """An Rtec's log, whose reader plots -Fx; a coefficient of other forces proves nothing."""
    load, mu = -level(20, 1), level(0.12, 2)
    columns = [0.1 * np.arange(ROWS), load, mu, ratio * mu * load, level(100, 3)]
    head = "Timestamp,DAQ.Fz (N),DAQ.COF (),DAQ.Fx (N),Rotary.Velocity (rpm)\n"
    run = draft_dialect(write(tmp_path / "LOG.csv", head, columns))
    (force,) = (c for c in run.understood.columns if c.quantity == "friction_force")
    assert force.sign == (-1 if ratio == 1 else 1)


def test_a_nameless_column_that_rises_by_factors_is_no_clock(tmp_path):
    """RHEOS, data_freq.csv: frequency, storage and loss modulus without names."""
    frequency = np.geomspace(0.09, 1000, 9)
    file = write(tmp_path / "f.csv", "", [frequency, frequency**0.2, 0.2 * frequency**0.3], ",")
    with pytest.raises(ReadError, match=r"column 1 rises by factors.*is no time.*write names"):
        tl.read(file)
    steps = np.arange(1, 40.0)
    draft = draft_dialect(write(tmp_path / "t.csv", "", [steps, level(2, rows=39), steps**2], ","))
    assert draft.understood.columns[0].quantity == "time"


def test_of_two_discs_the_faster_one_is_driven_against_the_friction(tmp_path):
    """A twin-disc log that starts while the discs slide: its first value is no zero."""
    torque = 2.35 + 0.03 * np.sin(np.arange(60))
    one, other = 400 + 0 * torque, 397.5 + 0 * torque
    head = "Twin-disc test\nDisc diameter: 47 mm\n"
    head += "Time [s];Speed 1 [rpm];Speed 2 [rpm];Normal force [N];Friction torque [Nm]\n"
    columns = [0.5 * np.arange(60), one, other, 1500 + 0 * torque, torque]
    run = tl.read(write(tmp_path / "disc.csv", head, columns, ";"))
    assert float((run.friction_force * run.sliding_velocity).min()) > 0


def test_a_flow_curve_with_a_normal_stress_is_no_friction(tmp_path):
    """TRIOS writes the friction of its bearing above the table (bsaintmichel/read-rheol)."""
    file = tmp_path / "flow.csv"
    head = "Friction correction enabled,yes\nStress,Shear rate,Viscosity,Step time,Normal stress\n"
    rows = "".join(f"{0.2 * r},{r},0.2,{r},{2 + r % 3}\n" for r in range(1, 20))
    file.write_text(head + "Pa,1/s,Pa.s,s,Pa\n" + rows)
    with pytest.raises(ReadError, match="holds a flow curve"):
        tl.read(file)


def test_what_counts_the_points_of_a_profile_is_no_length(tmp_path):
    """A shaft's profile by number (wszczawinski/BearingMeasurementAnalysis)."""
    z = 5.6 + np.sin(np.arange(300) / 9)
    file = write(tmp_path / "shaft.csv", "Count;Z measurement\n", [np.arange(1, 301), z], ";")
    with pytest.raises(ReadError, match="counts the points, whose distance is not stated"):
        tl.read_scans(file)


def test_names_that_leave_out_the_quoted_number_of_a_row_begin_at_the_second_column(tmp_path):
    """R's write.table names no column for the numbers of the rows."""
    names = ["Time [s]", "Friction force [N]", "Normal force [N]", "Speed [mm/s]"]
    rows = [f'"{i + 1}",{0.02 * i:.2f},3.0{i % 7},10.0,5.0\n' for i in range(90)]
    file = tmp_path / "r.csv"
    file.write_text(",".join(f'"{name}"' for name in names) + "\n" + "".join(rows))
    run = tl.read(file)
    assert float(run.time[-1] - run.time[0]) == pytest.approx(1.78)
    assert float(run.friction_force.mean()) == pytest.approx(3.03, abs=0.01)
