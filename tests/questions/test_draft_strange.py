"""Files as a stranger's laboratory writes them: what could be taken wrongly is right, or asked."""

import time

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.text.number_spelling import find_thousands

N = 600
T = np.arange(N) / 20
SPEED = np.where(T < 15, 2.0, 5.0)  # mm/s
LOAD = 1500 + np.sin(T)  # mN
FRICTION = 0.25 * LOAD + 1e-3


def written(path, header, *columns, delimiter=",", number="{:.4f}", encoding="utf-8", end="\n"):
    """Write a table; `number` writes a float, or is a text with a place for it."""
    form = number if callable(number) else number.format
    rows = zip(*(np.broadcast_to(c, N) for c in columns), strict=True)
    cells = ([c if isinstance(c, str) else form(c) for c in row] for row in rows)
    body = "".join(delimiter.join(row) + end for row in cells)
    path.write_bytes(f"{header}\n{body}".encode(encoding))
    return path


def asked(path):
    with pytest.raises(tl.TribolabError, match="does not state everything") as told:
        tl.read(path)
    return str(told.value)


def german(x):
    return f"{x:,.3f}".replace(",", "_").replace(".", ",").replace("_", ".")


@pytest.mark.parametrize(
    ("number", "delimiter", "encoding"),
    [
        (german, ";", "utf-8"),
        (german, "\t", "utf-16"),
        (lambda x: f"{x:,.3f}".replace(",", "\u00a0").replace(".", ","), ";", "latin-1"),
        (lambda x: f"{x:,.3f}".replace(",", "'"), ";", "utf-8"),
        (lambda x: f'"{x:,.3f}"', ",", "utf-8"),
    ],
)
def test_marks_between_thousands_are_no_decimal_marks_and_no_lost_values(
    number, delimiter, encoding, tmp_path
):
    """Half of the friction is above a thousand: left out, it would be a lower friction."""
    head = delimiter.join(["Time [s]", "Friction force [mN]", "Normal force [mN]", "Speed [mm/s]"])
    friction = 4 * FRICTION - 500  # 996 to 1004 mN
    file = written(
        tmp_path / "a.csv", head, T, friction, 4 * LOAD, SPEED,
        delimiter=delimiter, number=number, encoding=encoding,
    )  # fmt: skip
    run = tl.read(file)
    np.testing.assert_allclose(run.friction_force, 1e-3 * friction, atol=1e-6)
    np.testing.assert_allclose(run.normal_force, 4e-3 * LOAD, atol=1e-6)


def test_text_before_the_table_keeps_its_points_where_the_table_has_them_between_thousands(
    tmp_path,
):
    head = "Track radius: 1.500 mm\nZeit [s];Reibkraft [mN];Normalkraft [mN];Drehzahl [1/min]"
    file = written(tmp_path / "a.csv", head, T, FRICTION, LOAD, 60, delimiter=";", number=german)
    np.testing.assert_allclose(tl.read(file).sliding_velocity, 2 * np.pi * 1.5e-3, rtol=1e-6)


@pytest.mark.parametrize("cell", ["{:.3f} N", "<{:.3f}", "~{:.2f}"])
def test_numbers_with_something_about_them_are_not_left_out_in_silence(cell, tmp_path):
    file = tmp_path / "a.csv"
    force = [cell.format(f) if n > 450 else f"{f:.3f}" for n, f in enumerate(1e-3 * FRICTION)]
    written(file, "Time [s];Friction force [N];Load [N];Speed [mm/s]", T, force, 1e-3 * LOAD, SPEED,
            delimiter=";")  # fmt: skip
    assert "is taken for no value" in asked(file)
    written(file, "Time [s];Friction force;Load [N];Speed [mm/s]", T,
            [cell.format(f) for f in FRICTION], 1e-3 * LOAD, SPEED, delimiter=";")  # fmt: skip
    assert "'Friction force'" in asked(file) and "not a number" in asked(file)


