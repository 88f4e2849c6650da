"""Contacts that carry a force."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arrays


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts that carry a force, one per row.

    Attributes
    ----------
    bodies : ndarray of uint32, shape (k, 2)
        The two sides, by their place in `Simulator.names`; of a `Resolver` the numbers of the bodies, half-spaces
        behind them.
    vertices : ndarray of uint32, shape (k, 4)
        The vertices of both sides, those of the first side first; if there are fewer than four, the first again.
    weights : ndarray of float64, shape (k, 4)
        Weights of the closest points in the vertices [1]: positive on the first side, negative on the second, 0 where
        there is no further vertex.
    points_a, points_b : ndarray of float64, shape (k, 3)
        The closest points of the first and the second side [m].
    normals : ndarray of float64, shape (k, 3)
        Unit normals, toward the first side [1].
    gaps : ndarray of float64, shape (k,)
        Distances of the closest points along the normals [m].
    forces : ndarray of float64, shape (k, 3)
        Forces on the first side [N]; those on the second are opposite. A pair of bodies may appear in both orders.
    """

    bodies: NDArray[np.uint32]
    vertices: NDArray[np.uint32]
    weights: NDArray[np.float64]
    points_a: NDArray[np.float64]
    points_b: NDArray[np.float64]
    normals: NDArray[np.float64]
    gaps: NDArray[np.float64]
    forces: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.gaps)

    def __repr__(self) -> str:
        return f"Contacts({len(self)})"

    def wrench(
        self, body: int, about: Any = (0.0, 0.0, 0.0), *, by: int | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Force [N] and torque [N m] about a point that contacts exert on a side, by its number in ``bodies``: all of
        them, or those with the side ``by`` alone. On itself (``by=body``) a body exerts no force in sum."""
        places = np.concatenate([self.points_a, self.points_b]) - _arrays.vector("about", about)
        forces = np.concatenate([self.forces, -self.forces])
        on_it = np.concatenate([self.bodies[:, 0], self.bodies[:, 1]]) == body
        if by is not None:
            on_it &= np.concatenate([self.bodies[:, 1], self.bodies[:, 0]]) == by
        return forces[on_it].sum(axis=0), np.cross(places[on_it], forces[on_it]).sum(axis=0)


def contacts_of(arrays: Mapping[str, NDArray[Any]]) -> Contacts:
    """Contacts of arrays, which become read-only."""
    return Contacts(**{name: _arrays.read_only(array) for name, array in arrays.items()})
