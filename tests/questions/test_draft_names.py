"""Names of columns in seven languages, and those that programs make of devices and channels."""

import io

import numpy as np
import pytest
from drafts import drafted
from rich.console import Console

import tribolab as tl
from tribolab.qc.run.checks import check_run
from tribolab.reading.lexicon.lexicon import known_words, normalise_label
from tribolab.reading.unknown.proposal.draft import draft_dialect
from tribolab.reading.unknown.proposal.questions import questions
from tribolab.reading.unknown.proposal.show import print_draft

TABLES = {
    "French": "Temps (s);Force de frottement (N);Charge (N);Vitesse de glissement (mm/s);"
    "Déplacement (mm)",
    "Spanish": "Tiempo [s];Fuerza de fricción [N];Carga [N];Velocidad [mm/s];Posición [mm]",
    "Italian": "Tempo [s];Forza di attrito [N];Forza normale [N];Velocità [mm/s];Spostamento [mm]",
    "Chinese": "时间（s）;摩擦力（N）;法向载荷（N）;滑动速度（mm/s）;位移（mm）",
    "Japanese": "時間[s];摩擦力[N];垂直荷重[N];すべり速度[mm/s];変位[mm]",
    "German": "Zeit [s];Reibkraft [N];Anpresskraft [N];Gleitgeschwindigkeit [mm/s];Weg [mm]",
    "symbols": "t [s];Ftan [N];Fn [N];Vx [mm/s];enc [mm]",
    "devices": "DAQ.Time [s];DAQ.Fx [N];DAQ.Fz [N];Stage.Velocity [mm/s];Stage.X [mm]",
    "Polish": "Czas [s];Siła tarcia [N];Siła nacisku [N];Prędkość [mm/s];Położenie [mm]",
    "Portuguese": "Tempo [s];Força de atrito [N];Força normal [N];Velocidade [mm/s];Posição [mm]",
    "Russian": "Время, с;Сила трения, Н;Нагрузка, Н;Скорость, мм/с;Перемещение, мм",
    "Korean": "시간 [s];마찰력 [N];수직하중 [N];속도 [mm/s];변위 [mm]",
    "Turkish": "Zaman [s];Sürtünme kuvveti [N];Normal kuvvet [N];Hız [mm/s];Konum [mm]",
    "Czech": "Čas [s];Třecí síla [N];Normálová síla [N];Rychlost [mm/s];Poloha [mm]",
    "Swedish": "Tid [s];Friktionskraft [N];Normalkraft [N];Hastighet [mm/s];Förskjutning [mm]",
}
STAGES = ((1, 10), (2, 30), (3, 100))
QUANTITIES = ["time", "friction_force", "normal_force", "sliding_velocity", "position"]


@pytest.mark.parametrize("language", TABLES)
def test_a_header_is_understood_without_a_guess_in_any_of_the_languages(language, tmp_path):
    file = tmp_path / "table.txt"
    rows = "\n".join(f"{n / 10};{n % 3};30;{5 + n % 2};{n / 2}" for n in range(30))
    file.write_text(f"{TABLES[language]}\n{rows}\n", encoding="utf-8")
    data, draft = drafted(file, tmp_path)
    assert [column.quantity for column in draft.understood.columns] == QUANTITIES
    assert (draft.guesses, dict(draft.to_fill_in)) == ((), {})
    np.testing.assert_allclose(data.friction_force, [n % 3 for n in range(30)])
    np.testing.assert_allclose(data.position, [n / 2000 for n in range(30)])


