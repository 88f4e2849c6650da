# SPDX-License-Identifier: GPL-3.0-or-later
"""Tetrahedra inside of a closed surface: the Delaunay tetrahedra of its vertices and of a lattice within.

The surface of the result has the vertices of the given one; its triangles may differ where the given ones are not
Delaunay. The Delaunay tetrahedra come from adding one point at a time (Bowyer, Watson 1981).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Most vertices of a surface: the time grows with the square of the number of all points.
MOST_VERTICES = 6000

#: Least volume of a tetrahedron, in the cube of the root mean square of its edges; a regular one has 0.118.
_LEAST_QUALITY = 0.003

_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
_EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])


class NotSolid(Exception):
    """A mesh that cannot be filled: the message says why, and what to do."""


def fill(points: Floats, triangles: Indices, cell: float = 0.0) -> tuple[Floats, Indices]:
    """Fills a closed surface.

    Parameters
    ----------
    points, triangles : shapes (n, 3) and (m, 3)
        The surface, closed, with its triangles counter-clockwise seen from outside, or all the other way round.
    cell : float
        Edge length of the tetrahedra inside; 0: the mean one of the surface. Less than that is not used.

    Returns
    -------
    points, tets
        The vertices of the surface, in their order, then those inside.
    """
    _closed(triangles)
    if len(points) > MOST_VERTICES:
        raise NotSolid(
            f"a solid may have {MOST_VERTICES} vertices, this one has {len(points)}: simulate a coarser mesh "
            "(Decimate, Remesh), with a Subdivision Surface modifier for the looks"
        )
    volume = _volume(points, triangles)
    if volume < 0.0:
        triangles, volume = triangles[:, ::-1], -volume
    edges = points[triangles] - points[np.roll(triangles, 1, axis=1)]
    mean = float(np.linalg.norm(edges, axis=2).mean())
    cell = max(cell, mean)
    best: tuple[float, Floats, Indices] | None = None
    for seed in range(4):
        inside = _lattice(points, triangles, cell, seed)
        found = np.concatenate([points, inside])
        tets = _peeled(found, _kept(found, delaunay(found, mean, seed), points, triangles), len(points))
        quality = float(_quality(found, tets).min()) if len(tets) > 0 else 0.0
        fits = len(tets) > 0 and _fits(found, tets, len(points), volume)
        if fits and (best is None or quality > best[0]):
            best = quality, found, tets
        if best is not None and best[0] > 2.0 * _LEAST_QUALITY:
            break
    if best is None or best[0] < _LEAST_QUALITY:
        raise NotSolid(
            "no tetrahedra fit its surface: it has thin or very uneven parts. Even it out (Object Data > Remesh > Voxel, "
            "smaller than the thinnest part), or make it Cloth"
        )
    _, found, tets = best
    used = np.unique(np.concatenate([np.arange(len(points)), tets.ravel()]))
    numbers = np.zeros(len(found), np.int64)
    numbers[used] = np.arange(len(used))
    return found[used], numbers[tets]


def surface(tets: Indices) -> Indices:
    """The triangles of the surface of tetrahedra, shape (m, 3), counter-clockwise seen from outside."""
    faces = tets[:, _FACES].reshape(-1, 3)
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[counts == 1])]


def delaunay(points: Floats, length: float, seed: int = 0) -> Indices:
    """The Delaunay tetrahedra of points, shape (t, 4); `length` is a typical distance of neighbors.

    Where five points lie on a sphere, small random weights decide (a regular triangulation). Unlike points that are
    moved, they make no flat tetrahedra of four points in a plane, of which grids have many.
    """
    random = np.random.default_rng(seed)
    middle = points.mean(axis=0)
    size = float(np.abs(points - middle).max()) + length
    around = 40.0 * size * np.array([[1, 1, 1], [1.1, -1, -1.2], [-1.3, 1, -1], [-1, -1.1, 1.0]])
    count = len(points)
    # About the middle, so that rounding is small far from the origin.
    moved = np.concatenate([points - middle, around])
    weights = np.concatenate([random.uniform(0.0, 1e-3, count) * length**2, np.zeros(4)])
    # Room for the tetrahedra; those that are gone have the radius -inf.
    tets = np.zeros((256, 4), np.int64)
    centers, radii = np.zeros((256, 3)), np.full(256, -np.inf)
    tets[0] = count + np.arange(4)
    centers[:1], radii[:1] = _spheres(moved, weights, tets[:1])
    top, free = 1, []
    for point in random.permutation(count):
        away = moved[point] - centers[:top]
        bad = np.flatnonzero(np.einsum("ij,ij->i", away, away) - weights[point] < radii[:top])
        faces = tets[bad][:, _FACES].reshape(-1, 3)
        _, first, counts = np.unique(
            np.sort(faces, axis=1) @ [1, count + 4, (count + 4) ** 2], return_index=True, return_counts=True
        )
        rim = faces[first[counts == 1]]
        new = np.column_stack([np.full(len(rim), point), rim])
        radii[bad] = -np.inf
        free.extend(bad.tolist())
        while len(free) < len(new):
            if top == len(tets):
                tets = np.concatenate([tets, np.zeros_like(tets)])
                centers = np.concatenate([centers, np.zeros_like(centers)])
                radii = np.concatenate([radii, np.full(len(radii), -np.inf)])
            free.append(top)
            top += 1
        places = [free.pop() for _ in range(len(new))]
        tets[places] = new
        centers[places], radii[places] = _spheres(moved, weights, new)
    found = tets[:top][radii[:top] > -np.inf]
    return _positive(points, found[(found < count).all(axis=1)])


def _spheres(points: Floats, weights: Floats, tets: Indices) -> tuple[Floats, Floats]:
    """Centers and squared radii of the spheres that are orthogonal to the weighted points of tetrahedra."""
    first = points[tets[:, 0]]
    edges = points[tets[:, 1:]] - first[:, None]
    lengths = np.einsum("ijk,ijk->ij", edges, edges) - weights[tets[:, 1:]] + weights[tets[:, :1]]
    a, b, c = edges[:, 0], edges[:, 1], edges[:, 2]
    bc, ca, ab = np.cross(b, c), np.cross(c, a), np.cross(a, b)
    down = 2.0 * np.einsum("ij,ij->i", a, bc)
    # Of a flat tetrahedron the sphere is as good as a half-space.
    down = np.where(np.abs(down) < 1e-300, 1e-300, down)
    offset = (lengths[:, :1] * bc + lengths[:, 1:2] * ca + lengths[:, 2:] * ab) / down[:, None]
    return first + offset, np.einsum("ij,ij->i", offset, offset) - weights[tets[:, 0]]


def _positive(points: Floats, tets: Indices) -> Indices:
    """Tetrahedra with their vertices in the order of positive volume."""
    turned = _volumes(points, tets) < 0.0
    tets = tets.copy()
    tets[turned] = tets[turned][:, [1, 0, 2, 3]]
    return tets


def _volumes(points: Floats, tets: Indices) -> Floats:
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    return np.linalg.det(edges) / 6.0


def _quality(points: Floats, tets: Indices) -> Floats:
    """Volumes in the cube of the root mean square of the edges."""
    edges = points[tets[:, _EDGES[:, 0]]] - points[tets[:, _EDGES[:, 1]]]
    mean = np.sqrt(np.einsum("ijk,ijk->i", edges, edges) / 6.0)
    return _volumes(points, tets) / np.maximum(mean, 1e-300) ** 3


def _volume(points: Floats, triangles: Indices) -> float:
    a, b, c = (points[triangles[:, k]] - points.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def _closed(triangles: Indices) -> None:
    """Refuses what is no closed surface with one outside."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    open_edges, many = int((counts == 1).sum()), int((counts > 2).sum())
    if open_edges > 0:
        raise NotSolid(
            f"a solid needs a closed surface, and this one has {open_edges} open edges: fill its holes "
            "(Select > All by Trait > Non Manifold, then Face > Fill)"
        )
    if many > 0:
        raise NotSolid(
            f"a solid needs a closed surface, and here {many} edges have more than two faces: remove the inner ones"
        )


