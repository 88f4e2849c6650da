# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes as an artist makes them, in a Blender without a window."""

import os
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from conftest import ball, caches, faces, group, sheet, world

import bowknot
from bl_ext.user_default.bowknot import bake, operators, panel
from bl_ext.user_default.bowknot.core import pc2


def clean(cloth, obstacles, frames):
    """Whether what Blender shows is free of intersections in each frame."""
    for frame in frames:
        parts = [world(cloth, frame)] + [world(other) for other in obstacles]
        offsets = np.cumsum([0] + [len(part) for part in parts])
        triangles = [faces(obj) + offset for obj, offset in zip([cloth, *obstacles], offsets)]
        solid = np.arange(offsets[-1]) >= len(parts[0])
        if not bowknot.check(np.concatenate(parts), np.concatenate(triangles), obstacles=solid, distance=False):
            return False
    return True


def test_the_zip_brings_its_own_package():
    assert os.path.realpath(bowknot.__file__).startswith(os.path.realpath(os.environ["BLENDER_USER_RESOURCES"]))


def test_cloth_on_a_moving_obstacle_is_clean_and_shown_as_baked(scene):
    cloth = sheet(location=(0, 0, 0.6), rotation=(0, 0, 0.3))
    obstacle = ball(location=(0, 0, 0.3))
    obstacle.keyframe_insert("location", frame=1)
    obstacle.location.x = 0.3
    obstacle.keyframe_insert("location", frame=20)
    assert bpy.ops.bowknot.bake() == {"FINISHED"}
    samples = pc2.read(bake.folder(scene) / "sheet.pc2")
    assert samples.shape == (20, 169, 3)
    matrix = np.array(cloth.matrix_world)
    for frame in (1, 7, 20):
        expected = samples[frame - 1] @ matrix[:3, :3].T + matrix[:3, 3]
        assert np.abs(world(cloth, frame) - expected).max() < 1e-5
    assert np.abs(world(cloth, 1)[:, 2] - 0.6).max() < 1e-6
    end = world(cloth, 20)
    assert end[:, 2].min() < 0.3 and 0.53 < end[:, 2].max() < 0.6  # it lies on the ball
    assert clean(cloth, [obstacle], range(1, 21))


def test_pins_follow_their_vertices_and_nothing_else_does(scene):
    cloth = sheet()
    cloth.location.z = 1.0
    cloth.keyframe_insert("location", frame=1)
    cloth.location.x = 0.5
    cloth.keyframe_insert("location", frame=20)
    before = world(cloth, 1)
    row = np.flatnonzero(before[:, 1] > 0.499)
    group(cloth, "waist", row)
    led = {frame: world(cloth, frame)[row] for frame in (5, 12, 20)}
    bpy.ops.bowknot.bake()
    for frame, places in led.items():
        assert np.abs(world(cloth, frame)[row] - places).max() < 2e-5
    free = np.setdiff1d(np.arange(len(before)), row)
    lowest = [world(cloth, frame)[free, 2].min() for frame in range(1, 21)]
    assert min(lowest) < 0.05, lowest  # the sheet, 1 m long, swings about the row


def test_a_scene_in_centimeters_falls_as_one_in_meters(empty):
    falls = []
    for unit in (1.0, 0.01):
        scene = empty()
        scene.unit_settings.scale_length = unit
        scene.frame_end = 10
        cloth = sheet(size=1.0 / unit)
        bpy.ops.bowknot.bake()
        falls.append((world(cloth, 1) - world(cloth, 10))[:, 2].mean() * unit)
    time, dt = 9 / 24, 1 / 96
    assert falls[0] == pytest.approx(0.5 * 9.81 * time * (time + dt), rel=1e-4)  # of implicit Euler
    assert falls[1] == pytest.approx(falls[0], rel=1e-5)


