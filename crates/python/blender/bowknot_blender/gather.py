# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of a scene as plain arrays in meters, frame by frame. It runs on Blender's main thread."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np
from numpy.typing import NDArray

from . import sewing, stack
from .core.scene import Body, Description, Obstacle, Refused, Settings

#: Density of air at room temperature [kg/m^3].
_AIR = 1.2

Floats = NDArray[np.float64]


def members(scene: bpy.types.Scene) -> tuple[list[bpy.types.Object], list[bpy.types.Object]]:
    """The objects that are simulated and the obstacles, each by name.

    Raises
    ------
    Refused
        Nothing is simulated, or an object cannot be what its role says.
    """
    found = sorted((obj for obj in scene.objects if obj.bowknot.role != "NONE"), key=lambda obj: obj.name)
    bodies = [obj for obj in found if obj.bowknot.role != "OBSTACLE"]
    if not bodies:
        raise Refused("nothing is simulated: select objects and press Cloth, Solid or Hair")
    for obj in found:
        role = obj.bowknot.role
        if not obj.visible_get():
            # Blender evaluates nothing of it: it would be simulated without its modifiers and animation.
            raise Refused(f"{obj.name}: it is hidden, or its collection is: show it, or set its role to None")
        types = {"HAIR": {"MESH", "CURVES"}}.get(role, {"MESH"})
        if obj.type not in types:
            remedy = "Object > Convert > " + ("Hair Curves" if role == "HAIR" else "Mesh")
            raise Refused(f"{obj.name}: a {obj.type.lower()} cannot be {role.lower()}: {remedy}")
    shared: dict[bpy.types.ID, str] = {}
    for obj in bodies:
        if obj.data in shared:
            raise Refused(
                f"{obj.name} and {shared[obj.data]} share their data: Object > Relations > Make Single User > Object & Data"
            )
        shared[obj.data] = obj.name
        stack.leading(obj)
    return bodies, [obj for obj in found if obj.bowknot.role == "OBSTACLE"]


class Gathering:
    """Visits the frames of a scene and makes a description of it.

    `frames` is an iterator that goes to one frame each time it is asked; when it is done, `description` is there.
    """

    def __init__(self, context: bpy.types.Context) -> None:
        self._context = context
        self._scene = context.scene
        self._unit = self._scene.unit_settings.scale_length
        self.bodies, self.obstacles = members(self._scene)
        self.first, self.last = self._scene.frame_start, self._scene.frame_end
        if self.last <= self.first:
            raise Refused(f"the frame range is {self.first} to {self.last}: it needs two frames at least")
        self.description: Description | None = None

    def frames(self) -> Iterator[int]:
        """Goes through the frames; puts modifiers and the current frame back at the end, also of a failure."""
        back = self._scene.frame_current, self._scene.frame_subframe
        try:
            with stack.only_leading(self.bodies):
                bodies, obstacles = [], []
                for frame in range(self.first, self.last + 1):
                    self._scene.frame_set(frame)
                    graph = self._context.evaluated_depsgraph_get()
                    if frame == self.first:
                        bodies = [_BodyTrack(obj, graph, self._unit) for obj in self.bodies]
                        obstacles = [_ObstacleTrack(obj, graph, self._unit) for obj in self.obstacles]
                    else:
                        for track in (*bodies, *obstacles):
                            track.add(graph, frame)
                    yield frame
        finally:
            self._scene.frame_set(back[0], subframe=back[1])
        known = {track.obj.name: track for track in obstacles}
        self.description = Description(
            settings=_settings(self._scene, self.last - self.first),
            bodies=[track.finish(known) for track in bodies],
            obstacles=[track.finish() for track in obstacles],
        )


def _settings(scene: bpy.types.Scene, frames: int) -> Settings:
    own = scene.bowknot
    return Settings(
        frames=frames,
        frame_rate=scene.render.fps / scene.render.fps_base,
        steps=own.steps,
        gravity=tuple(map(float, scene.gravity)) if scene.use_gravity else (0.0, 0.0, 0.0),
        preset=own.quality,
        contact_distance=float(own.contact_distance),
        air_density=_AIR if own.air else 0.0,
        wind=tuple(map(float, own.wind)),
    )


def _matrix(obj: bpy.types.Object, unit: float) -> Floats:
    """From the space of an object to the world in meters."""
    matrix = np.array(obj.matrix_world, np.float64)
    matrix[:3] *= unit
    if abs(np.linalg.det(matrix[:3, :3])) < 1e-18 * unit**3:
        raise Refused(f"{obj.name}: its scale is 0 along an axis; give it one")
    return matrix


