"""Rigs that turn: what their files say of contacts, arms, radii, surfaces, loads and zeros."""

from __future__ import annotations

import numpy as np
import pytest

import tribolab as tl
from tribolab.reading.unknown.proposal.answers import corrected
from tribolab.reading.unknown.proposal.questions import GuessedError

HOLD = 40  # rows at each speed
TURNS = (0.0, 60.0, 120.0, 240.0)  # 1/min


def columns(*, friction, load=10.0, turns=TURNS, noise=0.002, seed=1):
    """Return times, turns, friction, load (row) at each speed, without slope, with some noise."""
    rng = np.random.default_rng(seed)
    rpm = np.repeat(turns, HOLD)
    moving = rpm > 0
    signal = friction * moving * (1 + noise * rng.standard_normal(rpm.size))
    pressed = load * (1 + noise * rng.standard_normal(rpm.size))
    return 0.1 * np.arange(rpm.size), rpm, signal, pressed


def written(path, above, header, rows, *, delimiter="\t", encoding="utf-8", formats="%.6g"):
    """Write a file of some lines, a header and rows, and return its path."""
    formats = [formats] * len(rows) if isinstance(formats, str) else formats
    body = [
        delimiter.join(
            f % cell if isinstance(f, str) else f(cell)
            for f, cell in zip(formats, row, strict=True)
        )
        for row in zip(*rows, strict=True)
    ]
    text = "\n".join([*above, "", *([header] if isinstance(header, str) else header), *body])
    path.write_text(text + "\n", encoding=encoding)
    return path


def coefficient(run):
    """Return the median coefficient while it slides."""
    fast = np.abs(run.sliding_velocity) > 0.5 * np.abs(run.sliding_velocity).max()
    return float((run.friction_force / run.normal_force)[fast].median())


@pytest.mark.parametrize(
    ("said", "share"),
    [
        ("Cell: ball on 3 plates", 0.70711),
        ("Messsystem: Kugel auf drei Platten, 45°", 0.70711),
        ("bille sur trois plans", 0.70711),
        ("Geometry\tball-on-pyramid", 0.70711),
        ("Four-ball wear test ASTM D5183", 0.81650),
        ("Vierkugelapparat", 0.81650),
        ("四球摩擦试验机", 0.81650),
    ],
)
def test_contacts_at_an_angle_carry_more_than_the_axial_force(said, share, tmp_path):
    time, rpm, torque, axial = columns(friction=8.0)
    above = [said, "Contact radius: 4.5 mm"]
    header = "Time [s]\tSpeed [1/min]\tTorque [mN m]\tNormal Force [N]"
    run = tl.read(written(tmp_path / "a.txt", above, header, (time, rpm, torque, axial)))
    assert coefficient(run) == pytest.approx(8e-3 / 4.5e-3 / 10 * share, rel=2e-3)


def test_a_stated_axial_load_is_shared_by_the_contacts_of_four_balls(tmp_path):
    time, rpm, torque, _ = columns(friction=80.0)
    above = ["Four ball tester", "Load: 392 N", "Ball diameter: 12.7 mm"]
    header = "Time [s]\tSpeed [1/min]\tTorque [mN m]"
    run = tl.read(written(tmp_path / "a.txt", above, header, (time, rpm, torque)))
    assert coefficient(run) == pytest.approx(2**0.5 * 0.08 / (6.35e-3 * 392), rel=2e-3)
    assert float(run.sliding_velocity.max()) == pytest.approx(
        8 * np.pi * 6.35e-3 / 3**0.5, rel=1e-3
    )


def test_an_angle_of_contacts_that_is_not_said_is_asked(tmp_path):
    time, rpm, torque, axial = columns(friction=8.0)
    above = ["balls on cone", "Track radius: 4.5 mm"]
    header = "Time [s]\tSpeed [1/min]\tTorque [mN m]\tNormal Force [N]"
    with pytest.raises(GuessedError, match="cosine"):
        tl.read(written(tmp_path / "a.txt", above, header, (time, rpm, torque, axial)))