@pytest.mark.parametrize(
    ("head", "quantity", "guesses"),
    [
        ("t/s;Ff/N;Fn/N;v/(mm/s)", "friction_force", 0),
        ("t [s];Ff/N;Fn [N];v [mm/s]", "friction_force", 1),
        ("t [s];F_R/F_N;Fn [N];v [mm/s]", "friction_coefficient", 0),
        ("t [s];F/N [-];Fn [N];v [mm/s]", "friction_coefficient", 0),
    ],
)
def test_a_stroke_parts_a_unit_or_divides_by_the_load(head, quantity, guesses, tmp_path):
    """Ff/N is the force in newton beside t/s; alone it may be the coefficient, and is asked."""
    file = tmp_path / "table.txt"
    ratio = quantity == "friction_coefficient"
    rows = "\n".join(f"{n / 10};{0.3 if ratio else 9 + n % 2};30;5" for n in range(30))
    file.write_text(f"{head}\n{rows}\n")
    _, draft = drafted(file, tmp_path)
    assert draft.understood.columns[1].quantity == quantity
    assert (len(draft.guesses), dict(draft.to_fill_in)) == (guesses, {})


def test_the_axes_of_a_stage_are_no_sliding_position_where_something_turns(tmp_path):
    file = tmp_path / "disc.csv"
    head = "Time [s],DAQ.Ft [N],DAQ.Fn [N],Stage.X [mm],Rotary.Velocity [rpm]"
    file.write_text(head + "\n" + "\n".join(f"{n / 10},{n % 3},30,{n},60" for n in range(30)))
    data, draft = drafted(file, tmp_path)
    assert "position" not in data and draft.dialect.speed.source == "none"
    np.testing.assert_allclose(data.rotation_speed, 2 * np.pi)
    file.write_text(file.read_text().replace(",Rotary.Velocity [rpm]", ",Oil [degC]"))
    assert drafted(file, tmp_path / "..")[0].position.values[-1] == pytest.approx(0.029)


@pytest.mark.parametrize("name", ["Load Cell", "Force", "Kraft", "力"])
def test_a_force_that_may_be_another_is_a_guess(name, tmp_path):
    file = tmp_path / "gauge.csv"
    file.write_text(f"Time [s],{name} [N]\n0,1\n1,2\n2,2\n", encoding="utf-8")
    draft = draft_dialect(file)
    assert draft.understood.columns[1].quantity == "friction_force"
    assert any("the name means friction force" in guess for guess in draft.guesses)


def test_the_vocabulary_is_written_as_names_are_compared_and_says_nothing_twice():
    for words in (known_words("run"), known_words("scan")):
        for word in words:
            for text in (*word.symbols, *word.stems, *word.vague):
                assert normalise_label(text) == text
            assert len(set(word.stems)) == len(word.stems)


def test_marks_of_kana_stay_and_accents_go():
    assert normalise_label("すべり速度 [ｍｍ]") == "すべり速度mm"
    assert normalise_label("すへり速度") != normalise_label("すべり速度")
    assert normalise_label("Coefficient d’attrito È") == "coefficientdattritoe"


@pytest.mark.parametrize(
    ("language", "encoding"),
    [("Chinese", "gbk"), ("Chinese", "gb18030"), ("Japanese", "shift_jis"), ("French", "latin-1")]
    + [("Russian", "cp1251"), ("Korean", "cp949")],
)
def test_a_header_is_read_in_the_encoding_of_the_place(language, encoding, tmp_path):
    file = tmp_path / "table.txt"
    rows = "\n".join(f"{n / 10};{n % 3};30;{5 + n % 2};{n / 2}" for n in range(30))
    file.write_bytes(f"{TABLES[language]}\n{rows}\n".encode(encoding))
    data, draft = drafted(file, tmp_path)
    assert [column.quantity for column in draft.understood.columns] == QUANTITIES
    np.testing.assert_allclose(data.friction_force, [n % 3 for n in range(30)])
    np.testing.assert_array_equal(tl.read(file).position, data.position)


def test_laps_without_a_clock_have_the_stated_speed_and_not_that_of_their_rows(tmp_path):
    file = tmp_path / "laps.txt"
    rows = "\n".join(
        f"{n};{n * 2 * np.pi * 0.01:.4f};{0.3 + 0.01 * (n % 3)}" for n in range(1, 200)
    )
    file.write_text(f"Linear speed: 5 cm/s\nLap;Distance [m];COF\n{rows}\n")
    data, draft = drafted(file, tmp_path)
    assert 'source = "position"' in draft.toml  # the way over the stated speed is the clock
    assert not draft.guesses
    [speed] = tl.find_segments(data).sliding_speed.values
    assert speed == pytest.approx(0.05)


