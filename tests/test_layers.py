"""The house: imports point down only, and importing tribolab is cheap."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import tribolab

ROOT = Path(tribolab.__file__).parent

# What stands in one row may not see its neighbours unless it is the same room.
LAYERS = [
    {"errors", "provenance", "quantities", "turns", "unit_text", "units", "validity"},
    {"io"},
    {"qc", "friction", "surface"},
    {"contact", "rubber"},
    {"lubrication"},
    {"compare"},
    {"rig", "studies"},
    {"campaign"},
    {"plot"},
    {"report"},
    {"cli"},
]
LEVEL = {room: level for level, rooms in enumerate(LAYERS) for room in rooms}
# The rig is built on a study; the quality checks look at what friction and surface found.
NEIGHBOURS_ALLOWED = {("rig", "studies"), ("qc", "friction"), ("qc", "surface")}


def room_of(path: Path) -> str:
    return path.relative_to(ROOT).parts[0].removesuffix(".py")


def imports_of(path: Path) -> set[str]:
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            assert node.level == 0, f"{path}: relative import"
            if node.module == "tribolab":
                found |= {alias.name for alias in node.names}
            elif node.module.startswith("tribolab."):
                found.add(node.module.split(".")[1])
        elif isinstance(node, ast.Import):
            found |= {a.name.split(".")[1] for a in node.names if a.name.startswith("tribolab.")}
    return found & set(LEVEL)


@pytest.mark.parametrize("path", sorted(ROOT.rglob("*.py")), ids=lambda p: str(p.relative_to(ROOT)))
def test_imports_point_down_only(path):
    room = room_of(path)
    if room in ("__init__", "__main__"):
        return
    for other in imports_of(path) - {room}:
        allowed = LEVEL[other] < LEVEL[room] or LEVEL[other] == LEVEL[room] == 0
        assert allowed or (room, other) in NEIGHBOURS_ALLOWED, f"{room} imports {other}"


def test_every_room_stands_in_the_plan():
    rooms = {room_of(path) for path in ROOT.rglob("*.py")} - {"__init__", "__main__"}
    assert rooms <= set(LEVEL)


def test_import_is_lazy():
    code = (
        "import sys, tribolab; "
        "heavy = {'numpy','pandas','xarray','scipy','matplotlib','pint','pydantic','dask'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_public_name_resolves():
    for name in tribolab.__all__:
        assert getattr(tribolab, name) is not None
