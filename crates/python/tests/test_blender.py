"""What of the extension for Blender needs no Blender: scenes of arrays, bakes on a thread, caches, tetrahedra, the zip.
`cargo xtask blender --test` runs the rest."""

import importlib.util
import struct
import subprocess
import sys
import time
import tomllib
import zipfile

import numpy as np
import pytest
from conftest import ROOT, grid

import bowknot

FOLDER = ROOT / "crates" / "python" / "blender"
sys.path.insert(0, str(FOLDER / "bowknot_blender"))

from core import job as jobs  # noqa: E402
from core import pc2, presets, tets  # noqa: E402
from core.scene import Body, Description, Obstacle, Refused, Settings, build, intersecting  # noqa: E402


def sheet(frames, height=0.5, side=9, name="sheet", **keys):
    vertices, faces = grid(side, 1.0, height)
    identity = np.tile(np.eye(4), (frames + 1, 1, 1))
    return Body(name, "cloth", vertices, faces.astype(np.int64), "silk", to_object=identity, **keys)


def ball(frames, travel=0.2):
    mesh = bowknot.shape("ball", radius=0.2, edge=0.06)
    way = np.linspace(0.0, travel, frames + 1)
    places = mesh.vertices + [0.0, 0.0, 0.25] + way[:, None, None] * [1.0, 0.0, 0.0]
    return Obstacle("ball", places, mesh.faces.astype(np.int64))


def described(frames=8, **keys):
    pinned = np.array([0, 8])
    still = np.tile(grid(9, 1.0, 0.5)[0][pinned], (frames + 1, 1, 1))
    body = sheet(frames, pinned=pinned, led=pinned, led_frames=still, **keys)
    return Description(Settings(frames, 24.0), [body], [ball(frames)])


def finished(job):
    job.start()
    job.join()
    if job.error is not None:
        raise job.error
    return job


FILES = {"sheet": "sheet.pc2"}


def test_a_bake_writes_every_frame_and_none_intersects(tmp_path):
    description = described()
    job = finished(jobs.Job(description, tmp_path, FILES))
    samples = pc2.read(tmp_path / "sheet.pc2")
    assert job.done == 8 and samples.shape == (9, 81, 3)
    assert np.abs(samples[0] - description.bodies[0].start).max() < 1e-7
    assert np.abs(samples[:, [0, 8]] - samples[0, [0, 8]]).max() < 1e-7
    assert samples[-1, :, 2].min() < 0.3
    sheet_faces, obstacle = description.bodies[0].elements, description.obstacles[0]
    for sample, places in zip(samples, obstacle.frames):
        both = np.concatenate([sample.astype(np.float64), places])
        assert bowknot.check(both, np.concatenate([sheet_faces, obstacle.triangles + 81]), distance=False)


def test_a_canceled_bake_resumes_to_the_same_bits(tmp_path):
    finished(jobs.Job(described(), tmp_path / "whole", FILES))
    job = jobs.Job(described(), tmp_path / "part", FILES)
    job.start()
    while job.done < 3 and job.running:
        time.sleep(0.001)
    job.cancel()
    job.join()
    assert job.error is None and 3 <= job.done < 8
    finished(jobs.Job(described(), tmp_path / "part", FILES, resume=True))
    assert (tmp_path / "part" / "sheet.pc2").read_bytes() == (tmp_path / "whole" / "sheet.pc2").read_bytes()


@pytest.mark.parametrize("change", ["friction", "start", "obstacle", "steps"])
def test_what_was_changed_does_not_resume(tmp_path, change):
    finished(jobs.Job(described(frames=4), tmp_path, FILES))
    longer = described()
    longer.obstacles = [Obstacle("ball", ball(4).frames[[0, 1, 2, 3, 4, 4, 4, 4, 4]], ball(4).triangles)]
    finished(jobs.Job(longer, tmp_path, FILES, resume=True))
    if change == "friction":
        longer.bodies[0].friction += 0.1
    elif change == "start":
        longer.bodies[0].start[5, 2] += 1e-9
    elif change == "obstacle":
        longer.obstacles[0].frames[3] += 1e-9
    else:
        longer.settings.steps = 3
    with pytest.raises(Refused, match="not those of the bake that stopped"):
        finished(jobs.Job(longer, tmp_path, FILES, resume=True))


