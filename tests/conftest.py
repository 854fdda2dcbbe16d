"""Fixtures that every test file shares."""

import os
from pathlib import Path

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "Agg")
# workers of the suite beside each other: more threads of BLAS than processors only wait
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# the same examples at every run, however busy the machine; HYPOTHESIS_PROFILE=default searches anew
settings.register_profile("seeded", derandomize=True, deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "seeded"))

SHARED = Path(__file__).resolve().parents[2] / "shared"


@pytest.fixture(scope="session")
def shared() -> Path:
    """Reference material beside the project; tests on it run wherever it is present."""
    if not SHARED.is_dir():
        pytest.skip("the reference material (../shared) is not beside the project")
    return SHARED


@pytest.fixture(scope="session")
def shared_data(shared: Path) -> Path:
    """Real measured files."""
    return shared / "data"


@pytest.fixture(scope="session")
def original(tmp_path_factory):
    """A campaign with results, in which two runs went wrong; tests copy it."""
    from reviews import faulted

    return faulted(tmp_path_factory.mktemp("review"))


@pytest.fixture(scope="session")
def reviewed(original, tmp_path_factory):
    """The same with decisions on three of four runs; and what the campaign came to."""
    from reviews import decided_on

    return decided_on(original, tmp_path_factory.mktemp("reviewed"))
