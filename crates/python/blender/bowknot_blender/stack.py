# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifiers of what is simulated: which lead it, which come after it, and which must not be there."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from .core.scene import Refused

#: Modifiers that move vertices and keep their number.
_DEFORM = {
    "ARMATURE", "CAST", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM", "LATTICE", "MESH_CACHE", "MESH_DEFORM",
    "MESH_SEQUENCE_CACHE", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "CORRECTIVE_SMOOTH", "LAPLACIANSMOOTH",
    "SURFACE_DEFORM", "WARP", "WAVE", "DATA_TRANSFER", "UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY", "COLLISION", "SURFACE", "PARTICLE_SYSTEM",
}  # fmt: skip

#: Those that would move the result again if they stood after it.
_LEADING = {"ARMATURE", "CURVE", "HOOK", "LATTICE", "MESH_DEFORM", "SURFACE_DEFORM"}

#: Those whose faces must be simulated, and are not while the modifier makes them.
_REFUSED = {
    "ARRAY", "BOOLEAN", "BUILD", "CLOTH", "DECIMATE", "EXPLODE", "FLUID", "MASK", "MIRROR", "OCEAN",
    "PARTICLE_INSTANCE", "REMESH", "SCREW", "SKIN", "SOFT_BODY", "VOLUME_TO_MESH", "WELD", "WIREFRAME",
}  # fmt: skip


def leading(obj: bpy.types.Object) -> int:
    """How many modifiers at the top of the stack lead the simulated mesh; the result goes after them.

    Raises
    ------
    Refused
        Modifiers after them that make what should be simulated, or would deform the result once more.
    """
    count = 0
    while count < len(obj.modifiers) and _moves_only(obj.modifiers[count]):
        count += 1
    if obj.type != "MESH":
        return count
    for modifier in obj.modifiers[count:]:
        if not modifier.show_viewport:
            continue
        if modifier.type in _REFUSED:
            raise Refused(
                f"{obj.name}: the modifier {modifier.name} changes what is simulated: apply it, or switch it off"
            )
        if modifier.type in _LEADING:
            first = obj.modifiers[count].name
            raise Refused(
                f"{obj.name}: the modifier {modifier.name} would deform the result again: move it above {first}"
            )
    return count


def _moves_only(modifier: bpy.types.Modifier) -> bool:
    if modifier.type == "NODES" and modifier.node_group is not None:
        # What Blender adds to hair that grows on a surface.
        return modifier.node_group.name.startswith(("Surface Deform", "Deform Curves on Surface"))
    return modifier.type in _DEFORM


@contextmanager
def only_leading(objects: list[bpy.types.Object]) -> Iterator[None]:
    """Switches off all modifiers but the leading ones meanwhile."""
    muted = []
    try:
        for obj in objects:
            for modifier in obj.modifiers[leading(obj) :]:
                if modifier.show_viewport:
                    modifier.show_viewport = False
                    muted.append(modifier)
        yield
    finally:
        for modifier in muted:
            modifier.show_viewport = True
