"""Files judged: meshes, animations, runs."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from contextlib import ExitStack
from types import SimpleNamespace
from typing import Any

from . import _native
from ._call import call
from ._errors import InputError
from ._info import Info
from ._meshes import is_path
from ._usd import as_text


class FilesReport(Info):
    """What the judge says of all frames of some files. It is true if nothing intersects and nothing is too near.

    ``states`` and ``intersecting_states`` count frames, ``intersections`` the pairs of elements that intersect in all
    of them, ``hints_between_frames`` those that meet on the straight way between frames. ``pairs`` has the parts that
    intersect: in how many frames, the first, the one with the most pairs, the deepest; ``hint_pairs`` the same of
    hints, ``inside`` the parts that lie within closed ones without meeting them. ``files`` has a verdict for each
    frame, with ``pairs``, ``findings``, ``time_s`` and the ``time_code`` of USD; ``elements`` has the elements of the
    findings by their part and their numbers within it.
    """

    __slots__ = ()

    def __bool__(self) -> bool:
        return bool(self["clear"])

    @property
    def findings(self) -> list[str]:
        """The first intersections of each frame in words, with its time where the file knows it."""
        return [f"{_named(frame)}: {finding}" for frame in self["files"] for finding in frame["findings"]]

    @property
    def hint_pairs(self) -> list[dict[str, Any]]:
        """The pairs of parts that meet between frames; empty if none do or the ways were not judged."""
        return self._all().get("hint_pairs", [])

    @property
    def inside(self) -> list[dict[str, Any]]:
        """The parts that lie inside of others, whose surfaces are closed, without meeting them."""
        return self._all().get("inside", [])

    @property
    def intersection_count(self) -> int:
        """Pairs of elements that intersect, in all frames."""
        return int(self["intersections"])

    def __repr__(self) -> str:
        count, frames = self["intersections"], self["states"]
        return f"FilesReport({count} {'intersection' if count == 1 else 'intersections'} in {frames} frames)"


def check_files(
    paths: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    between_frames: bool = False,
    together: bool = False,
    obstacles: str | Iterable[str] = (),
    may_intersect: str | Iterable[str] = (),
    leave_out: str | Iterable[str] = (),
    min_distance: float | None = None,
    up: str = "z",
    scale: float = 1.0,
    fps: float | None = None,
    limit: int = 5,
) -> FilesReport:
    """Judges every frame of meshes, animations and runs, by exact predicates.

    Parameters
    ----------
    paths : path, or several
        Mesh files, animations (USD, glTF, PC2 with its mesh, PVD, NPZ), folders of frames, folders of runs. Binary
        USD is read if usd-core is installed.
    between_frames : bool
        Whether the straight paths between frames are judged too. What meets there is a hint: how it moved is not
        known. The paths of a run's ``trace`` are always judged, and count.
    together : bool
        Whether the files are parts of one scene, which are judged frame by frame; those of one frame stand still.
    obstacles, may_intersect, leave_out : str, or several
        Names of parts: obstacles may intersect themselves and each other, others may intersect themselves, and some
        are not judged. ``*`` stands for any characters. Parts are bodies, prims, nodes or objects, as the files say.
    min_distance : float, optional
        The report is false, too, where two elements without a common vertex are nearer [m].
    up : {"z", "y", "x"}
        The axis of the files that points up.
    scale : float
        Length of the files' unit [m].
    fps : float, optional
        Frames per second of files that have motion but no frames. Default: the times of their keys.
    limit : int
        How many intersections of each frame are described; all are counted.

    Returns
    -------
    FilesReport

    Raises
    ------
    InputError
        Files that cannot be read, with the place; names that no part has.
    """
    given = [paths] if is_path(paths) else list(paths)
    if not given or not all(is_path(path) for path in given):
        raise InputError(f"paths: expected the path of a file or a folder, or several, got {paths!r}")
    judging = SimpleNamespace(
        up=up,
        scale=float(scale),
        fps=None if fps is None else float(fps),
        together=bool(together),
        between_frames=bool(between_frames),
        obstacles=_names(obstacles),
        may_intersect=_names(may_intersect),
        leave_out=_names(leave_out),
        min_distance=None if min_distance is None else float(min_distance),
        limit=count_of("limit", limit),
    )
    with ExitStack() as opened:
        texts = [opened.enter_context(as_text(path)) for path in given]
        report = call(_native.check_files, texts, judging)
    for text, path in zip(texts, map(os.fspath, given)):
        if text != path:
            report = report.replace(json.dumps(text)[1:-1], json.dumps(path)[1:-1])
    return FilesReport(report)


def _named(frame: dict[str, Any]) -> str:
    """A frame in words."""
    if "time_s" not in frame:
        return str(frame["file"])
    code = f", time code {frame['time_code']:g}" if "time_code" in frame else ""
    return f"{frame['file']} ({frame['time_s']:g} s{code})"


def _names(names: str | Iterable[str]) -> list[str]:
    return [names] if isinstance(names, str) else [str(name) for name in names]


def count_of(name: str, value: int) -> int:
    """A whole number from 0 up."""
    count = int(value)
    if not 0 <= count < 2**63:
        raise InputError(f"{name} {value}: it must be a whole number from 0 up")
    return count