TWIN = {
    "Chinese": (
        "上试样直径(mm):\t40",
        "下试样直径(mm):\t40",
        "上试样转速(r/min)",
        "下试样转速(r/min)",
    ),
    "German": ("Durchmesser obere Rolle: 40 mm", "Durchmesser untere Rolle: 40 mm")
    + ("Drehzahl oben [1/min]", "Drehzahl unten [1/min]"),
    "English": ("Twin-disc machine", "Disc diameter: 40 mm", "Speed 1 [rpm]", "Speed 2 [rpm]"),
    "Hertz": ("Driving roller radius: 20 mm", "Driven roller radius: 20 mm")
    + ("Driving roller [Hz]", "Driven roller [Hz]"),
}


@pytest.mark.parametrize("language", TWIN)
def test_two_rollers_slide_at_the_difference_of_their_surfaces(language, tmp_path):
    *above, one, other = TWIN[language]
    time, rpm, torque, load = columns(friction=1.2, load=400)
    speeds = (1.02 * rpm, rpm)
    speeds = [speed / 60 for speed in speeds] if "Hz" in one else speeds
    header = f"Time [s]\t{one}\t{other}\tTorque [N m]\tLoad [N]"
    path = written(tmp_path / "a.txt", above, header, (time, *speeds, torque, load))
    run = tl.read(path)
    assert float(run.sliding_velocity.max()) == pytest.approx(0.02 * 8 * np.pi * 0.02, rel=1e-3)
    assert float(run.rolling_speed.max()) == pytest.approx(1.01 * 8 * np.pi * 0.02, rel=1e-3)
    assert coefficient(run) == pytest.approx(1.2 / 0.02 / 400, rel=2e-3)


def test_two_numbered_speeds_are_asked_about(tmp_path):
    time, rpm, torque, load = columns(friction=1.2, load=400)
    header = "Time [s]\tSpeed 1 [rpm]\tSpeed 2 [rpm]\tTorque [N m]\tLoad [N]"
    above = ["Disc diameter: 40 mm"]
    path = written(tmp_path / "a.txt", above, header, (time, 1.006 * rpm, rpm, torque, load))
    with pytest.raises(GuessedError, match="slide at the difference"):
        tl.read(path)


def test_a_ball_on_a_disc_slides_at_the_difference_of_both_speeds(tmp_path):
    time, rpm, force, load = columns(friction=1.5)
    header = "Time [s]\tDisc Speed [mm/s]\tBall Speed [mm/s]\tTraction [N]\tLoad [N]"
    path = written(tmp_path / "a.txt", ["MTM"], header, (time, rpm, 0.8 * rpm, force, load))
    run = tl.read(path)
    assert float(run.sliding_velocity.max()) == pytest.approx(0.2 * 0.24)
    assert float(run.rolling_speed.max()) == pytest.approx(0.9 * 0.24)


@pytest.mark.parametrize(
    ("name", "length", "kept"),
    [
        ("Reibweg [m]", lambda t, rpm: np.cumsum(np.abs(rpm)) * 2 * np.pi / 600 * 0.02, False),
        ("Sliding distance [m]", lambda t, rpm: np.cumsum(rpm) * 2 * np.pi / 600 * 0.02, True),
        ("Displacement [um]", lambda t, rpm: 0.1 * t + 0.5 * np.sin(t), False),
        ("Przemieszczenie liniowe [µm]", lambda t, rpm: 3 * t**0.5, False),
    ],
)
def test_the_turns_tell_whether_a_length_is_the_way(name, length, kept, tmp_path):
    time, rpm, friction, load = columns(friction=4.0, turns=(0.0, 60.0, -60.0, 120.0))
    header = f"Time [s]\tDisc [rpm]\tFriction [N]\tLoad [N]\t{name}"
    above = ["POD", "Track radius: 20 mm"]
    rows = (time, rpm, np.sign(rpm) * friction, load, length(time, rpm))
    run = tl.read(written(tmp_path / "a.txt", above, header, rows))
    assert ("position" in run) == kept
    assert float(run.sliding_velocity.max()) == pytest.approx(4 * np.pi * 0.02)


