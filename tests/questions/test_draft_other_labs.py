"""Headers as other laboratories write them: few units, steps in cells, one column, marks."""

from __future__ import annotations

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.unknown.proposal.draft import draft_dialect

ROWS = 400


def noisy(level, seed):
    return level * (1 + 0.01 * np.random.default_rng(seed).standard_normal(ROWS))


def test_a_row_of_units_for_some_names_is_not_shifted(tmp_path):
    """In a table that blanks part a pure number has no unit, and the row of units is short."""
    time = 0.02 * np.arange(ROWS)
    rows = np.column_stack([time, noisy(6.0, 1), noisy(50.0, 2), noisy(0.12, 3), noisy(2.0, 4)])
    head = "Sliding speed = 25 mm/s\n       T        Fx        Fz       COF        AE\n"
    head += "     sec        mN         N                   V\n"
    text = head + "\n".join(" ".join(f"{x:9.4f}" for x in row) for row in rows) + "\n"
    (tmp_path / "run.txt").write_text(text, "utf-8")
    run = tl.read(tmp_path / "run.txt")
    assert float(run.friction_coefficient.mean()) == pytest.approx(0.12, rel=0.01)
    assert "friction_force" not in run and "'Fx' (friction_force, unit not" in run.attrs["left_out"]


@pytest.mark.parametrize(
    ("title", "unit"),
    [
        ("Palier {n}/3;{rpm};tr/min;;", "tr/min"),
        ("Step {n} of 3;Rotational speed;{rpm};min-1;", ""),
    ],
)
def test_a_rotation_stated_in_the_title_of_each_step_is_its_own(tmp_path, title, unit):
    """Where it stands in cells too, and in whatever way a turn a minute is written."""
    if not unit:
        title = title.replace(";Rotational speed;", "\tRotational speed ").replace(
            ";min-1;", " min-1"
        )
    blocks = ["Rayon de piste;15;mm;;"]
    for number, rpm in enumerate((30, 60, 120), start=1):
        blocks += [title.format(n=number, rpm=rpm), "Temps (s);Ft (N);Fn (N);T (°C)"]
        force = noisy(2.0 / number, number)
        blocks += [f"{0.1 * k:.1f};{f:.4f};10.0;21.0" for k, f in enumerate(force)]
    (tmp_path / "disc.csv").write_text("\n".join(blocks) + "\n", "latin-1")
    draft = draft_dialect(tmp_path / "disc.csv")
    assert not any("how fast it turns" in guess for guess in draft.guesses)
    run = tl.read(tmp_path / "disc.csv")
    assert run.attrs["speed_from"] == "stated"
    speed = [float(np.median(run.sliding_velocity[run.step == step])) for step in (1, 2, 3)]
    assert speed == pytest.approx([2 * np.pi * 0.015 * rpm / 60 for rpm in (30, 60, 120)])


def test_a_row_of_units_that_fills_one_cell_is_one(tmp_path):
    head = ["Normal load;15;N", "Oscillation frequency;2;Hz", "Stroke;8;mm", "Sampling rate;100;Hz"]
    head += ["Drive;crank;", "No.;Lateral force", " ;N"]
    phase = 2 * np.pi * 2 * 0.01 * np.arange(ROWS)
    rows = [f"{k};{x:.3f}" for k, x in enumerate(4.5 * np.sign(np.cos(phase)), start=1)]
    (tmp_path / "pin.csv").write_text("\n".join([*head, *rows]) + "\n", "utf-8")
    run = tl.read(tmp_path / "pin.csv")
    assert float(run.time[-1]) == pytest.approx((ROWS - 1) / 100)
    assert float(np.abs(run.friction_force).median()) == 4.5
    assert float(run.sliding_velocity.max()) == pytest.approx(np.pi * 0.008 * 2, rel=1e-3)


