"""What sentences above a table state, and what is said where something is missing."""

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core.errors import TribolabError

T = np.arange(0, 30, 0.1)
RNG = np.random.default_rng(3)
FORCE = 2.0 + 0.02 * RNG.standard_normal(T.size)
LOAD = 12.0 + 0.05 * RNG.standard_normal(T.size)
RADIUS = 21.5e-3


def table(path, head, *columns, rows=None):
    values = np.column_stack(np.broadcast_arrays(*columns))
    lines = ["\t".join(f"{x:.6g}" for x in row) for row in values]
    path.write_text(head + "\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return path


def command(*words):
    done = CliRunner().invoke(cli.app, [str(word) for word in words])
    return " ".join(done.output.split())


def refusal(path):
    with pytest.raises(tl.TribolabError) as caught:
        tl.read(path)
    return " ".join(str(caught.value).split())


@pytest.mark.parametrize(
    "said",
    [
        "Geometry: ring on disc, mean track radius 21.5 mm",
        "# track radius 21,5 mm on a 50 mm disc",
        "ball 6 mm on a disc with a wear track diameter of 43 mm",
        "Aufbau: Ring, Laufbahnradius 2,15 cm, Öl",
        "条件：磨痕半径 21.5 mm",
        "rayon de la piste 21.5 mm",
    ],
)
def test_a_radius_within_a_sentence_makes_speed_and_friction_of_turns_and_torque(said, tmp_path):
    head = f"Rig export\n{said}\nTime [s]\tRotation [rpm]\tTorque [mN·m]\tLoad cell [N]"
    run = tl.read(table(tmp_path / "a.txt", head, T, 60.0, 1e3 * FORCE * RADIUS, LOAD))
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * RADIUS, rtol=1e-6)
    np.testing.assert_allclose(run.friction_force, FORCE, rtol=1e-4)
    np.testing.assert_allclose(run.normal_force, LOAD, rtol=1e-4)  # a torque is the friction


def test_a_radius_and_an_angle_in_columns_and_a_load_that_was_set_are_enough(tmp_path):
    radius = np.where(T < 15, 20.0, 25.0)
    head = "Time [s]\tRotation [rpm]\tTrack radius [mm]\tTorque [N mm]\tSet load [N]"
    torque = FORCE * radius
    run = tl.read(table(tmp_path / "a.txt", head, T, 60.0, radius, torque, 12.0))
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 1e-3 * radius, rtol=1e-6)
    np.testing.assert_allclose(run.friction_force, FORCE, rtol=1e-4)
    np.testing.assert_allclose(run.normal_force, 12.0)
    told = tl.check(run).table.query("check == 'stuck' and variable == 'normal_force'")
    assert not set(told.status) & {"suspect", "fail"}  # what was set stands still
    head = "track radius 20 mm\nTime [s]\tAngle [deg]\tFriction [N]\tLoad [N]"
    run = tl.read(table(tmp_path / "b.txt", head, T, 90 * T, FORCE, LOAD))
    np.testing.assert_allclose(run.position, np.pi / 2 * T * 20e-3, rtol=1e-4, atol=1e-9)


