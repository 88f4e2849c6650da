"""The judge, the search and repair."""

import pickle

import numpy as np
import pytest
from conftest import grid, two_sheets

import bowknot
from bowknot import InputError


def test_the_judge_finds_what_intersects():
    x, faces = two_sheets(5)
    report = bowknot.check(x, faces)
    assert report and report.intersection_count == 0 and report.intersections == []
    assert abs(report.min_distance_m - 0.1) < 1e-12
    x[12, 2] = 0.15
    report = bowknot.check(x, faces, limit=2)
    assert not report and report.intersection_count > 2 and len(report.intersections) == 2
    assert len(report.findings) == 2 and "triangle" in report.findings[0]
    assert "intersections" in repr(report)
    again = pickle.loads(pickle.dumps(report))
    assert again.findings == report.findings and dict(again) == dict(report)
    assert bowknot.check(x, faces, obstacles=np.ones(len(x), bool))
    assert not bowknot.check(x[:25] - [0, 0, 1], faces[:32], planes=[[0, 0, 1, 0]])
    assert bowknot.check(np.zeros((0, 3)))


def test_the_judge_follows_paths():
    x, faces = two_sheets(5)
    y = x.copy()
    y[25:, 2] += 1.0
    assert bowknot.check_path(x, y, faces)
    y[25:, 2] -= 2.0
    report = bowknot.check_path(x, y, faces, limit=3)
    assert not report and report.intersection_count > 3 and len(report.findings) == 3
    with pytest.raises(InputError, match="end: expected"):
        bowknot.check_path(x, y[:3], faces)


def test_the_search_finds_all_pairs():
    x, faces = two_sheets(6, 0.05)
    pairs = bowknot.search(x, faces, 0.06)
    assert len(pairs) > 0 and (pairs.distances <= 0.06).all() and pairs.distances.min() >= 0.05 - 1e-12
    # The gradient of the distance is that of finite differences.
    gap = np.einsum("ki,kic,kc->k", pairs.weights, x[pairs.vertices], pairs.normals)
    assert np.allclose(gap, pairs.distances)
    triangles = pairs.kinds == 2
    found = {tuple(pair) for pair in pairs.elements[triangles]}
    # Each vertex is above or below a triangle of the other sheet.
    assert {vertex for vertex, _ in found} == set(range(len(x)))
    assert len(bowknot.search(x, faces, 0.01)) == 0
    assert len(bowknot.search(x, faces, 0.06, obstacles=np.ones(len(x), bool))) == 0
    ground = bowknot.search(x[:36] + [0, 0, 0.01], faces[:50], 0.02, planes=[[0, 0, 1, 0]])
    assert (ground.kinds == 4).sum() == 36
    for distance in (-1.0, np.nan, np.inf):
        with pytest.raises(InputError, match="distance"):
            bowknot.search(x, faces, distance)


def test_repair_welds_seams():
    vertices, faces = grid(4)
    panels = np.concatenate([vertices, vertices + [1.0 + 1e-5, 0.0, 0.0]])
    both = np.concatenate([faces, faces + 16, [[0, 0, 1]]])
    mesh, report = bowknot.repair(panels, both, weld_distance=1e-3)
    assert report.welded_vertices == 4 and len(mesh.vertices) == 28 and len(mesh.faces) == 36
    assert report.after["parts"] == 1
    assert bowknot.check(mesh)
    for refused in ({"weld_distance": -1.0}, {"weld_distance": np.nan}):
        with pytest.raises(InputError, match="weld distance"):
            bowknot.repair(panels, both, **refused)
    with pytest.raises(InputError, match="nothing to repair"):
        bowknot.repair(panels)


def test_solids_are_judged_by_their_surface():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
    tets = [[0, 1, 2, 3], [1, 2, 3, 4]]
    mesh, report = bowknot.repair(corners, tets=tets)
    assert len(mesh.tets) == 2 and report.solid is not None
    assert bowknot.check(mesh)


@pytest.mark.parametrize(
    ("shape", "part", "columns"),
    [
        ("ball", "faces", 3),
        ("garment", "faces", 3),
        ("block", "tets", 4),
        ("tet-ball", "tets", 4),
        ("strands", "edges", 2),
        ("woven", "edges", 2),
        ({"type": "figure", "edge": 0.03}, "faces", 3),
    ],
)
def test_shapes_have_arrays(shape, part, columns):
    mesh = bowknot.shape(shape)
    sizes = {name: len(getattr(mesh, name)) for name in ("faces", "tets", "edges", "particles")}
    assert [name for name, size in sizes.items() if size > 0] == [part]
    assert getattr(mesh, part).shape[1] == columns and getattr(mesh, part).max() == len(mesh.vertices) - 1
    assert bowknot.check(mesh)


def test_shapes_are_placed_and_refused():
    ball = bowknot.shape("ball", radius=0.1, edge=0.03, translate=[0.0, 0.0, 2.0])
    radii = np.linalg.norm(ball.vertices - [0.0, 0.0, 2.0], axis=1)
    assert np.allclose(radii, 0.1)
    grains = bowknot.shape({"type": "grains", "count": [2, 3, 4]})
    assert sorted(grains.particles) == list(range(24))
    for refused, text in (
        ({"shape": "half-space"}, "no mesh"),
        ({"shape": "bal"}, "^shape.type.*did you mean ball"),
        ({"shape": "ball", "radius": -1.0}, "^shape.radius"),
        ({"shape": {"radius": 1.0}}, "key type"),
    ):
        with pytest.raises(InputError, match=text):
            bowknot.shape(**refused)