def test_names_behind_a_mark_of_comments_are_found_again_whatever_the_blanks(tmp_path):
    time = 0.01 * np.arange(ROWS)
    way = 1e-2 * np.abs((time % 2) - 1)
    rows = np.column_stack([time, 1e3 * way, noisy(2.0, 1), noisy(0.1, 2)])
    head = (
        "% linear slider\n% deadweight 2 N\n%\n% t [s]           x [mm]          Fn [N]   Ft [N]\n"
    )
    text = head + "\n".join("  " + "  ".join(f"{x:.7e}" for x in row) for row in rows) + "\n"
    (tmp_path / "sweep.txt").write_text(text, "utf-8")
    run = tl.read(tmp_path / "sweep.txt")
    assert float(run.position.max()) == pytest.approx(1e-2, rel=0.01)
    assert float(run.normal_force.mean()) == pytest.approx(2.0, rel=0.01)


def test_dates_that_two_forms_read_alike_are_no_guess(tmp_path):
    lines = ["日時,回転数,荷重,摩擦トルク", ",rpm,N,N・m"]
    lines += [f"2018/06/12 13:05:{k / 10:04.1f},100,300.0,0.5" for k in range(500)]
    (tmp_path / "ring.csv").write_text("\n".join(lines) + "\n", "cp932")
    with pytest.raises(ReadError) as told:
        tl.read(tmp_path / "ring.csv")
    assert "written" not in str(told.value) and "radius" in str(told.value)
    torque = draft_dialect(tmp_path / "ring.csv").understood.columns[3]
    assert torque.file_unit == "N・m"


def test_a_polish_header_gives_load_radius_and_the_speed_of_each_run(tmp_path):
    lines = ["Obciążenie P = 29,43 N   (odważnik 3 kg)", "Promień tarcia r = 14 mm"]
    for number, rpm in enumerate((40, 80), start=1):
        lines += [
            f"===== Bieg {number}   n = {rpm} obr/min =====",
            "Czas[s] Siła_tarcia[N] Temp[°C]",
        ]
        force = noisy(7.0 / number, number)
        rows = [f"{0.04 * k:8.2f} {f:8.4f}     22.0" for k, f in enumerate(force)]
        lines += [row.replace(".", ",") for row in rows]
    (tmp_path / "proba.txt").write_text("\n".join(lines) + "\n", "cp1250")
    run = tl.read(tmp_path / "proba.txt", draft_dialect(tmp_path / "proba.txt").dialect)
    assert float(run.normal_force[0]) == pytest.approx(29.43)
    speed = [float(np.median(run.sliding_velocity[run.step == step])) for step in (1, 2)]
    assert speed == pytest.approx([2 * np.pi * 0.014 * rpm / 60 for rpm in (40, 80)])


def test_a_unit_may_stand_behind_a_comma_of_what_is_stated(tmp_path):
    x = 0.5e-6 * np.arange(3000)
    height = (
        3 + 0.2 * np.sin(2 * np.pi * x / 1e-4) + 0.01 * np.random.default_rng(2).normal(size=3000)
    )
    head = ["Длина трассы, мм: 1,5", "Шаг дискретизации, мкм: 0,5", "Количество точек: 3000"]
    head += ["Ординаты профиля, мкм:"]
    values = [f"{z:.4f}".replace(".", ",") for z in height]
    (tmp_path / "трасса.txt").write_text("\n".join([*head, *values]) + "\n", "cp1251")
    scan = tl.read_scans(tmp_path / "трасса.txt", draft_dialect(tmp_path / "трасса.txt").dialect)
    assert float(scan.x[1] - scan.x[0]) == pytest.approx(0.5e-6)
    assert float(scan.height.mean()) == pytest.approx(3e-6, rel=0.01)


def test_a_layout_that_lacks_what_its_maker_writes_is_read_by_what_it_says_itself(tmp_path):
    """A high-speed export names the instrument, and its frequencies stand in the titles."""
    lines = ["SRV report", "Normalkraft [N];200", "Abtastrate [kHz];5"]
    for number, hertz in enumerate((10, 20), start=1):
        time = np.arange(2000) / 5e3
        way = -np.cos(2 * np.pi * hertz * time)
        force = np.sign(np.sin(2 * np.pi * hertz * time)) * (30 - hertz) * 1.0
        lines += ["", f"Aufzeichnung {number};Frequenz [Hz];{hertz}", "Zeit;Weg;Reibkraft"]
        lines += ["ms;mm;N"]
        rows = zip(1e3 * time, way, force, strict=True)
        lines += [f"{t:.1f};{x:.4f};{f:.2f}".replace(".", ",") for t, x, f in rows]
    (tmp_path / "srv.csv").write_text("\n".join(lines) + "\n", "utf-8")
    run = tl.read(tmp_path / "srv.csv")
    assert run.attrs["instrument"] == "drafted from the file"
    assert "optimol_srv" in run.attrs["known_layout_lacks"]
    mu = tl.friction_coefficient(run, tl.find_segments(run))
    fast = mu.sliding_speed > 0.09
    assert float(mu.friction_coefficient[~fast].mean()) == pytest.approx(20 / 200, rel=0.01)
    assert float(mu.friction_coefficient[fast].mean()) == pytest.approx(10 / 200, rel=0.01)