def test_frames_after_a_resumed_one_may_change(tmp_path):
    finished(jobs.Job(described(frames=4), tmp_path, FILES))
    other = described()
    other.obstacles = [Obstacle("ball", ball(4).frames[[0, 1, 2, 3, 4, 4, 3, 2, 1]], ball(4).triangles)]
    assert finished(jobs.Job(other, tmp_path, FILES, resume=True)).done == 8


def test_a_start_that_intersects_names_its_vertices(tmp_path):
    description = described()
    description.bodies[0].start[:, 2] = 0.4  # through the top of the ball, whose center is at 0.25
    with pytest.raises(jobs.StartIntersects, match="sheet and ball overlap") as caught:
        finished(jobs.Job(description, tmp_path, FILES))
    places = caught.value.places
    assert set(places) == {"sheet", "ball"}
    near = np.linalg.norm(description.bodies[0].start[places["sheet"], :2], axis=1)
    assert len(near) > 0 and near.max() < np.hypot(0.2**2 - 0.15**2, 0) ** 0.5 + 0.18
    assert intersecting(described()) == {}
    assert not (tmp_path / "bake.json").exists()


def test_a_start_that_is_refused_leaves_the_earlier_bake(tmp_path):
    finished(jobs.Job(described(frames=3), tmp_path, FILES, first=7))
    before = (tmp_path / "sheet.pc2").read_bytes()
    description = described()
    description.bodies[0].start[:, 2] = 0.4
    with pytest.raises(jobs.StartIntersects):
        finished(jobs.Job(description, tmp_path, FILES, first=1))
    assert (tmp_path / "sheet.pc2").read_bytes() == before
    assert jobs.about(tmp_path)["first"] == 7


def test_an_obstacle_that_begins_to_move_in_the_new_frames_resumes_to_the_same_bits(tmp_path):
    def still_at_first(frames):
        description = described(frames=frames)
        places = ball(4).frames[[0, 0, 0, 0, 0, 1, 2, 3, 4][: frames + 1]]
        description.obstacles = [Obstacle("ball", places[:1] if frames < 5 else places, ball(4).triangles)]
        return description

    finished(jobs.Job(still_at_first(8), tmp_path / "whole", FILES))
    finished(jobs.Job(still_at_first(4), tmp_path / "part", FILES))
    finished(jobs.Job(still_at_first(8), tmp_path / "part", FILES, resume=True))
    assert (tmp_path / "part" / "sheet.pc2").read_bytes() == (tmp_path / "whole" / "sheet.pc2").read_bytes()


@pytest.mark.parametrize("thickness", [0.0, 0.01])
def test_a_cloth_keeps_its_thickness_from_an_obstacle(tmp_path, thickness):
    body = sheet(12, height=0.33, side=17, thickness=thickness)
    box = bowknot.shape("box", size=[0.6, 0.6, 0.2], edge=0.1)
    table = Obstacle("table", box.vertices[None] + [0.0, 0.0, 0.2], box.faces.astype(np.int64))
    finished(jobs.Job(Description(Settings(12, 24.0), [body], [table]), tmp_path, FILES))
    end = pc2.read(tmp_path / "sheet.pc2")[-1].astype(np.float64)
    faces = np.concatenate([body.elements, table.triangles + len(end)])
    both = np.concatenate([end, table.frames[0]])
    pairs = bowknot.search(both, faces, 0.05, obstacles=np.arange(len(both)) >= len(end))
    across = (pairs.vertices >= len(end)).any(axis=1)  # not the cloth's own folds
    gap = pairs.distances[across].min()
    assert gap >= thickness - 1e-6 and gap < thickness + 0.012
    assert end[:, 2].min() < 0.25  # the rim hangs


def test_a_pin_that_is_stopped_does_not_hold_up_the_others(tmp_path):
    frames = 6
    body = sheet(frames, height=0.5)
    corners = np.array([0, 80])  # at x = y = -0.5 and at x = y = 0.5
    way = body.start[corners] + np.linspace(0, 0.3, frames + 1)[:, None, None] * [0.0, 0.0, -1.0]
    body = sheet(frames, height=0.5, pinned=corners, led=corners, led_frames=way)
    box = bowknot.shape("box", size=[0.2, 0.2, 0.2], edge=0.1)
    stop = Obstacle("box", box.vertices[None] + [-0.5, -0.5, 0.3], box.faces.astype(np.int64))
    finished(jobs.Job(Description(Settings(frames, 24.0), [body], [stop]), tmp_path, FILES))
    end = pc2.read(tmp_path / "sheet.pc2")[-1]
    assert 0.4 < end[0, 2] < 0.42  # the box ends at 0.4; it would go to 0.2
    assert np.abs(end[80] - way[-1, 1]).max() < 1e-6


