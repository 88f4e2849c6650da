"""Scenes of the runs, and what identifies them."""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .. import _native, _toml
from .._call import call
from .._errors import InputError
from .._scene import Scene, builtin_scenes
from ._study import Study, parsed

#: Characters of a hash in the name of a folder.
_LENGTH = 16

#: A key of a scene that holds a path, as scenes are written.
_PATH = re.compile(r"^(mesh|sequence) = ", re.MULTILINE)


class Resolver:
    """Makes the scenes of a study. Scenes and files that several runs share are read once."""

    def __init__(self, study: Study) -> None:
        self._study = study
        self._bases: dict[str, Scene] = {}
        self._files: dict[str, str] = {}

    def scene(self, values: Mapping[str, Any]) -> Scene:
        """The scene of a run.

        Raises
        ------
        InputError
            What the scene is refused for.
        """
        values = {**self._study.set, **values}
        scene = self._base(values.pop("scene", self._study.scene), values.pop("scale", self._study.scale))
        sets = [f"{key}={_toml.value(key, value)}" for key, value in values.items()]
        return Scene._of(call(scene._native.with_sets, sets)) if sets else scene

    def hash(self, text: str) -> str:
        """What identifies a run: its whole scene, the content of its files, the version of this package, and
        whether states are judged."""
        content: Any = text
        if _PATH.search(text):
            content = parsed(text)
            for entry in [*content.get("body", []), *content.get("obstacle", [])]:
                for key in entry.keys() & {"mesh", "sequence"}:
                    entry[key] = self._digest(entry[key])
        identity = json.dumps([_native.__version__, self._study.check, content], sort_keys=True)
        return hashlib.sha256(identity.encode()).hexdigest()[:_LENGTH]

    def _base(self, given: Any, scale: Any) -> Scene:
        """The scene before keys are set."""
        if isinstance(given, Scene):
            return given
        key = json.dumps([given, scale], default=os.fspath)
        if key not in self._bases:
            self._bases[key] = self._loaded(given, scale)
        return self._bases[key]

    def _loaded(self, given: Any, scale: Any) -> Scene:
        if isinstance(given, Mapping):
            return Scene.from_toml(_toml.document(given) + "\n", folder=self._study.folder)
        name = os.fspath(given)
        # As the command does: a name is that of a built-in scene, unless it looks like a path.
        if name in builtin_scenes() or not (Path(name).suffix or Path(name).name != name):
            return Scene.builtin(name, scale)
        if scale != 1:
            raise InputError(f"scale = {scale}: {name} is a file; only built-in scenes have a scale")
        return Scene.from_toml(self._study.folder / name)

    def _digest(self, path: str) -> str:
        """The hash of the content of a file, or of the files of a folder and their names."""
        if path not in self._files:
            digest = hashlib.sha256()
            place = Path(path)
            try:
                for file in sorted(place.iterdir()) if place.is_dir() else [place]:
                    if file.is_file():
                        digest.update(f"{file.name if place.is_dir() else ''}\0{file.stat().st_size}\0".encode())
                        with file.open("rb") as content:
                            while block := content.read(1 << 20):
                                digest.update(block)
            except OSError as error:
                raise InputError(f"{path}: cannot be read: {error.strerror}") from error
            self._files[path] = f"sha256:{digest.hexdigest()}"
        return self._files[path]
