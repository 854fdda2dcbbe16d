"""The house: imports point down only, nothing runs in circles, and importing tribolab is cheap."""

import subprocess
import sys
from pathlib import Path

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
    io = tmp_path / "tribolab" / "io"
    (io / "one.py").write_text("def f():\n    import tribolab.report\n")
    (io / "two.py").write_text("from tribolab.io import three\n")
    (io / "three.py").write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from tribolab.io import two\n"
    )
    (io / "four.py").write_text("from tribolab import read\n")
    settings = tmp_path / "tribolab" / "campaign" / "settings"
    (settings / "five.py").write_text("from tribolab.campaign.runs import stage\n")
    said = lint(tmp_path).stdout
    assert "tribolab.io is not allowed to import tribolab.report" in said
    assert "tribolab.campaign.settings is not allowed to import tribolab.campaign.runs" in said
    assert "No circles, in packages and between them BROKEN" in said
    assert "Nothing below the face imports the public names BROKEN" in said


def test_every_room_stands_in_the_plan():
    layers = (PROJECT / "pyproject.toml").read_text("utf-8").split("layers = [")[1].split("]")[0]
    assert {room for room in ROOMS if f"tribolab.{room}" not in layers} == set()


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
