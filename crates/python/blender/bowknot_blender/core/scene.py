# SPDX-License-Identifier: GPL-3.0-or-later
"""What is simulated, as plain arrays in meters, and the scene of the package that is made of it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

import bowknot

from . import tets as tetrahedra
from .presets import HAIR

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


class Refused(Exception):
    """An object that cannot be simulated as it is: the message names it and the remedy."""


def _no_indices() -> Indices:
    return np.zeros(0, np.int64)


@dataclass
class Body:
    """An object that is simulated.

    `start` has all vertices of the object in the first frame. `elements` are triangles of a cloth, edges of strands
    or triangles of the closed surface of a solid. Vertices that no element names keep their animated place, as
    `pinned` ones do: `led` are both, `led_frames` their places in each frame, shape (f, k, 3).
    """

    name: str
    kind: str
    start: Floats
    elements: Indices
    material: str
    friction: float = 0.3
    thickness: float = 0.0
    self_collision: bool = True
    pinned: Indices = field(default_factory=_no_indices)
    led: Indices = field(default_factory=_no_indices)
    led_frames: Floats = field(default_factory=lambda: np.zeros((0, 0, 3)))
    #: Edge length of the tetrahedra inside of a solid [m]; 0: that of its surface.
    cell: float = 0.0
    #: From the world [m] to the space of the object in each frame, shape (f, 4, 4).
    to_object: Floats = field(default_factory=lambda: np.zeros((0, 4, 4)))

    def __post_init__(self) -> None:
        #: The vertices that are simulated, in the order in which the scene has them.
        self.used = np.unique(self.elements)
        self._mesh: dict[str, NDArray] | None = None

    def mesh(self) -> dict[str, NDArray]:
        """The mesh of the scene: the used vertices, of a solid followed by those inside of it."""
        if self._mesh is None:
            numbers = np.zeros(len(self.start), np.int64)
            numbers[self.used] = np.arange(len(self.used))
            points, elements = self.start[self.used], numbers[self.elements]
            if self.kind == "solid":
                try:
                    points, elements = tetrahedra.fill(points, elements, self.cell)
                except tetrahedra.NotSolid as error:
                    raise Refused(f"{self.name}: {error}") from error
            key = {"cloth": "faces", "solid": "tets", "hair": "edges"}[self.kind]
            self._mesh = {"mesh": points, key: elements}
        return self._mesh

    def held(self) -> Indices:
        """The pinned vertices by their numbers in the mesh of the scene, ascending."""
        return np.searchsorted(self.used, self.held_vertices())

    def held_vertices(self) -> Indices:
        """The pinned vertices that are simulated, ascending."""
        return np.intersect1d(self.pinned, self.used)


@dataclass
class Obstacle:
    """An object that the others collide with; `frames` are its places, shape (f, n, 3), or (1, n, 3) at rest."""

    name: str
    frames: Floats
    triangles: Indices
    friction: float = 0.3
    #: Whether `frames` are the vertices of the object, rather than those that modifiers made of it.
    same_vertices: bool = True


@dataclass
class Settings:
    """What holds for the whole scene."""

    frames: int
    frame_rate: float
    steps: int = 4
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    preset: str = "fast"
    contact_distance: float = 0.0
    air_density: float = 0.0
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass
class Description:
    """All that a bake computes from."""

    settings: Settings
    bodies: list[Body]
    obstacles: list[Obstacle]

    def fingerprint(self, frames: int) -> str:
        """A hash of all that the result depends on up to a number of frames after the first."""
        own = hashlib.sha256()
        settings = self.settings
        own.update(repr((bowknot.__version__, settings.frame_rate, settings.steps, settings.gravity)).encode())
        own.update(repr((settings.preset, settings.contact_distance, settings.air_density, settings.wind)).encode())
        for body in self.bodies:
            about = (body.name, body.kind, body.material, body.friction, body.thickness, body.self_collision, body.cell)
            own.update(repr(about).encode())
            arrays = (body.start, body.elements, body.pinned, body.led, body.led_frames[: frames + 1])
            for array in (*arrays, body.to_object[: frames + 1]):
                own.update(repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
        for obstacle in self.obstacles:
            own.update(repr((obstacle.name, obstacle.friction)).encode())
            places = obstacle.frames[: frames + 1]
            if (places == places[:1]).all():
                places = places[:1]  # at rest so far, whatever comes later
            for array in (places, obstacle.triangles):
                own.update(np.ascontiguousarray(array).tobytes())
        return own.hexdigest()


def build(description: Description) -> bowknot.Scene:
    """The scene of the package. It has a pin for each held vertex, in the order of the bodies and of `Body.held`: a pin
    goes as one, so that a single vertex that something stops would hold up all others of its pin."""
    settings = description.settings
    if not description.bodies:
        raise Refused("nothing is simulated: select objects and make them Cloth, Solid or Hair")
    contact: dict[str, object] = {"preset": settings.preset}
    finest: dict[str, float] = {}
    if settings.contact_distance > 0.0:
        contact["delta"] = settings.contact_distance
    elif any(body.kind == "hair" for body in description.bodies):
        # The contacts of hair are finer than those of all else: obstacles have those of the finest.
        finest = {body.name: _contact_distance(body) for body in description.bodies}
        contact["delta"] = min(finest.values())
    bodies, pins = [], []
    for body in description.bodies:
        table: dict[str, object] = {"name": body.name, "material": body.material, "friction": body.friction}
        table["kind"] = {"hair": "strands"}.get(body.kind, body.kind)
        if body.thickness > 0.0:
            table["thickness"] = body.thickness
        if not body.self_collision:
            table["self_collision"] = False
        if body.name in finest:
            table["delta"] = finest[body.name]
        bodies.append({**table, **body.mesh()})
        pins.extend({"body": body.name, "vertices": [vertex]} for vertex in body.held().tolist())
    # A pair keeps the mean of both, so that an obstacle without a thickness would halve that of a body.
    thickness = max(body.thickness for body in description.bodies)
    apart = {"thickness": thickness} if thickness > 0.0 else {}
    obstacles = [
        {"name": own.name, "mesh": own.frames[0], "faces": own.triangles, "friction": own.friction, **apart}
        for own in description.obstacles
    ]
    return bowknot.Scene(
        bodies,
        obstacles,
        pins,
        simulation={
            "frames": settings.frames * settings.steps,
            "dt": 1.0 / (settings.frame_rate * settings.steps),
            "gravity": list(settings.gravity),
            "air_density": settings.air_density,
            "wind": list(settings.wind),
        },
        contact=contact,
    )


def _contact_distance(body: Body) -> float:
    """Distance at which contacts of a body begin to press: a tenth of its edges, of hair at most its thickness."""
    corners = body.start[body.elements]
    tenth = 0.1 * float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
    if body.kind != "hair":
        return tenth
    return min([tenth, *(preset.contact for preset in HAIR if preset.material == body.material)])


def intersecting(description: Description, limit: int = 100_000) -> dict[str, Indices]:
    """The vertices of each object whose elements intersect at the start, by the numbers that the object has."""
    points, faces, edges, obstacles, owners = [], [], [], [], []
    count = 0
    for body in description.bodies:
        mesh = body.mesh()
        own = mesh["mesh"]
        if "edges" in mesh:
            edges.append(mesh["edges"] + count)
        else:
            faces.append((mesh["faces"] if "faces" in mesh else tetrahedra.surface(mesh["tets"])) + count)
        numbers = np.full(len(own), -1)
        numbers[: len(body.used)] = body.used
        owners.append((body.name, count, numbers))
        points.append(own)
        obstacles.append(np.zeros(len(own), bool))
        count += len(own)
    for obstacle in description.obstacles:
        own = obstacle.frames[0]
        faces.append(obstacle.triangles + count)
        numbers = np.arange(len(own)) if obstacle.same_vertices else np.full(len(own), -1)
        owners.append((obstacle.name, count, numbers))
        points.append(own)
        obstacles.append(np.ones(len(own), bool))
        count += len(own)
    bodies = np.concatenate([np.full(len(own), number) for number, own in enumerate(points)])
    report = bowknot.check(
        np.concatenate(points),
        np.concatenate(faces) if faces else None,
        np.concatenate(edges) if edges else None,
        bodies=bodies,
        obstacles=np.concatenate(obstacles),
        limit=limit,
        distance=False,
    )
    hit = np.zeros(count, bool)
    for pair in report.intersections:
        for side in pair["vertices"]:
            hit[side] = True
    places = {}
    for name, first, numbers in owners:
        own = numbers[hit[first : first + len(numbers)]]
        if len(own) > 0:
            places[name] = own[own >= 0]
    return places