@pytest.mark.parametrize(
    "names",
    [
        ("Velocity", "Measured velocity"),
        ("Velocity setpoint", "Velocity"),
        ("Commanded speed", "Actual speed"),
        ("Sollgeschwindigkeit", "Istgeschwindigkeit"),
        ("TargetSpeed", "Speed"),
    ],
)
@pytest.mark.parametrize("turned", [False, True])
def test_the_speed_that_was_measured_counts_and_not_the_one_that_was_set(names, turned, tmp_path):
    columns = [(names[0], 1.1 * SPEED), (names[1], SPEED)][:: -1 if turned else 1]
    head = "Time [s],Friction [mN],Load [mN]," + ",".join(f"{n} [mm/s]" for n, _ in columns)
    file = written(tmp_path / "a.csv", head, T, FRICTION, LOAD, *(c for _, c in columns))
    np.testing.assert_allclose(tl.read(file).sliding_velocity, 1e-3 * SPEED)


def test_a_load_that_stands_still_gives_way_to_one_that_moves(tmp_path):
    head = "Time [s],Friction [mN],Load setpoint [mN],Load [mN],Speed [mm/s]"
    file = written(tmp_path / "a.csv", head, T, FRICTION, 1700, LOAD, SPEED)
    np.testing.assert_allclose(tl.read(file).normal_force, 1e-3 * LOAD, atol=1e-6)
    head = "Time [s],Friction [mN],Applied load [g],Normal force [mN],Speed [mm/s]"
    told = asked(written(tmp_path / "b.csv", head, T, FRICTION, 100, LOAD, SPEED))
    assert "column 4 'Normal force [mN]'" in told and "column 3" in told


def test_two_columns_that_name_the_same_and_say_otherwise_are_asked_about(tmp_path):
    head = "Time [s],Friction force [mN],Tangential force [mN],Load [mN],Speed [mm/s]"
    told = asked(written(tmp_path / "a.csv", head, T, FRICTION, 1.3 * FRICTION, LOAD, SPEED))
    assert "of several columns for friction_force" in told


def test_a_load_counted_negative_is_told_by_its_size_where_noise_surrounds_zero(tmp_path):
    load = np.where(T < 3, 20 * np.cos(9 * T), -LOAD)
    head = "Time [s],Fx [mN],Fz [mN],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, load, SPEED))
    assert run.attrs["counted_negative"] == "normal_force"
    np.testing.assert_allclose(run.normal_force, -1e-3 * load, atol=1e-6)


def test_what_is_horizontal_slides_and_what_is_vertical_does_not(tmp_path):
    head = (
        "Time [s],Vertical displacement [mm],Horizontal displacement [mm],Vertical force [mN],"
        "Horizontal force [mN]"
    )
    file = written(tmp_path / "a.csv", head, T, 0.01 * T, 2 * T, LOAD, FRICTION)
    run = tl.read(file)
    np.testing.assert_allclose(run.position, 2e-3 * T, atol=1e-9)
    np.testing.assert_allclose(run.friction_force / run.normal_force, FRICTION / LOAD, rtol=1e-3)


HEAD = "Time [s],Friction force [mN],Load [mN],Speed [mm/s]"


@pytest.mark.parametrize(
    "footer",
    ["\nAverage,0.4,10,2\nMax,9,1,5\n", "Mean,250,10.0,0.0\n", "Std dev,1,1,1\nn,4,4,4\n"],
)
def test_averages_below_the_rows_are_no_rows(footer, tmp_path):
    file = written(tmp_path / "a.csv", HEAD, T, FRICTION, LOAD, SPEED)
    file.write_text(file.read_text() + footer)
    run = tl.read(file)
    assert run.sizes["time"] == N
    assert float(run.friction_force.max()) == pytest.approx(1e-3 * FRICTION.max(), abs=1e-6)


@pytest.mark.parametrize(
    "clock",
    [
        lambda s: f"{int(s // 60) % 60:02d}:{s % 60:05.2f}",
        lambda s: f"{int(s // 3600):02d}:{int(s // 60) % 60:02d}:{s % 60:05.2f}",
        lambda s: f"{int(s // 60) % 60:02d}:{s % 60:05.2f}".replace(".", ","),
        lambda s: (
            f"{(int(s // 3600) + 11) % 12 + 1:02d}:{int(s // 60) % 60:02d}:{s % 60:05.2f} "
            f"{'AM' if s < 43200 else 'PM'}"
        ),
    ],
)
def test_a_clock_that_shows_minutes_and_seconds_goes_on_over_the_hour(clock, tmp_path):
    times = [clock(3590 + t) for t in T]
    file = written(tmp_path / "a.csv", HEAD.replace(",", ";"), times, FRICTION, LOAD, SPEED,
                   delimiter=";")  # fmt: skip
    np.testing.assert_allclose(tl.read(file).time, T, atol=1e-6)


