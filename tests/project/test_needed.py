"""What workers import beforehand is there under its name, and loads no arrays of others."""

import gc
import subprocess
import sys
import zipfile
from importlib.util import find_spec

import pandas as pd
import pytest

from tribolab.app.info.file_info import file_lines
from tribolab.app.needed import ANALYSIS, FILES, SIMULATION
from tribolab.campaign.engine.cluster import dask_executor
from tribolab.campaign.engine.pool import LastingPool
from tribolab.core.errors import ConfigError, TribolabError

_WORKER = """
import importlib, sys
from tribolab.app.needed import ANALYSIS, SIMULATION
for name in SIMULATION + ANALYSIS:
    importlib.import_module(name)
import xarray as xr
xr.Dataset({"force": ("time", [1.0, 2.0])}, {"time": [0.0, 0.1]}).force.to_numpy()
print(sorted({"dask", "pint"} & set(sys.modules)))
"""

_UNCHANGED = """
import sys
import tribolab.app.first_campaign, tribolab.app.run, tribolab.app.terminal
import tribolab.campaign.store.unchanged, tribolab.cli
print(sorted({"xarray", "pandas", "scipy", "pint", "matplotlib", "netCDF4"} & set(sys.modules)))
"""


def test_telling_that_nothing_changed_loads_none_of_what_analyses():
    done = subprocess.run([sys.executable, "-c", _UNCHANGED], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stdout + done.stderr


@pytest.mark.parametrize("name", sorted({*FILES, *SIMULATION, *ANALYSIS}))
def test_a_module_that_workers_import_is_there(name):
    # a name that is not there is passed over, and only the time would tell
    assert find_spec(name) is not None


@pytest.mark.slow
def test_the_workers_of_a_campaign_load_no_arrays_but_numpys():
    done = subprocess.run([sys.executable, "-c", _WORKER], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr


def test_a_worker_looks_for_garbage_though_not_in_what_was_imported():
    with LastingPool(1, ["numpy"]) as pool:
        looks, left_alone = pool.submit(gc.isenabled), pool.submit(gc.get_freeze_count)
        assert looks.result() and left_alone.result() > 10_000


def _workbook(folder):
    pd.DataFrame({"Fx [N]": [1.0, 2.0]}).to_excel(folder / "log.xlsx", index=False)
    return folder / "log.xlsx"


def _packed(folder):
    with zipfile.ZipFile(folder / "log.zip", "w") as packed:
        packed.write(_workbook(folder), "log.xlsx")
    return folder / "log.zip"


def _beginning(name, magic):
    def written(folder):
        (folder / name).write_bytes(magic.ljust(600, b"\0"))
        return folder / name

    return written


_HDF5 = b"\x89HDF\r\n\x1a\n"
FORMATS = "'tribolab[formats]'"


@pytest.mark.parametrize(
    ("library", "write", "package", "source"),
    [
        ("python_calamine", _workbook, "python-calamine", FORMATS),
        ("python_calamine", _packed, "python-calamine", FORMATS),
        ("nptdms", _beginning("log.tdms", b"TDSm"), "npTDMS", FORMATS),
        ("h5py", _beginning("log.h5", _HDF5), "h5py", "h5py"),
        ("SurfaceTopography", _beginning("a.sur", b"DIGITAL SURF"), "SurfaceTopography", FORMATS),
        ("SurfaceTopography", _beginning("a.al3d", b"AliconaImaging\0\r\n"), "", FORMATS),
    ],
)
def test_a_file_whose_library_is_missing_says_what_to_install(
    tmp_path, without, library, write, package, source
):
    path = write(tmp_path)
    without(library)
    with pytest.raises(TribolabError) as told:
        file_lines(path)
    assert f"needs the package {package}" in str(told.value)
    assert f"pip install {source}" in str(told.value)


def test_a_scheduler_without_dask_says_what_to_install(without):
    without("distributed")
    with (
        pytest.raises(ConfigError, match=r"pip install 'tribolab\[cluster\]'"),
        dask_executor("tcp://127.0.0.1:1"),
    ):
        pass