def test_of_a_cell_of_six_axes_the_larger_force_is_proposed(tmp_path):
    """Across the motion a cell shows noise and cross-talk; which one is meant is asked."""
    file = tmp_path / "cell.csv"
    rows = "\n".join(f"{n / 10},{0.02 * (n % 2)},{7 + n % 2},30,5" for n in range(50))
    file.write_text(f"Time [s],Fx [N],Fy [N],Fz [N],v [mm/s]\n{rows}\n")
    _, draft = drafted(file, tmp_path)
    [column] = [c for c in draft.understood.columns if c.quantity == "friction_force" and c.used]
    assert column.label == "Fy [N]" and draft.guesses


def test_a_coefficient_stands_under_the_load_that_the_text_states(tmp_path):
    file = tmp_path / "cof.txt"
    rows = "\n".join(f"{n / 10};2;0.3" for n in range(50))
    file.write_text(f"Normal load: 5 N\nTime [s];Speed [mm/s];COF\n{rows}\n")
    data, draft = drafted(file, tmp_path)
    assert data.attrs["set_normal_force_N"] == 5 and not draft.guesses
    assert "normal_force" not in data


@pytest.mark.parametrize(
    ("text", "quantity", "unit"),
    [
        ("TIME(S),POSITION(CM),FRICTION(N)", "position", "cm"),
        ("Sled weight: 3 kg\nTime [s],Load [N],Extension [mm]", "friction_force", "N"),
    ],
)
def test_units_and_forces_are_told_by_what_stands_around_them(text, quantity, unit, tmp_path):
    file = tmp_path / "table.csv"
    rows = "\n".join(f"{n / 10},{9 + n % 3},{5 + n % 2}" for n in range(60))
    file.write_text(f"{text}\n{rows}\n")
    _, draft = drafted(file, tmp_path)
    column = draft.understood.columns[1]
    assert (column.quantity, column.read_unit, column.used) == (quantity, unit, True)


def test_n_is_the_number_of_the_row_where_it_goes_on_by_one(tmp_path):
    file = tmp_path / "table.csv"
    rows = "\n".join(f"{n},{n / 10},5,{9 + n % 3}" for n in range(60))
    file.write_text(f"n,Time [s],v [mm/s],Ff [N]\n{rows}\n")
    assert not drafted(file, tmp_path)[1].guesses


def test_a_stated_rotation_and_radius_make_the_speed_of_each_step(tmp_path):
    file = tmp_path / "stages.csv"
    rows = "\n".join(f"{n / 10},{9 + n % 3}" for n in range(100))
    parts = (f"*** STAGE {k} SPEED {rpm} RPM ***\nTime [s],Ff [N]\n{rows}" for k, rpm in STAGES)
    file.write_text("Track dia 24 mm\nLoad 30 N\n" + "\n".join(parts) + "\n")
    data, draft = drafted(file, tmp_path)
    assert not any("how fast it turns" in guess for guess in draft.guesses)
    assert data.attrs["speed_from"] == "stated"
    speeds = [2 * np.pi * rpm / 60 * 0.012 for _, rpm in STAGES]
    np.testing.assert_allclose(tl.find_segments(data).sliding_speed, speeds, rtol=1e-6)