@pytest.mark.parametrize(
    "said",
    ["Dead weight,153.,g", "Load mass = 0.153 kg", "Normal load;1.5004;N", "Load: 1.5004 N"],
)
def test_a_load_above_the_table_is_the_normal_force(said, tmp_path):
    head = f"Operator,Bob\n{said}\nTime [s],Friction force [mN],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, SPEED))
    np.testing.assert_allclose(run.normal_force, 1.5004, rtol=1e-4)
    said = tl.check(run).table.query("check == 'stuck' and variable == 'normal_force'")
    assert not set(said.status) & {"suspect", "fail"}  # a stated load is no stuck sensor


@pytest.mark.parametrize(
    "said",
    [
        "Wear track diameter (mm),40",
        "Track radius: 0.7874015748 in",
        "Ball radius,3,mm\nTrack radius,20,mm",
    ],
)
def test_the_track_above_the_table_makes_the_speed_of_turns(said, tmp_path):
    head = f"{said}\nTime [s],Friction [mN],Load [mN],Speed [rpm]"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, 60))
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 20e-3, rtol=1e-6)


def test_the_size_of_a_ball_is_no_track_and_that_of_a_disc_is_asked_about(tmp_path):
    head = "{}\nTime [s],Friction [mN],Load [mN],Speed [rpm]"
    columns = (T, FRICTION, LOAD, 60)
    ball = written(tmp_path / "a.csv", head.format("Ball radius: 3 mm"), *columns)
    assert "sliding_velocity" not in tl.read(ball)
    for said in ("Disc diameter: 60 mm", "disc dia. 60 mm", "Geometry: pin, R = 30 mm"):
        assert "radius of the track" in asked(
            written(tmp_path / "b.csv", head.format(said), *columns)
        )


@pytest.mark.parametrize(
    "head",
    [
        "Time,Friction,Load,Speed\nCH1,CH2,CH3,CH4\ns,mN,mN,mm/s",
        "Channel,1,2,3\nTime,Friction,Load,Speed\nElapsed,Tangential,Normal,Actual\ns,mN,mN,mm/s",
        "Time,Friction,Load,Speed\n,,,\ns,mN,mN,mm/s",
        "Zeit in Sekunden,Reibkraft in mN,Last in mN,Geschwindigkeit in mm/s",
        "Time / s,Friction / mN,Load / mN,Speed / mm/s",
    ],
)
def test_units_may_stand_in_the_third_line_or_in_words(head, tmp_path):
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, SPEED))
    np.testing.assert_allclose(run.friction_force, 1e-3 * FRICTION, atol=1e-6)
    np.testing.assert_allclose(run.sliding_velocity, 1e-3 * SPEED)


@pytest.mark.parametrize(("said", "at_once"), [("Half stroke: 5 mm", True), ("Amplitude: 5 mm", 0)])
def test_half_a_stroke_is_half_and_an_amplitude_is_asked_about(said, at_once, tmp_path):
    force = 300 * np.sign(np.cos(np.pi * T)) + np.sin(7 * T)
    head = f"{said}\nFrequency: 0.5 Hz\nMotion: sine\nTime [s],Friction [mN],Load [mN]"
    file = written(tmp_path / "a.csv", head, T, force, LOAD)
    if not at_once:
        assert "is half of a stroke" in asked(file)
        return
    assert float(tl.read(file).sliding_velocity.max()) == pytest.approx(np.pi * 5e-3, rel=0.01)


@pytest.mark.parametrize(("share", "at_once"), [(0.02, True), (30.0, False)])
def test_the_larger_of_two_forces_in_the_plane_is_asked_about(share, at_once, tmp_path):
    head = "Time [s],Fx [mN],Fy [mN],Fz [mN],Speed [mm/s]"
    file = written(tmp_path / "a.csv", head, T, FRICTION, share * FRICTION, LOAD, SPEED)
    if at_once:  # cross-talk
        np.testing.assert_allclose(tl.read(file).friction_force, 1e-3 * FRICTION, atol=1e-6)
    else:
        assert "of several columns for friction_force" in asked(file)