def test_loose_vertices_and_numbers_with_gaps_stay_in_order(tmp_path):
    frames = 3
    vertices, faces = grid(4, 0.5, 1.0)
    order = np.arange(16) * 2 + 1  # each second vertex belongs to no face
    start = np.zeros((33, 3))
    start[order] = vertices
    loose = np.setdiff1d(np.arange(33), order)
    led = np.sort(np.append(loose, order[0]))
    way = start[led] + np.linspace(0, 0.03, frames + 1)[:, None, None] * [0.0, 1.0, 0.0]
    lifted = np.tile(np.eye(4), (frames + 1, 1, 1))
    lifted[:, 2, 3] = -1.0
    body = Body(
        "sheet", "cloth", start, order[faces], "cotton", pinned=order[:1], led=led, led_frames=way, to_object=lifted
    )
    finished(jobs.Job(Description(Settings(frames, 24.0), [body], []), tmp_path, FILES))
    samples = pc2.read(tmp_path / "sheet.pc2") + [0.0, 0.0, 1.0]
    assert np.abs(samples[:, led] - way).max() < 1e-6
    assert (samples[-1, order[1:], 2] < 0.995).all()


def test_hair_and_solids_become_bodies_of_their_kinds():
    box = bowknot.shape("box", size=[0.2, 0.2, 0.2], edge=0.1)
    strand = np.column_stack([np.full(6, 1.0), np.zeros(6), np.linspace(0, 0.1, 6)])
    edges = np.column_stack([np.arange(1, 5), np.arange(2, 6)])
    description = Description(
        Settings(5, 25.0, steps=4),
        [
            Body("box", "solid", box.vertices.copy(), box.faces.astype(np.int64), "jelly"),
            Body("hair", "hair", strand, edges, "lock", pinned=np.array([0, 1, 2])),
        ],
        [],
    )
    scene = build(description)
    info = scene.info()
    assert scene.dt == 0.01 and scene.frames == 20
    assert bowknot.Simulator(scene).mass_of("box") == pytest.approx(0.008 * 1020, rel=1e-9)
    assert description.bodies[1].held().tolist() == [0, 1]
    assert info["vertices"] == len(box.vertices) + 5  # the first point of the strand belongs to no edge
    # The contacts of each: a tenth of the edges, of hair about its thickness.
    table = tomllib.loads(scene.to_toml())
    assert table["contact"]["delta"] == 0.0005
    deltas = {body["name"]: body["delta"] for body in table["body"]}
    assert deltas["hair"] == 0.0005 and 0.01 < deltas["box"] < 0.015


@pytest.mark.parametrize(
    "shape, keys",
    [
        ("ball", {"radius": 0.2, "edge": 0.06}),
        ("box", {"edge": 0.08}),
        ("cone", {"radius": 0.2}),
        ("lathe", {"edge": 0.04}),
    ],
)
def test_tetrahedra_fill_a_closed_surface(shape, keys):
    mesh = bowknot.shape(shape, **{"edge": 0.08, **keys})
    points, cells = tets.fill(mesh.vertices.copy(), mesh.faces.astype(np.int64))
    assert (points[: len(mesh.vertices)] == mesh.vertices).all()
    sides = points[cells[:, 1:]] - points[cells[:, :1]]
    volumes = np.linalg.det(sides) / 6
    corners = mesh.vertices[mesh.faces]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert volumes.min() > 0 and volumes.sum() == pytest.approx(volume, rel=0.02)
    skin = tets.surface(cells)
    assert set(skin.ravel()) == set(range(len(mesh.vertices)))
    assert bowknot.check(points, skin, distance=False)


def test_what_is_no_solid_is_refused_with_a_remedy():
    vertices, faces = grid(4)
    with pytest.raises(tets.NotSolid, match="12 open edges: fill its holes"):
        tets.fill(vertices, faces.astype(np.int64))
    body = sheet(1, name="cape")
    body.kind = "solid"
    with pytest.raises(Refused, match="cape: a solid needs a closed surface"):
        build(Description(Settings(1, 24.0), [body], []))


