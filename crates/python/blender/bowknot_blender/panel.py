# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab Bowknot in the sidebar of the 3D view."""

from __future__ import annotations

import textwrap

import bpy

from . import bake


class _Tab:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Bowknot"


class BOWKNOT_PT_object(_Tab, bpy.types.Panel):
    """What the active object is"""

    bl_idname = "BOWKNOT_PT_object"
    bl_label = "Object"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        grid = layout.grid_flow(columns=2, even_columns=True, align=True)
        for role, label in (("CLOTH", "Cloth"), ("SOLID", "Solid"), ("HAIR", "Hair"), ("OBSTACLE", "Obstacle")):
            grid.operator("bowknot.assign", text=label).role = role
        layout.operator("bowknot.assign", text="None").role = "NONE"
        obj = context.object
        if obj is None or obj.bowknot.role == "NONE":
            return
        own = obj.bowknot
        layout.label(text=f"{obj.name}: {own.role.title()}")
        if own.role != "OBSTACLE":
            layout.prop(own, own.role.lower())
        layout.prop(own, "friction")
        if own.role == "OBSTACLE":
            return
        layout.prop(own, "thickness")
        layout.prop(own, "self_collision")
        if own.role == "SOLID":
            layout.prop(own, "cell")
        if own.role == "HAIR":
            layout.prop(own, "roots_on_skin")
        if obj.type == "MESH":
            layout.prop_search(own, "pins", obj, "vertex_groups")
        layout.prop(own, "pin_to")


class BOWKNOT_PT_bake(_Tab, bpy.types.Panel):
    """How the scene is baked"""

    bl_idname = "BOWKNOT_PT_bake"
    bl_label = "Bake"

    def draw(self, context: bpy.types.Context) -> None:
        layout, own = self.layout, context.scene.bowknot
        layout.use_property_split = True
        current = bake.running
        settings = layout.column()
        settings.enabled = current is None
        for name in ("steps", "quality", "result", "folder", "contact_distance", "air"):
            settings.prop(own, name)
        if own.air:
            settings.prop(own, "wind")
        if current is not None:
            layout.progress(factor=current.progress, text=f"{current.what}: {100 * current.progress:.0f} %")
            layout.operator("bowknot.cancel")
            return
        row = layout.row(align=True)
        row.operator("bowknot.bake")
        row.operator("bowknot.resume")
        row.operator("bowknot.free")
        for line in textwrap.wrap(own.message, 42):
            layout.label(text=line)


_CLASSES = (BOWKNOT_PT_object, BOWKNOT_PT_bake)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
