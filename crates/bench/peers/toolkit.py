"""The parts of ipctk that the comparisons use: meshes, distances, intersections."""

import numpy as np

from meshes import edges_of
from setting import peer


def start(threads):
    """The module, limited to so many threads."""
    ipctk = peer("ipctk")
    ipctk.set_num_threads(threads)
    ipctk.set_logger_level(ipctk.LoggerLevel.error)
    return ipctk


def mesh_of(ipctk, points, faces, held=None):
    """A collision mesh; `held` vertices do not collide with each other."""
    edges = np.asfortranarray(edges_of(faces), dtype=np.int32)
    faces = np.asfortranarray(faces, dtype=np.int32)
    mesh = ipctk.CollisionMesh(positions(points), edges, faces)
    if held is not None and held.any():
        # Vertices of one patch do not collide: all held ones are in patch 0, each other in its own.
        patches = np.where(held, 0, 1 + np.arange(len(points)))
        mesh.can_collide = ipctk.make_vertex_patches_filter(patches.astype(np.int32))
    return mesh


def positions(points):
    """Positions in the layout that ipctk takes without a copy."""
    return np.asfortranarray(points, dtype=np.float64)


def smallest_distance(ipctk, mesh, points, within):
    """The smallest distance of two primitives; None if all distances exceed `within`."""
    collisions = ipctk.NormalCollisions()
    collisions.build(mesh, points, within)
    return collisions.compute_minimum_distance(mesh, points) ** 0.5 if len(collisions) else None
