"""What is said to a reader names what he has before him: functions, options, or keys of a file."""

import ast
import functools
import inspect
import json
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core import errors
from tribolab.friction.oscillation.stick_slip import stick_slip
from tribolab.qc.run.checks import check_run
from tribolab.reading.dialect.find import load_dialect

PACKAGE = Path(tl.__file__).parent
# Who reads a docstring, or what `notebook=` and `function=` say, has Python before him.
FOR_NOTEBOOKS = {"notebook", "function"}
CALL = re.compile(r"\b[A-Za-z_][\w.]*\(\)")
ARGUMENT = re.compile(r"(?<![\w\"'<\-/.?&])[a-z][a-z0-9_]*=(?![=\s])|(?<![\w\-])[a-z]+_[a-z_]+=")

BARE = re.compile(r"(?<![\w\"'\[.])[a-z]\w*(?![\w\"'\]])")  # not a name of a variable in quotes


@functools.cache
def parsed(path):
    return ast.parse(path.read_text())


@functools.cache
def functions():
    """Names of public functions that no word of the field or key of a file shares."""
    public = {name for name in tl.__all__ if inspect.isfunction(getattr(tl, name, None))}
    for path in PACKAGE.rglob("*.py"):
        public |= {node.name for node in parsed(path).body if isinstance(node, ast.FunctionDef)}
    return {name for name in public if "_" in name.strip("_") and not name.startswith("_")}


def sentences(path):
    """Line and text of every sentence in a module that is for all readers alike."""
    found = []

    def visit(node):
        if isinstance(node, ast.keyword) and node.arg in FOR_NOTEBOOKS:
            return
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            return  # a docstring
        if isinstance(node, ast.JoinedStr):
            parts = [n.value if isinstance(n, ast.Constant) else "{}" for n in node.values]
            found.append((node.lineno, "".join(map(str, parts))))
            for part in node.values:
                if isinstance(part, ast.FormattedValue):
                    visit(part.value)
            return
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.append((node.lineno, node.value))
        for child in ast.iter_child_nodes(node):
            visit(child)

    visit(parsed(path))
    return [(line, text) for line, text in found if " " in text.strip()]


@functools.cache
def words_of_the_field():
    """Names that are quantities, keys of a campaign or dialect: everyone may read them."""
    from tribolab.campaign.settings.config import Campaign
    from tribolab.reading.dialect.find import json_schema
    from tribolab.units.quantities import QUANTITIES

    schemas = json.dumps([Campaign.model_json_schema(), json_schema()])
    keys = set(re.findall(r'"(\w+)"', schemas))
    return keys | set(QUANTITIES) | {"contact_width"}


# Modules whose strings are programs, pages or files, not sentences.
NO_SENTENCES = {
    "campaign/store/catalogue.py",
    "reading/unknown/proposal/show.py",
    "figures/axes.py",
    "figures/look/style.py",
    "figures/page/marks.py",
    "figures/page/still.py",
    "units/display.py",
}


@pytest.mark.slow
def test_no_sentence_for_all_readers_names_a_python_function_or_argument():
    names = (functions() - words_of_the_field()) | {"psd_1d", "psd_2d"}
    assert {"read_scans", "remove_form"} <= names
    told = 0
    for path in sorted(PACKAGE.rglob("*.py")):
        module = path.relative_to(PACKAGE).as_posix()
        if module in NO_SENTENCES:
            continue
        for line, text in sentences(path):
            told += 1
            found = [
                *CALL.findall(text),
                *ARGUMENT.findall(text),
                *names.intersection(BARE.findall(text)),
            ]
            assert not found, f"{module}:{line} names {found[0]} to every reader: {text!r}"
    assert told > 1500


@pytest.mark.parametrize(
    "text",
    ["say which with instrument=", "use read_scans()", "take form='circle'", "see psd_1d for it"],
)
def test_the_search_for_such_names_finds_them(text):
    bare = functions().intersection(BARE.findall(text))
    assert CALL.search(text) or ARGUMENT.search(text) or bare


def test_every_cure_has_words_of_its_own_for_the_terminal_and_the_campaign():
    from tribolab.reading import cures

    said = [one for one in vars(cures).values() if isinstance(one, errors.Cure)]
    said += [cures.name_instrument(), cures.unknown_instrument(Path("a b.txt"), cures.RUN)]
    assert len(said) >= 7
    for cure in said:
        assert cure.notebook and cure.terminal and cure.campaign
        for audience in ("terminal", "campaign"):
            assert not (CALL.search(cure.told(audience)) or ARGUMENT.search(cure.told(audience)))


def test_an_error_keeps_its_parts_between_processes():
    cure = errors.Cure(notebook="say clock_shift=", terminal="see", campaign="say clock_shift")
    inner = errors.ReadError("no overlap", where="a.csv", function="read", cure=cure)
    outer = errors.AnalysisError(inner, where="varied speed")
    again = pickle.loads(pickle.dumps(outer))
    assert type(again) is errors.AnalysisError
    for audience in errors.AUDIENCES:
        assert again.told(audience) == outer.told(audience)
    assert str(again) == "varied speed: read: a.csv: no overlap; say clock_shift="
    assert again.told("campaign") == "varied speed: a.csv: no overlap; say clock_shift"


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


@pytest.mark.parametrize(
    "command", [c.name or c.callback.__name__ for c in cli.app.registered_commands]
)
def test_the_help_of_a_command_names_no_function_or_argument(command):
    said = CliRunner().invoke(cli.app, [command, "--help"]).stdout
    assert "Usage" in said
    assert not (CALL.search(said) or ARGUMENT.search(said))
    assert not (functions() - words_of_the_field()).intersection(BARE.findall(said))