def test_a_seal_on_a_shaft_has_its_load_its_drag_and_a_clock_of_days(tmp_path):
    time, rpm, torque, _ = columns(friction=40.0, noise=1e-4)
    above = ["Banco prova paraolio", "Albero: Ø 80 mm, C45 temprato, Ra 0,3 µm"]
    above += ["Carico radiale totale del labbro (misurato a parte): 20,0 N"]
    above += ["Coppia a vuoto senza anello: 1,8 N·cm (da sottrarre)"]
    header = "Data/ora;Velocità albero [giri/min];Coppia [N·cm];T olio [°C]"
    days = 44987.36458333 + time / 86400
    rows = (days, rpm, torque + 1.8, 24 + 0 * time)
    path = written(tmp_path / "a.csv", above, header, rows, delimiter=";", formats="%.8f")
    path.write_text(path.read_text("utf-8").replace(".", ",").replace("1,8", "1,8"), "utf-8")
    run = tl.read(path)
    assert coefficient(run) == pytest.approx(0.4 / 0.04 / 20, rel=2e-3)
    assert float(run.time[-1]) == pytest.approx(time[-1], abs=1e-3)


@pytest.mark.parametrize(
    "said",
    [
        '"Charge";"masses posées 5 kg, rapport de levier 10:1"',
        "Load: dead weight 5 kg, lever 1:10",
        "Belastung: Gewichte 5 kg am Hebel 10:1",
    ],
)
def test_a_weight_on_a_lever_is_asked_about(said, tmp_path):
    time, rpm, torque, _ = columns(friction=0.86)
    above = [
        "Essai bloc sur anneau",
        '"Anneau";"acier 4620, diamètre 35 mm, largeur 8,74 mm"',
        said,
    ]
    path = written(tmp_path / "a.txt", above, "Time [s]\tn [1/min]\tM [N m]", (time, rpm, torque))
    with pytest.raises(GuessedError, match="not times"):
        tl.read(path)


def test_of_a_torque_in_divisions_only_what_one_is_worth_is_missing(tmp_path):
    time, rpm, torque, load = columns(friction=40.0, load=50.0)
    above = ["Схема: ролик - колодка. Ролик диаметром 50 мм, сталь 45; колодка - баббит"]
    header = "Время, с;n, об/мин;P, кгс;Mтр, дел.;t, °C"
    rows = (time, rpm, load, torque, 30 + 0 * time)
    path = written(tmp_path / "a.txt", above, header, rows, delimiter=";", encoding="cp1251")
    with pytest.raises(GuessedError) as error:
        tl.read(path)
    assert not error.value.asked
    assert [lack[:40] for lack in error.value.lacks] == [
        "what one number of the torque 'Mтр, дел.'"[:40]
    ]
    draft = corrected(tl.reading.draft_dialect(path), "torque", 4, "N m", scale=0.0125)
    run = tl.read(path, draft.dialect)
    assert coefficient(run) == pytest.approx(40 * 0.0125 / 0.025 / (50 * 9.80665), rel=2e-3)


@pytest.mark.parametrize("unit", ["dev/dk", "об/мин", "ot/min", "U/min", "giri/min", "r/min"])
def test_turns_a_minute_are_read_in_many_languages(unit, tmp_path):
    time, rpm, friction, load = columns(friction=4.0)
    header = f"Time [s]\tn ({unit})\tFriction [N]\tLoad [N]"
    above = ["POD", "Track radius: 20 mm"]
    run = tl.read(written(tmp_path / "a.txt", above, header, (time, rpm, friction, load)))
    assert float(run.sliding_velocity.max()) == pytest.approx(8 * np.pi * 0.02)


@pytest.mark.parametrize(
    ("rig", "size"),
    [
        ("Stanowisko: klocek-pierścień KP-35", "Średnica pierścienia: 35,00 mm"),
        ("Prüfstand: Klotz-Ring", "Ringdurchmesser: 35,00 mm"),
        ("Banc bloc-anneau", "Diamètre de l'anneau : 35,00 mm"),
        ("Stroj: kroužek-blok", "Průměr kroužku: 35,00 mm"),
    ],
)
def test_a_block_slides_on_the_outside_of_its_ring_in_any_language(tmp_path, rig, size):
    time, rpm, force, _ = columns(friction=30.0)
    torque = 0.0175 * force
    head = "t [s]\tn [1/min]\tM [N·m]"
    above = [rig, size, "Fn = 300 N"]
    run = tl.read(written(tmp_path / "a.txt", above, head, [time, rpm, torque]))
    np.testing.assert_allclose(run.friction_force, force, rtol=1e-4, atol=1e-3)
    top = TURNS[-1] * 2 * np.pi / 60 * 0.0175
    assert float(run.sliding_velocity.max()) == pytest.approx(top, rel=1e-4)


