"""The house: imports point down only, nothing runs in circles, and importing tribolab is cheap."""

import ast
import importlib
import inspect
import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import tribolab

PROJECT = Path(tribolab.__file__).resolve().parents[1]
ROOMS = sorted(
    path.stem
    for path in (PROJECT / "tribolab").iterdir()
    if path.name[0] not in "_." and (path.is_dir() or path.suffix == ".py")
)


def lint(folder: Path) -> subprocess.CompletedProcess:
    command = "import sys; from importlinter.cli import lint_imports; sys.exit(lint_imports())"
    return subprocess.run(
        [sys.executable, "-P", "-c", f"import sys; sys.path.insert(0, '.'); {command}"],
        cwd=folder,
        capture_output=True,
        text=True,
    )


def test_imports_point_down_only_and_never_in_circles():
    done = lint(PROJECT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_an_import_upwards_a_circle_and_one_of_the_public_face_are_found(tmp_path):
    for path in (PROJECT / "tribolab").rglob("*.py"):
        empty = tmp_path / path.relative_to(PROJECT)
        empty.parent.mkdir(parents=True, exist_ok=True)
        empty.write_text("")
    (tmp_path / "pyproject.toml").write_text((PROJECT / "pyproject.toml").read_text("utf-8"))
    assert lint(tmp_path).returncode == 0
    clocks = tmp_path / "tribolab" / "reading" / "clocks"
    (clocks / "one.py").write_text("def f():\n    import tribolab.report\n")
    (clocks / "two.py").write_text("from tribolab.reading.clocks import three\n")
    (clocks / "three.py").write_text(
        "from typing import TYPE_CHECKING\n"
        "if TYPE_CHECKING:\n    from tribolab.reading.clocks import two\n"
    )
    (clocks / "four.py").write_text("from tribolab import read\n")
    settings = tmp_path / "tribolab" / "campaign" / "settings"
    (settings / "five.py").write_text("from tribolab.campaign.runs import stage\n")
    said = lint(tmp_path).stdout
    assert "tribolab.reading is not allowed to import tribolab.report" in said
    assert "tribolab.campaign.settings is not allowed to import tribolab.campaign.runs" in said
    assert "No circles, in packages and between them BROKEN" in said
    assert "Nothing below the face imports the public names BROKEN" in said


def unexplained(path: Path) -> list[str]:
    """Imports within functions, the first of each block, without a word beside or above them."""
    text = path.read_text("utf-8")
    lines = text.splitlines()
    late = []
    for function in ast.walk(ast.parse(text)):
        if not isinstance(function, ast.FunctionDef):
            continue
        bodies = (getattr(node, "body", None) for node in ast.walk(function))
        for body in (body for body in bodies if isinstance(body, list)):
            imports = [isinstance(statement, ast.Import | ast.ImportFrom) for statement in body]
            late += [
                statement.lineno
                for statement, here, before in zip(body, imports, [False, *imports], strict=False)
                if here and not before
            ]
    return [
        f"{path.name} {number}: {lines[number - 1].strip()}"
        for number in sorted(set(late))
        if not re.search("# (?!noqa)", lines[number - 1])
        and not lines[number - 2].strip().startswith("#")
    ]


def test_an_import_within_a_function_has_its_reason_above_it(tmp_path):
    late = [text for path in (PROJECT / "tribolab").rglob("*.py") for text in unexplained(path)]
    assert late == []
    made = tmp_path / "made.py"
    made.write_text("def f():\n    import this\n\n    f()\n    # late: long\n    import that\n")
    assert unexplained(made) == ["made.py 2: import this"]


def test_every_room_stands_in_the_plan():
    layers = (PROJECT / "pyproject.toml").read_text("utf-8").split("layers = [")[1].split("]")[0]
    assert {room for room in ROOMS if f"tribolab.{room}" not in layers} == set()


def hidden(faces: Iterable[ModuleType]) -> set[str]:
    """Public functions with the name of a module in the folder of their own: it would hide them."""
    values = [getattr(face, name) for face in faces for name in face.__all__]
    return {
        f"{value.__module__}.{value.__name__}"
        for value in values
        if inspect.isfunction(value)
        for folder in [Path(inspect.getfile(value)).parent]
        if (folder / f"{value.__name__}.py").exists() or (folder / value.__name__).is_dir()
    }


def test_no_public_function_has_the_name_of_a_module_in_its_folder(tmp_path, monkeypatch):
    groups = (getattr(tribolab, name) for name in tribolab.__all__)
    faces = [group for group in groups if isinstance(group, ModuleType)]
    assert tribolab.contact in faces
    assert hidden([tribolab, *faces]) == set()
    (tmp_path / "friction_of_paper.py").write_text(
        "__all__ = ['friction_of_paper']\ndef friction_of_paper(): ...\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    made = importlib.import_module("friction_of_paper")
    assert hidden([made]) == {"friction_of_paper.friction_of_paper"}


def test_a_folder_holds_twenty_files_at_most():
    folders = [f for f in (PROJECT / "tribolab").rglob("*") if (f / "__init__.py").is_file()]
    assert {f.name: n for f in folders if (n := len(list(f.glob("*.py")))) > 20} == {}
