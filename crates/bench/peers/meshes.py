"""Generated meshes: a folded sheet, a flat one, surfaces of revolution."""

import numpy as np


def folded_sheet(vertices, gap, seed=1):
    """About `vertices` vertices of a sheet 20 cm wide, folded into layers `gap` [m] apart.

    The profile runs back and forth at even heights, joined by half circles. All layers share the same
    waves, a shear along z, which keeps their distances along z; small random offsets, an eighth of
    the gap at most, break the regularity. The sheet is free of intersections; the caller checks it.
    """
    width, turn = 0.2, 8
    layers = max(4, round(2.0 * (vertices / 1000.0) ** 0.5))
    across = max(8, round((vertices / layers / 2.0) ** 0.5))
    along = max(8, round(vertices / (layers * across)) - turn)

    profile = []
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, turn + 2)[1:-1]
    for layer in range(layers):
        right = layer % 2 == 0
        run = np.linspace(0.0, width, along)
        profile.append(np.stack([run if right else run[::-1], np.full(along, layer * gap)], axis=1))
        if layer + 1 < layers:
            x = width + 0.5 * gap * np.cos(angles) if right else -0.5 * gap * np.cos(angles)
            profile.append(np.stack([x, (layer + 0.5) * gap + 0.5 * gap * np.sin(angles)], axis=1))
    profile = np.concatenate(profile)

    rows = len(profile)
    x, z = np.repeat(profile, across, axis=0).T
    y = np.tile(np.linspace(0.0, width, across), rows)
    # Folds are tighter than a triangle is wide: there the sheet stays smooth.
    smooth = np.clip(np.minimum(x, width - x) / (0.05 * width), 0.0, 1.0)
    offset = smooth * np.random.default_rng(seed).uniform(-gap / 8.0, gap / 8.0, len(x))
    z = z + 0.01 * np.sin(25.0 * x) * np.sin(19.0 * y) + offset
    return np.stack([x, y, z], axis=1), _grid(rows, across)


def flat_sheet(side, vertices):
    """A square of `vertices` x `vertices` vertices about the origin."""
    t = np.linspace(-0.5 * side, 0.5 * side, vertices)
    x, y = np.meshgrid(t, t, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1), _grid(vertices, vertices)


def ball(radius, meridians=64, parallels=32):
    """A closed sphere about the origin."""
    phi = np.linspace(-0.5 * np.pi, 0.5 * np.pi, parallels + 1)
    return _revolved(radius * np.cos(phi), radius * np.sin(phi), meridians)


def needle(radius, height, meridians=24, parallels=16):
    """A closed cone whose tip is the origin, pointing up."""
    s = np.linspace(0.0, 1.0, parallels + 1)
    profile = np.append(0.0, radius * (1.0 - s)), np.append(-height, height * (s - 1.0))
    return _revolved(*profile, meridians)


def mean_edge(points, faces):
    """Mean length of the edges of triangles."""
    a, b = edges_of(faces).T
    return float(np.linalg.norm(points[a] - points[b], axis=1).mean())


def edges_of(faces):
    """Each edge of the triangles once, the smaller vertex first."""
    halves = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(np.sort(halves, axis=1), axis=0)


def _grid(rows, columns):
    """Triangles of a grid, their diagonals alternating."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    i, j = i.ravel(), j.ravel()
    a = i * columns + j
    b, c, d = a + columns, a + columns + 1, a + 1
    even = ((i + j) % 2 == 0)[:, None]
    first = np.where(even, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(even, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.concatenate([first, second]).astype(np.int32)


def _revolved(radii, heights, meridians):
    """The surface that a profile sweeps about z; its ends are on the axis, the lower one first."""
    angle = 2.0 * np.pi * np.arange(meridians) / meridians
    rings = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(meridians, z)], axis=1)
        for r, z in zip(radii[1:-1], heights[1:-1], strict=True)
    ]
    points = np.concatenate([[[0.0, 0.0, heights[0]]], *rings, [[0.0, 0.0, heights[-1]]]])
    here = np.arange(meridians)
    after = (here + 1) % meridians
    top = len(points) - 1
    faces = [np.stack([np.zeros(meridians, int), 1 + after, 1 + here], axis=1)]
    for ring in range(len(rings) - 1):
        a, b = 1 + ring * meridians, 1 + (ring + 1) * meridians
        faces.append(np.stack([a + here, a + after, b + after], axis=1))
        faces.append(np.stack([a + here, b + after, b + here], axis=1))
    last = 1 + (len(rings) - 1) * meridians
    faces.append(np.stack([last + here, last + after, np.full(meridians, top)], axis=1))
    return points, np.concatenate(faces).astype(np.int32)
