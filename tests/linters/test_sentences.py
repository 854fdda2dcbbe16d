"""No sentence that all readers see names a Python function or argument."""

import ast
import functools
import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli

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
    public = set()
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
    "campaign/store/new_catalogue.py",
    "reading/unknown/proposal/show.py",
    "figures/axes.py",
    "figures/look/style.py",
    "figures/page/marks.py",
    "figures/page/still.py",
    "units/display.py",
}


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


@pytest.mark.parametrize(
    "command", [c.name or c.callback.__name__ for c in cli.app.registered_commands]
)
def test_the_help_of_a_command_names_no_function_or_argument(command):
    said = CliRunner().invoke(cli.app, [command, "--help"]).stdout
    assert "Usage" in said
    assert not (CALL.search(said) or ARGUMENT.search(said))
    assert not (functions() - words_of_the_field()).intersection(BARE.findall(said))
