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


def test_bodies_have_colors(small, tmp_path):
    vertices, faces = grid(5)
    both, faces = np.concatenate([vertices, vertices + [1.2, 0, 0]]), np.concatenate([faces, faces + 25])
    options = {"size": (96, 48), "view": "top", "quality": "fast"}
    bodies = np.repeat([0, 1], 25)

    def halves(pixels):
        """The mean color of what is not gray, left and right."""
        sides = pixels[:, :48], pixels[:, 48:]
        colored = [side[np.ptp(side.astype(int), axis=2) > 40] for side in sides]
        return [side.mean(axis=0) if len(side) else None for side in colored]

    plain = bowknot.render(both, faces, **options)
    left, right = halves(bowknot.render(both, faces, bodies=bodies, **options))
    assert np.abs(left - right).max() > 30 and np.abs(halves(plain)[0] - halves(plain)[1]).max() < 10
    left, right = halves(bowknot.render(both, faces, bodies=bodies, colors=["#c02020", (20, 20, 200)], **options))
    assert left.argmax() == 0 and right.argmax() == 2
    left, right = halves(bowknot.render(both, faces, bodies=bodies, obstacles=bodies == 1, **options))
    assert left is not None and right is None
    green = bowknot.render(small, colors={small.names[0]: "#10d010"}, size=(96, 48), quality="fast")
    assert (green != bowknot.render(small, size=(96, 48), quality="fast")).any()
    # Parts of a file have colors of their own.
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in both)
    for name, first in (("a", 0), ("b", len(faces) // 2)):
        text += f"o {name}\n" + "".join(f"f {i + 1} {j + 1} {k + 1}\n" for i, j, k in faces[first : first + 32])
    (tmp_path / "two.obj").write_text(text)
    left, right = halves(bowknot.render(tmp_path / "two.obj", colors={"b": "#10d010"}, **options))
    assert right.argmax() == 1 and left.argmax() != 1


def test_frames_of_a_run_are_drawn(tmp_path):
    scene = bowknot.Scene(simulation={"frames": 12, "dt": 0.02})
    scene.add_body(*grid(4, 0.4, 0.5), name="cloth")
    scene.add_obstacle(shape="half-space", name="ground")
    run = bowknot.run(scene, tmp_path / "run")
    options = {"size": (64, 48), "quality": "fast", "eye": [0, -2, 1], "target": [0, 0, 0.3]}
    first, last = run.render(0, **options), bowknot.Run(run.folder).render(**options)
    assert (first != last).any() and (last == bowknot.render(run, frame=12, **options)).all()
    # The same as the simulation that it is: the ground is no square.
    simulator = bowknot.Simulator(scene)
    assert np.abs(first.astype(int) - simulator.render(**options)).max() < 8
    assert (run.render(0, colors={"cloth": "#10d010"}, **options) != first).any()
    with pytest.raises(InputError, match="frame 13 is not in"):
        run.render(13, **options)
    with pytest.raises(InputError, match="frame: only a Run has several"):
        bowknot.render(*grid(3), frame=0)


@pytest.mark.parametrize(
    "options",
    [
        {"bodies": [0]},
        {"colors": "red"},
        {"colors": ["red"]},
        {"colors": [(0.5, 0.5, 0.5)]},
        {"colors": [(0, 0, 256)]},
        {"colors": {"cape": "#000000"}},
        {"colors": {0.5: "#000000"}},
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
