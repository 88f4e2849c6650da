# SPDX-License-Identifier: GPL-3.0-or-later
"""A bake on a thread of its own. It knows arrays and files, and nothing of Blender, which only its main thread may
touch."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import bowknot

from . import pc2
from .scene import Body, Description, Refused, build, intersecting

#: What a folder of a bake says of itself, and the state that it goes on from.
ABOUT, STATE = "bake.json", "state.npz"

#: Frames between two states in the folder. What a crash loses at most.
_STATE_EVERY = 10


class StartIntersects(Refused):
    """The start intersects; `places` are the vertices of each object."""

    def __init__(self, message: str, places: dict[str, NDArray[np.int64]]) -> None:
        super().__init__(message)
        self.places = places


def about(folder: Path) -> dict[str, Any] | None:
    """What the bake in a folder says of itself; None if there is none."""
    try:
        found = json.loads((folder / ABOUT).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return found if isinstance(found, dict) and found.get("format") == 1 else None


def remove(folder: Path) -> None:
    """Removes the files of a bake, and the folder if nothing else is in it."""
    found = about(folder)
    if found is None:
        return
    for name in (*found["files"].values(), STATE, ABOUT):
        (folder / name).unlink(missing_ok=True)
    if folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()


class _Pins:
    """The pins of a body, one per held vertex, and the rows of their places in its frames."""

    def __init__(self, body: Body, names: list[str]) -> None:
        self._frames = body.led_frames
        self._rows = dict(zip(names, np.searchsorted(body.led, body.held_vertices())))

    def lead(self, simulator: bowknot.Simulator, frame: int, share: float) -> None:
        """Leads them to a place between a frame and the next one."""
        if self._rows:
            targets = _between(self._frames, frame, share)
            for name, row in self._rows.items():
                simulator.set_pin_targets(name, targets[row][None])


class Job:
    """Makes the frames of a description and writes a cache per body into a folder.

    `done` is how many frames after the first there are, `unsolved` how many time steps were not solved. After it has
    ended `error` holds what went wrong, or None. The caches begin at the frame `first` of the program around it.
    """

    def __init__(
        self, description: Description, folder: Path, files: dict[str, str], *, first: int = 0, resume: bool = False
    ) -> None:
        self.description = description
        self.folder = folder
        self.total = description.settings.frames
        self.done = 0
        self.unsolved = 0
        self.error: Exception | None = None
        self._files = files
        self._resume = resume
        self._first = first
        self._cancel = threading.Event()
        self._thread = threading.Thread(target=self._guarded, name="bowknot bake", daemon=True)

    def start(self) -> None:
        """Starts the thread."""
        self._thread.start()

    def cancel(self) -> None:
        """Asks the thread to end after the time step that it is in."""
        self._cancel.set()

    @property
    def running(self) -> bool:
        """Whether the thread is at work."""
        return self._thread.is_alive()

    def join(self) -> None:
        """Waits for the thread."""
        self._thread.join()

    def _guarded(self) -> None:
        try:
            self._run()
        except Exception as error:  # whatever it is, the main thread tells the artist
            self.error = error

    def _run(self) -> None:
        description, settings = self.description, self.description.settings
        scene = build(description)
        try:
            simulator = bowknot.Simulator(scene)
        except bowknot.IntersectionError as error:
            raise StartIntersects(str(error), intersecting(description)) from error
        simulator.set_measured(False)
        names = iter(simulator.pins)
        pins = [_Pins(body, [next(names) for _ in body.held()]) for body in description.bodies]
        if self._resume:
            self._restore(simulator)
        else:
            # Not before: a start that is refused leaves the earlier bake.
            remove(self.folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        caches = self._caches()
        state = simulator.checkpoint()
        try:
            if not self._resume:
                for body in description.bodies:
                    caches[body.name].add(_in_object(body, body.start, 0))
            while self.done < self.total and not self._cancel.is_set():
                if not self._frame(simulator, pins, settings.steps):
                    break
                frame = self.done + 1
                for body in description.bodies:
                    caches[body.name].add(self._positions(simulator, body, frame))
                # After what may fail, such as on a full disk: frames that count are whole.
                state = simulator.checkpoint()
                self.done = frame
                if self.done % _STATE_EVERY == 0:
                    self._keep(state)
        finally:
            # Also of a failure: the frames before it are as good as ever.
            self._keep(state)
            for cache in caches.values():
                cache.close()

    def _caches(self) -> dict[str, pc2.Writer]:
        keep = self.done + 1 if self._resume else 0
        return {
            body.name: pc2.Writer(self.folder / self._files[body.name], len(body.start), keep=keep)
            for body in self.description.bodies
        }

    def _frame(self, simulator: bowknot.Simulator, pins: list[_Pins], steps: int) -> bool:
        """Makes the time steps of one frame; False if it was canceled meanwhile."""
        unsolved = 0
        for step in range(1, steps + 1):
            if self._cancel.is_set():
                return False
            share = step / steps
            for obstacle in self.description.obstacles:
                if len(obstacle.frames) > 1:
                    simulator.set_obstacle_targets(obstacle.name, _between(obstacle.frames, self.done, share))
            for held in pins:
                held.lead(simulator, self.done, share)
            unsolved += not simulator.step().solved
        self.unsolved += unsolved
        return True

    def _positions(self, simulator: bowknot.Simulator, body: Body, frame: int) -> NDArray[np.float64]:
        """The vertices of the object in its own space, in the frame that was made last."""
        positions = np.empty_like(body.start)
        if len(body.led) > 0:
            positions[body.led] = body.led_frames[frame]
        positions[body.used] = simulator.positions_of(body.name)[: len(body.used)]
        return _in_object(body, positions, frame)

    def _keep(self, state: bowknot.Checkpoint) -> None:
        """Writes the state, then what the folder says of itself: each in one go, so that a crash leaves the last ones."""
        beside = self.folder / f"new-{STATE}"
        state.save(beside)
        text = {
            "format": 1,
            "done": self.done,
            "first": self._first,
            "unsolved": self.unsolved,
            "fingerprint": self.description.fingerprint(self.done),
            "files": self._files,
        }
        beside.replace(self.folder / STATE)
        other = self.folder / f"new-{ABOUT}"
        other.write_text(json.dumps(text, indent=1), encoding="utf-8")
        other.replace(self.folder / ABOUT)

    def _restore(self, simulator: bowknot.Simulator) -> None:
        found = about(self.folder)
        if found is None:
            raise Refused(f"{self.folder}: there is no bake to resume; press Bake")
        self.done, self.unsolved = found["done"], found["unsolved"]
        if self.done > self.total:
            raise Refused("the frame range is shorter than what is baked already: lengthen it, or press Bake")
        if found["files"] != self._files or found["fingerprint"] != self.description.fingerprint(self.done):
            raise Refused(
                "objects, animation or settings are not those of the bake that stopped: undo the change, or press Bake"
            )
        state = bowknot.Checkpoint.load(self.folder / STATE)
        if state.step != self.done * self.description.settings.steps:
            raise Refused(f"{self.folder}: the state and {ABOUT} are of different frames; press Bake")
        simulator.restore(state)


def _between(frames: NDArray[np.float64], frame: int, share: float) -> NDArray[np.float64]:
    """The places between a frame and the next one."""
    if share == 1.0:
        return frames[frame + 1]
    return (1.0 - share) * frames[frame] + share * frames[frame + 1]


def _in_object(body: Body, positions: NDArray[np.float64], frame: int) -> NDArray[np.float64]:
    matrix = body.to_object[frame]
    return positions @ matrix[:3, :3].T + matrix[:3, 3]
