"""Collision problems of built-in scenes, recorded by `bowknot run --record`."""

from dataclasses import dataclass

import numpy as np

from setting import Unusable, call, clear, program


@dataclass(frozen=True)
class Recording:
    """A problem of a scene: the first one of the last of `frames` time steps."""

    scene: str
    scale: float
    frames: int

    @property
    def name(self):
        return f"{self.scene} {self.scale:g}, time step {self.frames}"


# Hard targets: a sheet hits the needle's tip, another is drawn into the funnel. Many contacts and
# near targets: four sheets fall on each other and on a ball, a tube is wound up.
FULL = [
    Recording("needle", 0.52, 9),
    Recording("funnel", 0.2, 33),
    Recording("stack", 0.5, 26),
    Recording("tube", 0.45, 143),
]
QUICK = [Recording("needle", 0.25, 9), Recording("funnel", 0.2, 27)]


def path_of(recording, out):
    """The archive of the problem, recorded now if it does not exist."""
    folder = out / "recorded" / f"{recording.scene}-{recording.scale:g}-{recording.frames}"
    states = folder / "states"
    if not (folder / "summary.json").exists():
        print(f"recording {recording.name}")
        clear(folder)
        options = ["--scale", recording.scale, "--frames", recording.frames, "--record", "--quiet"]
        call([program("bowknot"), "run", recording.scene, *options, "--out", folder])
    found = sorted(states.glob(f"{recording.frames:06}_*.npz"))
    if not found:
        raise Unusable(f"{states} has no problem of time step {recording.frames}: remove {folder}")
    return found[0]


def load(path):
    """The arrays of a problem."""
    with np.load(path) as archive:
        return {name: archive[name] for name in archive.files}
