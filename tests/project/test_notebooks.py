"""The notebooks run from top to bottom, without a warning, and are kept without outputs."""

import ast
import asyncio
import os
import re
from pathlib import Path

import jupyter_client
import nbclient
import nbconvert
import nbformat
import pytest

PROJECT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((PROJECT / "notebooks").glob("*.ipynb"))
# what concerns who wrote the notebook; that a package lacks MPI, for one, does not
STRICT = (
    "import warnings\n"
    "for kind in (UserWarning, RuntimeWarning, FutureWarning, DeprecationWarning):\n"
    "    where = '__main__' if kind is DeprecationWarning else ''\n"
    "    warnings.filterwarnings('error', category=kind, module=where)\n"
)
# of the notebook before, only what was imported is left
BARE = "%reset -f\nassert not {{'tl', 'plot', 'np'}} & set(globals())\n%cd -q {place}\n"

named = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


ANSWER = re.compile(r"<details>.*?```python\n(.*?)```.*?</details>", re.DOTALL)


def with_answers(notebook):
    """Put the code of the folded answers into cells behind them."""
    cells = []
    for cell in notebook.cells:
        cells.append(cell)
        if cell.cell_type == "markdown":
            cells += [nbformat.v4.new_code_cell(code) for code in ANSWER.findall(cell.source)]
    notebook.cells = cells


def pictures(cell):
    return [o for o in cell.get("outputs", ()) if "image/png" in o.get("data", ())]


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    """One kernel for all: its start and its imports take as long as half of a notebook."""
    folder = tmp_path_factory.mktemp("kernel")
    before = os.environ.get("PYTHONPATH")
    own = {
        "PYTHONPATH": os.pathsep.join(filter(None, [str(PROJECT), before])),
        "OPENBLAS_NUM_THREADS": "1",
        "IPYTHONDIR": str(folder / "ipython"),
        "TMPDIR": str(folder),  # what a notebook writes goes with the test
    }
    environment = os.environ | own
    environment.pop("MPLBACKEND", None)  # pyplot shows its figures in the notebook
    manager = jupyter_client.AsyncKernelManager(kernel_name="python3")
    asyncio.run(manager.start_kernel(env=environment, cwd=str(folder)))
    yield manager
    asyncio.run(manager.shutdown_kernel(now=True))


@pytest.fixture(scope="module")
def exporter():
    return nbconvert.HTMLExporter()


@pytest.mark.slow
@named
@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")  # of jupyter
def test_a_notebook_runs_without_error_or_warning(path, kernel, exporter, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    with_answers(notebook)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(BARE.format(place=str(tmp_path)) + STRICT))
    client = nbclient.NotebookClient(notebook, km=kernel, timeout=300)
    client.execute()
    client.kc.stop_channels()
    shown = [o for cell in notebook.cells for o in cell.get("outputs", ())]
    said = [o.get("text", o.get("evalue")) for o in shown if o.output_type == "error"]
    said += [o.text for o in shown if o.output_type == "stream" and o.name == "stderr"]
    assert said == []
    assert any(o.output_type in ("display_data", "execute_result") for o in shown)
    turned = [cell for cell in notebook.cells if "@plot.knobs" in cell.source]
    assert all(len(pictures(cell)) == 1 for cell in turned)
    notebook.metadata.pop("widgets", None)  # what a page without their state shows
    page, _ = exporter.from_notebook_node(notebook)
    assert (
        page.count('src="data:image/png') == sum(len(pictures(cell)) for cell in notebook.cells) > 0
    )


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
def test_a_notebook_uses_what_is_public_and_ends_with_an_exercise(path):
    notebook = nbformat.read(path, as_version=4)
    code = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    texts = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    for node in ast.walk(ast.parse(code)):
        homes = [node.module] if isinstance(node, ast.ImportFrom) else []
        homes += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        assert {home for home in homes if home.startswith("tribolab.")} <= {"tribolab.studies"}
    assert ANSWER.search(texts), "an exercise whose folded answer runs"
    assert texts.count("<details>") == texts.count("</details>") == texts.count("<summary>")


@named
def test_the_page_on_python_lists_the_notebook(path):
    assert f"(../notebooks/{path.name})" in (PROJECT / "docs/python.md").read_text(encoding="utf-8")
