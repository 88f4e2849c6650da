"""Every Python block of the documentation runs, and every example of a docstring."""

import doctest
import importlib
import re
import types

import pytest
from conftest import ROOT

import bowknot

DOCUMENTS = [ROOT / "docs" / "python.md", ROOT / "docs" / "cluster.md", ROOT / "crates" / "python" / "README.md"]


def blocks(path):
    text = path.read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.name)
def test_blocks_run_from_top_to_bottom(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = blocks(path)
    assert found
    names = {}
    for index, block in enumerate(found):
        try:
            exec(compile(block, f"{path.name}, block {index}", "exec"), names)
        except bowknot.DeviceError as error:
            pytest.skip(f"block {index}: {error}")


@pytest.mark.parametrize(
    "name",
    "_resolver _scene _shapes _simulator _tools _meshes _movie _pictures _runs _info _files sweep".split(),
)
def test_examples_of_docstrings_hold(name):
    module = importlib.import_module(f"bowknot.{name}")
    assert doctest.testmod(module).failed == 0


def public(thing, path):
    yield path, thing
    if isinstance(thing, type):
        for name, member in vars(thing).items():
            if not name.startswith("_") and isinstance(
                member, (types.FunctionType, property, classmethod, staticmethod)
            ):
                yield f"{path}.{name}", member


def test_all_that_is_public_has_a_docstring():
    found = [entry for name in bowknot.__all__ for entry in public(getattr(bowknot, name), name)]
    missing = [path for path, thing in found if not (getattr(thing, "__doc__", None) or "").strip()]
    assert not missing
    assert len(found) > 80