def test_a_layout_that_lacks_something_and_says_too_little_itself_is_refused(tmp_path):
    text = "SRV report\nZeit;Signal A;Reibkraft\ns;V;N\n"
    text += "".join(f"{n / 10};{n % 7};{5 + n % 3}\n" for n in range(50))
    (tmp_path / "srv.csv").write_text(text, "utf-8")
    with pytest.raises(ReadError, match="the stroke and the frequency is missing"):
        tl.read(tmp_path / "srv.csv")


@pytest.mark.parametrize(
    ("label", "quantity", "unit"),
    [
        ("rpm_set", "set_speed", "rpm"),
        ("rpm", "rotation_speed", "rpm"),
        ("RPM (enc)", "rotation_speed", "rpm"),
    ],
)
def test_names_that_are_or_end_in_their_unit_need_no_question(label, quantity, unit, tmp_path):
    rows = "\n".join(f"{n / 10},{60 + n % 3},{20 + n % 2}" for n in range(60))
    (tmp_path / "a.csv").write_text(f"Time [s],{label},Fz [N]\n{rows}\n", "utf-8")
    column = draft_dialect(tmp_path / "a.csv").understood.columns[1]
    assert (column.read_unit, column.fill_in) == (unit, "")
    assert column.quantity in (quantity, "rotation_speed")


@pytest.mark.parametrize("rig", ["Block on ring", "ブロックオンリング", "pin on disc"])
def test_the_ring_is_the_track_of_a_block_on_it(rig, tmp_path):
    head = f"Test rig: {rig}\nRing diameter,35,mm\n\nTime [s],Speed [rpm],Load [N],Torque [N m]\n"
    rows = "\n".join(f"{n / 10},100,{300 + n % 3},0.5" for n in range(ROWS))
    (tmp_path / "a.csv").write_text(f"{head}{rows}\n", "utf-8")
    if rig == "pin on disc":
        with pytest.raises(ReadError, match="twice the radius of the track"):
            tl.read(tmp_path / "a.csv")
        return
    run = tl.read(tmp_path / "a.csv")
    assert float(run.friction_force[0]) == pytest.approx(0.5 / 0.0175)
    assert float(run.sliding_velocity[0]) == pytest.approx(2 * np.pi * 100 / 60 * 0.0175)


def test_units_that_blanks_part_from_their_names_are_no_names_of_columns(tmp_path):
    rows = "\n".join(f"{n / 10:8.1f} {n % 9 / 2:8.2f} {3 + n % 2:6} {10:6}" for n in range(90))
    head = "Rig 7\nt [s]   x [mm]   Ft [N]   Fn [N]\n"
    (tmp_path / "a.txt").write_text(head + rows + "\n", "utf-8")
    labels = tl.read(tmp_path / "a.txt").attrs["columns_used"]
    assert labels == {
        "time": "t [s]",
        "position": "x [mm]",
        "friction_force": "Ft [N]",
        "normal_force": "Fn [N]",
    }


def test_what_pulls_a_sled_is_its_friction(tmp_path):
    rows = "\n".join(f"{n / 20:.2f},{n / 12:.3f},{0.47 + 0.01 * (n % 3):.3f}" for n in range(600))
    head = "Sled mass: 200 g\nTime (s),Extension (mm),Load (N)\n"
    (tmp_path / "film.csv").write_text(head + rows + "\n", "utf-8")
    run = tl.read(tmp_path / "film.csv")
    mu = tl.friction_coefficient(run, tl.find_segments(run)).friction_coefficient
    assert float(mu[0]) == pytest.approx(0.48 / (0.2 * 9.80665), rel=0.01)