@pytest.mark.parametrize("order", [slice(None), slice(None, None, -1)], ids=["up", "down"])
def test_each_row_of_a_table_of_results_is_a_point_of_the_curve(tmp_path, order):
    file = tmp_path / "results.csv"
    speed, mu = [2**n for n in range(8)][order], [0.4 - 0.03 * n for n in range(8)][order]
    rows = "\n".join(f"{v},20,{m}" for v, m in zip(speed, mu, strict=True))
    file.write_text(f"Speed (mm/s),Load (N),COF\n{rows}\n")
    run = tl.read(file)
    assert run.attrs["rows_are"] == "points"
    found = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(found.sliding_speed, 1e-3 * np.array(speed))
    np.testing.assert_allclose(found.friction_coefficient, mu)
    assert np.isnan(found.friction_coefficient_sem).all()
    curve = tl.measured_stribeck_curve([found])
    assert np.isnan(curve.friction_coefficient_u).all()  # of one run nothing is known of it
    other = found.assign(
        friction_coefficient=found.friction_coefficient + 0.01 * (found.sliding_speed == 0.008)
    )
    both = tl.measured_stribeck_curve([found, other])
    assert both.friction_coefficient_u.sel(sliding_speed=0.008, method="nearest") > 0
    statuses = dict(check_run(run).table[["check", "status"]].values)
    assert statuses["stuck"] == statuses["sampling"] == "skipped"


def test_a_record_whose_speed_is_held_or_noisy_is_no_table_of_results(tmp_path):
    rng = np.random.default_rng(4)
    for name, speed in {
        "held": np.repeat([1.0, 2.0, 4.0], 30),
        "noisy": 2 + 0.2 * rng.standard_normal(60),
        "slow ramp": np.linspace(1, 2, 90),
    }.items():
        rows = "\n".join(f"{t / 10},{v:.4f},20,0.3" for t, v in enumerate(speed))
        (tmp_path / f"{name}.csv").write_text(f"Time [s],Speed [mm/s],Load [N],COF\n{rows}\n")
        assert "rows_are" not in tl.read(tmp_path / f"{name}.csv").attrs


ASIDE = {
    "a set speed beside what turns": (
        "Track radius: 10 mm\nTime [s];Speed [rpm];Set speed [mm/s];Ft [N];Fn [N]",
        lambda n: (n / 10, 60, 5, 3 + n % 2, 10),
        2 * np.pi * 0.01,
    ),
    "a set speed beside strokes": (
        "Stroke: 10 mm\nFrequency: 0.5 Hz\nDrive: crank\nLoad: 10 N\n"
        "Time [s];Set speed [mm/s];Ff [N]",
        lambda n: (n / 50, 5, round(3.5 * np.cos(np.pi * n / 50), 3)),
        None,
    ),
    "a force across beside a torque": (
        "Track radius: 10 mm\nTime [s];Speed [rpm];Fy [N];Torque [N mm];Fn [N]",
        lambda n: (n / 10, 60, 0.1 * (n % 2), 35 + n % 2, 10),
        2 * np.pi * 0.01,
    ),
    "a force across beside a coefficient": (
        "Time [s];Speed [mm/s];Fy [N];COF",
        lambda n: (n / 10, 5, 0.1 * (n % 2), 0.35 + 0.01 * (n % 2)),
        5e-3,
    ),
    "a preload above the load": (
        "Preload: 1 N\nLoad: 10 N\nTime [s];Speed [mm/s];Ff [N]",
        lambda n: (n / 10, 5, 3 + n % 2),
        5e-3,
    ),
    "a displacement sensor": (
        "Load: 10 N\nTime [s];Speed [mm/s];Ff [N];LVDT [mm]",
        lambda n: (n / 10, 5, 3 + n % 2, 0.1 * (n % 2)),
        5e-3,
    ),
    "a mean coefficient": (
        "Load: 10 N\nTime [s];Speed [mm/s];Ff [N];Mean COF",
        lambda n: (n / 10, 5, 3 + n % 2, 0.5),
        5e-3,
    ),
}


