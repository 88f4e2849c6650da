"""The notebooks of the documentation: their cells run, and their outputs are whole and small."""

import json
import re
import sys
from types import ModuleType
from unittest.mock import MagicMock

import pytest
from conftest import ROOT

import bowknot

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
#: Largest size of all notebooks together [bytes].
LARGEST = 3_000_000


def cells(path):
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            yield cell, "".join(cell["source"])


def needs(cell):
    """The optional packages that a cell needs."""
    tags = cell["metadata"].get("tags", [])
    return [tag.removeprefix("needs-") for tag in tags if tag.startswith("needs-")]


@pytest.fixture
def no_figures(monkeypatch):
    """A matplotlib that draws nothing."""
    plots = MagicMock()
    plots.subplots.side_effect = lambda rows, columns, **_: (MagicMock(), [MagicMock() for _ in range(columns)])
    package = ModuleType("matplotlib")
    package.pyplot = plots
    monkeypatch.setitem(sys.modules, "matplotlib", package)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", plots)


def test_there_are_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["garment", "own_solver", "slope"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_cells_run(path, no_figures, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    frames = {"garment": 20, "own_solver": 30, "slope": 150}[path.stem]
    names = {}
    for index, (cell, source) in enumerate(cells(path)):
        if needs(cell):
            continue
        source = re.sub(r"^FRAMES = \d+$", f"FRAMES = {frames}", source, flags=re.MULTILINE)
        try:
            exec(compile(source, f"{path.name}, cell {index}", "exec"), names)
        except bowknot.DeviceError as error:
            pytest.skip(f"cell {index}: {error}")
    assert names["FRAMES"] == frames


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_all_cells_are_executed(path):
    counts = []
    for cell, source in cells(path):
        counts.append(cell["execution_count"])
        assert cell["outputs"] or not re.search(r"^(print|show|report|plt\.show|assert report)\(", source, re.MULTILINE)
        assert all(output["output_type"] != "error" for output in cell["outputs"])
        assert set(cell["metadata"]) <= {"tags"}
        for package in needs(cell):
            assert package in ("mujoco", "newton")
    assert counts == list(range(1, len(counts) + 1))


def test_they_are_small_and_name_no_folder():
    assert sum(path.stat().st_size for path in NOTEBOOKS) < LARGEST
    for path in NOTEBOOKS:
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"(?<![\w/])/(home|root|tmp|usr|Users|work)/", text)
