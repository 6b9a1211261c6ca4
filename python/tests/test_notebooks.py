"""The notebooks run from top to bottom. Their own assertions check the physics."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).resolve().parents[1] / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path):
    notebook = nbformat.read(path, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "commit notebooks without outputs"
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = {kind for cell in notebook.cells for output in cell.get("outputs", ()) for kind in output.get("data", {})}
    assert "image/png" in shown
    if path.stem == "pendulum":
        assert any("<iframe srcdoc=" in str(output) for cell in notebook.cells for output in cell.get("outputs", ()))


def test_there_are_three_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["atoms", "pendulum", "sweep"]
