"""Folders of runs that are replaced."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ._errors import InputError

#: What a run writes into its folder, and the page of it.
_PARTS = (
    "scene.toml",
    "backends.json",
    "frames",
    "frames.npz",
    "frames.pvd",
    "scene.usda",
    "pc2",
    "surface",
    "stats.jsonl",
    "summary.json",
    "checkpoint",
    "trace",
    "states",
    "report.html",
)


@contextmanager
def replaced(folder: Path) -> Iterator[None]:
    """Sets the run of a folder aside, and removes it at the end; it is put back if no other has begun there.

    A folder without ``scene.toml`` holds no run: nothing happens to it.
    """
    if not (folder / "scene.toml").is_file():
        yield
        return
    aside = Path(tempfile.mkdtemp(prefix=".replaced-", dir=folder))
    try:
        _refuse_in_use(folder)
        for part in _PARTS:
            if os.path.lexists(folder / part):
                os.rename(folder / part, aside / part)
        yield
    finally:
        if not (folder / "scene.toml").is_file():
            # What a run leaves that was refused is its lock.
            shutil.rmtree(folder / "checkpoint", ignore_errors=True)
            for part in os.listdir(aside):
                os.rename(aside / part, folder / part)
        shutil.rmtree(aside, ignore_errors=True)


def _refuse_in_use(folder: Path) -> None:
    """Refuses the folder of a run that goes on: it holds a lock of the operating system."""
    try:
        with open(folder / "checkpoint" / "lock", "r+b") as file:
            if os.name == "posix":
                import fcntl

                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            else:
                # A lock of Windows keeps others from reading.
                file.read()
    except FileNotFoundError:
        return
    except (BlockingIOError, PermissionError) as error:
        raise InputError(f"{folder}: a run writes to it, so it cannot be replaced") from error
