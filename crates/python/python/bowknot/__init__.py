"""Simulation of deformable bodies that never intersect.

`Resolver` keeps the states of anyone's dynamics free of intersections. `Scene` and `Simulator` simulate cloth, soft
solids, hair and sand. `check`, `search` and `repair` work on meshes by themselves; `render` draws; `run` and `report`
make the folders and pages of the command, `sweep` many runs and a table of them.

Lengths are in m, masses in kg, times in s; z is up. Vertices are arrays of float64 of shape (n, 3), triangles arrays of
integers of shape (m, 3). Where a mesh is taken, objects of meshio, trimesh and pyvista are taken as well. Warnings go
to the logger ``bowknot``; what makes results doubtful is a `BowknotWarning`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import _native
from ._contacts import Contacts
from ._errors import (
    ArrayTypeError,
    BowknotError,
    BowknotWarning,
    DeviceError,
    InputError,
    InternalError,
    IntersectionError,
)
from ._files import FilesReport, check_files
from ._info import Info, StepInfo
from ._meshes import Mesh, read_mesh
from ._movie import Movie
from ._pictures import keep_silent, render
from ._resolver import Resolver
from ._runs import Run, report, run
from ._scene import Scene, builtin_scenes
from ._shapes import shape
from ._simulator import Checkpoint, Simulator
from ._tools import CheckReport, Pairs, check, check_path, repair, search

if TYPE_CHECKING:
    from .sweep import sweep
else:
    # A module that is called as its function, so that `import bowknot.sweep` takes nothing away.
    from . import sweep

__version__: str = _native.__version__

__all__ = [
    "ArrayTypeError",
    "BowknotError",
    "BowknotWarning",
    "CheckReport",
    "Checkpoint",
    "Contacts",
    "DeviceError",
    "FilesReport",
    "Info",
    "InputError",
    "InternalError",
    "IntersectionError",
    "Mesh",
    "Movie",
    "Pairs",
    "Resolver",
    "Run",
    "Scene",
    "Simulator",
    "StepInfo",
    "builtin_scenes",
    "check",
    "check_files",
    "check_path",
    "gpus",
    "read_mesh",
    "render",
    "repair",
    "report",
    "run",
    "search",
    "set_threads",
    "shape",
    "sweep",
    "threads",
]


def gpus() -> list[str]:
    """The GPUs that are found, in the order of their numbers."""
    keep_silent()
    return _native.gpus()


def threads() -> int:
    """Number of threads that compute."""
    return _native.threads()


def set_threads(count: int) -> None:
    """Sets the number of threads; 0: one per core, or that of the variable ``RAYON_NUM_THREADS``. On the CPU it changes
    no bit of any result.

    Raises
    ------
    InputError
        A number below 0 or above 1024.
    """
    if not 0 <= int(count) <= 1024:
        raise InputError(f"threads {count}: it must be a whole number from 0 to 1024")
    _native.set_threads(int(count))