@pytest.mark.parametrize("mark", ["-9999", "1e30", "9.91E37", "65535", "-999.25", "1.70141E+38"])
@pytest.mark.parametrize("place", [1, 2])
def test_a_number_that_stands_for_no_value_is_none_and_is_told(mark, place, tmp_path):
    columns = [T, FRICTION, LOAD, SPEED]
    cells = [f"{x:.4f}" for x in columns[place] / 1e3]
    lost = [7, 150, 151, 400]
    for row in lost:
        cells[row] = mark
    columns = [T, FRICTION / 1e3, LOAD / 1e3, SPEED]
    columns[place] = cells
    head = "Time [s],Friction [N],Load [N],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, *columns))
    signal = run[["friction_force", "normal_force"][place - 1]].values
    assert np.flatnonzero(np.isnan(signal)).tolist() == lost
    assert f"{float(mark):.9g} 4 times" in run.attrs["taken_for_missing"]


@pytest.mark.parametrize(("rest", "mark", "times"), [(9000, 9999, 9), (3, 999, 1), (3, 612, 9)])
def test_a_number_that_may_be_measured_is_kept(rest, mark, times, tmp_path):
    """Not far outside, not repeated, or not one that programs choose."""
    force = rest + np.sin(T)
    force[10 : 10 + times] = mark
    head = "Time [s],Friction [mN],Load [mN],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, T, force, 1e4, SPEED))
    assert "taken_for_missing" not in run.attrs
    np.testing.assert_allclose(run.friction_force, 1e-3 * force, atol=1e-7)


@pytest.mark.parametrize(
    ("spelt", "delimiter"),
    [
        (lambda x: f"{x:.4f}".replace("-", "\u2212"), ","),
        (lambda x: f"{x:.8E}".replace("E", "D"), "\t"),
        (lambda x: f"{x:.8e}".replace("e", "d").replace(".", ","), ";"),
        (lambda x: f'"{x:.4f}"'.replace(".", ","), ","),
    ],
    ids=["true minus", "Fortran", "Fortran and commas", "commas in quotes"],
)
def test_numbers_in_an_unusual_spelling_are_numbers(spelt, delimiter, tmp_path):
    head = delimiter.join(["Time [s]", "Friction [mN]", "Load [mN]", "Speed [mm/s]"])
    friction, speed = FRICTION * np.sign(np.sin(T)), SPEED * np.sign(np.sin(T))
    file = written(
        tmp_path / "a.csv", head, T, friction, LOAD, speed, number=spelt, delimiter=delimiter
    )
    run = tl.read(file)
    np.testing.assert_allclose(run.friction_force, 1e-3 * friction, atol=1e-6)
    np.testing.assert_allclose(run.time, T, atol=1e-9)


@pytest.mark.parametrize(
    "said",
    [
        "dt = 0.05 s",
        "Sampling interval: 50 ms",
        "Abtastintervall;50 ms",
        "Sample period (s): 0.05",
        "Messrate: 20 Hz",
    ],
)
def test_a_rate_or_an_interval_above_the_table_makes_the_time(said, tmp_path):
    head = f"{said}\nFriction [mN];Load [mN];Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, FRICTION, LOAD, SPEED, delimiter=";"))
    np.testing.assert_allclose(run.time, T, atol=1e-9)
    assert run.attrs["time_source"] == "sample rate"


@pytest.mark.parametrize("said", ["dt: 0.05", "fs = 20"])
def test_of_a_rate_or_interval_without_a_unit_it_is_asked(said, tmp_path):
    head = f"{said}\nFriction [mN],Load [mN],Speed [mm/s]"
    assert said in asked(written(tmp_path / "a.csv", head, FRICTION, LOAD, SPEED))


