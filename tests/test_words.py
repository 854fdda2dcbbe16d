"""What is said to a reader names what he has before him: functions, options, or keys of a file."""

import ast
import inspect
import re
from pathlib import Path

import tribolab as tl

PACKAGE = Path(tl.__file__).parent
# Who reads a docstring, or what `notebook=` and `function=` say, has Python before him.
FOR_NOTEBOOKS = {"notebook", "function"}
CALL = re.compile(r"\b[A-Za-z_][\w.]*\(\)")
ARGUMENT = re.compile(r"(?<![\w\"'<\-/.?&])[a-z][a-z0-9_]*=(?![=\s])|(?<![\w\-])[a-z]+_[a-z_]+=")


def functions():
    """Names of public functions that no word of the field or key of a file shares."""
    public = {name for name in tl.__all__ if inspect.isfunction(getattr(tl, name, None))}
    for path in PACKAGE.rglob("*.py"):
        tree = ast.parse(path.read_text())
        public |= {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
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

    visit(ast.parse(path.read_text()))
    return [(line, text) for line, text in found if " " in text.strip()]