def test_caches_have_the_layout_of_pc2_and_damage_is_told(tmp_path):
    path = tmp_path / "a.pc2"
    writer = pc2.Writer(path, 2)
    writer.add(np.arange(6.0).reshape(2, 3))
    assert pc2.read(path).shape == (1, 2, 3)  # can be read while it grows
    writer.add(np.arange(6.0, 12.0).reshape(2, 3))
    writer.close()
    content = path.read_bytes()
    assert struct.unpack("<12siiffi", content[:32]) == (b"POINTCACHE2\0", 1, 2, 0.0, 1.0, 2)
    assert np.frombuffer(content[32:], "<f4").tolist() == list(map(float, range(12)))
    longer = pc2.Writer(path, 2, keep=1)
    longer.add(np.full((2, 3), 7.0))
    longer.close()
    assert pc2.read(path)[1].tolist() == [[7.0] * 3] * 2
    path.write_bytes(content[:40])
    with pytest.raises(ValueError, match="shorter than its header says"):
        pc2.read(path)
    path.write_bytes(b"no cache at all, whatever its name is called")
    with pytest.raises(ValueError, match="not a point cache"):
        pc2.read(path)


@pytest.mark.parametrize("kind", ["cloth", "solid", "hair"])
def test_every_preset_is_a_material_of_the_package(kind):
    mesh = {
        "cloth": {"faces": [[0, 1, 2]]},
        "solid": {"tets": [[0, 1, 2, 3]]},
        "hair": {"edges": [[0, 1], [1, 2], [2, 3]]},
    }[kind]
    corners = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    found = getattr(presets, kind.upper())
    for preset in found:
        scene = bowknot.Scene()
        name = {"hair": "strands"}.get(kind, kind)
        scene.add_body(corners, **mesh, kind=name, name="a", material=preset.material)
        assert bowknot.Simulator(scene).mass_of("a") > 0
    # And none is left out: the page of all keys lists the materials of each kind.
    page = (ROOT / "docs" / "scene-reference.md").read_text(encoding="utf-8")
    line = next(line for line in page.splitlines() if line.startswith(f'`kind = "{name}"`:'))
    assert line.count("`") // 2 - 1 == len(found)


def pack():
    spec = importlib.util.spec_from_file_location("pack", FOLDER / "pack.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_zip_is_an_extension(tmp_path):
    version = bowknot.__version__
    names = [
        f"bowknot-{version}-cp310-abi3-{tag}.whl" for tag in ("manylinux_2_35_x86_64", "win_amd64", "macosx_11_0_arm64")
    ]
    for name in names:
        (tmp_path / name).write_bytes(b"a wheel")
    wheels = [str(tmp_path / name) for name in names]
    done = subprocess.run(
        [sys.executable, FOLDER / "pack.py", tmp_path / "out", *wheels], capture_output=True, text=True, check=True
    )
    with zipfile.ZipFile(done.stdout.strip()) as archive:
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
        inside = archive.namelist()
    # The rules of Blender's schema 1.0.0.
    for key in ("id", "name", "tagline", "maintainer", "blender_version_min"):
        assert isinstance(manifest[key], str) and manifest[key]
    assert manifest["schema_version"] == "1.0.0" and manifest["type"] == "add-on" and manifest["version"] == version
    assert manifest["id"].isidentifier() and len(manifest["tagline"]) <= 64 and manifest["tagline"][-1].isalnum()
    assert manifest["license"] == ["SPDX:GPL-3.0-or-later"]
    assert manifest["platforms"] == ["linux-x64", "macos-arm64", "windows-x64"]
    assert set(manifest["permissions"]) == {"files"}
    assert all(len(reason) <= 64 and reason[-1].isalnum() for reason in manifest["permissions"].values())
    assert sorted(manifest["wheels"]) == sorted(f"./wheels/{name}" for name in names)
    assert {entry[2:] for entry in manifest["wheels"]} | {"__init__.py", "LICENSE"} <= set(inside)
    assert not [name for name in inside if "tests" in name or "__pycache__" in name]


def test_wheels_that_do_not_fit_are_refused(tmp_path):
    packed = pack()
    with pytest.raises(SystemExit, match="but the wheels have 9.9.9"):
        packed.manifest([tmp_path / "bowknot-9.9.9-cp310-abi3-win_amd64.whl"])
    with pytest.raises(SystemExit, match="Blender has no platform musllinux_1_2_x86_64"):
        packed.manifest([tmp_path / f"bowknot-{bowknot.__version__}-cp310-abi3-musllinux_1_2_x86_64.whl"])


def test_every_file_says_its_license():
    files = [*FOLDER.rglob("*.py")]
    assert len(files) > 15
    assert not [
        f
        for f in files
        if not f.read_text(encoding="utf-8").startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n")
    ]
