# SPDX-License-Identifier: GPL-3.0-or-later
"""The motion on the objects: a Mesh Cache modifier, shape keys, or for hair curves a modifier of nodes."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

from . import stack
from .core import pc2
from .core.scene import Refused

#: The name of the modifier, and what names of shape keys begin with.
NAME = "Bowknot"


def check(obj: bpy.types.Object, kind: str) -> None:
    """Refuses an object that cannot have a result of this kind."""
    if kind != "KEYS":
        return
    if obj.type != "MESH":
        raise Refused(
            f"{obj.name}: hair curves cannot have shape keys: set Result to Mesh Cache, or convert them to a mesh"
        )
    keys = obj.data.shape_keys
    if keys is not None and any(not _is_ours(key) for key in keys.key_blocks[1:]):
        raise Refused(f"{obj.name}: it has shape keys of its own: set Result to Mesh Cache")


def attach(obj: bpy.types.Object, cache: Path, first: int, kind: str) -> None:
    """Gives an object the motion of a cache that begins with frame `first`."""
    detach(obj)
    if kind == "KEYS":
        _attach_keys(obj, cache, first)
        _keep_diagonals(obj, stack.leading(obj))
    elif obj.type == "CURVES":
        _attach_nodes(obj, cache, first)
    else:
        place = stack.leading(obj)
        _attach_cache(obj, cache, first, place)
        _keep_diagonals(obj, place + 1)


def detach(obj: bpy.types.Object) -> None:
    """Takes the motion away; the object is as it was before the bake."""
    for modifier in [modifier for modifier in obj.modifiers if modifier.name.startswith(NAME)]:
        if modifier.type == "NODES":
            _remove_companion(modifier)
        if modifier.type in ("MESH_CACHE", "NODES", "TRIANGULATE"):
            obj.modifiers.remove(modifier)
    if obj.type == "MESH" and obj.data.shape_keys is not None:
        _detach_keys(obj)
    for line in obj.bowknot.muted.splitlines():
        if line[2:] in obj.modifiers:
            modifier = obj.modifiers[line[2:]]
            modifier.show_viewport, modifier.show_render = line[0] == "1", line[1] == "1"
    obj.bowknot.muted = ""


def _attach_cache(obj: bpy.types.Object, cache: Path, first: int, place: int) -> None:
    modifier = obj.modifiers.new(NAME, "MESH_CACHE")
    obj.modifiers.move(len(obj.modifiers) - 1, place)
    path = str(cache)
    if bpy.data.filepath:
        try:
            path = bpy.path.relpath(path)
        except ValueError:
            pass  # On another drive.
    modifier.cache_format = "PC2"
    modifier.filepath = path
    modifier.frame_start = first
    modifier.interpolation = "LINEAR"
    modifier.forward_axis, modifier.up_axis = "POS_Y", "POS_Z"


def _keep_diagonals(obj: bpy.types.Object, place: int) -> None:
    """Shows the quads of a cloth cut as they were simulated. Blender would cut those that fold along their other diagonal,
    through what lies near. Not ahead of a subdivision, which quads are made for."""
    if obj.bowknot.role != "CLOTH" or any(m.type in ("SUBSURF", "MULTIRES") for m in obj.modifiers):
        return
    mesh = obj.data
    mesh.calc_loop_triangles()
    cut = {tuple(triangle.loops) for triangle in mesh.loop_triangles}
    starts = [polygon.loop_start for polygon in mesh.polygons if polygon.loop_total == 4]
    if starts and all((start, start + 1, start + 2) in cut for start in starts):
        modifier = obj.modifiers.new(f"{NAME} Quads", "TRIANGULATE")
        obj.modifiers.move(len(obj.modifiers) - 1, place)
        modifier.quad_method = "FIXED"  # from the first corner to the third


def _is_ours(key: bpy.types.ShapeKey) -> bool:
    return key.name.startswith(f"{NAME} ")


def _attach_keys(obj: bpy.types.Object, cache: Path, first: int) -> None:
    samples = pc2.read(cache)
    muted = []
    for modifier in obj.modifiers[: stack.leading(obj)]:
        if modifier.show_viewport or modifier.show_render:
            muted.append(f"{modifier.show_viewport:d}{modifier.show_render:d}{modifier.name}")
            # Shape keys come before modifiers, which would move the result again.
            modifier.show_viewport = modifier.show_render = False
    obj.bowknot.muted = "\n".join(muted)
    if obj.data.shape_keys is None:
        obj.shape_key_add(name="Basis", from_mix=False)
    for number, sample in enumerate(samples):
        key = obj.shape_key_add(name=f"{NAME} {first + number}", from_mix=False)
        key.data.foreach_set("co", np.ascontiguousarray(sample).ravel())
        # Between two frames both of their keys count, in shares.
        for offset, value in ((-1, 0.0), (0, 1.0), (1, 0.0)):
            if 0 <= number + offset < len(samples):
                key.value = value
                key.keyframe_insert("value", frame=first + number + offset)
    for curve in _curves(obj.data.shape_keys.animation_data):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    del samples  # Windows cannot remove a file that is mapped.


def _detach_keys(obj: bpy.types.Object) -> None:
    keys = obj.data.shape_keys
    own = [key for key in keys.key_blocks if _is_ours(key)]
    if not own:
        return
    paths = {key.path_from_id("value") for key in own}
    for key in own:
        key.driver_remove("value")
    if keys.animation_data is not None and keys.animation_data.action is not None:
        for curves in _collections(keys.animation_data):
            for curve in [curve for curve in curves if curve.data_path in paths]:
                curves.remove(curve)
    for key in own:
        obj.shape_key_remove(key)
    if len(keys.key_blocks) == 1:
        obj.shape_key_remove(keys.key_blocks[0])


def _collections(data: bpy.types.AnimData) -> list:
    """The collections of F-curves of an action: one, or since Blender 4.4 those of its slots."""
    action = data.action
    if not hasattr(action, "layers"):
        return [action.fcurves]
    bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]
    return [bag.fcurves for bag in bags if bag.slot_handle == data.action_slot_handle]


def _curves(data: bpy.types.AnimData) -> list:
    return [curve for curves in _collections(data) for curve in curves]


def _attach_nodes(obj: bpy.types.Object, cache: Path, first: int) -> None:
    # Mesh Cache is for meshes alone: a mesh of the same points plays the cache, and the curves take its positions.
    count = len(obj.data.points)
    mesh = bpy.data.meshes.new(f"{obj.name} {NAME}")
    mesh.from_pydata(np.zeros((count, 3)).tolist(), [], [])
    companion = bpy.data.objects.new(f"{obj.name} {NAME}", mesh)
    _attach_cache(companion, cache, first, 0)
    place = stack.leading(obj)
    modifier = obj.modifiers.new(NAME, "NODES")
    obj.modifiers.move(len(obj.modifiers) - 1, place)
    modifier.node_group = _nodes()
    modifier[_socket(modifier.node_group)] = companion


def _remove_companion(modifier: bpy.types.Modifier) -> None:
    companion = modifier.get(_socket(modifier.node_group)) if modifier.node_group is not None else None
    if companion is not None:
        mesh = companion.data
        bpy.data.objects.remove(companion)
        bpy.data.meshes.remove(mesh)


def _socket(group: bpy.types.NodeTree) -> str:
    return next(
        item.identifier
        for item in group.interface.items_tree
        if item.item_type == "SOCKET" and item.socket_type == "NodeSocketObject"
    )


def _nodes() -> bpy.types.NodeTree:
    """A group of nodes that gives each point the position of the point of another object with the same number."""
    name = f"{NAME} Strands"
    if name in bpy.data.node_groups:
        return bpy.data.node_groups[name]
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Points", in_out="INPUT", socket_type="NodeSocketObject")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    given, made = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    info = group.nodes.new("GeometryNodeObjectInfo")
    sample = group.nodes.new("GeometryNodeSampleIndex")
    sample.data_type, sample.domain = "FLOAT_VECTOR", "POINT"
    put = group.nodes.new("GeometryNodeSetPosition")
    position, index = group.nodes.new("GeometryNodeInputPosition"), group.nodes.new("GeometryNodeInputIndex")
    link = group.links.new
    link(given.outputs["Points"], info.inputs["Object"])
    link(info.outputs["Geometry"], sample.inputs["Geometry"])
    link(position.outputs[0], next(s for s in sample.inputs if s.name == "Value" and s.enabled))
    link(index.outputs[0], sample.inputs["Index"])
    link(given.outputs["Geometry"], put.inputs["Geometry"])
    link(next(s for s in sample.outputs if s.enabled), put.inputs["Position"])
    link(put.outputs["Geometry"], made.inputs["Geometry"])
    for number, node in enumerate((given, info, position, index, sample, put, made)):
        node.location = (200.0 * number, 0.0)
    return group