@pytest.mark.parametrize(
    ("inner", "outer"),
    [
        ("Ring inner radius 14 mm", "Ring outer radius 16 mm"),
        ("Innendurchmesser (mm): 28", "Außendurchmesser (mm): 32"),
        ("リング内径 28 mm", "リング外径 32 mm"),
        ("Diamètre intérieur : 28 mm", "Diamètre extérieur : 32 mm"),
    ],
)
def test_a_ring_on_its_face_slides_at_the_mean_of_both_radii(tmp_path, inner, outer):
    time, rpm, force, load = columns(friction=3.0, load=10.0)
    head = "t [s]\tn [1/min]\tTorque [N·m]\tLoad [N]"
    rows = [time, rpm, 0.015 * force, load]
    run = tl.read(written(tmp_path / "a.txt", [inner, outer], head, rows))
    np.testing.assert_allclose(run.friction_force, force, rtol=1e-4, atol=1e-3)
    np.testing.assert_allclose(
        run.sliding_velocity, rpm * 2 * np.pi / 60 * 0.015, rtol=1e-4, atol=1e-9
    )


def test_a_wide_ring_is_asked_about_and_a_stated_mean_radius_goes_before(tmp_path):
    time, rpm, force, load = columns(friction=3.0)
    head = "t [s]\tn [1/min]\tTorque [N·m]\tLoad [N]"
    rows = [time, rpm, 0.015 * force, load]
    wide = ["Inner radius: 8 mm", "Outer radius: 22 mm"]
    with pytest.raises(GuessedError, match="friction acts at the mean of the inner and the outer"):
        tl.read(written(tmp_path / "a.txt", wide, head, rows))
    said = ["Inner radius: 14 mm", "Outer radius: 16 mm", "Mean radius of the track: 15.1 mm"]
    run = tl.read(written(tmp_path / "b.txt", said, head, rows))
    assert run.attrs["speed_from"] == "rotation"
    assert float(run.friction_force[-1]) == pytest.approx(0.015 / 0.0151 * force[-1], rel=1e-3)


def test_a_torque_in_letters_of_another_script_is_a_torque(tmp_path):
    time, rpm, force, _ = columns(friction=3.0)
    above = ["Диаметр вала, мм: 50,0", "Радиальное усилие манжеты на вал, Н: 34,0"]
    above.insert(0, "Стенд для испытания манжетных уплотнений")
    head = ["Время\tЧастота вращения\tМомент трения", "с\tоб/мин\tН·м"]
    rows = [time, rpm, 0.025 * force]
    run = tl.read(written(tmp_path / "a.txt", above, head, rows))
    np.testing.assert_allclose(run.friction_force, force, rtol=1e-4, atol=1e-3)
    assert float(run.normal_force[0]) == 34.0


def test_a_mean_speed_beside_a_ratio_in_a_column_is_no_sliding_speed(tmp_path):
    time, _, force, load = columns(friction=3.0)
    speed, ratio = np.repeat([200.0, 500.0, 1000.0, 2000.0], HOLD), np.full(time.size, 50.0)
    head = "Tiempo (s);Velocidad media (mm/s);SRR (%);Carga (N);Fuerza de tracción (N)"
    rows = [time, speed, ratio, load, force]
    run = tl.read(written(tmp_path / "a.csv", ["Ensayo"], head, rows, delimiter=";"))
    np.testing.assert_allclose(run.sliding_velocity, 0.5e-3 * speed, rtol=1e-6)
    np.testing.assert_allclose(run.friction_force, force, rtol=1e-4, atol=1e-3)


def test_the_set_point_of_a_load_that_is_held_is_kept_and_of_another_is_not(tmp_path):
    time, rpm, force, load = columns(friction=3.0)
    head = "t [s]\tn [1/min]\tFriction force [N]\tNormal force [N]"
    for stated, kept in ((10.0, True), (15.0, False)):
        above = ["Track radius: 20 mm", f"Normal force (set): {stated} N"]
        run = tl.read(written(tmp_path / f"{stated}.txt", above, head, [time, rpm, force, load]))
        assert ("set_normal_force_N" in run.attrs) == kept
