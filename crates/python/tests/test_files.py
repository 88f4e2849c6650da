"""Files judged: frames, parts, exemptions."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
from pathlib import Path

import bowknot
import numpy as np
import pytest
from conftest import grid

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def pierced(height: float) -> str:
    """A triangle whose lowest corner is at `height`."""
    return f"v 0.2 0.2 {height}\nv 0.3 0.2 {height + 2}\nv 5 5 {height + 1}\nf 1 2 3\n"


@pytest.fixture
def parts(tmp_path: Path) -> tuple[Path, Path]:
    """A triangle, and a folder of three frames of one that falls onto it."""
    still, moving = tmp_path / "still.obj", tmp_path / "moving"
    still.write_text(TRIANGLE)
    moving.mkdir()
    for frame, height in enumerate([2.0, 1.0, -0.25]):
        (moving / f"{frame}.obj").write_text(pierced(height))
    return still, moving


def test_frames_of_several_files(parts: tuple[Path, Path]) -> None:
    assert bowknot.check_files(parts)
    report = bowknot.check_files(parts, together=True, between_frames=True)
    assert not report and (report.states, report.intersecting_states, report.paths) == (3, 1, 2)
    (pair,) = report.pairs
    assert pair["parts"] == ["still", "moving"] and pair["states"] == 1
    assert pair["depth_m"] > 0.2
    assert [frame["intersections"] for frame in report.files] == [0, 0, 2]
    assert report.intersection_count == 2 and len(report.findings) == 2 and "of still" in report.findings[0]
    assert bowknot.check_files(parts, together=True, leave_out="sti*")
    assert bowknot.check_files(parts, together=True, obstacles=["still", "moving"])
    assert not bowknot.check_files(parts, together=True, may_intersect="still")


def test_a_path_is_judged_whole(parts: tuple[Path, Path]) -> None:
    assert bowknot.check(parts[1]).states == 3
    with pytest.raises(bowknot.InputError, match="check_files"):
        bowknot.check(parts[0], [[0, 1, 2]])


def test_the_command_says_the_same(parts: tuple[Path, Path], command: str) -> None:
    words = [command, "check", *map(str, parts), "--together", "--paths", "--json"]
    said = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert said.returncode == 1
    assert json.loads(said.stdout) == dict(bowknot.check_files(parts, together=True, between_frames=True))


def test_archives_and_units(tmp_path: Path) -> None:
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.3, 0.2, 1], [5, 5, 0]], float)
    apart = x + np.array([0, 0, 10.0]) * (np.arange(6) > 2)[:, None]
    np.savez(tmp_path / "two.npz", X=[apart, x], F=[[0, 1, 2], [3, 4, 5]])
    report = bowknot.check_files(tmp_path / "two.npz", scale=0.01)
    assert [frame["intersections"] > 0 for frame in report.files] == [False, True]
    assert report.files[0]["min_distance_m"] == pytest.approx(0.09, rel=0.2)
    assert report.pairs[0]["depth_m"] == pytest.approx(0.01, rel=1e-9)


def test_what_is_refused(parts: tuple[Path, Path], tmp_path: Path) -> None:
    for message, call in {
        "no part is called \"lid\": the parts are still, moving": lambda: bowknot.check_files(parts, leave_out="lid"),
        "expected the path": lambda: bowknot.check_files([]),
        "none.obj": lambda: bowknot.check_files(tmp_path / "none.obj"),
        "must be .x., .y. or .z.": lambda: bowknot.check_files(parts, up="w"),
        "scale": lambda: bowknot.check_files(parts, scale=-1.0),
        "frames.rate": lambda: bowknot.check_files(parts, fps=0.0),
        "limit": lambda: bowknot.check_files(parts, limit=-1),
        "min_distance": lambda: bowknot.check_files(parts, min_distance=-1.0),
    }.items():
        with pytest.raises(bowknot.InputError, match=message):
            call()


def test_binary_usd(tmp_path: Path) -> None:
    pytest.importorskip("pxr")
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.CreateNew(str(tmp_path / "two.usdc"))
    for name, points in {"still": [(0, 0, 0), (1, 0, 0), (0, 1, 0)], "moving": None}.items():
        mesh = UsdGeom.Mesh.Define(stage, f"/World/{name}")
        mesh.CreateFaceVertexCountsAttr([3])
        mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
        if points:
            mesh.CreatePointsAttr(points)
        else:
            for frame, z in enumerate([2.0, 1.0, -0.25]):
                mesh.CreatePointsAttr().Set([(0.2, 0.2, z), (0.3, 0.2, z + 2), (5, 5, z + 1)], frame)
    stage.Save()
    report = bowknot.check_files(tmp_path / "two.usdc")
    assert (report.states, report.intersecting_states) == (3, 1)
    assert report.pairs[0]["parts"] == ["still", "moving"]
    assert report.files[2]["file"].startswith(str(tmp_path / "two.usdc"))
    assert (report.files[2]["time_code"], report.files[2]["time_s"]) == (2.0, 2.0 / 24.0)
    assert report.findings[0].startswith(f"{tmp_path / 'two.usdc'}[2] (0.0833333 s, time code 2): edge")
    edge, triangle = report.files[2]["elements"][1]
    assert (edge["part"], edge["vertices"], edge["number"]) == ("moving", [0, 1], None)
    assert (triangle["part"], triangle["number"], triangle["vertices"]) == ("still", 0, [0, 1, 2])
    assert report.hint_pairs == report.inside == []
    hints = bowknot.check_files(tmp_path / "two.usdc", between_frames=True).hint_pairs
    assert [(pair["parts"], pair["paths"]) for pair in hints] == [(["still", "moving"], 1)]
    (tmp_path / "bad.usdc").write_bytes(b"PXR-USDC nothing")
    with pytest.raises(bowknot.InputError, match="bad.usdc: usd-core refuses it"):
        bowknot.check_files(tmp_path / "bad.usdc")


def test_skins_and_instances_of_binary_usd(tmp_path: Path) -> None:
    pytest.importorskip("pxr")
    from pxr import Gf, Usd, UsdGeom, UsdSkel, Vt

    stage = Usd.Stage.CreateNew(str(tmp_path / "arm.usdc"))
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(2)
    UsdSkel.Root.Define(stage, "/root")
    skeleton = UsdSkel.Skeleton.Define(stage, "/root/skeleton")
    skeleton.CreateJointsAttr(["bone"])
    identity = Vt.Matrix4dArray([Gf.Matrix4d(1.0)])
    skeleton.CreateBindTransformsAttr(identity)
    skeleton.CreateRestTransformsAttr(identity)
    animation = UsdSkel.Animation.Define(stage, "/root/animation")
    animation.CreateJointsAttr(["bone"])
    animation.CreateRotationsAttr([Gf.Quatf(1.0)])
    animation.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1, 1, 1)]))
    for frame, z in enumerate([0.0, -1.0, -2.25]):
        animation.CreateTranslationsAttr().Set([(0, 0, z)], frame)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets([animation.GetPath()])
    arm = UsdGeom.Mesh.Define(stage, "/root/arm")
    arm.CreateFaceVertexCountsAttr([3])
    arm.CreateFaceVertexIndicesAttr([0, 1, 2])
    arm.CreatePointsAttr([(0.2, 0.2, 2.0), (0.3, 0.2, 4.0), (5, 5, 3.0)])
    binding = UsdSkel.BindingAPI.Apply(arm.GetPrim())
    binding.CreateJointIndicesPrimvar(False, 1).Set([0, 0, 0])
    binding.CreateJointWeightsPrimvar(False, 1).Set([1.0, 1.0, 1.0])
    binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
    stage.CreateClassPrim("/prototype")
    still = UsdGeom.Mesh.Define(stage, "/prototype/still")
    still.CreateFaceVertexCountsAttr([3])
    still.CreateFaceVertexIndicesAttr([0, 1, 2])
    still.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    copy = stage.DefinePrim("/copy", "Xform")
    copy.GetReferences().AddInternalReference("/prototype")
    copy.SetInstanceable(True)
    stage.Save()
    report = bowknot.check_files(tmp_path / "arm.usdc")
    assert [frame["intersections"] > 0 for frame in report.files] == [False, False, True], report.files


def two_shirts(path: Path) -> Path:
    """A binary stage of two meshes with subsets, the second moving."""
    pytest.importorskip("pxr")
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.CreateNew(str(path))
    for name, z in {"Shirt": 0.0, "Sleeve": 2.0}.items():
        mesh = UsdGeom.Mesh.Define(stage, f"/World/{name}")
        mesh.CreateFaceVertexCountsAttr([3, 3])
        mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 2, 1, 3])
        points = [(0, 0, z), (1, 0, z), (0, 1, z), (1, 1, z)]
        mesh.CreateSubdivisionSchemeAttr("none")
        if name == "Sleeve":
            for frame in range(3):
                mesh.CreatePointsAttr().Set([(x, y, z + frame) for x, y, z in points], frame)
        else:
            mesh.CreatePointsAttr(points)
        for subset, kind, indices in (("hem", "point", [3, 0]), ("front", "face", [1])):
            UsdGeom.Subset.CreateGeomSubset(mesh, subset, kind, indices)
    stage.SetTimeCodesPerSecond(10)
    stage.Save()
    return path


def test_a_part_of_binary_usd(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = two_shirts(tmp_path / "shirts.usdc")
    shirt = bowknot.read_mesh(path, part="Shirt")
    assert len(shirt.vertices) == 4 and (shirt.vertices[:, 2] == 0.0).all()
    groups = {name: list(vertices) for name, vertices in shirt.groups.items()}
    assert groups == {"hem": [0, 3], "front": [1, 2, 3]}
    assert (bowknot.read_mesh(path, part="/World/Sleeve", scale=0.5).vertices[:, 2] == 1.0).all()
    with pytest.raises(bowknot.InputError) as refused:
        bowknot.read_mesh(path, part="Cape")
    assert str(refused.value) == f'{path}: no part "Cape"; it has /World/Shirt, /World/Sleeve'
    # All of it, with a warning that names the file that was given.
    caplog.clear()
    assert len(bowknot.read_mesh(path).vertices) == 8
    assert caplog.messages == [
        f"{path}: its 2 parts are read as one mesh: Shirt, Sleeve, ..; `part` takes one of them"
    ]
    scene = bowknot.Scene()
    scene.add_body(path, part="Sleeve", name="sleeve", scale=0.1)
    scene.add_pin("sleeve", group="hem")
    assert scene.info()["vertices"] == 4
    with pytest.raises(bowknot.InputError, match="part: names a part of a mesh file"):
        scene.add_body(shirt, part="Shirt")
    with pytest.raises(bowknot.InputError, match="part: needs a mesh file"):
        scene.add_obstacle(shape="half-space", part="Shirt")


def test_binary_usd_leads_an_obstacle(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    path = two_shirts(tmp_path / "shirts.usdc")
    monkeypatch.setenv("LOCALAPPDATA" if os.name == "nt" else "XDG_CACHE_HOME", str(tmp_path / "cache"))
    scene = bowknot.Scene(simulation={"frames": 10, "dt": 0.01})
    scene.add_body(*grid(4, 0.2, -1.0), name="cloth")
    scene.add_obstacle(sequence=path, part="Sleeve", name="sleeve", sequence_rate=10)
    # Saved and pickled scenes lead it as well.
    scene.save(tmp_path / "scene.toml")
    for again in (scene, bowknot.Scene.from_toml(tmp_path / "scene.toml"), pickle.loads(pickle.dumps(scene))):
        simulator = bowknot.Simulator(again)
        start = simulator.positions_of("sleeve")
        for _ in range(5):
            simulator.step()
        assert len(start) == 4 and np.allclose(simulator.positions_of("sleeve") - start, [0, 0, 0.5])
    # What is said of it names the file that was given.
    scene.add_obstacle(sequence=path, part="Cape", name="cape")
    with pytest.raises(bowknot.InputError) as refused:
        bowknot.Simulator(scene)
    assert str(path) in str(refused.value) and "cache" not in str(refused.value)
    bad = tmp_path / "bad.usdc"
    bad.write_bytes(b"PXR-USDC nothing")
    with pytest.raises(bowknot.InputError, match="bad.usdc: usd-core refuses it"):
        scene.add_obstacle(sequence=bad)
    # In a file of text, a part is a key of the scene.
    text = tmp_path / "shirts.usda"
    from pxr import Usd

    Usd.Stage.Open(str(path)).Export(str(text))
    scene = bowknot.Scene(bodies=[{"mesh": text, "part": "/World/Shirt", "name": "shirt"}])
    assert scene.info()["vertices"] == 4 and 'part = "/World/Shirt"' in scene.to_toml()
