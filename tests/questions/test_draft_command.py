"""`tribolab info FILE --write`: what it shows, writes, refuses and says comes next."""

import re
import shlex

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.app.info import describing
from tribolab.app.info.file_info import run_lines
from tribolab.core.errors import ConfigError
from tribolab.reading.dialect.find import load_dialect
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft


def test_an_existing_dialect_is_not_overwritten(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("Time [s],Fx [N]\n0,1\n1,2\n")
    draft = draft_dialect(file, name="Mine 2")
    toml = tmp_path / "mine_2.toml"
    save_draft(draft, toml)
    toml.write_text("by hand")
    with pytest.raises(ConfigError, match="--force"):
        save_draft(draft, toml)
    assert toml.read_text() == "by hand"
    save_draft(draft, toml, force=True)
    assert load_dialect(toml).name == "mine_2"


def test_one_value_and_a_pure_number_are_said_once_and_without_a_unit(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("Time [s],Fx [N],mu [1],Dev [V]\n0,1,0.5,0.004\n1,2,0.6,0.004\n2,3,0.7,0.004\n")
    draft = draft_dialect(file, name="mine")
    save_draft(draft, tmp_path / "mine.toml")
    assert ": 0.004\n" in (tmp_path / "mine.toml").read_text("utf-8")
    columns = {
        "mu": {"label": "", "unit": "1", "minimum": 1.0, "maximum": 2.0},
        "step": {"label": "", "unit": "1", "minimum": 4.0, "maximum": 4.0},
        "force": {"label": "", "unit": "N", "minimum": 4.0, "maximum": 4.0},
    }
    about = {"file": "a", "instrument": "b", "title": "", "rows": 2, "duration_s": 1.0}
    about |= {"are_points": False}
    about |= {"interval_s": None, "steps": 0, "left_out": "", "not_used": [], "metadata": {}}
    about |= {"columns": columns}
    assert [line.split(maxsplit=1)[1] for line in run_lines(about)[2:]] == ["1 to 2", "4", "4 N"]


def command(*words):
    return CliRunner().invoke(cli.app, [str(word) for word in words])


def test_the_command_shows_writes_and_tells_what_comes_next(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "odd one.csv"
    file.write_text("Zeit [s];Reibkraft;Weg [mm]\n0,0;1,5;0,1\n0,5;1,6;0,2\n")
    done = command("info", file.name, "--write", "odd_one.toml")
    assert (done.exit_code, done.stderr) == (0, "")
    assert "numbers parted by semicolon, decimal comma" in done.stdout
    rows = r"row +time s +position m\s[^\w]+1 +0 +0\.0001 *\n 2 +0\.5 +0\.0002"
    assert re.search(rows, done.stdout)
    line = int(re.search(r"fill in odd_one.toml line (\d+)", done.stdout)[1])
    assert "FILL IN" in (tmp_path / "odd_one.toml").read_text().splitlines()[line - 1]
    [following] = re.findall(r"next:  tribolab (.*)", done.stdout)
    info = command(*shlex.split(following))
    assert info.exit_code == 0 and "2 rows over 0.5 s" in info.stdout


def test_the_command_that_comes_next_reads_a_profile_too(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{n / 2000:.4f};{n % 7 / 10}\n" for n in range(200))
    (tmp_path / "odd profile.csv").write_text(f"x [mm];z [um]\n{rows}")
    done = command("info", "odd profile.csv", "--write", "odd_profile.toml")
    assert (done.exit_code, done.stderr) == (0, "")
    [following] = re.findall(r"next:  tribolab (.*)", done.stdout)
    read = command(*shlex.split(following))
    assert (read.exit_code, read.stderr) == (0, "")
    assert "200 points" in read.stdout


def test_the_command_refuses_with_the_exit_codes_of_the_house(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.csv").write_text("Time [s],Fx [N]\n0,1\n1,2\n")
    done = command("dialect", "a.csv", "--name", "Mine")  # the old name of the command
    assert done.exit_code == 0 and "write 'tribolab info FILE --write NAME.toml'" in done.stderr
    (tmp_path / "mine.toml").write_text("by hand")
    again = command("dialect", "a.csv", "--name", "mine")
    assert again.exit_code == 2 and "--force" in again.stderr
    assert (tmp_path / "mine.toml").read_text() == "by hand"
    assert command("dialect", "a.csv", "--name", "mine", "--force").exit_code == 0
    assert load_dialect("mine.toml").name == "mine"
    (tmp_path / "prose.txt").write_text("Once upon a time\nthere was a friction force.\n")
    refused = command("dialect", "prose.txt")
    assert refused.exit_code == 3 and "no table of numbers" in refused.stderr
    (tmp_path / "dma.csv").write_text("f,E_stor\nHz,MPa\n1,2\n2,3\n")
    table = command("dialect", "dma.csv", "--output", "dma.toml")
    assert table.exit_code == 3 and "a table of f, E_stor" in table.stderr
    assert not (tmp_path / "dma.toml").exists()
    nowhere = command("dialect", "a.csv", "--output", "no/such/folder/a.toml")
    assert nowhere.exit_code == 3 and "cannot be written" in nowhere.stderr


def test_a_profile_without_positions_needs_one_answer(tmp_path, monkeypatch, shared_data):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(describing, "is_terminal", lambda: True)
    file = shared_data / "profiles_mat_MIT/Luftpresser_1_56_ak.mat"
    asked = []

    def answer(question, default):
        asked.append(question)
        return "0.5 um"

    monkeypatch.setattr(describing, "_prompt", answer)
    described = describing.describe_by_questions([file], keep=True)
    assert len(asked) == 1 and described.name == "luftpresser_1_56_ak.toml"
    height = tl.read_scans(file, described).height.values[0]
    x = np.arange(height.size)
    rest = height - np.polynomial.Polynomial.fit(x, height, 1)(x)
    assert np.std(rest) == pytest.approx(0.4371e-6, rel=1e-3)
    assert describing.describe_by_questions([described], keep=True) is None