def test_whole_numbers_of_thousands_beside_decimals_are_read_and_others_are_not(tmp_path):
    def whole(x):
        return f"{round(x):,}".replace(",", ".")

    times = [f"{t:.2f}".replace(".", ",") for t in T]
    force = [whole(x) for x in np.linspace(900, 1600, N)]
    head = "Time [s];Friction [mN];Load [mN];Speed [um/s]"
    rest = [whole(x) for x in 4 * LOAD]
    file = written(tmp_path / "a.csv", head, times, force, rest, "500", delimiter=";")
    run = tl.read(file)
    np.testing.assert_allclose(run.friction_force, 1e-3 * np.linspace(900, 1600, N), atol=5.1e-4)
    # 1.412 N may be a force with three decimals: no number below tells that it is not
    force = [f"{x:.3f}" for x in FRICTION / 1e2]
    file = written(tmp_path / "b.csv", head, times, force, force, "500", delimiter=";")
    with pytest.raises(tl.TribolabError):
        tl.read(file)


def every(step, cells, number="{:.4f}"):
    return [number.format(x) if n % step == 0 else "" for n, x in enumerate(cells)]


def test_signals_of_two_rates_in_one_table_are_brought_together(tmp_path):
    load = LOAD + 20 * np.sin(T / 3)
    head = "Time [s],Friction [mN],Load [mN],Speed [mm/s]"
    file = written(tmp_path / "a.csv", head, T, 0.25 * load, every(5, load), every(10, SPEED))
    run = tl.read(file)
    assert "every 5th row" in run.attrs["interpolated"] and run.attrs["rows_in_file"] == N
    mu = run.friction_force / run.normal_force
    assert run.sizes["time"] == N - 9 and np.isfinite(mu).all()
    np.testing.assert_allclose(mu, 0.25, rtol=1e-3)
    # friction is the slower one: its own rows are kept, and no value of it is made up
    file = written(tmp_path / "b.csv", head, T, every(5, 0.25 * load), load, SPEED)
    run = tl.read(file)
    assert run.sizes["time"] == N / 5 == N - run.attrs["rows_without_friction"]
    np.testing.assert_allclose(run.friction_force / run.normal_force, 0.25, rtol=1e-4)


def test_values_that_are_missing_at_random_stay_so(tmp_path):
    lost = np.random.default_rng(3).random(N) < 0.6
    cells = ["" if gone else f"{x:.4f}" for gone, x in zip(lost, LOAD, strict=True)]
    head = "Time [s],Friction [mN],Load [mN],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, cells, SPEED))
    assert "interpolated" not in run.attrs
    np.testing.assert_array_equal(np.isnan(run.normal_force), lost)


def test_rows_with_the_newest_first_are_turned_round(tmp_path):
    head = "Time [s],Friction [mN],Load [mN],Speed [mm/s]"
    back = slice(None, None, -1)
    file = written(tmp_path / "a.csv", head, T[back], FRICTION[back], LOAD[back], SPEED[back])
    run = tl.read(file)
    assert run.attrs["rows_turned_round"]
    np.testing.assert_allclose(run.time, T, atol=1e-9)
    np.testing.assert_allclose(run.friction_force, 1e-3 * FRICTION, atol=1e-6)
    head = head.replace("Time", "Time left")
    assert "turned round" in asked(
        written(tmp_path / "b.csv", head, T[back], FRICTION, LOAD, SPEED)
    )


@pytest.mark.parametrize("unit", ["counts", "digits", "LSB"])
def test_what_a_count_is_worth_is_asked(unit, tmp_path):
    """Counts of both channels would be a coefficient of friction, and a wrong one."""
    head = f"Time [s],Friction [{unit}],Load [{unit}],Speed [mm/s]"
    told = asked(written(tmp_path / "a.csv", head, T, 7 * FRICTION, 9 * LOAD, SPEED))
    assert told.count("what is one count?") == 2


@pytest.mark.parametrize(
    ("column", "words"),
    [("COF x100", "'x100'"), ("mu [x1000]", "'x1000'"), ("COF*10^3", "'*10^3'")],
)
def test_a_factor_in_a_name_is_asked_about(column, words, tmp_path):
    head = f"Time [s],{column},Load [mN],Speed [mm/s]"
    assert words in asked(written(tmp_path / "a.csv", head, T, 25 + 0 * T, LOAD, SPEED))


