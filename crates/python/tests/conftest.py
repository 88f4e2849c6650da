"""What several tests share."""

import os
from pathlib import Path

import numpy as np
import pytest

import bowknot

ROOT = Path(__file__).resolve().parents[3]


def grid(side: int, size: float = 1.0, height: float = 0.0):
    """A square sheet of side x side vertices: vertices and faces."""
    ticks = np.linspace(-size / 2, size / 2, side)
    x, y = np.meshgrid(ticks, ticks, indexing="ij")
    vertices = np.column_stack([x.ravel(), y.ravel(), np.full(side * side, height)])
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.concatenate(
        [
            np.column_stack([corner, corner + side, corner + side + 1]),
            np.column_stack([corner, corner + side + 1, corner + 1]),
        ]
    )
    return vertices, faces


def two_sheets(side: int, gap: float = 0.1):
    """Two sheets, one above the other."""
    vertices, faces = grid(side)
    above = vertices + [0.0, 0.0, gap]
    return np.concatenate([vertices, above]), np.concatenate([faces, faces + len(vertices)])


@pytest.fixture(scope="session")
def command():
    """The command of the workspace: the variable BOWKNOT_COMMAND has its path."""
    path = os.environ.get("BOWKNOT_COMMAND")
    if not path:
        pytest.skip("BOWKNOT_COMMAND is not set")
    return path


@pytest.fixture
def small():
    """A small simulation in contact with an obstacle."""
    return bowknot.Simulator(bowknot.Scene.builtin("drape", scale=0.2))
