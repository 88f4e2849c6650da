"""Whole runs into a folder, as the command makes them."""

from __future__ import annotations

import html
import json
import os
import tempfile
import warnings
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native, _toml
from ._call import call, logger
from ._errors import BowknotWarning, InputError
from ._folders import replaced
from ._meshes import Mesh, read_mesh
from ._pictures import render
from ._progress import Callback, Follower, callback_of
from ._scene import Scene

#: Largest page in a notebook [bytes].
_NOTEBOOK_BYTES = 5_000_000


class Run:
    """The folder of a run: frames, statistics, a checkpoint.

    Parameters
    ----------
    folder : path
        The folder.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        if not (self.folder / "scene.toml").is_file():
            raise InputError(f"{self.folder}: not the folder of a run: it holds no scene.toml")
        #: The first intersections that a check found, in words.
        self.findings: list[str] = []

    @property
    def summary(self) -> dict[str, Any]:
        """The content of ``summary.json``."""
        return json.loads((self.folder / "summary.json").read_text(encoding="utf-8"))

    @property
    def stats(self) -> list[dict[str, Any]]:
        """One entry per time step, the lines of ``stats.jsonl``."""
        text = (self.folder / "stats.jsonl").read_text(encoding="utf-8")
        return [json.loads(line) for line in text.splitlines()]

    @property
    def scene(self) -> Scene:
        """Its scene."""
        return Scene.from_toml(self.folder / "scene.toml")

    def mesh(self, frame: int) -> Mesh:
        """A frame from ``frames/*.ply``; half-spaces are squares behind the other vertices.

        Raises
        ------
        InputError
            A frame that the run has not, or a run that wrote no such files.
        """
        frames = self.folder / "frames"
        path = frames / f"{int(frame):06}.ply"
        if not path.is_file():
            there = sorted(int(found.stem) for found in frames.glob("*.ply") if found.stem.isdigit())
            if not there:
                raise InputError(
                    f'{frames} holds no PLY files; run the scene with "ply" among `output.formats`, or export the '
                    "frames with the command `bowknot export`"
                )
            raise InputError(f"frame {frame} is not in {frames}; it holds {there[0]} to {there[-1]}")
        return read_mesh(path)

    def render(self, frame: int | None = None, **options: Any) -> NDArray[np.uint8]:
        """Draws a frame, by default the last one; see `bowknot.render`."""
        return render(self, frame=frame, **options)

    def _frame(self, frame: int | None) -> tuple[Mesh, NDArray[np.float64]]:
        """A frame without the squares of half-spaces, and these as planes. Those that are not there have no area."""
        if frame is None:
            there = [int(path.stem) for path in (self.folder / "frames").glob("*.ply") if path.stem.isdigit()]
            frame = max(there, default=0)
        mesh = self.mesh(frame)
        obstacles = _toml.read(self.scene.to_toml(short=False)).get("obstacle", [])
        squares = sum(_type(obstacle.get("shape")) == "half-space" for obstacle in obstacles)
        kept = len(mesh.vertices) - 4 * squares
        corners = mesh.vertices[kept:].reshape(squares, 4, 3)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        there = lengths > 0.0
        normals = normals[there] / lengths[there, None]
        offsets = np.einsum("kc,kc->k", normals, corners[there, 0])

        def elements(rows: NDArray[np.uint32]) -> NDArray[np.uint32]:
            is_kept = rows < kept if rows.ndim == 1 else (rows < kept).all(axis=1)
            return np.ascontiguousarray(rows[is_kept])

        without = Mesh(
            np.ascontiguousarray(mesh.vertices[:kept]),
            elements(mesh.faces),
            elements(mesh.tets),
            elements(mesh.edges),
            elements(mesh.particles),
            bodies=mesh.bodies[:kept],
            names=mesh.names,
            obstacles=mesh.obstacles[:kept],
        )
        return without, np.ascontiguousarray(np.column_stack([normals, offsets]))

    def report(self, out: str | os.PathLike[str] | None = None, **options: Any) -> Path:
        """Writes its page; see `bowknot.report`."""
        return report(self.folder, out, **options)

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"

    def _repr_html_(self) -> str:
        with tempfile.TemporaryDirectory() as folder:
            page = report(self.folder, Path(folder) / "report.html", max_bytes=_NOTEBOOK_BYTES)
            content = html.escape(page.read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{content}" width="100%" height="640" style="border: 0"></iframe>'


def _type(shape: Any) -> Any:
    return shape.get("type") if isinstance(shape, dict) else shape


def run(
    scene: Scene,
    out: str | os.PathLike[str] | None = None,
    *,
    resume: bool = False,
    overwrite: bool = False,
    check: bool = False,
    progress: bool | Callback | None = None,
) -> Run:
    """Runs a scene to its last frame and writes the folder that the command writes.

    Parameters
    ----------
    scene : Scene
        What is simulated.
    out : path, optional
        The folder; default ``out`` and the name of the scene.
    resume : bool
        Whether the run that the folder holds is continued.
    overwrite : bool
        Whether a run that the folder holds is replaced. What a run writes is removed, once the new one has begun;
        other files of the folder stay.
    check : bool
        Whether every accepted state and path is judged.
    progress : bool or function, optional
        True shows how far it is: a bar in a notebook, elsewhere a line on the standard error. Default: if that is a
        terminal, or in a notebook. A function is called as ``progress(frame, frames, info)`` before the first time
        step and after others, on a thread of its own; ``info`` is the `StepInfo` of the last one, or None. If it
        raises, it is called no more, and the run ends as usual before the exception comes.

    Returns
    -------
    Run
        The folder, with its summary.

    Warns
    -----
    BowknotWarning
        Time steps that ended unsolved: how many, the largest residual, and what helps. Pins that held edges over their
        stretch limits.

    Raises
    ------
    InputError
        What the scene or the folder is refused for; a folder that holds a run already. What it holds stays.
    KeyboardInterrupt
        Ctrl-C. The folder then has a checkpoint, from which ``resume=True`` goes on.
    """
    if not isinstance(scene, Scene):
        raise InputError(f"scene: expected a Scene, got {type(scene).__name__}")
    folder = Path("out") / scene.name if out is None else Path(out)
    if resume and overwrite:
        raise InputError("resume, overwrite: only one of them can be True")
    tell = callback_of(progress, scene.name)
    stats = folder / "stats.jsonl"
    if stats.exists() and not (resume or overwrite):
        tell = None  # the run is refused
    follower = None if tell is None else Follower(stats, scene.frames, tell)
    with replaced(folder) if overwrite else nullcontext(), follower or nullcontext():
        findings, advice = call(_native.run, scene._native, folder, bool(resume), bool(check))
    if follower is not None and follower.error is not None:
        raise follower.error
    for text in advice:
        warnings.warn(f"{scene.name}: {text}", BowknotWarning, stacklevel=2)
    done = Run(folder)
    done.findings = findings
    return done


def report(
    folder: str | os.PathLike[str] | Run,
    out: str | os.PathLike[str] | None = None,
    *,
    stride: int | None = None,
    max_bytes: int | None = None,
) -> Path:
    """Writes a run as one HTML page, which plays its frames beside plots of its statistics.

    Parameters
    ----------
    folder : path or Run
        The folder of the run.
    out : path, optional
        The page; default ``report.html`` in the folder.
    stride : int, optional
        Every how many frames one is shown. Default: as few are left out as `max_bytes` demands.
    max_bytes : int, optional
        Largest size of the page [bytes]. Default 30 MB.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        A folder without frames, a budget too small, an output that cannot be written.
    """
    folder = folder.folder if isinstance(folder, Run) else Path(folder)
    for name, value in (("stride", stride), ("max_bytes", max_bytes)):
        if value is not None and not 0 <= int(value) < 2**63:
            raise InputError(f"{name} {value}: it must be a whole number from 0 up")
    page, left_out = call(_native.report, folder, folder / "report.html" if out is None else out, stride, max_bytes)
    for what in left_out:
        logger.warning("left out: %s", what)
    return Path(page)
