"""Fixtures that every test file shares, and in which order the files are worked through."""

import gc
import os
import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from chromium import BROWSER, chromium
from hypothesis import settings

from tribolab.reading.raw.server import stop_reading

os.environ.setdefault("MPLBACKEND", "Agg")
# what is compiled is kept: children and the next run start in less time
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
# of jsonschema, for a format that no schema of ours has: its grammar takes a second to build
sys.modules.setdefault("rfc3987_syntax", None)
# workers of the suite beside each other: more threads of BLAS than processors only wait
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# the same examples at every run, however busy the machine; HYPOTHESIS_PROFILE=default searches anew
settings.register_profile("seeded", derandomize=True, deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "seeded"))

SHARED = Path(__file__).resolve().parents[2] / "shared"


def pytest_collection(session):
    gc.disable()  # what is collected stays


def pytest_collection_finish(session):
    # libraries and tests, a million objects, are not gone through again at every look for garbage
    gc.freeze()
    gc.enable()


@pytest.hookimpl(trylast=True)  # once the marks have chosen
def pytest_collection_modifyitems(items):
    """Put the files with the most slow tests first: so no worker is left alone with one."""
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))
    items.sort(key=lambda item: -slow[item.path])


@pytest.fixture(scope="session", autouse=True)
def one_process():
    """Work in this process by default, on any machine; tests of processes ask for them."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("tribolab.campaign.engine.executor.default_jobs", lambda: 1)
        yield


@pytest.fixture
def without(tmp_path_factory, monkeypatch):
    """Have libraries be missing for what reads files: in this process, and in its children."""

    def missing(*libraries: str) -> None:
        folder = tmp_path_factory.mktemp("absent")
        for name in libraries:
            monkeypatch.setitem(sys.modules, name, None)
            (folder / f"{name}.py").write_text(f"raise ImportError(name={name!r})")
        monkeypatch.syspath_prepend(str(folder))
        stop_reading()

    yield missing
    stop_reading()


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
def one_browser(tmp_path_factory):
    """One process for all pages that are opened."""
    if not BROWSER:
        message = "no page could be opened: no chromium was found"
        (pytest.fail if os.environ.get("TRIBOLAB_REQUIRE_BROWSER") else pytest.skip)(message)
    with chromium(tmp_path_factory.mktemp("profile")) as started:
        yield started


@pytest.fixture(scope="module")
def browser(one_browser):
    """A browser that knows nothing of what other files' tests did in it."""
    with one_browser.apart() as browser:
        yield browser


@pytest.fixture(scope="module")
def results(whole, tmp_path_factory):
    """The page of a file's own `whole` as it is sent: in a folder with nothing beside it.

    tests/report/test_report_page.py shows that it asks for nothing where it lies among its results.
    """
    from report_pages import sent

    return sent(whole, tmp_path_factory)


@pytest.fixture(scope="session")
def flagged_results(tmp_path_factory):
    """Results with a flagged run, a long one and a failed one; not to be changed."""
    from report_pages import made

    return made(tmp_path_factory.mktemp("flagged"))


@pytest.fixture(scope="session")
def repeated_results(tmp_path_factory):
    """Results of two conditions, one of them at two loads, with repeats; not to be changed."""
    from report_pages import made_with_repeats

    return made_with_repeats(tmp_path_factory.mktemp("repeated"))


@pytest.fixture(scope="session")
def two_runs(tmp_path_factory):
    """A campaign of two runs with results, recorded some time ago; tests copy it."""
    from campaigns import simulated

    from tribolab.app.run import run_campaign

    file = simulated(tmp_path_factory.mktemp("two_runs"), repeats=1)
    for path in (file.parent / "raw").rglob("*.csv"):
        os.utime(path, (time.time() - 60,) * 2)
    run_campaign(file, jobs=1, figures="none")
    return file


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
