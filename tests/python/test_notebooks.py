"""The notebooks run from their first cell to their last, and show images and tables."""

import pathlib

import cuvette
import pytest
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "experiments/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path, monkeypatch):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    monkeypatch.setenv("PYTHONPATH", str(pathlib.Path(cuvette.__file__).parents[1]))
    monkeypatch.setenv("JUPYTER_PLATFORM_DIRS", "1")
    notebook = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "outputs are not committed: clear them"
    nbclient.NotebookClient(
        notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}
    ).execute()
    outputs = [one for cell in notebook.cells for one in cell.get("outputs", [])]
    shown = {kind for one in outputs for kind in one.get("data", {})}
    assert {"image/png", "text/html"} <= shown and not any(one["output_type"] == "error" for one in outputs)


def test_there_are_two():
    assert len(NOTEBOOKS) >= 2