def test_an_armature_moves_an_obstacle(scene):
    bpy.ops.object.armature_add(location=(0, 0, 0))
    rig = bpy.context.object
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0, 0, 0.5))
    body = bpy.context.object
    body.bowknot.role = "OBSTACLE"
    body.vertex_groups.new(name="Bone").add(list(range(8)), 1.0, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = rig
    bone = rig.pose.bones["Bone"]
    bone.keyframe_insert("location", frame=1)
    bone.location = (0.0, 0.6, 0.0)  # along the bone, which points up
    bone.keyframe_insert("location", frame=20)
    scene.use_gravity = False
    cloth = sheet(size=0.5, location=(0, 0, 0.75))
    bpy.ops.bowknot.bake()
    end = world(cloth, 20)
    assert world(body)[:, 2].max() == pytest.approx(1.3, abs=1e-5)
    assert np.abs(end[:, :2]).min(axis=1).max() < 0.26 and end[:, 2].min() > 1.29  # pushed up by 0.55 m
    assert clean(cloth, [body], range(1, 21))


def test_an_intersecting_start_selects_the_vertices(scene):
    cloth = sheet(side=11, location=(0, 0, 0.31))
    obstacle = ball(radius=0.3)
    obstacle.location.z = 0.05
    with pytest.raises(
        RuntimeError,
        match=r"start intersects in frame 1: \d+ of sheet, \d+ of ball .vertices, which are selected.. .*move sheet by 0.04",
    ):
        bpy.ops.bowknot.bake()
    assert bpy.context.mode == "EDIT_MESH"
    bpy.ops.object.mode_set(mode="OBJECT")
    chosen = np.array([vertex.select for vertex in cloth.data.vertices])
    places = world(cloth)
    # Those of the squares that the rim of the cap goes through, and no others.
    rim = np.sqrt(0.3**2 - 0.26**2)
    assert chosen.any() and np.abs(np.linalg.norm(places[chosen, :2], axis=1) - rim).max() < 0.15
    assert not chosen[np.linalg.norm(places[:, :2], axis=1) > rim + 0.15].any()
    top = np.array([vertex.select for vertex in obstacle.data.vertices])
    assert top.any() and world(obstacle)[top, 2].min() > 0.2
    assert "sheet" in scene.bowknot.message and len(cloth.modifiers) == 0


@pytest.mark.parametrize("stop", [3, 13])
def test_cancel_and_resume_make_the_bits_of_a_whole_bake(scene, stop):
    sheet(location=(0, 0, 0.6))
    ball(location=(0.1, 0, 0.3))
    bpy.ops.bowknot.bake()
    whole = caches(scene)
    going = bake.begin(bpy.context, resume=False)
    while going.advance():
        if going._job is not None and going._job.done >= stop:
            going.cancel()
    bake.finish(going)
    part = caches(scene)["sheet.pc2"]
    assert len(part) < len(whole["sheet.pc2"]) and "Canceled at frame" in scene.bowknot.message
    # The next day.
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    assert bpy.ops.bowknot.resume() == {"FINISHED"}
    assert caches(bpy.context.scene) == whole


def test_an_undo_ends_a_bake_that_reads_the_animation(scene):
    cloth = sheet(location=(0, 0, 0.6))
    going = bake.begin(bpy.context, resume=False)
    assert going.advance() and not going.waiting
    handlers = bpy.app.handlers
    assert bake.before_undo in handlers.undo_pre and bake.after_undo in handlers.undo_post
    bake.before_undo(scene)
    scene.bowknot.message = ""
    bake.after_undo(scene)
    assert bake.running is None and "undo" in scene.bowknot.message
    assert not cloth.modifiers and scene.frame_current == scene.frame_start
    # A later one leaves it: nothing of Blender is read any more.
    going = bake.begin(bpy.context, resume=False)
    while going.advance() and not going.waiting:
        pass
    bake.before_undo(scene)
    bake.after_undo(scene)
    assert bake.running is going
    bake.stop()
    assert bake.running is None and [m.type for m in cloth.modifiers] == ["MESH_CACHE", "TRIANGULATE"]


def test_the_interface_bakes_in_the_background_and_cancels(scene):
    class Pressed(operators.BOWKNOT_OT_bake.__mro__[1]):
        """Stands for the operator, which Blender alone can make: there are no timers without its window."""

        told = None

        def report(self, kind, message):
            self.told = kind, message

    cloth = sheet(location=(0, 0, 0.6))
    press, tick, other = Pressed(), SimpleNamespace(type="TIMER"), SimpleNamespace(type="MOUSEMOVE")
    quiet = SimpleNamespace(
        event_timer_remove=lambda timer: None, progress_update=lambda x: None, progress_end=lambda: None, windows=[]
    )
    context = SimpleNamespace(window_manager=quiet)
    going = bake.begin(bpy.context, resume=False)
    assert not bpy.ops.bowknot.bake.poll() and bpy.ops.bowknot.cancel.poll()
    seen = set()
    while press.modal(context, other) == {"PASS_THROUGH"} and press.modal(context, tick) == {"PASS_THROUGH"}:
        seen.add((going.what, round(going.progress, 3)))
        if going.what == "Simulating" and going.progress > 0.2:
            bpy.ops.bowknot.cancel()
    assert press.told[0] == {"INFO"} and "Resume goes on from there" in press.told[1]
    assert len([what for what, _ in seen if what == "Simulating"]) > 2
    # Its window is closed.
    bake.begin(bpy.context, resume=False)
    assert press.modal(context, tick) == {"PASS_THROUGH"}
    press.cancel(context)
    assert bake.running is None and scene.bowknot.message == "Ended with its window"
    assert bake.running is None and [m.type for m in cloth.modifiers] == ["MESH_CACHE", "TRIANGULATE"]


def test_another_file_ends_a_bake(scene, empty):
    cloth = sheet(location=(0, 0, 0.6))
    cloth.modifiers.new("Smooth", "SUBSURF")
    going = bake.begin(bpy.context, resume=False)
    while going.advance() and not (going.waiting and going.progress > 0.1):
        pass
    empty()
    assert bake.running is None and not going._job.running
    sheet("other")
    assert bpy.ops.bowknot.bake() == {"FINISHED"}


def test_a_longer_range_resumes_and_a_changed_object_does_not(scene):
    cloth = sheet(location=(0, 0, 0.6))
    obstacle = ball(location=(0.1, 0, 0.3))
    bpy.ops.bowknot.bake()
    whole = caches(scene)
    scene.frame_end = 12
    bpy.ops.bowknot.bake()
    scene.frame_end = 20
    bpy.ops.bowknot.resume()
    assert caches(scene) == whole
    obstacle.location.x += 0.01
    with pytest.raises(RuntimeError, match="not those of the bake that stopped"):
        bpy.ops.bowknot.resume()
    assert caches(scene) == whole and [m.type for m in cloth.modifiers] == ["MESH_CACHE", "TRIANGULATE"]


def test_shape_keys_show_what_the_cache_does(scene):
    scene.frame_end = 8
    cloth = sheet(location=(0, 0, 0.6))
    ball(location=(0, 0, 0.3))
    bpy.ops.bowknot.bake()
    shown = {frame: world(cloth, frame) for frame in (1, 4, 8, 9)}
    scene.bowknot.result = "KEYS"
    bpy.ops.bowknot.bake()
    assert [m.type for m in cloth.modifiers] == ["TRIANGULATE"]
    assert len(cloth.data.shape_keys.key_blocks) == 9
    for frame, places in shown.items():
        assert np.abs(world(cloth, frame) - places).max() < 2e-6
    middle = (world(cloth, 4) + world(cloth, 5)) / 2
    scene.frame_set(4, subframe=0.5)
    assert np.abs(world(cloth) - middle).max() < 2e-6
    bpy.ops.bowknot.free()
    assert cloth.data.shape_keys is None and not bake.folder(scene).exists()


@pytest.mark.parametrize("result", ["CACHE", "KEYS"])
def test_an_armature_of_the_cloth_leads_its_pins_and_does_not_move_the_result_again(scene, result):
    scene.frame_end = 10
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bone = rig.pose.bones["Bone"]
    bone.keyframe_insert("location", frame=1)
    bone.location = (0.2, 0.0, 0.0)
    bone.keyframe_insert("location", frame=10)
    cloth = sheet(location=(0, 0, 1))
    cloth.vertex_groups.new(name="Bone").add(list(range(169)), 1.0, "REPLACE")
    cloth.modifiers.new("Rig", "ARMATURE").object = rig
    cloth.modifiers.new("Smooth", "SUBSURF").levels = 0
    group(cloth, "edge", range(13))
    led = world(cloth, 10)[:13]
    assert np.abs(led - world(cloth, 1)[:13] - [0.2, 0, 0]).max() < 1e-6
    scene.bowknot.result = result
    bpy.ops.bowknot.bake()
    end = world(cloth, 10)
    assert np.abs(end[:13] - led).max() < 2e-6
    matrix = np.array(cloth.matrix_world)[:3, 3]
    assert np.abs(end - pc2.read(bake.folder(scene) / "sheet.pc2")[9] - matrix).max() < 2e-6
    kinds = [(modifier.type, modifier.show_render) for modifier in cloth.modifiers]
    cached = [("ARMATURE", True), ("MESH_CACHE", True), ("SUBSURF", True)]
    assert kinds == (cached if result == "CACHE" else [("ARMATURE", False), ("SUBSURF", True)])
    bpy.ops.bowknot.bake()  # again, with the result in place
    assert np.abs(world(cloth, 10) - end).max() < 1e-7
    bpy.ops.bowknot.free()
    assert [(m.type, m.show_viewport and m.show_render) for m in cloth.modifiers] == [
        ("ARMATURE", True),
        ("SUBSURF", True),
    ]
    cloth.modifiers.move(0, 1)
    with pytest.raises(RuntimeError, match="the modifier Rig would deform the result again: move it above Smooth"):
        bpy.ops.bowknot.bake()


def test_subdivision_comes_after_the_cache_and_mirrors_are_refused(scene):
    scene.frame_end = 4
    cloth = sheet(side=6)
    cloth.modifiers.new("Smooth", "SUBSURF").levels = 2
    bpy.ops.bowknot.bake()
    assert [modifier.type for modifier in cloth.modifiers] == ["MESH_CACHE", "SUBSURF"]
    assert all(modifier.show_viewport for modifier in cloth.modifiers)
    assert len(world(cloth, 4)) > 300 and world(cloth, 4)[:, 2].max() < -0.05
    cloth.modifiers.new("Mirror", "MIRROR")
    with pytest.raises(RuntimeError, match="sheet: the modifier Mirror changes what is simulated: apply it"):
        bpy.ops.bowknot.bake()


def test_quads_that_fold_are_shown_cut_as_they_were_simulated(scene):
    cloth = sheet(side=3)
    drawn = {tuple(sorted(triangle)) for triangle in faces(cloth)}
    scene.frame_end = 2
    bpy.ops.bowknot.bake()
    # A vertex folds over the diagonal of its quad, from 0 to 4: Blender would cut it the other way.
    file = bake.folder(scene) / "sheet.pc2"
    folded = pc2.read(file).astype(np.float64)
    folded[1, 3] = (folded[1, 0] + folded[1, 4] + folded[1, 1]) / 3 + [0.0, 0.0, 0.01]
    writer = pc2.Writer(file, 9)
    for sample in folded:
        writer.add(sample)
    writer.close()
    scene.frame_set(2)
    assert {tuple(sorted(triangle)) for triangle in faces(cloth)} == drawn
    cloth.modifiers["Bowknot Quads"].show_viewport = False
    assert {tuple(sorted(triangle)) for triangle in faces(cloth)} != drawn


def test_a_mirrored_scaled_and_turned_object_keeps_its_place(scene):
    scene.frame_end = 3
    scene.use_gravity = False
    cloth = sheet(location=(0.2, 0.1, 0.5), rotation=(0.5, 0.2, 1.0))
    cloth.scale = (-0.5, 1.2, 0.8)
    before = world(cloth, 1)
    bpy.ops.bowknot.bake()
    assert np.abs(world(cloth, 3) - before).max() < 1e-6


def test_loose_vertices_stay_and_loose_edges_are_refused(scene):
    scene.frame_end = 4
    cloth = sheet(side=6)
    cloth.data.vertices.add(1)
    cloth.data.vertices[36].co = (0.0, 0.0, 2.0)
    bpy.ops.bowknot.bake()
    end = world(cloth, 4)
    assert np.abs(end[36] - [0, 0, 2]).max() < 1e-6 and end[:36, 2].max() < -0.05
    cloth.data.edges.add(1)
    cloth.data.edges[-1].vertices = (0, 36)
    cloth.data.update()
    with pytest.raises(RuntimeError, match="1 edges belong to no face, and sewing is not simulated"):
        bpy.ops.bowknot.bake()


def hair(points):
    curves = bpy.data.hair_curves.new("hair")
    curves.add_curves([len(strand) for strand in points])
    curves.attributes["position"].data.foreach_set("vector", np.concatenate(points).ravel())
    obj = bpy.data.objects.new("hair", curves)
    bpy.context.collection.objects.link(obj)
    obj.bowknot.role = "HAIR"
    return obj


def test_hair_curves_hang_from_their_roots_on_a_head(scene):
    head = ball("head", 0.1)
    directions = np.array([vertex.co.normalized() for vertex in head.data.vertices])
    directions = directions[directions[:, 2] > 0.5]
    reach = np.linspace(0.1, 0.4, 12)
    strands = hair([d * reach[:, None] for d in directions.astype(np.float32)])
    strands.parent = head
    head.keyframe_insert("location", frame=1)
    head.location.x = 0.3
    head.keyframe_insert("location", frame=20)
    roots = np.arange(len(directions)) * 12
    bpy.ops.bowknot.bake()
    start, end = world(strands, 1), world(strands, 20)
    assert np.abs(end[roots] - start[roots] - [0.3, 0, 0]).max() < 1e-5
    lengths = np.linalg.norm(np.diff(end.reshape(-1, 12, 3), axis=1), axis=2)
    assert np.abs(lengths / (reach[1] - reach[0]) - 1).max() < 0.11
    assert end[11::12, 2].mean() < start[11::12, 2].mean() - 0.1
    assert np.linalg.norm(end.reshape(-1, 12, 3)[:, 1:] - [0.3, 0, 0], axis=2).min() > 0.09
    bpy.ops.bowknot.free()
    assert len(strands.modifiers) == 0 and np.abs(world(strands, 1) - start).max() < 1e-6
    assert not [obj for obj in bpy.data.objects if "Bowknot" in obj.name]


def test_hair_that_begins_in_an_obstacle_is_selected(scene):
    ball("head", 0.1)
    points = [np.array([[x, 0, 0.3 - 0.05 * i] for i in range(8)], np.float32) for x in (0.0, 0.5)]
    strands = hair(points)
    with pytest.raises(RuntimeError, match="of hair, .* of head"):
        bpy.ops.bowknot.bake()
    chosen = np.zeros(16, bool)
    strands.data.attributes[".selection"].data.foreach_get("value", chosen)
    # It goes in at z = 0.1 and does not come out: the points at 0.1 and 0.05, perhaps the one above.
    assert chosen[:8].any() and not chosen[8:].any() and not chosen[:3].any()


def test_strands_of_edges_are_hair(scene):
    mesh = bpy.data.meshes.new("rope")
    mesh.from_pydata([(0.05 * i, 0, 1) for i in range(20)], [(i, i + 1) for i in range(19)], [])
    rope = bpy.data.objects.new("rope", mesh)
    bpy.context.collection.objects.link(rope)
    rope.bowknot.role, rope.bowknot.hair, rope.bowknot.roots_on_skin = "HAIR", "yarn", False
    bpy.ops.bowknot.bake()
    assert np.abs(world(rope, 20)[:2] - [[0, 0, 1], [0.05, 0, 1]]).max() < 1e-6
    lowest = [world(rope, frame)[19, 2] for frame in range(1, 21)]
    assert min(lowest) < 0.15, lowest  # 0.95 m of yarn swing about the root


def test_a_closed_mesh_is_a_solid_and_an_open_one_is_not(scene):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.2, location=(0, 0, 0.25))
    jelly = bpy.context.object
    jelly.name = "jelly"
    jelly.bowknot.role, jelly.bowknot.solid = "SOLID", "jelly"
    bpy.ops.mesh.primitive_plane_add(size=2)
    floor = bpy.context.object
    floor.bowknot.role = "OBSTACLE"
    bpy.ops.bowknot.bake()
    end = world(jelly, 20)
    assert 0.0 < end[:, 2].min() < 0.02 and end[:, 2].max() < 0.44  # it sags
    assert clean(jelly, [floor], range(1, 21))
    bpy.ops.object.select_all(action="DESELECT")
    jelly.select_set(True)
    bpy.ops.bowknot.assign(role="CLOTH")
    assert jelly.bowknot.role == "CLOTH"
    opened = sheet("open", location=(0, 0, 2))
    opened.bowknot.role = "SOLID"
    with pytest.raises(RuntimeError, match="open: a solid needs a closed surface, and this one has 48 open edges"):
        bpy.ops.bowknot.bake()