@pytest.mark.parametrize("kind", ASIDE)
def test_what_stands_beside_friction_load_and_speed_changes_none_of_them(kind, tmp_path):
    head, row, speed = ASIDE[kind]
    file = tmp_path / "run.txt"
    rows = "\n".join(";".join(f"{cell}" for cell in row(n)) for n in range(400))
    file.write_text(f"{head}\n{rows}\n")
    run = tl.read(file)
    segments = tl.find_segments(run)
    found = tl.friction_coefficient(run, segments).friction_coefficient
    assert float(found.mean()) == pytest.approx(0.355, abs=0.035)
    if speed is not None:
        np.testing.assert_allclose(segments.sliding_speed, speed, rtol=1e-6)
    else:
        assert segments.sizes["segment"] > 5


@pytest.mark.parametrize(
    "name", ["mu / %", "COF in %", "COF (%)", "µ %", "Friction coefficient [%]"]
)
def test_a_coefficient_in_percent_is_read_so_however_it_is_written(name, tmp_path):
    file = tmp_path / "cof.txt"
    rows = "\n".join(f"{n / 10};2;{30 + n % 2}" for n in range(50))
    file.write_text(f"Time [s];Speed [mm/s];{name}\n{rows}\n", encoding="utf-8")
    assert float(tl.read(file).friction_coefficient.mean()) == pytest.approx(0.305)
    file.write_text(f"Time [s];Speed [mm/s];COF\n{rows}\n")
    with pytest.raises(tl.TribolabError, match="is it written in percent"):
        tl.read(file)


@pytest.mark.parametrize("name", ["Z position [mm]", "Position [mm]", "pos_z [mm]"])
def test_on_a_disc_no_axis_is_the_way(name, tmp_path):
    file = tmp_path / "disc.txt"
    rows = "\n".join(f"{n / 10};60;3;10;{12 + 0.1 * (n % 3)}" for n in range(200))
    head = f"Track radius: 10 mm\nTime [s];Speed [rpm];Ft [N];Fn [N];{name}"
    file.write_text(f"{head}\n{rows}\n")
    run = tl.read(file)
    assert run.attrs["speed_from"] == "rotation"
    np.testing.assert_allclose(tl.find_segments(run).sliding_speed, 2 * np.pi * 0.01, rtol=1e-6)


@pytest.mark.parametrize("title", ["Step {k}: speed {rpm} rpm", "Stufe {k}: {rpm} U/min"])
@pytest.mark.parametrize("header", ["each", "first"])
def test_titles_that_state_a_rotation_are_used_for_their_steps_or_not_at_all(
    title, header, tmp_path
):
    file = tmp_path / "steps.csv"
    rows = "\n".join(f"{n / 10};{9 + n % 3}" for n in range(100))
    parts = []
    for k, rpm in STAGES:
        head = "Time [s];Ff [N]\n" if header == "each" or k == 1 else ""
        parts.append(f"{title.format(k=k, rpm=rpm)}\n{head}{rows}")
    file.write_text("Track radius: 12 mm\nLoad: 30 N\n" + "\n".join(parts) + "\n")
    data, draft = drafted(file, tmp_path)
    if header == "first":
        asked = [question.guess for question in questions(draft)]
        assert any("200 rows below it are not read" in guess for guess in asked)
        return
    assert not any("how fast it turns" in guess for guess in draft.guesses)
    assert data.attrs["speed_from"] == "stated"
    speeds = [2 * np.pi * rpm / 60 * 0.012 for _, rpm in STAGES]
    np.testing.assert_allclose(tl.find_segments(data).sliding_speed, speeds, rtol=1e-6)


def test_a_torque_that_makes_the_friction_is_not_shown_as_left_out(tmp_path):
    file = tmp_path / "disc.txt"
    rows = "\n".join(f"{n / 10};60;{35 + n % 2}" for n in range(50))
    head = "Track radius: 10 mm\nLoad: 10 N\nTime [s];Speed [rpm];Mz [N mm]"
    file.write_text(f"{head}\n{rows}\n")
    shown = io.StringIO()
    print_draft(draft_dialect(file), Console(file=shown, width=120))
    assert "used as torque" in shown.getvalue() and "not used" not in shown.getvalue()