def test_a_lever_above_the_table_is_asked_about(tmp_path):
    head = "Lever ratio: {}\nTime [s],Friction [mN],Load [mN],Speed [mm/s]"
    told = asked(written(tmp_path / "a.csv", head.format(3), T, FRICTION, LOAD, SPEED))
    assert "not times 'Lever ratio: 3'" in told
    tl.read(written(tmp_path / "b.csv", head.format(1), T, FRICTION, LOAD, SPEED))
    head = head.replace("Lever ratio: {}", "Gain of the load cell = 2.5")
    assert "not times" in asked(written(tmp_path / "c.csv", head, T, FRICTION, LOAD, SPEED))


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("Number of contacts: 2", "both of one"),
        ("No. of pins = 3", "both of one"),
        ("Anzahl Kontakte: 2", "both of one"),
        ("Specimens: 2 shoes", "both of one"),
        ("Lever 1:5", "not times"),
        ("Transmission ratio 1 : 10", "not times"),
        ("Amplifier gain 10", "not times"),
    ],
)
def test_contacts_ratios_and_gains_above_the_table_are_asked_about(line, words, tmp_path):
    head = f"{line}\nTime [s],Friction [mN],Load [mN],Speed [mm/s]"
    told = asked(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, SPEED))
    assert words in told
    assert line in told


@pytest.mark.parametrize("line", ["Number of contacts: 1", "Ratio 1:1", "Start 12:30", "Gain 1.0"])
def test_one_contact_and_factors_of_one_are_no_question(line, tmp_path):
    head = f"{line}\nTime [s],Friction [mN],Load [mN],Speed [mm/s]"
    tl.read(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, SPEED))


@pytest.mark.parametrize(("weight", "newton"), [("0.44 lb", 1.95722), ("7 oz", 1.94610)])
def test_a_sled_weighs_in_pounds_and_ounces(weight, newton, tmp_path):
    head = f"Sled weight: {weight}\nTime [s],Friction [mN],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, SPEED))
    np.testing.assert_allclose(run.normal_force, newton, rtol=1e-5)


def test_the_mean_goes_before_the_extremes_and_these_alone_are_asked_about(tmp_path):
    head = "Time [s],Max friction coefficient,Mean friction coefficient,Load [mN],Speed [mm/s]"
    run = tl.read(written(tmp_path / "a.csv", head, T, 0.9, 0.25, LOAD, SPEED))
    np.testing.assert_allclose(run.friction_coefficient, 0.25)
    head = "Time [s],Peak friction force [mN],Load [mN],Speed [mm/s]"
    assert "extremes" in asked(written(tmp_path / "b.csv", head, T, FRICTION, LOAD, SPEED))


@pytest.mark.parametrize("unit", ["1/min", "U/min", "min-1", "rev/s"])
def test_a_speed_in_turns_is_one_of_rotation(unit, tmp_path):
    head = f"Track radius: 20 mm\nTime [s],Friction [mN],Load [mN],Speed [{unit}]"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, 60))
    per_second = 60 if unit == "rev/s" else 1
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 20e-3 * per_second, rtol=1e-6)


def test_forces_that_do_not_make_the_coefficient_beside_them_are_asked_about(tmp_path):
    head = "Time [s],Friction [N],Load [N],COF,Speed [mm/s]"
    told = asked(written(tmp_path / "a.csv", head, T, FRICTION, LOAD / 1e3, 0.25, SPEED))
    assert "column 4 states 0.25" in told and "250" in told
    tl.read(written(tmp_path / "b.csv", head, T, FRICTION, LOAD, 0.25, SPEED))


@pytest.mark.parametrize("name", ["speed_mm_s", "speed_mm_per_s", "speed mm/s"])
def test_units_behind_underscores_are_units(name, tmp_path):
    """Read as turns per second, a radius above the table would make a wrong speed of it."""
    head = f"Track radius: 20 mm\ntime_s,friction_mN,load_mN,{name}"
    run = tl.read(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, SPEED))
    np.testing.assert_allclose(run.sliding_velocity, 1e-3 * SPEED)
    np.testing.assert_allclose(run.friction_force, 1e-3 * FRICTION, atol=1e-6)


def test_text_in_quotes_may_hold_the_delimiter_and_bars_may_part_cells(tmp_path):
    head = "Time [s],Phase,Friction [mN],Load [mN],Speed [mm/s]"
    phase = [f'"run, {n % 3}"' for n in range(N)]
    run = tl.read(written(tmp_path / "a.csv", head, T, phase, FRICTION, LOAD, SPEED))
    np.testing.assert_allclose(run.normal_force, 1e-3 * LOAD, atol=1e-6)
    head = "Time [s]|Friction [mN]|Load [mN]|Speed [mm/s]"
    run = tl.read(written(tmp_path / "b.csv", head, T, FRICTION, LOAD, SPEED, delimiter="|"))
    np.testing.assert_allclose(run.normal_force, 1e-3 * LOAD, atol=1e-6)


