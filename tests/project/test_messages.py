"""What is said to a reader names what he has before him: functions, options, or keys of a file."""

import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core import errors
from tribolab.friction.oscillation.slip_segments import stick_slip
from tribolab.qc.run.checks import check_run
from tribolab.reading.dialect.find import load_dialect

CALL = re.compile(r"\b[A-Za-z_][\w.]*\(\)")
ARGUMENT = re.compile(r"(?<![\w\"'<\-/.?&])[a-z][a-z0-9_]*=(?![=\s])|(?<![\w\-])[a-z]+_[a-z_]+=")


def test_every_cure_has_words_of_its_own_for_the_terminal_and_the_campaign():
    from tribolab.reading import cures

    said = [one for one in vars(cures).values() if isinstance(one, errors.Cure)]
    said += [cures.name_instrument(), cures.unknown_instrument(Path("a b.txt"), cures.RUN)]
    assert len(said) >= 7
    for cure in said:
        assert cure.notebook and cure.terminal and cure.campaign
        for audience in ("terminal", "campaign"):
            assert not (
                CALL.search(cure.message_for(audience))
                or ARGUMENT.search(cure.message_for(audience))
            )


def test_an_error_keeps_its_parts_between_processes():
    cure = errors.Cure(notebook="say clock_shift=", terminal="see", campaign="say clock_shift")
    inner = errors.ReadError("no overlap", where="a.csv", function="read", cure=cure)
    outer = errors.AnalysisError(inner, where="varied speed")
    again = pickle.loads(pickle.dumps(outer))
    assert type(again) is errors.AnalysisError
    for audience in errors.AUDIENCES:
        assert again.message_for(audience) == outer.message_for(audience)
    assert str(again) == "varied speed: read: a.csv: no overlap; say clock_shift="
    assert again.message_for("campaign") == "varied speed: a.csv: no overlap; say clock_shift"


@pytest.mark.parametrize("part", ["what", "where", "cure"])
def test_no_part_of_a_message_steers_a_terminal(part):
    steering = "\x1b[31mred\x07\x9b2J\x7f\u202e\ud800\r\x00"
    parts = {"what": "x", "where": "x", "cure": "x"} | {part: steering}
    said = str(errors.ReadError(parts.pop("what"), **parts))
    assert all(letter.isprintable() for letter in said)
    assert "red" in said


LONG = "\x1b[31m" + "Q" * 5000
LOG = "# Linear slider, force log\n"
ROWS = "\n0,1,31\n1,2,31\n"
SPOILT = {
    "unit": f"{LOG}Time [s],Fx [{LONG}],Fz [N]{ROWS}",
    "name": f"{LOG}Time [s],{LONG} [N],Fz [N]{ROWS}",
    "cell": f"{LOG}Time [s],Fx [N],Fz [N]{ROWS}2,{LONG},31\n",
    "row": f"{LOG}Time [s],Fx [N],Fz [N]{ROWS}2,{LONG},31,4,5\n",
    "unknown": f"{LONG}\n1,2\n",
    "result": f"// Header\nMode;RES\n// CalcResult\nRa;{LONG};{LONG};;\n",
}


@pytest.mark.parametrize("kind", SPOILT)
@pytest.mark.parametrize("command", ["info", "check", "dialect"])
def test_what_a_file_holds_is_cut_short_and_cannot_steer_the_terminal(tmp_path, kind, command):
    file = tmp_path / "a\x1b[2Jb.csv"
    file.write_text(SPOILT[kind])
    options = ["-o", str(tmp_path / "a.toml")] if command == "dialect" else []
    done = CliRunner().invoke(cli.app, [command, str(file), *options])
    said = [*done.stdout.splitlines(), *done.stderr.splitlines()]
    assert said and "\x1b" not in done.stdout + done.stderr
    assert all(len(line) < 800 for line in done.stderr.splitlines())
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    "line",
    [
        '[[run]]\nfiles = "{}"',
        '[[run]]\nfiles = "a.csv"\nsurface = "{}"',
        '[[run]]\nfiles = "a.csv"\nmedium = "{}"',
        '[[run]]\nfiles = "a.csv"\ninstrument = "{}"',
        '[[run]]\nfiles = "a.csv"\nnormal_force = "{}"',
        '[[run]]\nfiles = "a.csv"\n"{}" = 1',
        '[[run]]\nfiles = "a.csv"\ncycles = "{}"',
        '[[run]]\nfiles = "a.csv"\n[friction]\noffset = "{}"',
        '[[run]]\nfiles = "a.csv"\n[qc.limits."{}"]\na = 1',
    ],
)
def test_what_a_campaign_file_holds_is_cut_short(tmp_path, line):
    written = line.format(LONG.replace("\x1b", "\\u001b"))
    (tmp_path / "raw").mkdir()
    (tmp_path / "raw/a.csv").write_text(SPOILT["name"])
    (tmp_path / "campaign.toml").write_text(f'[campaign]\nname = "a"\n{written}\n')
    done = CliRunner().invoke(cli.app, ["run", str(tmp_path / "campaign.toml"), "-q", "-j", "1"])
    assert done.exit_code == 2, done.stderr
    assert "\x1b" not in done.stderr and "Q" * 81 not in done.stderr


def test_a_dialect_with_many_long_mistakes_is_answered_in_a_line(tmp_path):
    keys = "\n".join(f"{'k' * 3000}{number} = 1" for number in range(40))
    (tmp_path / "a.toml").write_text(f'name = "a"\n{keys}\n')
    with pytest.raises(errors.ConfigError, match="and 37 more") as error:
        load_dialect(tmp_path / "a.toml")
    assert len(str(error.value)) < 1200


@pytest.mark.slow
@pytest.mark.parametrize("column", ["t", "fx", "fz", "v"])
@pytest.mark.parametrize("wrong", [1e306, -1.7e308, 1e160, 1e-310, 0.0])
@pytest.mark.parametrize("rows", [slice(None), slice(150, 151), slice(200, None)])
def test_numbers_that_nothing_measures_raise_no_warning_of_arithmetic(
    tmp_path, column, wrong, rows
):
    rng = np.random.default_rng(5)
    t = 0.1 * np.arange(400)
    direction = np.where((t // 10).astype(int) % 2 == 0, 1.0, -1.0)
    table = {
        "t": t,
        "fx": 20 * direction + rng.normal(0, 0.1, t.size),
        "fz": 31 + rng.normal(0, 0.1, t.size),
        "v": direction,
    }
    table[column] = table[column].copy()
    table[column][rows] = wrong
    lines = [",".join(f"{x:.9g}" for x in row) for row in zip(*table.values(), strict=True)]
    (tmp_path / "own.csv").write_text("\n".join(["t,fx,fz,v", *lines, ""]))
    (tmp_path / "own.toml").write_text(OWN)
    try:  # a warning is an error here
        run = tl.read(tmp_path / "own.csv", tmp_path / "own.toml")
        segments = tl.find_segments(run)
        friction = tl.friction_coefficient(run, segments)
        stick_slip(run, segments)
        check_run(run, segments, friction)
        tl.measured_stribeck_curve([friction])
    except tl.TribolabError as refused:
        assert len(str(refused)) < 500


OWN = """
name = "own"
title = "an instrument of our own"
[header]
line = 1
[text]
delimiter = ","
""" + "".join(
    f'[[column]]\nquantity = "{quantity}"\nname = "{name}"\nunit = "{unit}"\n'
    for quantity, name, unit in [
        ("time", "t", "s"),
        ("friction_force", "fx", "N"),
        ("normal_force", "fz", "N"),
        ("sliding_velocity", "v", "mm/s"),
    ]
)