def test_points_of_a_ramp_are_told_from_a_record_though_they_have_a_time(tmp_path):
    rows = "\n".join(f"{10 * n};{1.3**n:.5g};{5 - n / 10:.2f};10" for n in range(1, 30))
    head = "Time [s];Sliding speed [mm/s];Friction force [N];Normal force [N]\n"
    (tmp_path / "ramp.csv").write_text(head + rows + "\n", "utf-8")
    run = tl.read(tmp_path / "ramp.csv")
    found = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(found.friction_coefficient, [0.5 - n / 100 for n in range(1, 30)])
    assert np.isnan(found.friction_coefficient_sem).all()


@pytest.mark.parametrize(
    ("speed", "ratio", "sliding"),
    [("Mean speed", "SRR = 30 %", 0.3), ("Sliding speed", "SRR = 30 %", 1.0)]
    + [("Entrainment speed", "Slide-to-roll ratio: 0.5", 0.5)],
)
def test_a_stated_slide_to_roll_ratio_makes_the_sliding_of_the_mean_speed(
    speed, ratio, sliding, tmp_path
):
    rows = "\n".join(
        f"{n / 10},{100 if n < 200 else 400},30,{1.5 + n % 3 / 50}" for n in range(400)
    )
    head = f"Ball on disc\n{ratio}\nTime (s),{speed} (mm/s),Load (N),Traction force (N)\n"
    (tmp_path / "oil.csv").write_text(head + rows + "\n", "utf-8")
    found = tl.find_segments(tl.read(tmp_path / "oil.csv")).sliding_speed.values
    np.testing.assert_allclose(found, [0.1 * sliding, 0.4 * sliding])


def test_a_speed_beside_such_a_ratio_that_is_called_neither_is_asked_about(tmp_path):
    rows = "\n".join(f"{n / 10},{100},30,{1.5 + n % 3 / 50}" for n in range(400))
    head = "SRR = 30 %\nTime (s),Speed (mm/s),Load (N),Traction force (N)\n"
    (tmp_path / "oil.csv").write_text(head + rows + "\n", "utf-8")
    with pytest.raises(ReadError, match="mean speed of both surfaces"):
        tl.read(tmp_path / "oil.csv")


ZERO_HEAD = "Time [s];Torque [mNm];Load [N];Speed [rpm]"
ZERO_ROWS = "\n".join(f"{n / 10:.1f};{38 + n % 3 - 1};20;60" for n in range(300))


@pytest.mark.parametrize(
    ("remark", "mu"),
    [
        ("Remark: torque is not zero corrected", 0.14),
        ("Bemerkung;Drehmoment ist nicht nullpunktkorrigiert", 0.14),
        ("All signals are zero corrected", 0.152),
        ("", None),
    ],
)
def test_a_zero_that_the_text_states_is_taken_off_where_it_is_still_in_the_signal(
    remark, mu, tmp_path
):
    head = f"Track radius: 12.5 mm\nTorque zero [mNm]: 3.0\n{remark}\n\n{ZERO_HEAD}\n"
    (tmp_path / "disc.csv").write_text(head + ZERO_ROWS + "\n", "utf-8")
    if mu is None:
        with pytest.raises(
            ReadError, match="was taken off the signal .or it is still in the signal"
        ):
            tl.read(tmp_path / "disc.csv")
        return
    run = tl.read(tmp_path / "disc.csv")
    found = tl.friction_coefficient(run, tl.find_segments(run))
    assert float(found.friction_coefficient[0]) == pytest.approx(mu, rel=1e-3)
    assert np.isfinite(found.friction_coefficient_sem[0])
    read = mu == 0.14
    assert found.attrs["offset"].startswith("read zero" if read else "none")
    assert ("zeros_stated" in run.attrs) == read


