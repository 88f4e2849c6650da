"""Meshes by themselves: the judge, the search, repair."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arrays, _native
from ._call import call
from ._errors import InputError
from ._files import FilesReport, check_files, count_of
from ._info import Info
from ._meshes import Mesh, is_path, mesh_of


class CheckReport(Info):
    """What the judge says. It is true if nothing intersects.

    ``intersection_count`` counts all pairs, ``intersections`` has the first ones with their vertices, place and depth,
    ``findings`` the same in words; ``body_pairs`` counts them by bodies, of which a half-space is None, with the
    deepest of each [m]; ``min_distance_m`` is the smallest distance [m], None if there is no pair.
    """

    __slots__ = ("findings",)

    def __init__(self, text: str, findings: list[str]) -> None:
        super().__init__(text)
        #: The first intersections in words.
        self.findings = findings

    def _all(self) -> dict[str, Any]:
        entries = super()._all()
        if "hits" in entries:
            entries["intersections"] = entries.pop("hits")
            entries["intersection_count"] = entries.pop("hit_count")
        if "min_distance_m" not in entries and "nearest" in entries:
            nearest = entries["nearest"]
            entries["min_distance_m"] = None if nearest is None else nearest["distance"]
        return entries

    def __bool__(self) -> bool:
        return self["intersection_count"] == 0

    def __repr__(self) -> str:
        count = self["intersection_count"]
        return f"CheckReport({count} {'intersection' if count == 1 else 'intersections'})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text, self.findings)


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of primitives, one per row, sorted by kind and elements.

    Attributes
    ----------
    kinds : ndarray of uint8, shape (k,)
        0: two particles, 1: a particle and an edge, 2: a vertex and a triangle, 3: two edges, 4: a vertex and a
        half-space.
    elements : ndarray of uint32, shape (k, 2)
        Numbers of the two primitives; edges are those of all triangles and strands.
    vertices : ndarray of uint32, shape (k, 4)
        Vertices of the first primitive, then of the second; if there are fewer than four, the first again.
    distances : ndarray of float64, shape (k,)
        Distances [m].
    normals : ndarray of float64, shape (k, 3)
        Unit directions from the second primitive to the first [1].
    weights : ndarray of float64, shape (k, 4)
        Weights of the closest points in the vertices [1], negative on the second primitive: the gradient of the
        distance by vertex i is ``weights[i] * normal``.
    """

    kinds: NDArray[np.uint8]
    elements: NDArray[np.uint32]
    vertices: NDArray[np.uint32]
    distances: NDArray[np.float64]
    normals: NDArray[np.float64]
    weights: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.distances)

    def __repr__(self) -> str:
        return f"Pairs({len(self)})"


def _given(
    mesh: Mesh, bodies: ArrayLike | None, obstacles: ArrayLike | None, planes: ArrayLike | None
) -> SimpleNamespace:
    obstacle = _arrays.flags("obstacles", obstacles, len(mesh.vertices))
    triangles = mesh.faces
    if len(mesh.tets) > 0:
        from ._pictures import _surface

        triangles = np.concatenate([triangles, _surface(mesh.tets)])
    return SimpleNamespace(
        triangles=triangles,
        strands=mesh.edges,
        particles=mesh.particles,
        obstacle=obstacle,
        body=_arrays.bodies(bodies, obstacle),
        planes=np.zeros((0, 4)) if planes is None else _arrays.numbers("planes", planes, 4),
    )


def check(
    mesh: Any,
    faces: ArrayLike | None = None,
    edges: ArrayLike | None = None,
    particles: ArrayLike | None = None,
    *,
    bodies: ArrayLike | None = None,
    obstacles: ArrayLike | None = None,
    planes: ArrayLike | None = None,
    limit: int = 100,
    distance: bool = True,
) -> CheckReport | FilesReport:
    """Judges whether a mesh, or any frame of a file, intersects itself, by exact predicates.

    Parameters
    ----------
    mesh : mesh, path, or array_like of float64, shape (n, 3)
        A mesh of meshio, trimesh or pyvista, or vertices [m]. Of tetrahedra, the surface is judged. A path is that of
        a mesh, an animation or a run, all frames of which are judged; `check_files` has more options.
    faces, edges, particles : array_like of integers, optional
        Triangles (m, 3), edges of strands (k, 2) and particles (p,) of an array of vertices.
    bodies : array_like of integers, shape (n,), optional
        The body of each vertex, for the report.
    obstacles : array_like of bool, shape (n,), or of integers, optional
        Vertices of obstacles, which may intersect each other.
    planes : array_like of float64, shape (h, 4), optional
        Half-spaces that vertices must be above: a normal and an offset [m].
    limit : int
        How many intersections are listed; all are counted.
    distance : bool
        Whether the smallest distance is found, which costs about as much again.

    Returns
    -------
    CheckReport, or FilesReport of a path
        True if nothing intersects.

    Raises
    ------
    InputError
        Shapes, types, elements that do not exist, coordinates that are not finite; files that cannot be read.

    Examples
    --------
    >>> import bowknot
    >>> crossed = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.2, 0.2, 1], [0.3, 0.2, 1]]
    >>> report = bowknot.check(crossed, [[0, 1, 2], [3, 4, 5]])
    >>> bool(report), report.intersection_count
    (False, 2)
    """
    if is_path(mesh):
        if any(given is not None for given in (faces, edges, particles, bodies, obstacles, planes)):
            raise InputError("the file has elements of its own; check_files has the options for files")
        return check_files(mesh, limit=limit)
    found = mesh_of(mesh, faces, edges=edges, particles=particles)
    given = _given(found, bodies, obstacles, planes)
    return CheckReport(*call(_native.check_state, found.vertices, given, count_of("limit", limit), bool(distance)))