def test_pins_sewn_to_a_body_go_with_it(scene):
    body = ball(radius=0.2)
    body.rotation_euler.z = 0.0
    body.keyframe_insert("rotation_euler", frame=1)
    body.rotation_euler.z = 0.5
    body.keyframe_insert("rotation_euler", frame=20)
    cloth = sheet(size=0.6, location=(0, 0, 0.22))
    before = world(cloth, 1)
    middle = np.flatnonzero(np.linalg.norm(before[:, :2], axis=1) < 0.06)
    group(cloth, "crown", middle)
    cloth.bowknot.pin_to = body
    bpy.ops.bowknot.bake()
    turn = np.array([[np.cos(0.5), -np.sin(0.5), 0], [np.sin(0.5), np.cos(0.5), 0], [0, 0, 1]])
    assert np.abs(world(cloth, 20)[middle] - before[middle] @ turn.T).max() < 1e-5


def test_shared_data_and_wrong_types_are_refused_with_a_remedy(scene):
    cloth = sheet()
    twin = bpy.data.objects.new("twin", cloth.data)
    scene.collection.objects.link(twin)
    twin.location.z = 1
    twin.bowknot.role = "CLOTH"
    with pytest.raises(RuntimeError, match="share their data: Object > Relations > Make Single User"):
        bpy.ops.bowknot.bake()
    bpy.data.objects.remove(twin)
    bpy.ops.object.text_add()
    bpy.context.object.bowknot.role = "CLOTH"
    with pytest.raises(RuntimeError, match="a font cannot be cloth: Object > Convert > Mesh"):
        bpy.ops.bowknot.bake()


