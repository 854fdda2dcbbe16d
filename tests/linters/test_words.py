"""Words of languages stand in the lexicon, where a reader of the language can review them."""

import ast
import re
from pathlib import Path

import pytest

import tribolab.reading

READING = Path(tribolab.reading.__file__).parent
LAST_OF_LATIN = "\u024f"
MODULES = [p for p in sorted(READING.rglob("*.py")) if p.parent.name != "lexicon"]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(READING)))
def test_no_module_of_reading_but_the_lexicon_holds_letters_beyond_latin(path):
    lines = path.read_text("utf-8").splitlines()
    found = [
        f"{number}: {line.strip()}"
        for number, line in enumerate(lines, 1)
        if any(sign > LAST_OF_LATIN and sign.isalpha() for sign in line)
    ]
    assert not found


PACKAGE = READING.parent
TRANSLATED = re.compile(
    r"_*(?:\w+_)?(told|held|said|unsaid|says|holds|beside|worth|anew|goes|lies|stands)(?:_\w+)?"
)
STORED = {"uncertainty_says", "interval_says", "told"}  # keys of tables and of report.json
NOT_YET = ("reading/unknown/", "reading/interpret/", "reading/dialect/")
NAMED = [
    p for p in sorted(PACKAGE.rglob("*.py")) if not str(p.relative_to(PACKAGE)).startswith(NOT_YET)
]


def names(tree):
    """Yield the names that a module defines: functions, classes, arguments and variables."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id


def test_names_are_terms_of_the_field():
    found = {
        f"{path.relative_to(PACKAGE)}: {name}"
        for path in NAMED
        for name in set(names(ast.parse(path.read_text("utf-8")))) - STORED
        if TRANSLATED.fullmatch(re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower())
    }
    assert not found
