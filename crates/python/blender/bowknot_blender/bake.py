# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake from press to result: gathers on the main thread, computes on another, then gives objects their motion."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from . import places, results
from .core import job as jobs
from .core.scene import Refused
from .gather import Gathering

#: The bake that goes on, if any. There is one at a time: it has all cores.
running: Bake | None = None
#: The bake that the last undo has ended, if it has.
_undone: Bake | None = None


class Bake:
    """A bake of the present scene. `advance` does a little of the work; call it until it returns False."""

    def __init__(self, context: bpy.types.Context, *, resume: bool) -> None:
        self._scene = context.scene.name
        self._resume = resume
        self._gathering = Gathering(context)
        kind = context.scene.bowknot.result
        for obj in self._gathering.bodies:
            results.check(obj, kind)
        if resume and jobs.about(folder(context.scene)) is None:
            raise Refused(f"{folder(context.scene)}: there is no bake to resume; press Bake")
        self._job: jobs.Job | None = None
        self._canceled = False
        self.progress = 0.0
        self.what = "Reading the animation"
        #: What went wrong; then what came of it, for the artist.
        self.error: Exception | None = None
        self.message = ""
        self._work = self._steps()

    def advance(self) -> bool:
        """Does a little of the work; False if there is none left."""
        try:
            next(self._work)
            return True
        except StopIteration:
            return False
        except Exception as error:  # whatever it is, the artist is told
            self.error = error
            self.message = str(error)
            return False

    @property
    def waiting(self) -> bool:
        """Whether the other thread is at work, and there is nothing to do here but to wait for it."""
        return self._job is not None

    def close(self) -> None:
        """Ends the bake now, with what is done."""
        self.cancel()
        if self._job is not None:
            self._job.join()
        self._work.close()

    def cancel(self) -> None:
        """Ends the bake soon; what is done stays."""
        self._canceled = True
        if self._job is not None:
            self._job.cancel()

    def _steps(self) -> Iterator[None]:
        scene = bpy.data.scenes[self._scene]
        if bpy.context.object is not None and bpy.context.object.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        where = folder(scene)
        files = _files([obj.name for obj in self._gathering.bodies])
        for obj in self._gathering.bodies:
            results.detach(obj)
        try:
            yield from self._gather()
            if self._canceled:
                self.message = "Canceled before the first frame"
                return
            self.what = "Simulating"
            first = self._gathering.first
            self._job = jobs.Job(self._gathering.description, where, files, first=first, resume=self._resume)
            self._job.start()
            while self._job.running:
                self.progress = self._job.done / self._job.total
                yield
            self._told()
        finally:
            self._attach(where, files)

    def _gather(self) -> Iterator[None]:
        frames = self._gathering.frames()
        try:
            for frame in frames:
                if bpy.context.scene.name != self._scene:
                    raise Refused("the scene was changed while its animation was read: stay in it, and bake again")
                count = self._gathering.last - self._gathering.first + 1
                self.progress = (frame - self._gathering.first + 1) / count
                yield
                if self._canceled:
                    return
        finally:
            frames.close()

    def _told(self) -> None:
        job, first = self._job, self._gathering.first
        if isinstance(job.error, jobs.StartIntersects):
            bpy.data.scenes[self._scene].frame_set(first)
            places.show(bpy.context, job.error.places)
            raise Refused(_intersects(job.error, first))
        if job.error is not None:
            raise job.error
        reached = first + job.done
        self.message = f"Baked frames {first} to {reached}"
        if job.done < job.total:
            self.message = f"Canceled at frame {reached}: Resume goes on from there"
        if _is_temporary(bpy.data.scenes[self._scene]):
            self.message += ". The file is not saved: save it and bake again, or the cache is gone when Blender ends"
        if job.unsolved > 0:
            made = job.done * job.description.settings.steps
            self.message += (
                f". {job.unsolved} of {made} time steps were not solved to their tolerance: nothing intersects, but "
                "motion may be off there; more Steps per Frame may help"
            )

    def _attach(self, where: Path, files: dict[str, str]) -> None:
        if self._job is not None and isinstance(self._job.error, jobs.StartIntersects):
            return  # The places are being looked at, in edit mode. The files of an earlier bake stay.
        found = jobs.about(where)
        kind = bpy.data.scenes[self._scene].bowknot.result
        for name, file in files.items():
            obj = bpy.data.objects.get(name)
            if found is None or found["files"].get(name) != file:
                continue
            if obj is None:
                self.message += f". {name} was renamed or removed meanwhile: it has no motion"
                continue
            # An earlier bake that stays may begin at another frame.
            results.attach(obj, where / file, found["first"], kind)