def _moved(matrix: Floats, points: Floats) -> Floats:
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def _coordinates(items: bpy.types.bpy_prop_collection, name: str) -> Floats:
    flat = np.empty(3 * len(items), np.float32)
    items.foreach_get(name, flat)
    return flat.reshape(-1, 3).astype(np.float64)


def _integers(items: bpy.types.bpy_prop_collection, name: str, width: int) -> NDArray[np.int64]:
    flat = np.empty(width * len(items), np.int32)
    items.foreach_get(name, flat)
    return flat.reshape(-1, width).astype(np.int64)


def _triangles(mesh: bpy.types.Mesh) -> NDArray[np.int64]:
    mesh.calc_loop_triangles()
    return _integers(mesh.loop_triangles, "vertices", 3)


class _BodyTrack:
    """A simulated object: its animated vertices in each frame that was visited."""

    def __init__(self, obj: bpy.types.Object, graph: bpy.types.Depsgraph, unit: float) -> None:
        self.obj = obj
        self._unit = unit
        self._count = len(obj.data.vertices) if obj.type == "MESH" else len(obj.data.points)
        places, matrix = self._evaluated(graph)
        self._start, self._matrices = places, [matrix]
        self._elements, self._strands = self._structure()
        self._pinned = self._pins()
        used = np.unique(self._elements)
        unused = np.setdiff1d(np.arange(self._count), used)
        self._led = np.union1d(self._pinned, unused)
        self._frames = [places[self._led]]

    def add(self, graph: bpy.types.Depsgraph, frame: int) -> None:
        """Adds the places in another frame."""
        places, matrix = self._evaluated(graph)
        self._frames.append(places[self._led])
        self._matrices.append(matrix)

    def finish(self, obstacles: dict[str, _ObstacleTrack]) -> Body:
        """The body of all frames."""
        own = self.obj.bowknot
        role = own.role.lower()
        frames = np.array(self._frames)
        if own.pin_to is not None and len(self._led) > 0:
            if own.pin_to.name not in obstacles:
                raise Refused(
                    f"{self.obj.name}: its pins follow {own.pin_to.name}, which is no obstacle: make it one, or clear Pin to"
                )
            surface = obstacles[own.pin_to.name]
            frames = sewing.carried(self._start[self._led], surface.frames, surface.triangles)
        return Body(
            name=self.obj.name,
            kind=role,
            start=self._start,
            elements=self._elements,
            material=getattr(own, role),
            friction=float(own.friction),
            thickness=float(own.thickness),
            self_collision=own.self_collision,
            pinned=self._pinned,
            led=self._led,
            led_frames=frames,
            cell=float(own.cell),
            to_object=np.linalg.inv(np.array(self._matrices)),
        )

    def _evaluated(self, graph: bpy.types.Depsgraph) -> tuple[Floats, Floats]:
        found = self.obj.evaluated_get(graph)
        matrix = _matrix(found, self._unit)
        if self.obj.type == "CURVES":
            places = _coordinates(found.data.points, "position")
        else:
            mesh = found.to_mesh()
            places = _coordinates(mesh.vertices, "co")
            found.to_mesh_clear()
        if len(places) != self._count:
            raise Refused(
                f"{self.obj.name}: its modifiers make {len(places)} vertices of {self._count}: apply or switch off those "
                "that add or remove points"
            )
        return _moved(matrix, places), matrix

    def _structure(self) -> tuple[NDArray[np.int64], list[NDArray[np.int64]]]:
        """The elements, and of hair the strands, from their roots on."""
        obj, role = self.obj, self.obj.bowknot.role
        if role == "HAIR":
            strands = _curves(obj) if obj.type == "CURVES" else _chains(obj)
            if obj.bowknot.roots_on_skin:
                strands = [strand[1:] for strand in strands]
            short = sum(len(strand) < 3 for strand in strands)
            if short > 0:
                least = 4 if obj.bowknot.roots_on_skin else 3
                raise Refused(
                    f"{obj.name}: {short} of {len(strands)} strands have fewer than {least} points: subdivide or resample them"
                )
            edges = [np.column_stack([strand[:-1], strand[1:]]) for strand in strands]
            return np.concatenate(edges), strands
        triangles = _triangles(obj.data)
        if len(triangles) == 0:
            raise Refused(f"{obj.name}: it has no faces; a {role.lower()} needs them")
        loose = np.zeros(len(obj.data.edges), bool)
        obj.data.edges.foreach_get("is_loose", loose)
        if loose.any():
            raise Refused(
                f"{obj.name}: {loose.sum()} edges belong to no face, and sewing is not simulated: merge what they join, or "
                "Mesh > Clean Up > Delete Loose"
            )
        return triangles, []

    def _pins(self) -> NDArray[np.int64]:
        obj, own = self.obj, self.obj.bowknot
        if own.pins:
            group = obj.vertex_groups.get(own.pins) if obj.type == "MESH" else None
            if group is None:
                raise Refused(f"{obj.name}: there is no vertex group {own.pins}; choose another one for Pins")
            weights = np.zeros(self._count)
            for vertex in obj.data.vertices:
                for entry in vertex.groups:
                    if entry.group == group.index:
                        weights[vertex.index] = entry.weight
            pinned = np.flatnonzero(weights >= 0.5)
            if len(pinned) == 0:
                raise Refused(f"{obj.name}: the vertex group {own.pins} has no vertex with a weight of 0.5 or more")
            return pinned
        return (
            np.sort(np.concatenate([strand[:2] for strand in self._strands]))
            if self._strands
            else np.zeros(0, np.int64)
        )


