"""`tribolab info --write`: answers of a person, several examples, and the trial on the files."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core.errors import ReadError, UnitError
from tribolab.reading.unknown.proposal.answers import corrected
from tribolab.reading.unknown.proposal.draft import dialect_name, draft_dialect
from tribolab.units.conversion import to_si


def log(n=400, force=6.0, load=-30.0):
    rng = np.random.default_rng(2)
    noise = rng.standard_normal((3, n))
    return {
        "A1": 100 * np.arange(n),
        "A2": 1e3 * (force + 0.05 * noise[0]),
        "A3": load + 0.1 * noise[1],
        "Speed [mm/s]": 10 + 0.01 * noise[2],
    }


def write(file, columns):
    rows = zip(*columns.values(), strict=True)
    body = "\n".join(",".join(f"{v:.4f}" for v in row) for row in rows)
    file.write_text(f"{','.join(columns)}\n{body}\n")
    return file


def command(*words, typed=None):
    return CliRunner().invoke(cli.app, [str(word) for word in words], input=typed)


def describe(name, *options, typed=None):
    return command("info", name, "--write", f"{dialect_name(name)}.toml", *options, typed=typed)


def test_answers_make_a_dialect_that_reads_the_file_without_mending(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = write(tmp_path / "odd.csv", log())
    typed = "1\nms\n2\nmN\nA3\nN\nyes\n\n"
    done = describe(file.name, "--ask", typed=typed)
    assert (done.exit_code, done.stderr) == (0, "")
    assert re.search(r"tried:  odd\.csv: 400 rows over 39\.9 s, 1 segment, friction coefficient "
                     r"0\.(199|200|201|2)\d* \(± U95 at most ", done.stdout)  # fmt: skip
    assert "fill in" not in done.stdout.split("tried:")[1]
    run = tl.read(file, "odd.toml")
    assert float(run.normal_force.mean()) == pytest.approx(30, abs=0.05)
    assert float(run.friction_force.mean()) == pytest.approx(6, abs=0.02)
    toml = (tmp_path / "odd.toml").read_text()
    assert "guessed:" not in toml and "sign = -1" in toml


def test_a_wrong_answer_is_told_and_asked_for_again(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = write(tmp_path / "odd.csv", log())
    typed = "9\n1\nkg\n1\nms\n2\nmN\n3\nN\n\n\n"
    done = describe(file.name, "--ask", typed=typed)
    assert done.exit_code == 0, done.stdout
    assert "there is no column '9'" in done.stdout
    assert "'kg' is no unit of time, e.g. 's', nor an amount of it" in done.stdout
    assert tl.read(file, "odd.toml").sizes["time"] == 400


def test_without_a_terminal_nothing_is_asked_and_the_guess_is_tried(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    columns = log(load=30.0)
    good = dict(zip(["Time [ms]", "Fx [mN]", "Fz [N]", "v [mm/s]"], columns.values(), strict=True))
    file = write(tmp_path / "good.csv", good)
    done = describe(file.name)
    assert done.exit_code == 0 and "which column" not in done.stdout
    assert "friction coefficient 0.2" in done.stdout
    assert re.search(r"friction_force N +5\.\d+ +6\.\d+", done.stdout)
    assert re.search(r"\n 10 +0\.9 ", done.stdout)  # ten rows as understood


def test_only_what_is_unusual_stands_in_the_toml(tmp_path):
    file = tmp_path / "plain.csv"
    file.write_text("Time [s],Fx [N],v [mm/s]\n0,1,1\n1,2,1\n2,2,1\n")
    rules = tomllib.loads(draft_dialect(file).toml)
    assert rules.pop("column") == [
        {"quantity": "time", "name": "Time"},
        {"quantity": "friction_force", "name": "Fx"},
        {"quantity": "sliding_velocity", "name": "v"},
    ]
    assert set(rules) == {"name", "title", "recognise", "header"}
    assert rules["header"] == {"line": 1}


def test_a_correction_takes_a_quantity_from_the_column_that_had_it(tmp_path):
    file = tmp_path / "two.csv"
    file.write_text("Time [s],Fx [N],Fy [N]\n0,1,5\n1,2,6\n2,2,7\n")
    draft = corrected(draft_dialect(file), "friction_force", 3)
    [held] = [c for c in draft.understood.columns if c.quantity == "friction_force"]
    assert held.place == 3
    assert draft.dialect.column[1].name == "Fy"
    with pytest.raises(ReadError, match="columns 1 to 3"):
        corrected(draft, "friction_force", 4)
    with pytest.raises(ReadError, match="needs a unit of normal_force"):
        corrected(draft, "normal_force", 1)


def test_heights_without_positions_are_read_once_their_pitch_is_said(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "line.txt"
    heights = np.sin(np.arange(200) / 9)
    file.write_text("Z\n" + "".join(f"{z:.4f}\n" for z in heights))
    unasked = describe(file.name, "--no-ask")  # and without a terminal
    assert unasked.exit_code == 0 and "the distance of neighbouring heights" in unasked.output
    with pytest.raises(ReadError, match=r"pitch = \"0\.25 um\" in its first lines"):
        tl.read_scans(file, instrument="line.toml")
    toml = Path("line.toml")
    toml.write_text(toml.read_text().replace('# pitch = "? um"', 'pitch = "0.5 um"'))
    assert tl.read_scans(file, instrument="line.toml").attrs["pitch_m"] == pytest.approx(5e-7)
    done = describe(file.name, "--ask", "--force", typed="2 s\n0.25 um\nnm\n")
    assert done.exit_code == 0, done.output
    scan = tl.read_scans(file, instrument="line.toml")
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)
    np.testing.assert_allclose(scan.height[0], 1e-9 * heights, atol=1e-13)


def test_a_torque_with_a_radius_is_a_force_and_a_load_may_be_a_weight(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "ring.txt"
    rows = "".join(f"{i / 10:.1f},{4 + i % 3},60,{100 + i % 2}\n" for i in range(400))
    file.write_text("Time [s],M9 [mN m],Disc [rpm],Q [V]\n" + rows)
    done = describe(file.name, "--ask", typed="2\n2 kg\n10 mm\n")
    assert done.exit_code == 0, done.output
    run = tl.read(file, "ring.toml")
    np.testing.assert_allclose(run.friction_force[:3], [0.4, 0.5, 0.6])
    np.testing.assert_allclose(run.normal_force, 2 * 9.80665)
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 0.01)


@pytest.mark.parametrize("answer", ["yes", ""])
def test_yes_takes_the_radius_that_a_line_perhaps_states(answer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "ring.txt"
    rows = "".join(f"{i / 10:.2f}\t{4 + i % 3}\t60\t{20 + i % 2}\n" for i in range(400))
    header = "Time [s]\tTorque [mN m]\tSpeed [rpm]\tLoad [N]\n"
    file.write_text("Rig 3\nHalf of it: 22.5 mm\n" + header + rows)
    done = describe(file.name, "--ask", typed=f"\n\n\n\n{answer}\n")
    assert "is it in 'Half of it: 22.5 mm'? (yes: 22.5 mm; -: not known) [yes]" in done.output
    run = tl.read(file, "ring.toml")
    np.testing.assert_allclose(run.sliding_velocity, 2 * np.pi * 0.0225)
    file.write_text(file.read_text().replace("22.5 mm", "30 mm"))  # another ring has its own
    np.testing.assert_allclose(tl.read(file, "ring.toml").sliding_velocity, 2 * np.pi * 0.030)


def test_an_angle_with_a_radius_is_a_way(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "table.txt"
    rows = "".join(f"{i / 10:.1f},{4 + i % 3},{i / 100:.2f}\n" for i in range(400))
    file.write_text("Time [s],Friction force [mN],E1\n" + rows)
    done = describe(file.name, "--ask", typed="2 N\n3\nturn\n10 mm\n")
    assert done.exit_code == 0, done.output
    run = tl.read(file, "table.toml")
    np.testing.assert_allclose(np.diff(run.position), 2 * np.pi * 1e-4, rtol=1e-3)


def test_volts_and_counts_are_forces_by_what_one_is_less_what_stands_without_contact(
    tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "bridge.txt"
    rows = "".join(f"{0.5 + 0.1 * (i > 99):.2f},{1000 + 500 * (i > 99)}\n" for i in range(400))
    file.write_text("A [V],B\n" + rows)
    typed = "100 Hz\n1\nmV\n1\n8,0 N/V\nfirst 0.9 s\n2\n0.02 N\n1000\n6 mm/min\n"
    done = describe(file.name, "--ask", typed=typed)
    assert done.exit_code == 0, done.output
    assert "column 1 is in V: how much is 1 V? (e.g. 8.2 N/V)" in done.output
    run = tl.read(file, "bridge.toml")
    np.testing.assert_allclose(run.friction_force[[0, -1]], [0, 0.8], atol=1e-12)
    np.testing.assert_allclose(run.normal_force[[0, -1]], [0, 10])
    assert float(run.time[-1]) == pytest.approx(3.99)
    np.testing.assert_allclose(run.set_speed, 1e-4)


def test_loads_that_add_up_pulses_of_a_turn_and_a_weight_on_a_lever(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "ring.txt"
    rows = "".join(f"{i / 10:.1f},{i},3,{4 + i % 2},{6 - i % 2}\n" for i in range(400))
    file.write_text("Time [s],P1,Friction force [N],C1,C2\n" + rows)
    done = describe(file.name, "--ask", typed="4+5\nN\nN\n2\n1/100 turn\n10 mm\n")
    assert done.exit_code == 0, done.output
    run = tl.read(file, "ring.toml")
    np.testing.assert_allclose(run.normal_force, 10)
    np.testing.assert_allclose(np.diff(run.position), 2 * np.pi * 1e-4, rtol=1e-6)
    typed = "10 x 5 kg\n2\n1/100 turn\n10 mm\n"
    done = describe(file.name, "--ask", "--force", typed=typed)
    assert done.exit_code == 0, done.output
    np.testing.assert_allclose(tl.read(file, "ring.toml").normal_force, 490.333, rtol=1e-5)


def test_a_set_speed_that_turns_over_tells_the_way_on_trial(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "wiper.txt"
    rng = np.random.default_rng(4)
    way = np.repeat([1, -1] * 4, 100)
    rows = "".join(
        f"{n / 20:.2f},{5 * w},{3 * w + 0.02 * e:.4f},10\n"
        for n, (w, e) in enumerate(zip(way, rng.standard_normal(way.size), strict=True))
    )
    file.write_text("Time [s],Speed set [mm/s],Friction force [N],Normal force [N]\n" + rows)
    done = describe(file.name, "--no-ask")
    assert "8 segments, friction coefficient 0.3000 ± 0.0005 (U95, mean of 8;" in done.output, (
        done.output
    )


@pytest.mark.parametrize("answer", ["102 gf", "yes"])
def test_lines_that_may_state_the_load_are_quoted(answer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "stage.txt"
    rows = "".join(f"{n / 20:.2f},{3 + n % 3}\n" for n in range(200))
    file.write_text(f"Thing on top: 102 gf\nTime [s],Friction force [N]\n{rows}")
    done = describe(file.name, "--ask", typed=f"\n\n{answer}\n1 mm/s\n")
    assert "is it in 'Thing on top: 102 gf'?" in done.output, done.output
    np.testing.assert_allclose(tl.read(file, "stage.toml").normal_force, 0.102 * 9.80665)
    file.write_text(file.read_text().replace("102 gf", "204 gf"))
    np.testing.assert_allclose(tl.read(file, "stage.toml").normal_force, 0.204 * 9.80665)


def test_yes_to_the_line_of_a_speed_holds_for_other_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "pull.txt"
    rows = "".join(f"{n / 20:.2f},{3 + n % 3}\n" for n in range(200))
    file.write_text(f"Load: 10 N\nGoes: 6 mm/min\nTime [s],Friction force [N]\n{rows}")
    done = describe(file.name, "--ask", typed="\n\n\nyes\n")
    assert "is it in 'Goes: 6 mm/min'?" in done.output, done.output
    assert float(tl.read(file, "pull.toml").set_speed[0]) == pytest.approx(1e-4)
    file.write_text(file.read_text().replace("6 mm/min", "60 mm/min"))
    assert float(tl.read(file, "pull.toml").set_speed[0]) == pytest.approx(1e-3)


def test_a_force_without_a_load_is_tried(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{i / 10:.1f},{4 + i % 3},{i}\n" for i in range(200))
    file = tmp_path / "bare.txt"
    file.write_text("Time [s],Fx [N],Position [um]\n" + rows)
    done = describe(file.name, "--no-ask")
    assert done.exit_code == 0 and "no friction coefficient" in done.output, done.output


def test_questions_that_end_early_write_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "x.txt"
    file.write_text("Time [s],Fx [N],Fy [N]\n" + "".join(f"{i},1,5\n" for i in range(50)))
    done = describe(file.name, "--ask", typed="")
    assert done.exit_code == 130 and "nothing was written" in done.output
    assert not (tmp_path / "x.toml").exists()


def test_an_answer_stays_where_another_is_not_known_and_may_have_a_comma(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "ring.txt"
    rows = "".join(f"{i / 10:.1f},{4 + i % 3},60\n" for i in range(200))
    file.write_text("Time [s],Torque [mN m],Rotation [rpm]\n" + rows)
    done = describe(file.name, "--ask", typed="\n46,0 N\n-\n")
    assert "formula = \"'46.0 N'\"" in Path("ring.toml").read_text("utf-8"), done.output
    assert "a torque: with the radius at which it acts" in done.output


def test_a_decimal_comma_of_an_amount_is_named():
    with pytest.raises(UnitError, match=r"'46,0 N' has a decimal comma; write '46.0 N'"):
        to_si("46,0 N", "N", "load")


def test_strokes_may_be_typed_and_one_of_both_is_not_enough(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    time = np.arange(0, 20, 0.005)
    force = 3 * np.tanh(30 * np.cos(4 * np.pi * time))
    columns = {"Time [s]": time, "Friction force [N]": force, "Load [N]": np.full(time.size, 15.0)}
    file = write(tmp_path / "pin.csv", columns)
    done = describe(file.name, "--ask", typed="2 Hz\nstroke 8 mm, 2 Hz\n\n")
    assert (done.exit_code, done.stderr) == (0, "")
    assert "strokes also need a length, such as 8 mm" in done.stdout
    assert done.stdout.count("sliding_velocity m/s") == 2  # once a row, once as a line of blocks
    assert "friction coefficient 0.2 (U95, mean of 79;" in done.stdout.split("tried:")[1]
    said = tomllib.loads((tmp_path / "pin.toml").read_text())["speed"]
    crank = {"source": "stroke", "stroke": "8 mm", "frequency": "2 Hz", "drive": "crank"}
    assert said == crank
    run = tl.read(file, "pin.toml")
    assert float(run.sliding_velocity.max()) == pytest.approx(np.pi * 2 * 8e-3, rel=1e-3)


def test_turns_may_be_typed_with_the_radius_of_their_track(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    time = np.arange(0, 20, 0.05)
    lines = "".join(f"{t:.2f}\t{3 + 0.01 * np.sin(t):.4f}\n" for t in time)
    Path("disc.txt").write_text(f"Load: 15 N\nTime [s]\tFriction force [N]\n{lines}", "utf-8")
    typed = "8 rpm\n8\n15,5\n8 rpm at 20 mm radius\n\n"
    done = describe("disc.txt", "--ask", typed=typed)
    assert (done.exit_code, done.stderr) == (0, "")
    assert "normal force? (" not in done.stdout  # the file states it
    assert "a rotation speed needs the radius of the track: 8 rpm at 20 mm radius" in done.stdout
    assert "there is no column '8'" in done.stdout
    assert "15,5 has no unit: type it with one, such as 6 mm/min" in done.stdout
    run = tl.read("disc.txt", "disc.toml")
    speed = 2 * np.pi * 0.02 * 8 / 60
    assert float(run.set_speed.mean()) == pytest.approx(speed, rel=1e-5)
    assert 'name = "normal_force"' not in Path("disc.toml").read_text("utf-8")
    assert float(run.normal_force.mean()) == pytest.approx(15)


def test_a_description_that_was_drafted_of_a_file_is_named_where_it_lies(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = write(tmp_path / "odd.csv", log())
    told = command("info", file.name)
    assert told.exit_code == 3 and "is a description of it" not in told.output
    assert describe(file.name, "--ask", typed="1\nms\n2\nmN\n3\nN\n\n\n").exit_code == 0
    told = command("info", file.name)
    assert told.exit_code == 3 and "--instrument odd.toml is a description of it" in told.output
