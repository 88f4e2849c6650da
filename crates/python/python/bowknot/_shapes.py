"""Generated meshes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ._errors import InputError
from ._meshes import Mesh
from ._scene import Scene, _kind
from ._simulator import Simulator

#: Name of the shape in its scene.
_NAME = "shape"


def shape(shape: str | Mapping[str, Any], **keys: Any) -> Mesh:
    """Makes the mesh of a shape of scenes, for those who want its arrays.

    Parameters
    ----------
    shape : str or dict
        The type of a shape of the scene reference, or its table: ``"ball"``, ``{"type": "ball", "radius": 0.1}``.
    **keys
        Keys of the table, and of where it is: ``radius``, ``edge``, ``size``; ``scale``, ``rotate``, ``translate``.

    Returns
    -------
    Mesh
        Vertices [m] and triangles, tetrahedra, edges or particles, whichever the shape is made of. A shape that moves
        is that of the time 0.

    Raises
    ------
    InputError
        An unknown type or key, a value out of its range, a half-space, which has no mesh.

    Examples
    --------
    >>> import bowknot
    >>> bowknot.shape("ball", radius=0.1, edge=0.05)
    Mesh(42 vertices, 80 faces)
    """
    table: dict[str, Any] = dict(shape) if isinstance(shape, Mapping) else {"type": shape}
    if not isinstance(table.get("type"), str):
        raise InputError(f"shape: expected the type of a shape or a dict with the key type, got {shape!r}")
    if table["type"] == "half-space":
        raise InputError("shape: a half-space has no mesh")
    place = {key: keys.pop(key) for key in ("scale", "rotate", "translate") if key in keys}
    entry = {"shape": {**table, **keys}, "name": _NAME, **place}
    try:
        simulator = _simulator(entry)
    except InputError as error:
        raise InputError(re.sub(r"(body|obstacle)\[0\]\.", "", str(error))) from None
    order = simulator.vertices_of(_NAME)
    numbers = np.zeros(len(simulator.positions), np.uint32)
    named = np.flatnonzero(order >= 0)
    numbers[order[named]] = named
    own = np.isin(simulator.particles, order)
    faces = simulator.faces_of(_NAME) if len(simulator.tets) == 0 else np.zeros((0, 3), np.uint32)
    return Mesh(
        np.array(simulator.positions_of(_NAME)),
        faces,
        numbers[simulator.tets],
        numbers[simulator.edges],
        numbers[simulator.particles[own]],
    )


def _simulator(entry: dict[str, Any]) -> Simulator:
    if entry["shape"]["type"] == "figure":
        # A figure is an obstacle, and no scene is without a body.
        grain = {"mesh": np.array([[0.0, 0.0, 1e3]]), "name": "grain"}
        return Simulator(Scene([grain], [entry]))
    if _kind(entry["shape"]) == "solid":
        entry = {**entry, "elements": "linear"}
    return Simulator(Scene([entry]))
