"""The package as it is shipped: a wheel carries the descriptions of raw data with it."""

import json
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import tribolab
from tribolab.reading.schema_folder import schema_folder

PROJECT = Path(tribolab.__file__).resolve().parents[1]
SHOWS = (
    "import json, tribolab\n"
    "from tribolab.reading.schema_folder import schema_folder\n"
    "from tribolab.reading.dialect.find import known_dialects, load_dialect\n"
    "names = [load_dialect(name).name for name in known_dialects()]\n"
    "print(json.dumps([str(schema_folder()), names, tribolab.__version__]))\n"
)


def told_from(folder, cwd):
    done = subprocess.run(
        [sys.executable, "-c", SHOWS],
        cwd=cwd,
        env={"PYTHONPATH": str(folder), "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """Build a wheel from a copy of the sources, without network."""
    source = tmp_path_factory.mktemp("source")
    for name in ("tribolab", "raw_data_schema"):
        ignore = shutil.ignore_patterns("__pycache__")
        shutil.copytree(PROJECT / name, source / name, ignore=ignore)
    for name in ("pyproject.toml", "README.md"):
        shutil.copy(PROJECT / name, source)
    subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", "dist", "."],
        cwd=source,
        capture_output=True,
        check=True,
    )
    [built] = (source / "dist").glob("*.whl")
    return built


@pytest.mark.slow
def test_a_wheel_finds_its_schemas_wherever_it_is_used(wheel, tmp_path):
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "unpacked")
    folder, names, version = told_from(tmp_path / "unpacked", tmp_path)
    assert Path(folder) == tmp_path / "unpacked" / "tribolab" / "raw_data_schema"
    assert "linear_slider" in names
    assert version == tribolab.__version__
    for path in sorted((PROJECT / "raw_data_schema").rglob("*")):
        if path.is_file():
            shipped = Path(folder) / path.relative_to(PROJECT / "raw_data_schema")
            assert shipped.read_bytes() == path.read_bytes(), path.name


@pytest.mark.slow
def test_a_wheel_carries_what_the_report_needs(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    sources = [path for path in (PROJECT / "tribolab").rglob("*") if path.is_file()]
    wanted = {p.relative_to(PROJECT).as_posix() for p in sources if "__pycache__" not in p.parts}
    assert wanted <= names


def test_a_checkout_finds_its_schemas_from_anywhere(tmp_path):
    folder, names, _ = told_from(PROJECT, tmp_path)
    assert Path(folder) == PROJECT / "raw_data_schema" == schema_folder()
    assert "linear_slider" in names


def test_the_citation_names_this_version():
    text = (PROJECT / "README.md").read_text(encoding="utf-8")
    assert f"version = {{{tribolab.__version__}}}" in text
