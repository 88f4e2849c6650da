"""Scenes from TOML, from the library, and from arrays."""

import copy
import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, grid

import bowknot
from bowknot import InputError, Scene, Simulator

TEXT = """
[simulation]
frames = 7
dt = 0.02

[[body]]
name = "sheet"
shape = { type = "sheet", size = [0.4, 0.4], edge = 0.05 }
translate = [0, 0, 0.3]

[[obstacle]]
name = "ground"
shape = "half-space"
"""


def test_toml_as_text_and_as_a_file(tmp_path):
    scene = Scene.from_toml(TEXT)
    assert (scene.frames, scene.dt, scene.bodies, scene.obstacles) == (7, 0.02, ["sheet"], ["ground"])
    path = tmp_path / "falling.toml"
    path.write_text(TEXT, encoding="utf-8")
    for given in (path, str(path)):
        assert Scene.from_toml(given).name == "falling"
    assert Scene.from_toml(scene.to_toml()) == scene == Scene.from_toml(scene.to_toml(short=False))
    scene.save(tmp_path / "again.toml")
    again = Scene.from_toml(tmp_path / "again.toml")
    assert again.bodies == ["sheet"]
    assert scene.info()["vertices"] > 50


def test_errors_are_those_of_the_command(tmp_path):
    with pytest.raises(InputError, match="scene.toml:3.*simulation.framess.*frames"):
        Scene.from_toml(TEXT.replace("frames", "framess"))
    with pytest.raises(InputError, match="no such file"):
        Scene.from_toml(tmp_path / "missing.toml")
    with pytest.raises(InputError, match="drape"):
        Scene.builtin("drapes")
    with pytest.raises(InputError, match="scale"):
        Scene.builtin("drape", scale=math.nan)
    scene = Scene.from_toml(TEXT)
    before = scene.copy()
    for key, value in (
        ("simulation.dt", -1.0),
        ("simulation.dt", "abc"),
        ("nothing", 1),
        ("contact.delta", math.inf),
        ("body.7", 0.1),
        ("body.sheet.material", "stone"),
    ):
        with pytest.raises(InputError, match=key.split(".")[-1]):
            scene.set(key, value)
        assert scene == before
    for value in (object(), {1, 2}, 2**70, b"abc", "\ud800", lambda: 1):
        with pytest.raises(InputError, match="simulation.dt"):
            scene.set("simulation.dt", value)


def test_keys_can_be_set():
    scene = Scene.from_toml(TEXT)
    scene.set("contact.delta", 0.002)
    scene.set("body.sheet.friction", 0.3)
    scene.set("contact.preset", "quick")
    scene.set("simulation.gravity", np.array([0.0, 0.0, -1.62]))
    text = scene.to_toml()
    for line in ("delta = 0.002", "friction = 0.3", 'preset = "quick"', "-1.62"):
        assert line in text


def test_a_scene_of_arrays():
    vertices, faces = grid(6, 0.5, 0.3)
    block = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 0.1 + [0.0, 0.0, 0.6]
    scene = Scene(
        bodies=[
            {"name": "cloth", "mesh": vertices, "faces": faces, "material": "silk", "friction": 0.2},
            {"name": "tet", "mesh": block, "tets": [[0, 1, 2, 3]]},
        ],
        obstacles=[{"name": "table", "mesh": vertices * [2, 2, 0], "faces": faces.tolist()}],
        pins=[{"body": "cloth", "vertices": np.array([0, 5])}],
        simulation={"frames": 3, "gravity": (0.0, 0.0, -1.0)},
        contact={"delta": 0.004},
    )
    scene.add_body([[0.0, 0.0, 0.8], [0.0, 0.1, 0.8]], name="grains")
    scene.add_body([[0.3, 0.0, 0.8], [0.3, 0.1, 0.8]], edges=[[0, 1]], name="hair")
    scene.add_body(shape={"type": "sheet", "size": [0.1, 0.1], "edge": 0.05}, translate=[0, 0, 1.2], name="patch")
    scene.add_obstacle(shape="half-space", translate=[0, 0, -1])
    scene.add_pin("patch", side="x-min", end=0.1)
    assert scene.bodies == ["cloth", "tet", "grains", "hair", "patch"]
    assert scene.obstacles == ["table", "obstacle1"]
    simulator = Simulator(scene)
    assert (simulator.positions_of("cloth") == vertices).all()
    assert (simulator.faces_of("cloth") == faces).all()
    assert (simulator.positions_of("table") == vertices * [2, 2, 0]).all()
    for _ in simulator:
        pass
    assert simulator.frame == 3
    assert (simulator.positions_of("cloth")[[0, 5]] == vertices[[0, 5]]).all()


