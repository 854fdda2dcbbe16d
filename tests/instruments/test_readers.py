"""Readers in Python: a file of one's own beside a campaign, and an installed package."""

import zipfile

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.core.errors import ConfigError, ReadError

T = np.arange(600) / 100
LOAD, SPEED = 20.0, np.where(T < 3, 1e-3, -1e-3)
FRICTION = 0.3 * LOAD * np.sign(SPEED)
READER = """
import numpy as np
import xarray as xr


def can_read(head):
    return "yes" if head.startswith(b"RIG7") else "no"


def read(path):
    t, ft, fn, v = np.fromfile(path, "<f8", offset=8).reshape(-1, 4).T
    signals = {
        "friction_force": ("time", ft, {"units": "mN"}),
        "normal_force": ("time", fn, {"units": "N"}),
        "sliding_velocity": ("time", v, {"units": "m/s"}),
    }
    return xr.Dataset(signals, {"time": ("time", t, {"units": "ms"})})
"""
RAW_FILE = """
import numpy as np
from tribolab.reading.raw.model import RawColumn, RawFile, RawTable


def can_read(head):
    return "maybe"


def read(path):
    t, ft, fn, v = np.fromfile(path, "<f8", offset=8).reshape(-1, 4).T
    signals = (("time", "ms", t), ("friction_force", "mN", ft), ("normal_force", "N", fn))
    columns = [RawColumn(name, unit, values) for name, unit, values in signals]
    columns.append(RawColumn("sliding_velocity", "m/s", v))
    return RawFile(path, "rig 7", (RawTable("", tuple(columns)),))
"""
CAMPAIGN = """
[campaign]
name = "rig 7"
[[run]]
files = "*.rig"
instrument = "my_reader.py"
"""


def write_run(path):
    rows = np.column_stack([1e3 * T, 1e3 * FRICTION, np.full(T.size, LOAD), SPEED])
    path.write_bytes(b"RIG7\0\0\0\0" + rows.astype("<f8").tobytes())
    return path


def is_right(run):
    np.testing.assert_allclose(run.time, T, atol=1e-12)
    np.testing.assert_allclose(run.friction_force, FRICTION, rtol=1e-12)
    np.testing.assert_allclose(run.normal_force, LOAD)
    np.testing.assert_allclose(run.sliding_velocity, SPEED)
    assert run.attrs["instrument"] == "my_reader"


def mean_friction(outcome):
    table = pd.read_csv(outcome.folder / "tables" / "friction.csv")
    return float(table.friction_coefficient.abs().mean())


@pytest.fixture
def campaign(tmp_path):
    (tmp_path / "raw").mkdir()
    write_run(tmp_path / "raw" / "one.rig")
    (tmp_path / "my_reader.py").write_text(READER)
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    return tmp_path / "campaign.toml"


@pytest.mark.parametrize("code", [READER, RAW_FILE])
def test_a_run_is_read_by_a_file_of_python_in_the_units_that_it_states(code, tmp_path):
    (tmp_path / "my_reader.py").write_text(code)
    is_right(tl.read(write_run(tmp_path / "one.rig"), str(tmp_path / "my_reader.py")))


def test_a_scan_is_read_by_a_file_of_python(tmp_path):
    (tmp_path / "map.py").write_text(
        """
import numpy as np
import xarray as xr


def can_read(head):
    return "yes"


def read(path):
    z = np.fromfile(path, "<f8").reshape(30, 40)
    um = {"units": "um"}
    axes = {"y": ("y", 2.0 * np.arange(30), um), "x": ("x", 0.5 * np.arange(40), um)}
    return xr.Dataset({"height": (("y", "x"), z, {"units": "nm"})}, axes)
"""
    )
    heights = np.random.default_rng(1).normal(size=(30, 40))
    (tmp_path / "a.map").write_bytes(heights.tobytes())
    scan = tl.read_scans(tmp_path / "a.map", str(tmp_path / "map.py"))
    np.testing.assert_allclose(scan.height, 1e-9 * heights, rtol=1e-9)
    np.testing.assert_allclose(scan.x, 0.5e-6 * np.arange(40), atol=1e-15)