@pytest.mark.parametrize(
    ("zero", "mu"),
    [
        ("Drehmoment Nullpunkt: 3,0 mNm (NICHT abgezogen)", 0.14),
        ("Torque zero: 3.0 mNm, to be subtracted", 0.14),
        ("Torque zero: 3.0 mNm (idle run, already subtracted)", 0.152),
        ("Zéro du couple : 3,0 mNm (déduit)", 0.152),
        ("Zéro du couple : 3,0 mNm (non déduit)", 0.14),
    ],
)
def test_the_line_of_the_zero_may_say_itself_whether_it_was_taken_off(zero, mu, tmp_path):
    head = f"Track radius: 12.5 mm\n{zero}\n\n{ZERO_HEAD}\n"
    (tmp_path / "disc.csv").write_text(head + ZERO_ROWS + "\n", "utf-8")
    run = tl.read(tmp_path / "disc.csv")
    assert float((run.friction_force / run.normal_force).mean()) == pytest.approx(mu, rel=1e-3)


def test_the_frequency_of_samples_is_none_of_the_strokes(tmp_path):
    force = np.where(np.arange(4000) % 200 < 100, 1.5, -1.5)
    head = "Course (crête à crête) : 4 mm\nFréquence : 2 Hz (bielle-manivelle)\nCharge : 12,5 N\n"
    head += "Fréquence d'échantillonnage : 400 Hz\nn°\tFt (N)\n"
    rows = "\n".join(f"{n}\t{f}" for n, f in enumerate(force))
    (tmp_path / "a.dat").write_text(f"{head}{rows}\n", "latin-1")
    run = tl.read(tmp_path / "a.dat")
    assert float(np.abs(run.sliding_velocity).max()) == pytest.approx(np.pi * 2 * 4e-3, rel=1e-3)
    assert float(run.normal_force[0]) == 12.5


def test_a_zero_of_a_force_is_taken_off_its_column_and_one_of_the_load_is_not(tmp_path):
    rows = "\n".join(f"{n / 10:.1f},{6.5 + n % 3 / 100},20,5" for n in range(300))
    table = f"\nTime [s],Friction force [N],Normal force [N],Speed [mm/s]\n{rows}\n"
    remark = "Friction not zero corrected\n"
    (tmp_path / "a.csv").write_text(f"Friction offset: 0.5 N\n{remark}{table}", "utf-8")
    assert float(tl.read(tmp_path / "a.csv").friction_force.mean()) == pytest.approx(6.01)
    (tmp_path / "b.csv").write_text(f"Load offset: 0.5 N\n{remark}{table}", "utf-8")
    assert float(tl.read(tmp_path / "b.csv").friction_force.mean()) == pytest.approx(6.51)


def test_the_version_of_a_file_is_no_lever(tmp_path):
    rows = "\n".join(f"{n / 10:.1f},{6.5 + n % 3 / 100},20,5" for n in range(300))
    table = f"Time [s],Friction force [N],Normal force [N],Speed [mm/s]\n{rows}\n"
    (tmp_path / "a.csv").write_text(f"File version : 2.3\nAgainst steel: 2\n{table}", "utf-8")
    tl.read(tmp_path / "a.csv")
    (tmp_path / "b.csv").write_text(f"Lever arm: 2.3\n{table}", "utf-8")
    with pytest.raises(ReadError, match="not times 'Lever arm: 2.3'"):
        tl.read(tmp_path / "b.csv")


@pytest.mark.parametrize(
    ("stroke", "length"), [("Stroke: ±4 mm", 8e-3), ("Stroke amplitude: +/- 4 mm", 8e-3)]
)
def test_a_stroke_either_way_from_the_middle_is_half_of_it(stroke, length, tmp_path):
    t = np.arange(2000) / 200
    rows = "\n".join(f"{a:.3f},{f:.1f}" for a, f in zip(t, np.sign(np.sin(6.283 * t)), strict=True))
    head = f"{stroke}\nFrequency: 1 Hz\nCrank drive\nTime [s],Friction force [N]\n"
    (tmp_path / "a.csv").write_text(head + rows + "\n", "utf-8")
    assert tl.read(tmp_path / "a.csv").attrs["stroke_m"] == pytest.approx(length)


SHAFT = "\n".join(
    f"1;{n / 2:.1f};{200 + n % 3};{0.9 + n % 4 / 100}".replace(".", ",") for n in range(300)
)