def test_a_scene_is_put_together_piece_by_piece():
    scene = Scene(simulation={"frames": 2})
    assert scene.bodies == [] and scene.frames == 2
    with pytest.raises(InputError, match="the scene is empty"):
        Simulator(scene)
    scene.add_obstacle(shape="half-space", name="ground")
    vertices, faces = grid(4, 0.3, 0.1)
    scene.add_body(vertices, faces, name="cloth")
    before = scene.copy()
    for refused in (
        lambda: scene.add_body(vertices, faces, name="cloth"),
        lambda: scene.add_body(vertices, faces, frictions=1.0),
        lambda: scene.add_body(vertices, faces, kind="solid"),
        lambda: scene.add_body(vertices, faces + 100),
        lambda: scene.add_body(vertices * np.nan, faces),
        lambda: scene.add_body(np.zeros((0, 3)), name="nothing"),
        lambda: scene.add_body(faces=faces),
        lambda: scene.add_body(vertices, faces, shape="sheet"),
        lambda: scene.add_body(),
        lambda: scene.add_pin("skirt", [0]),
        lambda: scene.add_pin("cloth"),
        lambda: scene.add_obstacle(vertices, faces, material="silk"),
        lambda: scene.add_body(Path("no such file.obj"), [[0, 1, 2]]),
    ):
        with pytest.raises(InputError) as refusal:
            refused()
        assert str(refusal.value)
        assert scene == before
    # A file is read when the simulation begins.
    scene.add_body("no-such-file.obj", name="late")
    with pytest.raises(InputError, match="no such file"):
        Simulator(scene)


def test_mesh_files_are_read_relative_to_where_they_are_named(tmp_path):
    (tmp_path / "tri.obj").write_text("v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n")
    path = tmp_path / "scene.toml"
    path.write_text('[[body]]\nname = "tri"\nmesh = "tri.obj"\n')
    scene = Scene.from_toml(path)
    assert Simulator(scene).positions.shape == (3, 3)
    scene.add_obstacle(shape="half-space")
    again = pickle.loads(pickle.dumps(scene))
    for copied in (scene, again, copy.deepcopy(scene), Scene.from_toml(path.read_text(), folder=tmp_path)):
        assert Simulator(copied).positions_of("tri")[0, 2] == 1.0
    mesh = bowknot.read_mesh(tmp_path / "tri.obj", up="y", scale=0.01)
    assert np.allclose(mesh.vertices[1], [0.01, -0.01, 0.0]) and mesh.faces.tolist() == [[0, 1, 2]]
    with pytest.raises(InputError, match="up"):
        bowknot.read_mesh(tmp_path / "tri.obj", up="w")
    with pytest.raises(InputError, match="scale"):
        bowknot.read_mesh(tmp_path / "tri.obj", scale=-1.0)


def test_pins_select_groups_of_a_mesh_file(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\ng hem\nf 2 4 3\n")
    mesh = bowknot.read_mesh(tmp_path / "a.obj")
    assert {name: list(vertices) for name, vertices in mesh.groups.items()} == {"hem": [1, 2, 3]}
    scene = Scene()
    scene.add_body(mesh=tmp_path / "a.obj", name="cloth")
    scene.add_pin("cloth", group=["hem"])
    simulator = Simulator(scene)
    simulator.step()
    held = simulator.positions_of("cloth")
    assert np.array_equal(held[1:], mesh.vertices[1:]) and held[0, 2] < 0.0
    scene = Scene()
    scene.add_body(mesh, name="cloth")
    scene.add_pin("cloth", mesh.groups["hem"])
    assert np.array_equal(Simulator(scene).positions_of("cloth"), mesh.vertices)
    # Groups of a mesh object are known by name, too.
    scene = Scene(bodies=[{"mesh": mesh, "name": "cloth"}], pins=[{"body": "cloth", "group": "hem"}])
    assert "vertices" in scene.to_toml()
    named = scene.copy()
    named.add_pin("cloth", group=["hem"])
    assert np.array_equal(Simulator(scene).positions_of("cloth"), mesh.vertices)
    with pytest.raises(InputError, match="no group 'hen'; the mesh has hem"):
        named.add_pin("cloth", group="hen")
    wrong = Scene()
    wrong.add_body(mesh=tmp_path / "a.obj", name="cloth")
    wrong.add_pin("cloth", group="hen")
    with pytest.raises(InputError, match="there are: hem; did you mean hem"):
        Simulator(wrong)


def test_builtin_scenes_and_those_of_the_repository_load():
    assert "drape" in bowknot.builtin_scenes()
    for name in bowknot.builtin_scenes():
        assert Scene.builtin(name, scale=0.2).bodies, name
    found = sorted((ROOT / "assets").rglob("*.toml"))
    loaded = 0
    for path in found:
        if "[[body]]" in path.read_text(encoding="utf-8"):
            assert Scene.from_toml(path).bodies
            loaded += 1
    assert loaded > 0


def test_pickles_of_scenes_are_equal():
    vertices, faces = grid(5, 1 / 3, 0.1)
    scene = Scene.builtin("drape", scale=0.3)
    scene.add_body(vertices + np.pi * 10, faces, name="far")
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene and again.frames == scene.frames
    assert (Simulator(again).positions == Simulator(scene).positions).all()


@pytest.mark.parametrize(
    "shape", ["sheet", "block", {"type": "tet-ball"}, "strands", "woven", "grains", "garment", "ribbon"]
)
def test_the_kind_of_a_body_follows_from_its_shape(shape):
    scene = Scene(bodies=[{"shape": shape, "name": "one"}])
    scene.add_body(shape=shape, name="two", translate=[5, 0, 0])
    assert len(Simulator(scene).positions) > 0
    with pytest.raises(InputError, match="makes a body of kind|can only"):
        scene.add_body(shape=shape, name="three", kind="solid" if shape in ("sheet", "garment", "ribbon") else "cloth")
