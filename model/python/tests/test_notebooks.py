"""The notebooks run from the first cell to the last, and show pictures."""

import base64
import os
import pathlib
import re

import nbclient
import nbformat
import pytest

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def test_there_are_notebooks():
    assert len(NOTEBOOKS) >= 2


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_notebook(path, tmp_path, monkeypatch):
    monkeypatch.setenv("QUADRILLE_RTL", str(FOLDER.parents[2] / "rtl"))  # the kernel runs elsewhere
    notebook = nbformat.read(path, as_version=4)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in cells), "outputs are not committed"
    # Seconds of a cell, which takes three, or simulates. A reply whose wake-up is lost (pyzmq under asyncio) is found
    # when they end.
    nbclient.NotebookClient(
        notebook,
        timeout_func=lambda cell: 300 if "simulator.test" in cell.source else 60,
        resources={"metadata": {"path": tmp_path}},
    ).execute()
    outputs = [output for cell in cells for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error"]
    if path.stem == "check_your_own_rtl":  # the RTL under cocotb, against the model
        printed = "".join(output.text for output in outputs if output.output_type == "stream")
        assert int(re.search(r"(\d+) fragments, 0 mismatches, seed \d+\n0 of 1 tests failed", printed)[1]) > 100
    pictures = [output.data["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) >= 2 and min(map(len, pictures)) > 4000  # an empty one is smaller
    # To be looked at: QUADRILLE_PICTURES=FOLDER
    if folder := os.environ.get("QUADRILLE_PICTURES"):
        for i, picture in enumerate(pictures):
            pathlib.Path(folder, f"{path.stem}_{i}.png").write_bytes(base64.b64decode(picture))
