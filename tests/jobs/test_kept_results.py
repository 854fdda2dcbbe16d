"""Results folders of earlier versions are read, verified and computed again by this one."""

import shutil
import tarfile
from pathlib import Path

import numpy as np
import pytest
from kept_results import KINDS, PAGE, REVIEWED, raw_campaign

import tribolab as tl
from tribolab.app.run import run_campaign
from tribolab.app.verifying import problems

ARCHIVES = sorted(Path(__file__).parents[1].glob("kept_results/*.tar.xz"))


@pytest.fixture(scope="module", params=ARCHIVES, ids=lambda path: path.name)
def kept(request, tmp_path_factory):
    """Results folders of one version by kind."""
    folder = tmp_path_factory.mktemp("kept")
    with tarfile.open(request.param) as archive:
        archive.extractall(folder, filter="data")
    return folder


def test_there_are_results_of_some_version():
    assert ARCHIVES


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_but_what_was_left_out_is_missing(kept, kind):
    missing = [text.split(":")[0] for text in problems(kept / kind)]
    assert PAGE in missing
    assert all(name == PAGE or name.endswith(".parquet") for name in missing)


@pytest.mark.parametrize("kind", KINDS)
def test_tables_and_data_of_every_run_are_read(kept, kind):
    results = tl.read_results(kept / kind)
    names = results["runs" if "runs" in results else "friction"].run.unique().tolist()
    runs = results.runs()
    assert runs.run.values.tolist() == names and REVIEWED in names
    for name in names:
        measured = results.data(name, "friction").friction_coefficient.values
        assert np.isfinite(measured).any()
        table = results["friction"]
        stated = table[table.run == name].friction_coefficient.to_numpy(float)
        np.testing.assert_allclose(measured, stated, rtol=1e-6)


def test_a_surface_and_a_model_are_read(kept):
    results = tl.read_results(kept / "surfaces_and_models")
    [model] = (kept / "surfaces_and_models" / "data").glob("model_*.nc")
    assert results.data(model.stem, "curve").sizes
    assert np.isfinite(results["roughness"].select_dtypes(float)).any().any()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_run_beside_them_completes_the_folder(kept, kind, tmp_path):
    campaign = raw_campaign(tmp_path / "campaign", kind)
    shutil.copytree(kept / kind, campaign.parent / "results")
    outcome = run_campaign(campaign, jobs=1, figures="none")
    assert (outcome.folder / PAGE).is_file() and problems(outcome.folder) == []