def _lattice(points: Floats, triangles: Indices, cell: float, seed: int) -> Floats:
    """Points of a body-centered cubic lattice inside of a surface and not near to it."""
    random = np.random.default_rng(seed)
    spacing = 1.1 * cell
    low = points.min(axis=0) + random.uniform(-0.5, 0.5, 3) * spacing
    ticks = [np.arange(low[k], points[:, k].max(), spacing) for k in range(3)]
    corners = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    lattice = np.concatenate([corners, corners + 0.5 * spacing])
    corners_of = points[triangles]
    samples = np.concatenate(
        [points, corners_of.mean(axis=1), 0.5 * (corners_of + np.roll(corners_of, 1, axis=1)).reshape(-1, 3)]
    )
    kept = []
    for part in np.array_split(lattice, max(1, len(lattice) * len(samples) // 2_000_000)):
        away = part[:, None] - samples[None]
        kept.append(part[np.einsum("ijk,ijk->ij", away, away).min(axis=1) > (0.6 * cell) ** 2])
    lattice = np.concatenate(kept)
    return lattice[_inside(lattice, points, triangles)]


def _inside(places: Floats, points: Floats, triangles: Indices) -> NDArray[np.bool_]:
    """Whether places are inside of a closed surface: by the solid angle that it fills (van Oosterom, Strackee 1983)."""
    inside = np.zeros(len(places), bool)
    corners = points[triangles]
    for part in np.array_split(np.arange(len(places)), max(1, len(places) * len(triangles) // 1_000_000)):
        a, b, c = (corners[None, :, k] - places[part, None] for k in range(3))
        la, lb, lc = (np.sqrt(np.einsum("ijk,ijk->ij", side, side)) for side in (a, b, c))
        ab, bc, ca = (np.einsum("ijk,ijk->ij", x, y) for x, y in ((a, b), (b, c), (c, a)))
        up = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        angle = np.arctan2(up, la * lb * lc + ab * lc + bc * la + ca * lb).sum(axis=1)
        inside[part] = angle > np.pi  # 2 pi inside, 0 outside
    return inside


def _kept(found: Floats, tets: Indices, points: Floats, triangles: Indices) -> Indices:
    """The tetrahedra inside of the surface. Those with a vertex inside are, if the surface is fine enough, which
    `_fits` checks."""
    own = (tets >= len(points)).any(axis=1)
    rest = np.flatnonzero(~own)
    own[rest] = _inside(found[tets[rest]].mean(axis=1), points, triangles)
    return tets[own]


def _peeled(found: Floats, tets: Indices, count: int) -> Indices:
    """Without flat tetrahedra on the surface: those of vertices of the surface alone."""
    for _ in range(10):
        if len(tets) == 0:
            break
        flat = (_quality(found, tets) < _LEAST_QUALITY) & (tets < count).all(axis=1)
        faces = np.sort(tets[:, _FACES].reshape(-1, 3), axis=1)
        _, back, counts = np.unique(faces, axis=0, return_inverse=True, return_counts=True)
        outer = (counts[back.ravel()] == 1).reshape(-1, 4).any(axis=1)
        if not (flat & outer).any():
            break
        tets = tets[~(flat & outer)]
    return tets


def _fits(found: Floats, tets: Indices, count: int, volume: float) -> bool:
    """Whether tetrahedra fill a surface of `count` vertices: with all of its vertices and no other ones on their own
    surface, which is closed and has its volume."""
    skin = surface(tets)
    if len(np.unique(skin)) != count or skin.max() >= count:
        return False
    edges = np.sort(skin[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    filled = float(_volumes(found, tets).sum())
    return bool((counts == 2).all()) and abs(filled - volume) < 0.02 * volume
