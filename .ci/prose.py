#!/usr/bin/env python3
"""Find habits of translated prose in what users read: `python3 .ci/prose.py`.

Searched are documents, notebooks, the page's templates and scripts, the descriptions of schemas and
every sentence among the strings of the code. Each place is printed with the better words of
docs/glossary.md; the exit code is 1 if there are any.
"""

from __future__ import annotations

import ast
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[1]
HABITS = {
    r"anew": "again",
    r"(?:is|are) none": "no ..., not",
    r"(?:is|are|was|were|be|been) told": "is stated, reported, measured",
    r"tells? (?:of|that|what|which|how)": "shows, states",
    r"beside": "next to, besides, in addition to",
    r"stands? (?:in|behind|for|at|beside|under)": "is in, is behind",
    r"rests? on": "depends on",
    r"comes? to": "becomes, amounts to",
    r"wander(?:s|ed|ing)?": "slow drift",
    r"with 95 %": "95 % coverage",
    r"to and fro": "back and forth, reversing",
    r"speaks? (?:for|against)": "supports, contradicts",
    r"hangs? on": "depends on",
    r"but for": "except for",
    r"sought": "looked for",
    r"gives? way": "is replaced",
    r"(?:holds?|says?) what": "contains, states",
    r"says? nothing": "does not state",
    r"of few": "few",
    r"where there (?:is|are) no(?:ne)?": "without",
}
PATTERN = re.compile(r"\b(?:" + "|".join(f"({habit})" for habit in HABITS) + r")\b", re.IGNORECASE)
BETTER = list(HABITS.values())


def user_texts() -> Iterator[tuple[str, str]]:
    """Yield where a text is and the text."""
    for path in [*PROJECT.glob("*.md"), *PROJECT.glob("*/*.md")]:
        text = path.read_text("utf-8")
        if path.name == "CHANGELOG.md":  # what was released stays as it was
            text = text.split("\n## 0.")[0]
        for number, line in enumerate(text.splitlines(), 1):
            yield f"{path.relative_to(PROJECT)}:{number}", line
    for path in PROJECT.glob("notebooks/*.ipynb"):
        for number, cell in enumerate(json.loads(path.read_text("utf-8"))["cells"]):
            if cell["cell_type"] == "markdown":
                yield f"{path.relative_to(PROJECT)}, cell {number}", "".join(cell["source"])
    for path in PROJECT.glob("raw_data_schema/*.json"):
        yield from _descriptions(json.loads(path.read_text("utf-8")), path.name)
    for suffix in ("html", "js"):
        for path in (PROJECT / "tribolab/report").rglob(f"*.{suffix}"):
            if not path.name.endswith(".min.js"):
                for number, line in enumerate(path.read_text("utf-8").splitlines(), 1):
                    text = re.sub(r"(?:^|\s)//.*", "", line)  # comments are not for users
                    yield f"{path.relative_to(PROJECT)}:{number}", text
    for path in sorted((PROJECT / "tribolab").rglob("*.py")):
        for node in _sentences(ast.parse(path.read_text("utf-8"))):
            yield f"{path.relative_to(PROJECT)}:{node.lineno}", str(node.value)


def _descriptions(schema: object, name: str) -> Iterator[tuple[str, str]]:
    if isinstance(schema, dict):
        if isinstance(text := schema.get("description"), str):
            yield name, text
        for value in schema.values():
            yield from _descriptions(value, name)
    elif isinstance(schema, list):
        for value in schema:
            yield from _descriptions(value, name)


def _sentences(tree: ast.Module) -> Iterator[ast.Constant]:
    docstrings = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and " " in node.value.strip()
            and id(node) not in docstrings
        ):
            yield node


def main() -> int:
    """Print every habit found; return 1 if there are any."""
    found = 0
    for place, text in user_texts():
        for match in PATTERN.finditer(text):
            found += 1
            better = BETTER[(match.lastindex or 1) - 1]
            around = text[max(0, match.start() - 30) : match.end() + 30].replace("\n", " ")
            print(f"{place}: ...{around}... ({match[0]}: {better})")
    return min(found, 1)


if __name__ == "__main__":
    sys.exit(main())
