# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows where objects intersect: selects the vertices, in edit mode."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray


def show(context: bpy.types.Context, places: dict[str, NDArray[np.int64]]) -> None:
    """Selects vertices of objects, and nothing else, and goes to edit mode with them."""
    found = [(context.scene.objects[name], own) for name, own in places.items() if name in context.scene.objects]
    found = [(obj, own) for obj, own in found if len(own) > 0 and obj.visible_get()]
    if not found:
        return
    if context.object is not None and context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for obj in context.selected_objects:
        obj.select_set(False)
    for obj, own in found:
        if obj.type == "MESH":
            _select_mesh(obj.data, own)
        else:
            _select_curves(obj.data, own)
    # Edit mode is for one type at a time: for meshes, if there are any.
    meshes = [obj for obj, _ in found if obj.type == "MESH"]
    shown = meshes or [obj for obj, _ in found]
    for obj in shown:
        obj.select_set(True)
    context.view_layer.objects.active = shown[0]
    if meshes:
        context.tool_settings.mesh_select_mode = (True, False, False)
    bpy.ops.object.mode_set(mode="EDIT")


def _select_mesh(mesh: bpy.types.Mesh, own: NDArray[np.int64]) -> None:
    chosen = np.zeros(len(mesh.vertices), bool)
    chosen[own] = True
    mesh.vertices.foreach_set("select", chosen)
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    mesh.edges.foreach_set("select", chosen[edges.reshape(-1, 2)].all(axis=1))
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    starts = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    if len(starts) > 0:
        mesh.polygons.foreach_set("select", np.logical_and.reduceat(chosen[corners], starts))
    mesh.update()


def _select_curves(curves: bpy.types.ID, own: NDArray[np.int64]) -> None:
    name = ".selection"
    if name in curves.attributes:
        curves.attributes.remove(curves.attributes[name])
    attribute = curves.attributes.new(name, "BOOLEAN", "POINT")
    chosen = np.zeros(len(curves.points), bool)
    chosen[own] = True
    attribute.data.foreach_set("value", chosen)
    if hasattr(curves, "selection_domain"):
        curves.selection_domain = "POINT"