class _ObstacleTrack:
    """An obstacle: its evaluated surface in each frame that was visited."""

    def __init__(self, obj: bpy.types.Object, graph: bpy.types.Depsgraph, unit: float) -> None:
        self.obj = obj
        self._unit = unit
        places, self.triangles = self._evaluated(graph)
        if len(self.triangles) == 0:
            raise Refused(f"{obj.name}: it has no faces; an obstacle needs them")
        self.frames = [places]

    def add(self, graph: bpy.types.Depsgraph, frame: int) -> None:
        """Adds the places in another frame."""
        places, triangles = self._evaluated(graph)
        if not np.array_equal(triangles, self.triangles):
            raise Refused(
                f"{self.obj.name}: its faces in frame {frame} are not those of the frames before: modifiers of an obstacle "
                "must keep its faces"
            )
        self.frames.append(places)

    def finish(self) -> Obstacle:
        """The obstacle of all frames."""
        frames = np.array(self.frames)
        if (frames == frames[:1]).all():
            frames = frames[:1]
        return Obstacle(
            name=self.obj.name,
            frames=frames,
            triangles=self.triangles,
            friction=float(self.obj.bowknot.friction),
            same_vertices=frames.shape[1] == len(self.obj.data.vertices),
        )

    def _evaluated(self, graph: bpy.types.Depsgraph) -> tuple[Floats, NDArray[np.int64]]:
        found = self.obj.evaluated_get(graph)
        matrix = _matrix(found, self._unit)
        mesh = found.to_mesh()
        places, triangles = _coordinates(mesh.vertices, "co"), self._faces(mesh, matrix)
        found.to_mesh_clear()
        return _moved(matrix, places), triangles

    def _faces(self, mesh: bpy.types.Mesh, matrix: Floats) -> NDArray[np.int64]:
        # The diagonals of a quad that bends may change with its shape, so those of the first frame stay.
        if hasattr(self, "_loops") and np.array_equal(_integers(mesh.loops, "vertex_index", 1), self._loops):
            return self.triangles
        self._loops = _integers(mesh.loops, "vertex_index", 1)
        triangles = _triangles(mesh)
        # A mirrored object has its outside within.
        return triangles[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0.0 else triangles


def _curves(obj: bpy.types.Object) -> list[NDArray[np.int64]]:
    """The points of each hair curve, from the root on."""
    firsts = _integers(obj.data.curves, "first_point_index", 1)[:, 0]
    counts = _integers(obj.data.curves, "points_length", 1)[:, 0]
    return [np.arange(first, first + count) for first, count in zip(firsts, counts)]


def _chains(obj: bpy.types.Object) -> list[NDArray[np.int64]]:
    """The vertices of each chain of edges, from the end with the lowest index on."""
    mesh = obj.data
    if len(mesh.polygons) > 0:
        raise Refused(
            f"{obj.name}: hair is a mesh of edges alone, and this one has faces: delete Only Faces, or make it Cloth"
        )
    edges = _integers(mesh.edges, "vertices", 2)
    if len(edges) == 0:
        raise Refused(f"{obj.name}: it has no edges; hair needs them")
    neighbors: dict[int, list[int]] = {}
    for a, b in edges.tolist():
        neighbors.setdefault(a, []).append(b)
        neighbors.setdefault(b, []).append(a)
    forked = [vertex for vertex, others in neighbors.items() if len(others) > 2]
    if forked:
        raise Refused(f"{obj.name}: {len(forked)} vertices join more than two edges: strands must not fork")
    strands, seen = [], set()
    for vertex in sorted(v for v, others in neighbors.items() if len(others) == 1):
        if vertex in seen:
            continue
        strand, last = [vertex], -1
        while True:
            onward = [other for other in neighbors[strand[-1]] if other != last]
            if not onward:
                break
            last = strand[-1]
            strand.append(onward[0])
        seen.update(strand)
        strands.append(np.array(strand))
    if len(seen) < len(neighbors):
        raise Refused(f"{obj.name}: some strands are closed loops: open them")
    return strands
