# SPDX-License-Identifier: GPL-3.0-or-later
"""What the artist sets: on each object what it is made of, on the scene how it is baked."""

from __future__ import annotations

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from .core import presets

ROLES = (
    ("NONE", "None", "Not part of the simulation"),
    ("CLOTH", "Cloth", "A surface of faces that folds: clothes, sheets, flags"),
    ("SOLID", "Solid", "A soft body: a mesh with a closed surface"),
    ("HAIR", "Hair", "Strands: hair curves, or a mesh of edges without faces"),
    ("OBSTACLE", "Obstacle", "What the others collide with; it moves as it is animated, with all its modifiers"),
)


def _items(found: tuple[presets.Preset, ...]) -> list[tuple[str, str, str]]:
    return [(preset.material, preset.label, preset.description) for preset in found]


def _other_mesh(self: bpy.types.PropertyGroup, other: bpy.types.Object) -> bool:
    return other.type == "MESH" and other != self.id_data


class BowknotObject(bpy.types.PropertyGroup):
    """What an object is in the simulation."""

    role: EnumProperty(name="Role", description="What the object is in the simulation", items=ROLES, default="NONE")
    cloth: EnumProperty(name="Fabric", description="The fabric it is made of", items=_items(presets.CLOTH))
    solid: EnumProperty(
        name="Material", description="The material it is made of", items=_items(presets.SOLID), default="silicone"
    )
    hair: EnumProperty(name="Material", description="What its strands are", items=_items(presets.HAIR))
    friction: FloatProperty(
        name="Friction",
        description="Friction with others: a contact has the geometric mean of both sides, so it takes both to rub",
        default=0.3,
        min=0.0,
        soft_max=1.0,
    )
    thickness: FloatProperty(
        name="Thickness",
        description="Smallest gap that it keeps, in meters: to obstacles at least this, to other bodies the mean of both. "
        "With a Subdivision Surface, a quarter of an edge keeps sharp edges below from showing through",
        default=0.0,
        min=0.0,
        soft_max=0.02,
        precision=4,
        step=0.01,
    )
    self_collision: BoolProperty(name="Self Collision", description="It collides with itself", default=True)
    pins: StringProperty(
        name="Pins",
        description="Vertex group whose vertices (weight 0.5 or more) are not simulated: they go where modifiers and "
        "animation take them",
    )
    pin_to: PointerProperty(
        name="Pin to",
        description="Object that the pinned vertices follow, as if sewn to its surface. Empty: they follow the "
        "animation of their own object",
        type=bpy.types.Object,
        poll=_other_mesh,
    )
    roots_on_skin: BoolProperty(
        name="Roots on Skin",
        description="The strands begin on, or in, a surface: their first segments are not simulated, but follow the "
        "animation. Off: whole strands are simulated, which then must begin clear of everything",
        default=True,
    )
    cell: FloatProperty(
        name="Cell",
        description="Edge length of the tetrahedra inside, in meters. It is at least that of the surface, which 0 stands for",
        default=0.0,
        min=0.0,
    )
    #: The modifiers that a result of shape keys has switched off, one per line, each after whether viewport and render
    #: showed it.
    muted: StringProperty(options={"HIDDEN"})


class BowknotScene(bpy.types.PropertyGroup):
    """How a scene is baked."""

    steps: IntProperty(
        name="Steps per Frame",
        description="Time steps in each frame. More: livelier motion and fast contacts more accurate; fewer: each takes longer",
        default=4,
        min=1,
        max=64,
    )
    quality: EnumProperty(
        name="Quality",
        description="How accurately each time step is solved. Neither ever intersects",
        items=(("fast", "Full", "For results"), ("quick", "Preview", "To try out: faster, forces less accurate")),
        default="fast",
    )
    contact_distance: FloatProperty(
        name="Contact Distance",
        description="Distance at which contacts begin to press, in meters. 0: a tenth of the mean edge, "
        "for hair about its thickness",
        default=0.0,
        min=0.0,
        soft_max=0.02,
        precision=4,
        step=0.01,
    )
    wind: FloatVectorProperty(
        name="Wind", description="Velocity of the air, in m/s; it needs Air", subtype="VELOCITY", unit="NONE", size=3
    )
    air: BoolProperty(name="Air", description="Cloth and hair feel the drag of the air", default=False)
    result: EnumProperty(
        name="Result",
        description="How objects get their motion",
        items=(
            ("CACHE", "Mesh Cache", "Files beside the .blend file and a Mesh Cache modifier: for any length"),
            ("KEYS", "Shape Keys", "A shape key per frame, in the .blend file: for short clips and export"),
        ),
    )
    folder: StringProperty(
        name="Folder",
        description="Where the caches are. // is the folder of the .blend file",
        default="//bowknot",
        subtype="DIR_PATH",
    )
    message: StringProperty(options={"HIDDEN"})


_CLASSES = (BowknotObject, BowknotScene)


def register() -> None:
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.bowknot = PointerProperty(type=BowknotObject)
    bpy.types.Scene.bowknot = PointerProperty(type=BowknotScene)


def unregister() -> None:
    del bpy.types.Scene.bowknot
    del bpy.types.Object.bowknot
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