def test_all_that_is_missing_is_told_in_one_message_and_stands_in_the_draft(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    head = "Time [s]\tRotation [rpm]\tTorque [N mm]"
    path = table(tmp_path / "a.txt", head, T, 60.0, FORCE * 20)
    told = refusal(path)
    assert "Missing: the radius of the track, for the friction and the sliding speed" in told
    assert "Missing: the load" in told
    command("dialect", path.name, "--no-ask")
    toml = (tmp_path / "a.toml").read_text()
    for wanted in ("# radius = ", "torque / '? mm'", "'? N'"):
        assert wanted in toml
    text, open_one = [], False
    for line in toml.splitlines():  # as a person would fill it in
        open_one = "FILL IN" in line or (open_one and line.startswith("#"))
        text.append(line.lstrip("# ") if open_one and "FILL IN" not in line else line)
    toml = "\n".join(line for line in text if line != 'source = "none"')
    toml = toml.replace("'? mm'", "'20 mm'").replace("? mm", "20 mm").replace("'? N'", "'12 N'")
    (tmp_path / "a.toml").write_text(toml)
    run = tl.read(path, "a.toml")
    np.testing.assert_allclose(run.friction_force, FORCE, rtol=1e-4)
    np.testing.assert_allclose(run.normal_force, 12.0)
    head = "Time [s]\tRotation [rpm]\tFriction [N]\tLoad [N]"
    told = command("info", table(tmp_path / "b.txt", head, T, 60.0, FORCE, LOAD))
    assert "missing: the radius of the track, for the sliding speed" in told


def test_a_load_cell_is_asked_about_unless_another_force_or_the_load_tells(tmp_path):
    head = "Time [s]\tSpeed [mm/s]\tLoad cell [N]"
    path = table(tmp_path / "a.txt", head, T, 5.0, LOAD)
    assert "the name means friction force (or normal_force" in refusal(path)
    assert not tl.reading.draft_dialect(path).understood.columns[2].used
    path = table(tmp_path / "b.txt", f"Load set: 12 N\n{head}", T, 5.0, LOAD)
    assert "it is the normal force: it reads what 'Load set: 12 N' says" in refusal(path)
    path = table(tmp_path / "c.txt", f"Load set: 12 N\n{head}", T, 5.0, FORCE)
    assert "it is the friction force: 'Load set: 12 N' is the load" in refusal(path)
    path = table(tmp_path / "d.txt", f"{head}\tFx [N]", T, 5.0, LOAD, FORCE)
    np.testing.assert_allclose(tl.read(path).normal_force, LOAD, rtol=1e-4)


@pytest.mark.parametrize(
    "said",
    [
        "stepping  0.25 um",
        "step 0.25 um",
        "dx=0.25um",
        "Abtastschritt 0,25 µm",
        "pas 0,25 µm",
        "passo: 0.25 µm",
        "采样间距 0.25 µm",
        "測定ピッチ：0.25 µm",
        "stylus 2 um, points every: step 0.25 um",
    ],
)
def test_the_distance_of_heights_is_told_in_many_words(said, tmp_path):
    path = tmp_path / "line.txt"
    heights = 500 * np.sin(np.arange(300) / 9)
    rows = "\n".join(f"{z:.1f}" for z in heights)
    path.write_text(f"Surfprobe\n{said}\nheights  nm\n---\n{rows}\n", encoding="utf-8")
    scan = tl.read_scans(path)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)
    np.testing.assert_allclose(scan.height[0], 1e-9 * heights, atol=1e-10)


def test_a_sentence_states_strokes_a_speed_and_a_load(tmp_path):
    said = "Reciprocating: stroke 5 mm at 0.5 Hz, load of 12 N\nMotion: sine"
    force = FORCE * np.sign(np.cos(np.pi * T) + 1e-9)
    run = tl.read(table(tmp_path / "a.txt", f"{said}\nTime [s]\tFriction [N]", T, force))
    assert run.attrs["stroke_m"] == pytest.approx(5e-3)
    assert float(run.sliding_velocity.max()) == pytest.approx(np.pi * 5e-3 / 2, rel=0.01)
    np.testing.assert_allclose(run.normal_force, 12.0)
    head = "Belt rig, speed 0,3 m/min\ntime/s\tdrag/cN\tload/N"
    path = table(tmp_path / "b.txt", head, T, 100 * FORCE, LOAD)
    told = command("dialect", path, "--no-ask", "--output", tmp_path / "b.toml")
    assert "friction coefficient 0.167 (± U95 at most 0.0" in told
    assert tl.read(path).attrs["set_speed_m_s"] == pytest.approx(0.005)
    fastest = table(tmp_path / "c.txt", head.replace("speed", "max speed"), T, 100 * FORCE, LOAD)
    assert "set_speed_m_s" not in tl.read(fastest).attrs
    run = tl.read(path, tl.reading.draft_dialect(path).dialect)
    assert run.attrs["set_speed_m_s"] == pytest.approx(5e-3)