def begin(context: bpy.types.Context, *, resume: bool) -> Bake:
    """Begins a bake; there must be none."""
    global running
    if running is not None:
        raise Refused("a bake is at work already: wait, or cancel it")
    running = Bake(context, resume=resume)
    return running


def finish(bake: Bake) -> None:
    """Forgets a bake that has ended and shows its message."""
    global running
    running = None
    scene = bpy.data.scenes.get(bake._scene)
    if scene is not None:
        scene.bowknot.message = bake.message


@persistent
def stop(*_: object) -> None:
    """Ends the bake that goes on, if any, and waits for it: before another file is opened, for one."""
    global running
    current, running = running, None
    if current is not None:
        current.close()


def end(message: str) -> Bake:
    """Ends the bake that goes on, waits for it, and says why; what is done stays."""
    current = running
    current.close()
    current.message = message
    finish(current)
    return current


@persistent
def before_undo(*_: object) -> None:
    """Ends a bake that still reads the animation: an undo replaces the objects that it reads. Later it knows names alone."""
    global _undone
    _undone = end("Canceled by an undo: bake again") if running is not None and not running.waiting else None


@persistent
def after_undo(*_: object) -> None:
    """Says so once more: the undo may have taken the message back."""
    if _undone is not None:
        finish(_undone)


def register() -> None:
    bpy.app.handlers.load_pre.append(stop)
    for handlers, handler in _of_undo():
        handlers.append(handler)


def unregister() -> None:
    stop()
    bpy.app.handlers.load_pre.remove(stop)
    for handlers, handler in _of_undo():
        handlers.remove(handler)


def _of_undo() -> list[tuple[list[object], object]]:
    of = bpy.app.handlers
    return [(of.undo_pre, before_undo), (of.redo_pre, before_undo), (of.undo_post, after_undo), (of.redo_post, after_undo)]


def run(context: bpy.types.Context, *, resume: bool) -> Bake:
    """A whole bake at once, as scripts have it."""
    bake = begin(context, resume=resume)
    try:
        while bake.advance():
            if bake.waiting:
                time.sleep(0.01)
    finally:
        bake.close()  # Ctrl-C may have come
        finish(bake)
    return bake


def free(scene: bpy.types.Scene) -> int:
    """Removes results and files of a scene; the number of objects that had one."""
    count = 0
    for obj in scene.objects:
        before = len(obj.modifiers), obj.type == "MESH" and obj.data.shape_keys is not None
        results.detach(obj)
        count += before != (len(obj.modifiers), obj.type == "MESH" and obj.data.shape_keys is not None)
    jobs.remove(folder(scene))
    scene.bowknot.message = ""
    return count


def folder(scene: bpy.types.Scene) -> Path:
    """Where the caches of a scene are."""
    if _is_temporary(scene):
        return Path(bpy.app.tempdir) / "bowknot" / bpy.path.clean_name(scene.name)
    # Files beside each other, such as versions of a shot, must not share one.
    name = bpy.path.clean_name(f"{Path(bpy.data.filepath).stem} {scene.name}")
    return Path(bpy.path.abspath(scene.bowknot.folder or "//bowknot")).resolve() / name


def _is_temporary(scene: bpy.types.Scene) -> bool:
    """Whether the folder is that of a file that is not saved, which has none."""
    return not bpy.data.filepath and (scene.bowknot.folder or "//").startswith("//")


def _files(names: list[str]) -> dict[str, str]:
    """A file for each object; names that differ in what files cannot have get a number."""
    files: dict[str, str] = {}
    for name in names:
        stem = bpy.path.clean_name(name)
        file, number = f"{stem}.pc2", 2
        while file.lower() in {other.lower() for other in files.values()}:
            file, number = f"{stem}_{number}.pc2", number + 1
        files[name] = file
    return files


def _intersects(error: jobs.StartIntersects, first: int) -> str:
    counts = [
        f"{len(own)} of {name}" if len(own) > 0 else f"some that modifiers of {name} made"
        for name, own in error.places.items()
    ]
    # The last line says how far what must go; the keys of scene files are nothing to an artist.
    advice = str(error).splitlines()[-1].replace(", by `translate`", "")
    return f"The start intersects in frame {first}: {', '.join(counts)} (vertices, which are selected). {advice}"
