"""Where results go: a folder, or what fsspec reaches."""

from __future__ import annotations

import contextlib
import fnmatch
import importlib.util
import json
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from .._errors import InputError

#: The file of a finished run, written last.
OUTCOME = "sweep.json"

#: Files of a run that are always kept.
_KEPT = ("scene.toml", "summary.json", OUTCOME)


def store(out: str) -> LocalStore | RemoteStore:
    """The place of results.

    Raises
    ------
    InputError
        A URL without fsspec or without what it needs for that protocol.
    """
    return RemoteStore(out) if "://" in out else LocalStore(out)


def place(run: str) -> str:
    """The folder of a run in that of its study."""
    return f"runs/{run}"


class LocalStore:
    """A folder. All workers must reach it under the same path."""

    def __init__(self, out: str) -> None:
        self._root = Path(out)

    def path(self, name: str) -> str:
        return str(self._root / name)

    def outcomes(self, runs: Iterable[str]) -> dict[str, dict[str, Any]]:
        """The outcomes of those runs that are finished."""
        found = {}
        for run in runs:
            with contextlib.suppress(OSError, ValueError):
                found[run] = json.loads((self._root / place(run) / OUTCOME).read_text(encoding="utf-8"))
        return found

    @contextlib.contextmanager
    def folder(self, run: str, keep: list[str]) -> Iterator[Path]:
        """The folder in which a run is made; afterwards only what is kept."""
        folder = self._root / place(run)
        folder.parent.mkdir(parents=True, exist_ok=True)
        yield folder
        drop(folder, keep)

    def finish(self, run: str, outcome: dict[str, Any]) -> None:
        """Marks a run as finished."""
        self.write(f"{place(run)}/{OUTCOME}", json.dumps(outcome, indent=1).encode())

    def write(self, name: str, content: bytes) -> None:
        """Writes a file as a whole or not at all."""
        path = self._root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            os.chmod(temporary, 0o644)
            os.replace(temporary, path)
        except BaseException:
            os.unlink(temporary)
            raise


class RemoteStore:
    """A URL that fsspec reaches. Runs are made in a temporary folder and then copied."""

    def __init__(self, out: str) -> None:
        if importlib.util.find_spec("fsspec") is None:
            raise InputError(f"out = {out!r}: needs fsspec: pip install fsspec, and its package for the protocol")
        import fsspec

        try:
            self._files, self._root = fsspec.core.url_to_fs(out)
        except (ImportError, ValueError) as error:
            raise InputError(f"out = {out!r}: {error}") from error
        self._url = out.rstrip("/")

    def path(self, name: str) -> str:
        return f"{self._url}/{name}"

    def outcomes(self, runs: Iterable[str]) -> dict[str, dict[str, Any]]:
        """The outcomes of those runs that are finished."""
        paths = {f"{self._root}/{place(run)}/{OUTCOME}": run for run in runs}
        found = self._files.cat(list(paths), on_error="omit") if paths else {}
        outcomes = {}
        for path, run in paths.items():
            with contextlib.suppress(KeyError, ValueError):
                outcomes[run] = json.loads(found[path])
        return outcomes

    @contextlib.contextmanager
    def folder(self, run: str, keep: list[str]) -> Iterator[Path]:
        """A temporary folder in which a run is made; what is kept of it is copied."""
        with tempfile.TemporaryDirectory(prefix="bowknot-") as temporary:
            folder = Path(temporary) / run
            yield folder
            drop(folder, keep)
            for file in sorted(folder.rglob("*")):
                if file.is_file():
                    target = f"{self._root}/{place(run)}/{file.relative_to(folder).as_posix()}"
                    self._files.makedirs(target.rpartition("/")[0], exist_ok=True)
                    self._files.put_file(str(file), target)

    def finish(self, run: str, outcome: dict[str, Any]) -> None:
        """Marks a run as finished."""
        self.write(f"{place(run)}/{OUTCOME}", json.dumps(outcome, indent=1).encode())

    def write(self, name: str, content: bytes) -> None:
        """Writes a file."""
        path = f"{self._root}/{name}"
        self._files.makedirs(path.rpartition("/")[0], exist_ok=True)
        self._files.pipe_file(path, content)


def drop(folder: Path, keep: list[str]) -> None:
    """Removes the files of a run that no pattern names, then folders without files."""
    if "*" in keep:
        return
    for path in sorted(folder.rglob("*"), reverse=True):
        name = path.relative_to(folder).as_posix()
        if path.is_dir():
            if not any(path.iterdir()):
                path.rmdir()
        elif name not in _KEPT and not any(fnmatch.fnmatch(name, pattern) for pattern in keep):
            path.unlink()


def clear(folder: Path) -> None:
    """Removes the folder of a run that cannot go on."""
    shutil.rmtree(folder, ignore_errors=True)
