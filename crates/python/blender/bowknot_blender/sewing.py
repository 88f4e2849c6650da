# SPDX-License-Identifier: GPL-3.0-or-later
"""Where points go that are sewn to a surface which moves and deforms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from mathutils.kdtree import KDTree
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Most vertices of the patch of a point, and fewest.
_MOST, _FEWEST = 48, 8

#: How often a point that is too near is pushed: in a crease, away from one side is toward the other.
_PUSHES = 4

#: The share of its distance to the surface that a point keeps at least.
_KEPT = 0.7


def carried(points: Floats, frames: Sequence[Floats], triangles: NDArray[np.int64]) -> Floats:
    """The places of points in each frame, shape (f, k, 3); in the first they are where they are given.

    Each point goes with the best rigid motion of a patch of the surface near it. A single triangle would not do: skin
    that a joint stretches and shears would pull a waistband apart, and turn it into the body.
    """
    first = frames[0]
    patches, weights = _patches(points, first, triangles)
    outside = _heights(points, _tree(first, triangles))[0]
    places = np.empty((len(frames), *points.shape))
    for number, frame in enumerate(frames):
        tree = _tree(frame, triangles)
        moved = _rigid(points, first[patches], frame[patches], weights)
        for _ in range(_PUSHES):
            height, foot, normal = _heights(moved, tree)
            side = np.where(outside < 0.0, -1.0, 1.0)
            least = _KEPT * np.abs(outside)
            near = height * side < least
            if not near.any():
                break
            moved[near] = (foot + normal * (side * least)[:, None])[near]
        places[number] = moved
    places[0] = points
    return places


def _patches(points: Floats, surface: Floats, triangles: NDArray[np.int64]) -> tuple[NDArray[np.int64], Floats]:
    """The vertices of the surface about each point, shape (k, most), and their weights, 0 where there are fewer."""
    corners = surface[triangles]
    edge = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
    tree = KDTree(len(surface))
    for number, vertex in enumerate(surface):
        tree.insert(Vector(vertex), number)
    tree.balance()
    faces = _tree(surface, triangles)
    patches = np.zeros((len(points), _MOST), np.int64)
    weights = np.zeros((len(points), _MOST))
    for row, point in enumerate(points):
        foot, _, _, distance = faces.find_nearest(Vector(point))
        radius = max(4.0 * distance, 3.0 * edge)
        found = tree.find_range(foot, radius)
        if len(found) < _FEWEST:
            found = tree.find_n(foot, _FEWEST)
        found = found[:: -(-len(found) // _MOST)]
        reach = max(radius, 1.1 * max(entry[2] for entry in found))
        patches[row, : len(found)] = [entry[1] for entry in found]
        weights[row, : len(found)] = [(1.0 - (entry[2] / reach) ** 2) ** 2 for entry in found]
    return patches, weights / weights.sum(axis=1, keepdims=True)


def _rigid(points: Floats, before: Floats, after: Floats, weights: Floats) -> Floats:
    """Points moved by the rigid motions that fit their patches best (Kabsch 1976)."""
    middle, onto = np.einsum("kn,kni->ki", weights, before), np.einsum("kn,kni->ki", weights, after)
    moments = np.einsum("kn,kni,knj->kij", weights, before - middle[:, None], after - onto[:, None])
    left, _, right = np.linalg.svd(moments)
    turned = np.einsum("kij,kjl->kil", left, right)
    left[:, :, 2] *= np.sign(np.linalg.det(turned))[:, None]
    return onto + np.einsum("ki,kij,kjl->kl", points - middle, left, right)


def _heights(points: Floats, tree: BVHTree) -> tuple[Floats, Floats, Floats]:
    """Heights of points above a surface, below 0 within; the nearest places on it, and normals there."""
    found = [tree.find_nearest(Vector(point)) for point in points]
    foot, normal = np.array([entry[0] for entry in found]), np.array([entry[1] for entry in found])
    away = points - foot
    return np.linalg.norm(away, axis=1) * np.where(np.einsum("ki,ki->k", away, normal) < 0.0, -1.0, 1.0), foot, normal


def _tree(surface: Floats, triangles: NDArray[np.int64]) -> BVHTree:
    return BVHTree.FromPolygons(surface.tolist(), triangles.tolist())