def test_words_of_others_and_a_clock_that_restarts_make_a_disc_with_steps(tmp_path):
    clock = np.tile(np.arange(N // 3), 3) / 600
    block = np.repeat([1, 2, 3], N // 3)
    head = "Wear track radius;18,5;mm\nBlock;Clock [min];Spindle [rpm];Drag [cN];Pressing force [N]"
    columns = [block, clock, 60.0 * block, FRICTION / 10, LOAD / 1e3]
    file = written(
        tmp_path / "a.csv", head, *columns, delimiter=";",
        number=lambda x: f"{x:.5f}".replace(".", ","),
    )  # fmt: skip
    run = tl.read(file)
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 18.5e-3 * block, rtol=1e-6)
    np.testing.assert_allclose(run.friction_force, 1e-3 * FRICTION, atol=1e-6)
    assert (np.diff(run.time) > 0).all()


def test_a_column_in_a_unit_of_time_that_rises_may_be_the_time(tmp_path):
    head = "Rolex [s],Friction [mN],Load [mN],Speed [mm/s]"
    assert "time" in asked(written(tmp_path / "a.csv", head, T, FRICTION, LOAD, SPEED))


@pytest.mark.parametrize(
    ("said", "stroke"),
    [("Amplitude of motion (peak to peak) = 12 mm", 12e-3), ("Half stroke = 6 mm", 12e-3)],
)
def test_an_amplitude_from_end_to_end_is_the_stroke(said, stroke, tmp_path):
    head = f"{said}\nReciprocation = 0.5 Hz\nProfile = sinusoidal\nDead load = 0.2 kgf"
    head += "\nLogger interval = 50 ms\nLateral [mN]\tChamber [degC]"
    force = 300 * np.sign(np.cos(np.pi * T)) + np.sin(7 * T)
    run = tl.read(written(tmp_path / "a.dat", head, force, 24.0, delimiter="\t"))
    assert run.attrs["stroke_m"] == pytest.approx(stroke)
    np.testing.assert_allclose(run.normal_force, 0.2 * 9.80665)


def test_heights_alone_say_that_their_distance_is_missing(tmp_path):
    file = tmp_path / "trace.txt"
    file.write_text("Traverse: 2.0 mm\nElevation (um)\n" + "".join(f"{x:.4f}\n" for x in T))
    with pytest.raises(tl.TribolabError, match="distance of neighbouring heights"):
        tl.read(file)


def test_what_is_said_before_each_step_is_that_of_the_step(tmp_path):
    """Taken from the first, speed and load of all later steps would be wrong."""
    head = "Time [s];Rotation [rpm];Friction [N]"
    text = "Disc rig\n"
    for step, (radius, load) in enumerate(((10, 5.0), (20, 5.0), (25, 8.0)), 1):
        text += f"Step {step}\nTrack radius: {radius} mm\nLoad: {load} N\n{head}\n"
        text += "".join(f"{n / 20:.2f};60;{0.25 * load + 0.001 * (n % 3):.4f}\n" for n in range(N))
    file = tmp_path / "a.txt"
    file.write_text(text)
    run = tl.read(file)
    radii, loads = np.repeat([10e-3, 20e-3, 25e-3], N), np.repeat([5.0, 5.0, 8.0], N)
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * radii, rtol=1e-6)
    np.testing.assert_allclose(run.normal_force, loads)
    toml = tl.reading.draft_dialect(file).toml.replace('source = "step"', 'source = "preamble"')
    (tmp_path / "a.toml").write_text(toml)
    with pytest.raises(tl.TribolabError, match=r"is 10 before the first table and 20 before a"):
        tl.read(file, tmp_path / "a.toml")


def test_a_long_row_of_empty_cells_is_gone_through_once_for_marks_of_thousands():
    began = time.process_time()
    assert find_thousands(["\t" * 30_000, "1.234,5\t2"]) == "."
    assert time.process_time() - began < 1.0