def test_a_factor_of_a_unit_is_read(tmp_path):
    head = "Time [s]\tFriction (1e-4 N)\tLoad [N]\tSpeed [mm/s]"
    run = tl.read(table(tmp_path / "a.txt", head, T, 1e4 * FORCE, LOAD, 5.0))
    np.testing.assert_allclose(run.friction_force, FORCE, rtol=1e-4)


def test_forces_whose_ratio_can_be_no_friction_are_asked_about(tmp_path):
    head = "Time [s]\tFriction force [N]\tNormal force [N]\tSpeed [mm/s]"
    path = table(tmp_path / "a.txt", head, T, 1e3 * LOAD, FORCE, 5.0)
    assert "are the two swapped, or a unit wrong?" in refusal(path)
    command("dialect", path, "--no-ask", "--output", tmp_path / "a.toml")
    told = command("info", path, "--instrument", tmp_path / "a.toml")
    assert "doubtful: the friction force is 6.0" in told and "a unit wrong?" in told


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('quantity = "friction_torque"', "formula as \"torque / '20 mm'\""),
        ('quantity = "laps"', "formula as \"2 * pi * turns * '20 mm'\""),
        ('quantity = "angle"', 'quantity = "position"'),
        ('quantity = "strain"', 'quantity = "friction_force"'),
        ('quantity = "counts"', "counts * '0.5 mN'"),
        ('quantity = "stress"', '"shear_stress" or "normal_stress"'),
        ('quantity = "normal_force"\nscale = true', "true stands where a number or a text belongs"),
    ],
)
def test_a_dialect_by_hand_is_told_how_a_column_of_another_kind_is_used(line, said, tmp_path):
    toml = tmp_path / "x.toml"
    columns = '[[column]]\nquantity = "time"\nname = "t"\nunit = "s"\n'
    toml.write_text(f'name = "x"\ntitle = "x"\n[header]\nline = 1\n{columns}[[column]]\n{line}\n'
                    'name = "T"\n')  # fmt: skip
    with pytest.raises(tl.TribolabError) as caught:
        tl.read(table(tmp_path / "a.txt", "t\tT", T, FORCE), toml)
    assert said in str(caught.value)


def test_units_tell_what_turns_where_the_names_are_unknown(tmp_path):
    head = "Radio de pista: 18,0 mm\nTiempo [s]\tGiro [rpm]\tPar [N·cm]\tCarga [N]"
    torque = 100 * FORCE * 18e-3
    run = tl.read(table(tmp_path / "a.txt", head, T, 60.0, torque, LOAD))
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 18e-3, rtol=1e-6)
    np.testing.assert_allclose(run.friction_force, FORCE, rtol=1e-4)


def test_one_heading_with_its_unit_tells_that_commas_are_decimal_marks(tmp_path):
    height = np.round(100 * RNG.standard_normal(400), 1)
    lines = [f"{value:.1f}".replace(".", ",") for value in height]
    text = "Profilometr\nRozteč bodů: 0,5 µm\nVýška [nm]\n" + "\n".join(lines) + "\n"
    (tmp_path / "a.txt").write_text(text, encoding="utf-8")
    profile = tl.read_scans(tmp_path / "a.txt")
    np.testing.assert_allclose(profile.height.squeeze(), 1e-9 * height, atol=1e-15)
    np.testing.assert_allclose(np.diff(profile.x).squeeze(), 0.5e-6)


def test_lines_that_may_state_what_is_missing_are_quoted(tmp_path):
    rows = "\n".join(f"{n / 10:.1f};200;0.{10 + n % 3}" for n in range(200))
    head = "Kommutator-Maß;42,0;mm\nFederkennwert;3,5;N\nTime [s];Speed [rpm];Torque [Nm]\n"
    (tmp_path / "a.csv").write_text(head + rows + "\n", "utf-8")
    with pytest.raises(TribolabError) as refused:
        tl.read(tmp_path / "a.csv")
    told = refused.value.message_for("terminal")
    assert "is it 'Kommutator-Maß;42,0;mm'?" in told and "is it 'Federkennwert;3,5;N'?" in told
