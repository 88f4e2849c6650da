# SPDX-License-Identifier: GPL-3.0-or-later
"""Bowknot in Blender: selected objects become cloth, soft solids, hair or obstacles, and a bake makes their motion."""

from . import bake, operators, panel, properties


def register() -> None:
    properties.register()
    operators.register()
    panel.register()
    bake.register()


def unregister() -> None:
    bake.unregister()
    panel.unregister()
    operators.unregister()
    properties.unregister()