def test_what_is_hidden_is_refused_and_an_unsaved_file_warned_of(empty):
    scene = empty()
    scene.frame_end = 2
    cloth = sheet()
    bpy.ops.bowknot.bake()
    assert scene.bowknot.message.startswith("Baked frames 1 to 2. The file is not saved")
    cloth.hide_viewport = True
    with pytest.raises(RuntimeError, match="sheet: it is hidden, or its collection is: show it"):
        bpy.ops.bowknot.bake()


@pytest.mark.parametrize("role", ["NONE", "CLOTH", "SOLID", "HAIR", "OBSTACLE"])
def test_panels_show_properties_and_buttons_that_there_are(scene, role):
    shown = []

    class Layout:
        """Takes what a panel draws, as Blender's layout does, of which there is none without a window."""

        def prop(self, owner, name):
            assert name in owner.bl_rna.properties
            shown.append(name)

        def prop_search(self, owner, name, where, among):
            assert among in where.bl_rna.properties
            self.prop(owner, name)

        def operator(self, name, text=""):
            space, own = name.split(".")
            shown.append(getattr(getattr(bpy.ops, space), own).get_rna_type().name)
            return SimpleNamespace()

        def label(self, text):
            shown.append(text)

        def column(self):
            return self

        def row(self, align):
            return self

        def grid_flow(self, columns, even_columns, align):
            return self

    sheet().bowknot.role = role
    scene.bowknot.message = "Baked frames 1 to 20"
    for kind in (panel.BOWKNOT_PT_object, panel.BOWKNOT_PT_bake):
        kind.draw(SimpleNamespace(layout=Layout()), bpy.context)
    assert ("friction" in shown) == (role != "NONE") and ("pins" in shown) == (role in ("CLOTH", "SOLID", "HAIR"))
    assert shown[-4:] == ["Bake", "Resume", "Free", "Baked frames 1 to 20"]
