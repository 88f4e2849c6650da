# SPDX-License-Identifier: GPL-3.0-or-later
"""Point caches (PC2): the positions of a mesh in each frame, as Blender's Mesh Cache modifier reads them."""

from __future__ import annotations

import os
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_HEADER = struct.Struct("<12siiffi")
_MAGIC = b"POINTCACHE2\0"


class Writer:
    """A cache that grows by one sample per frame. Every sample that was added can be read at once."""

    def __init__(self, path: Path, vertices: int, *, keep: int = 0) -> None:
        """Opens a cache; `keep` is how many samples of an earlier one stay, 0 for a new one."""
        self._size = 12 * vertices
        if keep == 0:
            self._file = open(path, "wb")
            self._samples = 0
            self._write_header(vertices)
        else:
            found = read(path)
            if found.shape[0] < keep or found.shape[1] != vertices:
                raise ValueError(
                    f"{path}: expected {keep} samples of {vertices} vertices, "
                    f"found {found.shape[0]} of {found.shape[1]}; bake anew"
                )
            del found  # Windows cannot cut a file that is mapped.
            self._file = open(path, "r+b")
            self._file.truncate(_HEADER.size + keep * self._size)
            self._samples = keep
            self._write_header(vertices)
        self._vertices = vertices

    def add(self, positions: NDArray[np.float64]) -> None:
        """Adds a sample, shape (n, 3)."""
        data = np.ascontiguousarray(positions, "<f4")
        if data.shape != (self._vertices, 3):
            raise ValueError(f"{data.shape}: expected a sample of {self._vertices} vertices")
        self._file.seek(_HEADER.size + self._samples * self._size)
        self._file.write(data.tobytes())
        self._samples += 1
        # The header last: a reader never counts on a sample that is not there.
        self._write_header(self._vertices)

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def _write_header(self, vertices: int) -> None:
        self._file.seek(0)
        self._file.write(_HEADER.pack(_MAGIC, 1, vertices, 0.0, 1.0, self._samples))
        self._file.flush()


def read(path: str | os.PathLike[str]) -> NDArray[np.float32]:
    """The samples of a cache, shape (f, n, 3)."""
    with open(path, "rb") as file:
        head = file.read(_HEADER.size)
    if len(head) < _HEADER.size or not head.startswith(_MAGIC):
        raise ValueError(f"{path}: not a point cache (PC2)")
    _, _, vertices, _, _, samples = _HEADER.unpack(head)
    if os.path.getsize(path) < _HEADER.size + 12 * vertices * samples:
        raise ValueError(f"{path}: shorter than its header says; bake anew")
    if samples * vertices == 0:
        return np.zeros((samples, vertices, 3), np.float32)
    return np.memmap(path, "<f4", "r", _HEADER.size, (samples, vertices, 3))