def test_a_campaign_runs_its_own_python_only_if_it_is_trusted(campaign):
    marker = campaign.parent / "it_ran"
    reader = campaign.parent / "my_reader.py"
    reader.write_text(f"open({str(marker)!r}, 'w').close()\n{READER}")
    with pytest.raises(ConfigError, match="'my_reader.py' is a Python program that belongs"):
        tl.run_campaign(campaign, jobs=1)
    done = CliRunner().invoke(cli.app, ["run", str(campaign), "--jobs", "1", "--quiet"])
    assert done.exit_code == 2
    assert done.output.count("tribolab:") == 1 and "--trust" in done.output
    assert not marker.exists() and not (campaign.parent / "results").exists()
    outcome = tl.run_campaign(campaign, jobs=1, trust=True, figures="none")
    assert marker.exists()
    assert outcome.runs[0].done


def test_a_changed_reader_is_run_again_and_packed(campaign):
    outcome = tl.run_campaign(campaign, jobs=1, trust=True, figures="none")
    friction = mean_friction(outcome)
    assert friction == pytest.approx(0.3, rel=1e-6)
    reader = campaign.parent / "my_reader.py"
    reader.write_text(READER.replace("ft, {", "2 * ft, {"))
    outcome = tl.run_campaign(campaign, jobs=1, trust=True, figures="none")
    friction = mean_friction(outcome)
    assert friction == pytest.approx(0.6, rel=1e-6)
    packed = campaign.parent / "deposit.zip"
    done = CliRunner().invoke(cli.app, ["pack", str(outcome.folder), "--output", str(packed)])
    assert done.exit_code == 0, done.output
    with zipfile.ZipFile(packed) as archive:
        names = [name for name in archive.namelist() if name.endswith("my_reader.py")]
        assert len(names) == 1 and b"2 * ft" in archive.read(names[0])


def test_an_installed_reader_is_found_by_the_file_that_it_can_read(tmp_path, monkeypatch):
    from tribolab.reading.raw import readers

    (tmp_path / "my_reader.py").write_text(READER)
    about = tmp_path / "my_reader-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-reader\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[tribolab.readers]\nmy_reader = my_reader\n")
    file = write_run(tmp_path / "one.rig")
    monkeypatch.syspath_prepend(str(tmp_path))
    readers.installed_readers.cache_clear()
    try:
        is_right(tl.read(file))
        is_right(tl.read(file, "my_reader"))
        (tmp_path / "other.rig").write_bytes(b"RIG8" + file.read_bytes()[4:])
        with pytest.raises(ReadError, match="neither text nor a binary format"):
            tl.read(tmp_path / "other.rig")
    finally:
        monkeypatch.undo()
        readers.installed_readers.cache_clear()


@pytest.mark.parametrize(
    ("old", "new", "error", "words"),
    [
        ("def read(", "def load(", ConfigError, "read"),
        ('"yes" if', '"of course" if', ConfigError, "return 'yes', 'maybe' or 'no'"),
        ("RIG7", "RIG8", ReadError, "does not read such a file"),
        (".reshape(-1, 4)", ".reshape(-1, 7)", ReadError, r"ValueError.*my_reader.py, line 1\d"),
        ('{"units": "mN"}', "{}", ReadError, "states no unit of 'friction_force', e.g. 'N'"),
        (
            "    return xr.Dataset",
            "    return t.tolist()\n    return dict",
            ReadError,
            "returns a list",
        ),
        ("import numpy", "import nothing_of_that_name", ConfigError, "ModuleNotFoundError"),
    ],
)
def test_what_is_wrong_with_a_reader_is_one_message(old, new, error, words, tmp_path):
    (tmp_path / "my_reader.py").write_text(READER.replace(old, new, 1))
    file = write_run(tmp_path / "one.rig")
    with pytest.raises(error, match=words):
        tl.read(file, str(tmp_path / "my_reader.py"))


def test_a_dataset_without_time_lacks_it(tmp_path):
    without = READER.replace('{"time": ("time", t, {"units": "ms"})}', "{}")
    (tmp_path / "my_reader.py").write_text(without)
    with pytest.raises(ReadError, match="'time'"):
        tl.read(write_run(tmp_path / "one.rig"), str(tmp_path / "my_reader.py"))
