"""The notebooks of the documentation run to their ends, and are kept without outputs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

NOTEBOOKS = sorted((Path(__file__).resolve().parents[2] / "docs" / "notebooks").glob("*.ipynb"))

# What Jupyter's own parts deprecate is not ours; warnings in the cells are errors below.
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(autouse=True)
def backend_of_the_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels draw inline, whatever backend the environment asks for."""
    monkeypatch.delenv("MPLBACKEND", raising=False)


def run(book: Any, folder: Path) -> Any:
    """A copy of a notebook with the outputs of all cells."""
    return NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()


def outputs(book: Any) -> list[Any]:
    return [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]


def test_there_are_notebooks() -> None:
    assert [file.stem for file in NOTEBOOKS] == ["first-run", "fragility", "overturning"]


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_a_notebook_runs_and_draws(file: Path, tmp_path: Path) -> None:
    book = nbformat.read(file, as_version=4)
    nbformat.validate(book)
    assert outputs(book) == [] and all(cell.execution_count is None for cell in book.cells if cell.cell_type == "code")
    assert file.stat().st_size < 20_000
    made = outputs(run(book, tmp_path))
    warned = [output.text for output in made if output.output_type == "stream" and output.name == "stderr"]
    assert warned == []
    pictures = [output for output in made if "data" in output and any(kind.startswith("image/") for kind in output.data)]
    assert len(pictures) >= 2
    assert list(tmp_path.iterdir()) == []


def test_a_notebook_that_raises_fails(tmp_path: Path) -> None:
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("import rocking as rk\nrk.Column.prisms(0, half_width=0.4, half_height=1.6)")])
    with pytest.raises(CellExecutionError, match="SceneError"):
        run(book, tmp_path)