def check_path(
    start: ArrayLike,
    end: ArrayLike,
    faces: ArrayLike | None = None,
    edges: ArrayLike | None = None,
    particles: ArrayLike | None = None,
    *,
    bodies: ArrayLike | None = None,
    obstacles: ArrayLike | None = None,
    planes: ArrayLike | None = None,
    limit: int = 100,
) -> CheckReport:
    """Judges whether anything meets while all vertices move along straight lines from one state to another.

    Parameters
    ----------
    start, end : array_like of float64, shape (n, 3)
        The two states [m].
    faces, edges, particles, bodies, obstacles, planes, limit
        As for `check`.

    Returns
    -------
    CheckReport
        True if nothing meets; pairs that could not be certified to stay apart count as meeting.
    """
    first = mesh_of(start, faces, edges=edges, particles=particles, name="start")
    last = _arrays.points("end", end, len(first.vertices))
    given = _given(first, bodies, obstacles, planes)
    return CheckReport(*call(_native.check_path, first.vertices, last, given, count_of("limit", limit)))


def search(
    mesh: Any,
    faces: ArrayLike | None = None,
    distance: float = 0.0,
    edges: ArrayLike | None = None,
    particles: ArrayLike | None = None,
    *,
    bodies: ArrayLike | None = None,
    obstacles: ArrayLike | None = None,
    planes: ArrayLike | None = None,
) -> Pairs:
    """Finds every pair of primitives without a common vertex that is at most a distance apart.

    Parameters
    ----------
    mesh : mesh, path, or array_like of float64, shape (n, 3)
        As for `check`.
    faces : array_like of integers, shape (m, 3), optional
        Triangles of an array of vertices.
    distance : float
        The distance [m].
    edges, particles, bodies, obstacles, planes
        As for `check`; two obstacles form no pair, and an element has one body.

    Returns
    -------
    Pairs
        The same for any number of threads.

    Examples
    --------
    >>> import bowknot
    >>> two = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0.5], [1, 0, 0.5], [0, 1, 0.5]]
    >>> pairs = bowknot.search(two, [[0, 1, 2], [3, 4, 5]], distance=0.6)
    >>> len(pairs), float(pairs.distances.min())
    (15, 0.5)
    """
    found = mesh_of(mesh, faces, edges=edges, particles=particles)
    given = _given(found, bodies, obstacles, planes)
    result = call(_native.search, found.vertices, given, float(distance))
    return Pairs(**{name: _arrays.read_only(array) for name, array in result.items()})


def repair(
    mesh: Any,
    faces: ArrayLike | None = None,
    *,
    tets: ArrayLike | None = None,
    edges: ArrayLike | None = None,
    weld_distance: float | None = None,
    drop_lines: bool = False,
    drop_triangles: bool = False,
) -> tuple[Mesh, Info]:
    """Welds the seams of a garment and drops triangles without area, or mends the tetrahedra of a solid.

    Parameters
    ----------
    mesh : mesh, path, or array_like of float64, shape (n, 3)
        As for `check`.
    faces, tets, edges : array_like of integers, optional
        Elements of an array of vertices.
    weld_distance : float, optional
        Border vertices, and any vertices of solids, nearer than this are welded [unit of the mesh]. Default: a
        hundredth of the mean border edge; of solids a ten-thousandth of the mean edge.
    drop_lines, drop_triangles : bool
        Whether all lines, and all triangles beside tetrahedra, are dropped.

    Returns
    -------
    mesh : Mesh
        The repaired mesh.
    report : Info
        What was done: ``welded_vertices``, ``zero_area_triangles``, ``before``, ``after`` and others.

    Raises
    ------
    InputError
        Neither triangles nor tetrahedra, a weld distance that is no length.
    """
    given = mesh_of(mesh, faces, tets=tets, edges=edges)
    weld = None if weld_distance is None else float(weld_distance)
    arrays, report = call(
        _native.repair,
        given.vertices,
        given.faces,
        given.tets,
        given.edges,
        weld,
        bool(drop_lines),
        bool(drop_triangles),
    )
    return Mesh(**arrays), Info(report)
