"""Frames of a run as binary PLY files, as `bowknot run` writes them, and what `bowknot check` says of them."""

import json
from dataclasses import dataclass

import numpy as np

import meshes
import setting

_KIND = np.dtype([("x", "<f8", 3), ("obstacle", "u1"), ("body", "<i4")])


@dataclass
class Frames:
    """The surfaces of the bodies, `x[f,n,3]`; which body a vertex is of; the edges within bodies."""

    x: np.ndarray
    body: np.ndarray
    edges: np.ndarray

    def largest_stretch(self):
        """Largest length of an edge over all frames, relative to that at the start, where nothing is strained."""
        a, b = self.edges.T
        rest = np.linalg.norm(self.x[0, a] - self.x[0, b], axis=1)
        return max(float((np.linalg.norm(x[a] - x[b], axis=1) / rest).max()) for x in self.x)

    def rests_from(self, dt, within):
        """The time from which on no vertex is farther than `within` [m] from where it ends; None if that holds for
        less than a tenth of the run."""
        away = np.linalg.norm(self.x - self.x[-1], axis=2).max(axis=1)
        moving = np.flatnonzero(away > within)
        first = int(moving[-1]) + 1 if len(moving) else 0
        return first * dt if first <= 0.9 * (len(self.x) - 1) else None


def read(folder):
    """All frames of a folder."""
    paths = sorted(folder.glob("*.ply"))
    vertices, faces = _read(paths[0])
    own = vertices["obstacle"] == 0
    edges = meshes.edges_of(faces)
    # Deformable vertices come first.
    edges = edges[own[edges].all(axis=1)]
    return Frames(np.array([_read(path)[0]["x"][own] for path in paths]), vertices["body"][own], edges)


def _read(path):
    header, _, data = path.read_bytes().partition(b"end_header\n")
    counts = [int(line.split()[2]) for line in header.splitlines() if line.startswith(b"element ")]
    vertices = np.frombuffer(data, _KIND, counts[0])
    faces, rest = [], data[counts[0] * _KIND.itemsize :]
    at = 0
    # The quads of half-spaces come last; their vertices are of obstacles.
    for _ in range(counts[1]):
        size = rest[at]
        if size == 3:
            faces.append(rest[at + 1 : at + 13])
        at += 1 + 4 * size
    return vertices, np.frombuffer(b"".join(faces), "<i4").reshape(-1, 3)


def intersecting(folder):
    """Number of frames that intersect, by `bowknot check`."""
    text = setting.call([setting.program("bowknot"), "check", folder, "--json"], (0, 1))
    return sum(verdict["intersections"] > 0 for verdict in json.loads(text)["files"])
