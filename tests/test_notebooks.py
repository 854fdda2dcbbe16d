"""The notebooks run from top to bottom, without a warning, and are kept without outputs."""

import os
from pathlib import Path

import nbclient
import nbformat
import pytest

PROJECT = Path(__file__).resolve().parents[1]
NOTEBOOKS = sorted((PROJECT / "notebooks").glob("*.ipynb"))
# what concerns who wrote the notebook; that a package lacks MPI, for one, does not
STRICT = (
    "import warnings\n"
    "for kind in (UserWarning, RuntimeWarning, FutureWarning, DeprecationWarning):\n"
    "    where = '__main__' if kind is DeprecationWarning else ''\n"
    "    warnings.filterwarnings('error', category=kind, module=where)\n"
)

named = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def of_widgets(notebook):
    """What widgets have shown: errors in them do not stop the execution."""
    kept = notebook.metadata.get("widgets", {}).values()
    models = [model["state"] for view in kept for model in view["state"].values()]
    return [output for model in models for output in model.get("outputs", ())]


@pytest.mark.slow
@named
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")  # of jupyter
def test_a_notebook_runs_without_error_or_warning(path, tmp_path, monkeypatch):
    before = os.environ.get("PYTHONPATH")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, [str(PROJECT), before])))
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    place = tmp_path / "work"
    place.mkdir()
    notebook = nbformat.read(path, as_version=4)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(STRICT))
    client = nbclient.NotebookClient(
        notebook,
        timeout=300,
        kernel_name="python3",
        resources={"metadata": {"path": str(place)}},
    )
    client.execute()
    shown = [o for cell in notebook.cells for o in cell.get("outputs", ())] + of_widgets(notebook)
    said = [o.get("text", o.get("evalue")) for o in shown if o.output_type == "error"]
    said += [o.text for o in shown if o.output_type == "stream" and o.name == "stderr"]
    assert said == []
    assert any(o.output_type in ("display_data", "execute_result") for o in shown)


@named
def test_a_notebook_is_kept_without_outputs(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert notebook.cells[0].cell_type == "markdown"
    assert [cell.outputs for cell in code] == [[]] * len(code)
    assert {cell.execution_count for cell in code} == {None}
    assert "widgets" not in notebook.metadata
    assert notebook.metadata.kernelspec.name == "python3"


@named
def test_the_readme_lists_the_notebook(path):
    assert f"(notebooks/{path.name})" in (PROJECT / "README.md").read_text(encoding="utf-8")
