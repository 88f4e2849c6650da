# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender without a window, with the extension installed from its zip as users do, for each test an empty file in a
folder of its own. The variable BOWKNOT_BLENDER_ZIP has the path of the zip."""

import os
import tempfile

_RESOURCES = tempfile.TemporaryDirectory(prefix="bowknot-blender-")
# Before Blender starts, so that it leaves the extensions of whoever runs this alone.
os.environ["BLENDER_USER_RESOURCES"] = _RESOURCES.name

import bpy  # noqa: E402, I001
import addon_utils  # noqa: E402, there once Blender is
import numpy as np  # noqa: E402
import pytest  # noqa: E402

bpy.ops.wm.read_factory_settings(use_empty=True)
addon_utils.enable("bl_pkg")
bpy.ops.extensions.package_install_files(
    filepath=os.environ["BOWKNOT_BLENDER_ZIP"], repo="user_default", enable_on_install=True
)


@pytest.fixture(scope="session", autouse=True)
def extension():
    yield
    # Blender's module crashes at its end if properties of Python are left.
    addon_utils.disable("bl_ext.user_default.bowknot")
    _RESOURCES.cleanup()


@pytest.fixture
def empty():
    """Makes an empty file."""

    def make():
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.context.scene.frame_end = 20
        return bpy.context.scene

    return make


@pytest.fixture
def scene(tmp_path, empty):
    """The scene of an empty file that is saved."""
    made = empty()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "test.blend"))
    return made


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
    from bl_ext.user_default.bowknot import bake

    return {path.name: path.read_bytes() for path in sorted(bake.folder(scene).glob("*.pc2"))}
