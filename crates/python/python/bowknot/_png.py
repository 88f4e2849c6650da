"""Pictures as PNG files, still and moving.

PNG specification, third edition (W3C 2025): section 5 has the chunks, section 11.3.6 those of animations.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def png(pixels: NDArray[np.uint8]) -> bytes:
    """Pixels of shape (height, width, 3) as a PNG file."""
    return _SIGNATURE + _header(pixels) + _chunk(b"IDAT", _data(pixels)) + _chunk(b"IEND", b"")


def animated_png(frames: Sequence[NDArray[np.uint8]], seconds: float) -> bytes:
    """Frames of the same size as an animated PNG that repeats; programs that know none show the first.

    Parameters
    ----------
    frames : sequence of ndarray, shape (height, width, 3)
        At least one.
    seconds : float
        How long each is shown [s].
    """
    height, width, _ = frames[0].shape
    milliseconds = min(max(round(1000 * seconds), 1), 65535)
    parts = [_SIGNATURE, _header(frames[0]), _chunk(b"acTL", struct.pack(">II", len(frames), 0))]
    number = 0
    for index, pixels in enumerate(frames):
        control = struct.pack(">IIIIIHHBB", number, width, height, 0, 0, milliseconds, 1000, 0, 0)
        parts.append(_chunk(b"fcTL", control))
        number += 1
        if index == 0:
            parts.append(_chunk(b"IDAT", _data(pixels)))
        else:
            parts.append(_chunk(b"fdAT", struct.pack(">I", number) + _data(pixels)))
            number += 1
    return b"".join([*parts, _chunk(b"IEND", b"")])


def _chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def _header(pixels: NDArray[np.uint8]) -> bytes:
    height, width, _ = pixels.shape
    return _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))


def _data(pixels: NDArray[np.uint8]) -> bytes:
    height, width, _ = pixels.shape
    # Each row is its filter, none, and its pixels.
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, 3 * width)], axis=1)
    return zlib.compress(rows.tobytes(), 9)
