"""Pictures; they need a graphics driver, which the variable BOWKNOT_NEED_DRIVER demands."""

import os

import numpy as np
import pytest
from conftest import grid

import bowknot
from bowknot import DeviceError, InputError


@pytest.fixture(scope="module", autouse=True)
def driver():
    try:
        bowknot.render(*grid(2), size=(16, 16), quality="fast")
    except DeviceError as error:
        if os.environ.get("BOWKNOT_NEED_DRIVER"):
            raise
        pytest.skip(str(error))


def test_a_simulation_is_drawn(small):
    pixels = small.render(size=(160, 120), quality="fast")
    assert pixels.shape == (120, 160, 3) and pixels.dtype == np.uint8
    assert pixels.std() > 5.0
    html = small._repr_html_()
    assert html.startswith('<figure><img src="data:image/png;base64,')
    values = np.linspace(0.0, 1.0, len(small.obstacle_vertices))
    colored = small.render(size=(160, 120), quality="fast", values=values)
    assert (colored != pixels).any()


def test_what_is_not_there_is_not_drawn():
    ball = {"type": "ball", "radius": 0.1, "edge": 0.05}
    scene = bowknot.Scene(simulation={"dt": 0.01})
    scene.add_body(*grid(3, 0.2), name="cloth")
    scene.add_obstacle(shape=ball, translate=[0.3, 0, 0], name="first", vanishes=0.015)
    options = {"size": (64, 48), "quality": "fast", "eye": [0, -2, 1], "target": [0, 0, 0]}
    pictures = []
    simulator = bowknot.Simulator(scene)
    for _ in simulator.steps(3):
        pictures.append(simulator.render(**options))
    assert np.abs(pictures[0].astype(int) - pictures[2]).max() > 30


def test_a_mesh_is_drawn():
    vertices, faces = grid(5)
    top = bowknot.render(vertices, faces, size=(64, 48), view="top", quality="fast")
    side = bowknot.render(vertices, faces, size=(64, 48), eye=[3, 3, 3], target=[0, 0, 0], quality="fast")
    assert (top != side).any()
    none = np.zeros((0, 4), np.uint32)
    strand = bowknot.Mesh(vertices, none[:, :3], none, np.array([[0, 1]], np.uint32), np.array([7], np.uint32))
    assert bowknot.render(strand, size=(64, 48), quality="fast").std() > 0.0


@pytest.mark.parametrize(
    "options",
    [
        {"size": (0, 0)},
        {"size": (10**6, 10**6)},
        {"size": (-1, 5)},
        {"size": "large"},
        {"size": (5, 5)},
        {"view": "back"},
        {"quality": "best"},
        {"fov": np.nan},
        {"fov": 180.0},
        {"eye": [0, 0, 0], "target": [0, 0, 0]},
        {"eye": [np.nan, 0, 0]},
        {"values": [1.0]},
    ],
)
def test_what_cannot_be_drawn_is_refused(options):
    with pytest.raises(InputError):
        bowknot.render(*grid(3), **{"size": (64, 48), "quality": "fast", **options})
    with pytest.raises(InputError):
        bowknot.render(np.zeros((0, 3)))
    with pytest.raises(InputError):
        bowknot.render(np.full((3, 3), np.nan), [[0, 1, 2]])
