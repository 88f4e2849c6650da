"""Meshes of meshio, trimesh and pyvista, told by their attributes."""

from types import SimpleNamespace

import numpy as np
import pytest
from conftest import grid

import bowknot
from bowknot import InputError, Resolver, Scene, Simulator


class Meshio:
    def __init__(self, points, **cells):
        self.points, self.cells_dict = points, cells


class Trimesh:
    def __init__(self, vertices, faces):
        # Those of trimesh are subclasses of arrays that note changes.
        self.vertices, self.faces = vertices.view(type("Tracked", (np.ndarray,), {})), faces


class Pyvista:
    def __init__(self, points, faces):
        self.points, self._faces = points, faces

    @property
    def regular_faces(self):
        if self._faces is None:
            raise ValueError("the faces have different sizes")
        return self._faces


VERTICES, FACES = grid(5, 0.4, 0.2)
SURFACES = {
    "meshio": Meshio(VERTICES, triangle=FACES),
    "trimesh": Trimesh(VERTICES, FACES),
    "pyvista": Pyvista(VERTICES.astype(np.float64), FACES),
}


@pytest.mark.parametrize("name", SURFACES)
def test_they_are_taken_wherever_a_mesh_is(name):
    mesh = SURFACES[name]
    assert bowknot.check(mesh)
    assert len(bowknot.search(mesh, distance=1e-3)) == 0
    repaired, _ = bowknot.repair(mesh)
    assert len(repaired.faces) == len(FACES)
    x, _ = Resolver(mesh).resolve(VERTICES, VERTICES + [0.0, 0.0, 0.01])
    assert np.allclose(x, VERTICES + [0.0, 0.0, 0.01])
    scene = Scene(bodies=[{"mesh": mesh, "name": "cloth"}])
    scene.add_obstacle(mesh, translate=[0, 0, -0.1], name="under")
    assert (Simulator(scene).positions_of("cloth") == VERTICES).all()
    with pytest.raises(InputError, match="elements of its own"):
        bowknot.check(mesh, FACES)


def test_cells_of_meshio():
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    quads = Meshio(corners[:, :2], quad=np.array([[0, 1, 2, 3]]))
    assert len(bowknot.repair(quads)[0].faces) == 2
    tets = Meshio(np.eye(4, 3), tetra=np.array([[0, 1, 2, 3]]), vertex=np.array([[0]]))
    assert len(bowknot.repair(tets)[0].tets) == 1
    scene = Scene(bodies=[{"mesh": Meshio(np.eye(4, 3), tetra=np.array([[3, 0, 1, 2]])), "name": "tet"}])
    assert Simulator(scene).positions.shape == (4, 3)
    # Grids of pyvista number the types of cells as VTK does.
    grid = Meshio(np.eye(4, 3), **{})
    grid.cells_dict = {10: np.array([[0, 1, 2, 3]])}
    assert len(bowknot.repair(grid)[0].tets) == 1
    with pytest.raises(InputError, match="hexahedron cannot be used"):
        bowknot.check(Meshio(np.zeros((8, 3)), hexahedron=np.arange(8)[None]))


def test_faces_of_several_sizes_are_refused():
    with pytest.raises(InputError, match="triangulate"):
        bowknot.check(Pyvista(VERTICES, None))
    with pytest.raises(InputError, match="triangulate"):
        bowknot.check(Pyvista(VERTICES, np.zeros((1, 4), int)))


def test_what_is_no_mesh_is_refused():
    for thing in (SimpleNamespace(points=VERTICES), SimpleNamespace(vertices=3, faces=FACES), object()):
        with pytest.raises(InputError):
            bowknot.check(thing)


def test_real_packages_if_they_are_installed():
    try:
        import meshio
    except ImportError:
        pytest.skip("meshio is not installed")
    assert bowknot.check(meshio.Mesh(VERTICES, [("triangle", FACES)]))


def test_real_trimesh_and_pyvista():
    trimesh = pytest.importorskip("trimesh")
    assert bowknot.check(trimesh.Trimesh(VERTICES, FACES, process=False))
    pyvista = pytest.importorskip("pyvista")
    assert bowknot.check(pyvista.PolyData.from_regular_faces(VERTICES, FACES))
