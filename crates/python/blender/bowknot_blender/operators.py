# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons: roles for selected objects, bake, resume, cancel, free."""

from __future__ import annotations

import time

import bpy
from bpy.props import EnumProperty

from . import bake
from .core import job as jobs
from .core.scene import Refused
from .properties import ROLES

#: Time between two looks at the other thread [s].
_TICK = 0.1


class BOWKNOT_OT_assign(bpy.types.Operator):
    """Give the selected objects a role in the simulation"""

    bl_idname = "bowknot.assign"
    bl_label = "Assign"
    bl_options = {"REGISTER", "UNDO"}

    role: EnumProperty(name="Role", items=ROLES, default="CLOTH")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(context.selected_objects)

    def execute(self, context: bpy.types.Context) -> set[str]:
        types = {"NONE": None, "HAIR": ("MESH", "CURVES")}.get(self.role, ("MESH",))
        given = [obj for obj in context.selected_objects if types is None or obj.type in types]
        for obj in given:
            obj.bowknot.role = self.role
        others = len(context.selected_objects) - len(given)
        if others > 0:
            self.report(
                {"WARNING"}, f"{others} selected objects are no {' or '.join(types).lower()}: convert them first"
            )
        return {"FINISHED"} if given else {"CANCELLED"}


class _Baking:
    """What Bake and Resume share: at once from a script, in the background from the interface."""

    _resume = False
    _timer: bpy.types.Timer | None = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bake.running is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            return self._end(bake.run(context, resume=self._resume))
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            bake.begin(context, resume=self._resume)
        except Refused as error:
            context.scene.bowknot.message = str(error)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TICK, window=context.window)
        manager.progress_begin(0.0, 1.0)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        current = bake.running
        going = current is not None and current.advance()
        # Blender's own work goes on in between, but most of the time is for reading the animation.
        end = time.perf_counter() + 0.8 * _TICK
        while going and not current.waiting and time.perf_counter() < end:
            going = current.advance()
        for window in context.window_manager.windows:
            for area in window.screen.areas:
                if area.type == "VIEW_3D":
                    area.tag_redraw()
        if going:
            context.window_manager.progress_update(current.progress)
            return {"PASS_THROUGH"}
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        if current is None:  # the extension was switched off
            return {"CANCELLED"}
        bake.finish(current)
        return self._end(current)

    def cancel(self, context: bpy.types.Context) -> None:
        """The window is closed, with the timer that would take the bake further."""
        context.window_manager.progress_end()
        if bake.running is not None:
            bake.end("Ended with its window")

    def _end(self, done: bake.Bake) -> set[str]:
        self.report({"ERROR" if done.error is not None else "INFO"}, done.message)
        return {"CANCELLED" if done.error is not None else "FINISHED"}


class BOWKNOT_OT_bake(_Baking, bpy.types.Operator):
    """Simulate the frame range anew, in the background"""

    bl_idname = "bowknot.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER"}


class BOWKNOT_OT_resume(_Baking, bpy.types.Operator):
    """Go on with a bake that was canceled, or whose frame range was lengthened"""

    bl_idname = "bowknot.resume"
    bl_label = "Resume"
    bl_options = {"REGISTER"}
    _resume = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bake.running is None and jobs.about(bake.folder(context.scene)) is not None


class BOWKNOT_OT_cancel(bpy.types.Operator):
    """End the bake after the present time step; what is done stays"""

    bl_idname = "bowknot.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bake.running is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        bake.running.cancel()
        return {"FINISHED"}


class BOWKNOT_OT_free(bpy.types.Operator):
    """Take the motion off all objects of the scene, and remove the files of the bake"""

    bl_idname = "bowknot.free"
    bl_label = "Free"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bake.running is None

    def execute(self, context: bpy.types.Context) -> set[str]:
        count = bake.free(context.scene)
        self.report({"INFO"}, f"Freed {count} objects")
        return {"FINISHED"}


_CLASSES = (BOWKNOT_OT_assign, BOWKNOT_OT_bake, BOWKNOT_OT_resume, BOWKNOT_OT_cancel, BOWKNOT_OT_free)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
