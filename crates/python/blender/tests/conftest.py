# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender without a window, with the extension, for each test an empty file in a folder of its own."""

import sys
from pathlib import Path

import bpy
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import bowknot_blender  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def extension():
    bowknot_blender.register()
    yield
    bowknot_blender.unregister()


@pytest.fixture
def scene(tmp_path):
    """The scene of an empty file that is saved."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "test.blend"))
    bpy.context.scene.frame_end = 20
    return bpy.context.scene


def sheet(name="sheet", side=13, size=1.0, **place):
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side - 1, y_subdivisions=side - 1, size=size, **place)
    obj = bpy.context.object
    obj.name = name
    obj.bowknot.role = "CLOTH"
    return obj


def ball(name="ball", radius=0.25, **place):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=radius, **place)
    obj = bpy.context.object
    obj.name = name
    obj.bowknot.role = "OBSTACLE"
    return obj


def world(obj, frame=None):
    """The evaluated vertices or points of an object in the world."""
    if frame is not None:
        bpy.context.scene.frame_set(frame)
    found = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if obj.type == "CURVES":
        places = np.array([point.position for point in found.data.points])
    else:
        places = np.array([vertex.co for vertex in found.to_mesh().vertices])
        found.to_mesh_clear()
    matrix = np.array(found.matrix_world)
    return places @ matrix[:3, :3].T + matrix[:3, 3]


def faces(obj):
    found = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = found.to_mesh()
    mesh.calc_loop_triangles()
    triangles = np.array([triangle.vertices for triangle in mesh.loop_triangles])
    found.to_mesh_clear()
    return triangles


def group(obj, name, vertices):
    obj.vertex_groups.new(name=name).add([int(v) for v in vertices], 1.0, "REPLACE")
    obj.bowknot.pins = name


def caches(scene):
    """The bytes of the caches of a scene, by file."""
    from bowknot_blender import bake

    return {path.name: path.read_bytes() for path in sorted(bake.folder(scene).glob("*.pc2"))}
