"""What workers import beforehand is there under its name, and loads no arrays of others."""

import gc
import subprocess
import sys
from importlib.util import find_spec

import pytest

from tribolab.app.needed import ANALYSIS, FILES, SIMULATION
from tribolab.campaign.engine.pool import LastingPool

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
