"""Meshes: those of this package, and those of others, which are told by their attributes.

Nothing is imported from meshio, trimesh and pyvista: an object that looks like a mesh of theirs is one.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _native
from ._call import call
from ._errors import InputError
from ._usd import as_text

#: Cells that can be used, by their numbers in VTK.
_VTK_CELLS = {1: "vertex", 3: "line", 5: "triangle", 9: "quad", 10: "tetra"}


@dataclass(frozen=True, eq=False)
class Mesh:
    """A mesh by its arrays.

    Attributes
    ----------
    vertices : ndarray of float64, shape (n, 3)
        Positions [m].
    faces : ndarray of uint32, shape (m, 3)
        Vertices of the triangles.
    tets : ndarray of uint32, shape (t, 4)
        Vertices of the tetrahedra.
    edges : ndarray of uint32, shape (k, 2)
        Vertices of the edges of strands.
    particles : ndarray of uint32, shape (p,)
        Vertices that are particles.
    groups : dict of str to ndarray of uint32
        Vertices of each group of a mesh file, by name: ``scene.add_pin("cape", mesh.groups["hem"])``.
    bodies : ndarray of uint32, shape (n,), or empty
        The body or part of each vertex of a mesh file.
    names : list of str
        Names of the bodies, by their numbers; that of the file, if it names no parts.
    obstacles : ndarray of bool, shape (n,), or empty
        The vertices of obstacles, in a frame of a run.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.uint32]
    tets: NDArray[np.uint32]
    edges: NDArray[np.uint32]
    particles: NDArray[np.uint32]
    groups: dict[str, NDArray[np.uint32]] = field(default_factory=dict)
    bodies: NDArray[np.uint32] = field(default_factory=lambda: np.zeros(0, np.uint32))
    names: list[str] = field(default_factory=list)
    obstacles: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, np.bool_))

    def __repr__(self) -> str:
        counts = [
            (len(self.vertices), "vertices"),
            (len(self.faces), "faces"),
            (len(self.tets), "tets"),
            (len(self.edges), "edges"),
            (len(self.particles), "particles"),
            (len(self.groups), "groups"),
        ]
        return f"Mesh({', '.join(f'{count} {what}' for count, what in counts if count)})"


def is_path(value: object) -> bool:
    """Whether a value names a file."""
    return isinstance(value, (str, os.PathLike))


def mesh_of(
    mesh: Any,
    faces: ArrayLike | None = None,
    *,
    tets: ArrayLike | None = None,
    edges: ArrayLike | None = None,
    particles: ArrayLike | None = None,
    name: str = "vertices",
) -> Mesh:
    """The mesh of an object, of a file, or of arrays.

    Parameters
    ----------
    mesh : Mesh, meshio.Mesh, trimesh.Trimesh, pyvista.PolyData, path, or array_like of shape (n, 3)
        A mesh, the path of a mesh file, or vertices [m].
    faces, tets, edges, particles : array_like of integers, optional
        Elements of vertices that are given as an array.
    name : str
        What the vertices are called in messages.

    Raises
    ------
    InputError
        Anything else, or elements of an object that has its own.
    """
    given = [faces, tets, edges, particles]
    parts = None if isinstance(mesh, np.ndarray) else _parts(mesh)
    if parts is None:
        vertices = _arrays.points(name, mesh)
        return _checked(vertices, faces, tets, edges, particles)
    if any(elements is not None for elements in given):
        raise InputError(f"{type(mesh).__name__}: the mesh has elements of its own; give either these or arrays")
    if isinstance(parts, Mesh):
        return parts
    vertices, faces, tets, edges, particles = parts
    return _checked(_arrays.points(name, vertices), faces, tets, edges, particles)


def _checked(vertices: Any, faces: Any, tets: Any, edges: Any, particles: Any) -> Mesh:
    count = len(vertices)
    return Mesh(
        vertices,
        _arrays.elements("faces", faces, 3, count),
        _arrays.elements("tets", tets, 4, count),
        _arrays.elements("edges", edges, 2, count),
        _arrays.elements("particles", particles, None, count),
    )


def _parts(mesh: Any) -> Any:
    """Vertices, faces, tetrahedra, edges and particles of a mesh; None for what is none."""
    if isinstance(mesh, Mesh):
        return mesh
    if is_path(mesh):
        return read_mesh(mesh)
    # pyvista: a surface of triangles.
    if _has(mesh, "points") and _has(mesh, "regular_faces"):
        try:
            faces = np.asarray(mesh.regular_faces)
        except Exception as error:  # pyvista raises ValueError for faces of several sizes
            raise InputError(f"{type(mesh).__name__}: {error}; `triangulate()` makes triangles of all") from error
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise InputError(
                f"{type(mesh).__name__}: expected triangles, got faces of shape {faces.shape}; "
                "`triangulate()` makes triangles of all"
            )
        return mesh.points, faces, None, None, None
    # meshio, and grids of pyvista: cells by type.
    if _has(mesh, "points") and _has(mesh, "cells_dict"):
        cells = {_VTK_CELLS.get(kind, kind): rows for kind, rows in mesh.cells_dict.items()}
        others = [str(kind) for kind in cells if kind not in _VTK_CELLS.values()]
        if others:
            raise InputError(
                f"{type(mesh).__name__}: cells of type {', '.join(others)} cannot be used; "
                f"{', '.join(_VTK_CELLS.values())} can"
            )
        triangles = cells.get("triangle")
        if "quad" in cells:
            quads = np.asarray(cells["quad"])
            halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
            triangles = halves if triangles is None else np.concatenate([triangles, halves])
        loose = cells.get("vertex")
        loose = None if loose is None else np.asarray(loose).reshape(-1)
        return _three(mesh.points), triangles, cells.get("tetra"), cells.get("line"), loose
    # trimesh, and whatever is like it.
    if _has(mesh, "vertices") and _has(mesh, "faces"):
        return mesh.vertices, mesh.faces, None, None, None
    return None


def _has(mesh: Any, name: str) -> bool:
    """Whether an object has an attribute, which may still refuse to tell its value."""
    try:
        return hasattr(mesh, name)
    except Exception:
        return True


def _three(points: Any) -> Any:
    """Points of a plane as points of space."""
    points = np.asarray(points)
    if points.ndim == 2 and points.shape[1] == 2:
        return np.column_stack([points, np.zeros(len(points))])
    return points


def read_mesh(path: str | os.PathLike[str], *, up: str = "z", scale: float = 1.0, part: str | None = None) -> Mesh:
    """Reads a mesh file: OBJ, PLY, STL, Gmsh (``.msh``), Medit (``.mesh``), TetGen, VTU, USD, glTF, ``.t``, ``.seg``.

    Parameters
    ----------
    path : path
        The file; the ending of its name tells the format. Binary USD needs usd-core.
    up : {"z", "y", "x"}
        The axis of the file that points up; in Bowknot, z does.
    scale : float
        Length of the file's unit [m]: 0.01 for centimeters.
    part : str, optional
        The part that is taken of a file that has several: a prim of a USD stage by its name or path, or all below that
        path; a node of a glTF scene, an object of an OBJ by its name. Default: all as one mesh.

    Returns
    -------
    Mesh
        Polygons as triangles; vertices keep their numbers.

    Raises
    ------
    InputError
        A missing or malformed file, with the place; a part that is not there, with those that are.
    """
    if not (part is None or isinstance(part, str)):
        raise InputError(f"part: expected the name of a part, got {type(part).__name__}")
    with as_text(path) as text:
        return Mesh(**call(_native.read_mesh, text, up, float(scale), part))