@pytest.mark.parametrize(
    "head",
    [
        "Wellendichtring-Prüfstand\nWellendurchmesser;80,0;mm\nRadialkraft (Mittel);46,0;N",
        "Rotary lip seal rig\nShaft dia. 80 mm, total radial force 46 N",
        "Gleitlager, Wellendurchmesser 80 mm\nRadiallast: 46 N",
        "旋转油封试验台\n轴径;80 mm\n唇口径向力(总);46 N",
    ],
)
def test_a_seal_or_bearing_slides_on_its_shaft(head, tmp_path):
    table = f"Stufe;Zeit [s];Drehzahl [1/min];Reibmoment [Nm]\n{SHAFT}\n"
    (tmp_path / "seal.csv").write_text(f"{head}\n\n{table}", "utf-8")
    run = tl.read(tmp_path / "seal.csv")
    assert float(run.sliding_velocity.mean()) == pytest.approx(np.pi * 0.08 * 201 / 60, rel=1e-3)
    assert float((run.friction_force / run.normal_force).mean()) == pytest.approx(
        0.915 / 0.04 / 46, rel=1e-3
    )


def test_a_ring_s_size_may_stand_behind_it_and_a_lever_s_load_behind_the_lever(tmp_path):
    rows = "\n".join(f"{n / 60:.4f},72,{4.4 + n % 3 / 100}" for n in range(300))
    head = '"BLOCK-ON-RING TEST","",""\n"Ring: SAE 4620, 35 mm O.D., width 8 mm","",""\n'
    head += '"Dead wt. on rod 3.00 lb, lever ratio 10:1 ==> LOAD ON BLOCK 30.0 LBF","",""\n'
    table = f'"Elapsed","Ring Speed","FRICTION"\n"(min)","(rpm)","(lbf)"\n{rows}\n'
    (tmp_path / "lfw.csv").write_text(head + table)
    run = tl.read(tmp_path / "lfw.csv")
    assert float(run.normal_force[0]) == pytest.approx(30 * 4.4482216, rel=1e-6)
    assert float(run.sliding_velocity[0]) == pytest.approx(np.pi * 0.035 * 72 / 60, rel=1e-6)


@pytest.mark.parametrize(
    ("said", "wrong"),
    [
        ("Stroke: 10 mm\nFrequency: 2 Hz\nNumber of cycles: 30\n", None),
        ("Stroke: 20 mm\nFrequency: 2 Hz\n", "states 20 mm strokes, its position signal shows"),
        ("Stroke: 10 mm\nFrequency: 4 Hz\n", "states 4 Hz, its position signal shows"),
        ("Stroke: 10 mm\nFrequency: 2 Hz\nCycles: 60\n", "states 60 cycles"),
    ],
)
def test_strokes_that_a_file_states_are_held_against_its_position(said, wrong, tmp_path):
    time = np.arange(7500) / 500
    phase = 2 * np.pi * 2 * time
    force = 6 * np.sign(np.cos(phase)) + 0.05 * np.sin(7 * time)
    rows = "\n".join(
        f"{t:.3f},{5 * s:.4f},{f:.4f}" for t, s, f in zip(time, np.sin(phase), force, strict=True)
    )
    head = f"Load: 20 N\n{said}Time [s],Position [mm],Friction force [N]\n"
    (tmp_path / "a.csv").write_text(head + rows + "\n")
    rows = [row for row in tl.check(tl.read(tmp_path / "a.csv")).rows]
    told = [
        r["message"] for r in rows if r["status"] == "suspect" and r["check"] == "said_elsewhere"
    ]
    assert (not told) if wrong is None else (len(told) == 1 and wrong in told[0])


def test_the_first_sample_of_a_step_is_no_spike(tmp_path):
    force = 6.5 + 0.01 * np.random.default_rng(1).normal(size=300)
    force[[100, 200]] = 2.0  # at rest still
    rows = "\n".join(f"{1 + n // 100},{n / 10:.1f},{f:.4f},20,5" for n, f in enumerate(force))
    head = "Step,Time [s],Friction force [N],Normal force [N],Speed [mm/s]\n"
    (tmp_path / "a.csv").write_text(head + rows + "\n")
    found = tl.check(tl.read(tmp_path / "a.csv")).rows
    assert [r["status"] for r in found if r["check"] == "spikes"] == ["pass", "pass"]
