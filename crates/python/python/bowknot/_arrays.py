"""Conversion of what users give to the arrays that the native part takes.

Errors say what was expected and what came.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ArrayTypeError, InputError

#: Types of entries by the letter of NumPy: integers, unsigned integers, floats.
_NUMBERS = "iuf"


def _array(name: str, value: Any, expected: str) -> NDArray[Any]:
    """The array of a value, whatever its type of entries."""
    if value is None:
        raise InputError(f"{name}: expected {expected}, got None")
    try:
        array = np.asarray(value)
    except Exception as error:  # anything that a user's class raises
        raise InputError(f"{name}: expected {expected}; NumPy makes no array of it: {error}") from error
    if array.dtype == object:
        kind = type(value).__name__
        raise ArrayTypeError(f"{name}: expected {expected}, got entries of type object from a {kind}")
    return array


def _shape(array: NDArray[Any]) -> str:
    return f"shape {array.shape} of {array.dtype}"


def _contiguous(array: NDArray[Any], dtype: Any) -> NDArray[Any]:
    """The same entries, aligned and in the order of C, as a plain array; without a copy if it is one."""
    return np.require(array, dtype=dtype, requirements=["C", "A", "E"])


def numbers(name: str, value: ArrayLike, columns: int | None, rows: int | None = None) -> NDArray[np.float64]:
    """An array of float64 of shape (rows, columns), or (rows,) if ``columns`` is None."""
    count = "n" if rows is None else str(rows)
    shape = f"({count},)" if columns is None else f"({count}, {columns})"
    expected = f"an array of shape {shape} of float64"
    array = _array(name, value, expected)
    if array.size == 0 and array.ndim == 1 and columns is not None:
        array = array.reshape(0, columns)
    dimensions = 1 if columns is None else 2
    fits = array.ndim == dimensions and (columns is None or array.shape[1] == columns)
    if not fits or (rows is not None and array.shape[0] != rows):
        raise InputError(f"{name}: expected {expected}, got {_shape(array)}")
    if array.size == 0:
        return np.zeros(array.shape)
    if array.dtype.kind not in _NUMBERS:
        raise ArrayTypeError(f"{name}: expected {expected}, got {_shape(array)}")
    if array.dtype.kind == "f" and array.dtype.itemsize > 8:
        raise ArrayTypeError(f"{name}: expected {expected}, got {_shape(array)}, which would be rounded")
    return _contiguous(array, np.float64)


def points(name: str, value: ArrayLike, rows: int | None = None) -> NDArray[np.float64]:
    """An array of float64 of shape (n, 3)."""
    return numbers(name, value, 3, rows)


def elements(name: str, value: ArrayLike | None, columns: int | None, vertices: int) -> NDArray[np.uint32]:
    """Vertices of elements, an array of uint32 of shape (m, columns), or (m,) if ``columns`` is None."""
    if value is None:
        return np.zeros((0,) if columns is None else (0, columns), np.uint32)
    shape = "(m,)" if columns is None else f"(m, {columns})"
    expected = f"an array of shape {shape} of integers"
    array = _array(name, value, expected)
    if array.size == 0 and array.ndim == 1 and columns is not None:
        array = array.reshape(0, columns)
    dimensions = 1 if columns is None else 2
    if array.ndim != dimensions or (columns is not None and array.shape[1] != columns):
        raise InputError(f"{name}: expected {expected}, got {_shape(array)}")
    if array.size == 0:
        return np.zeros(array.shape, np.uint32)
    if array.dtype.kind not in "iu":
        raise ArrayTypeError(f"{name}: expected {expected}, got {_shape(array)}")
    outside = (array < 0) | (array >= vertices)
    if outside.any():
        row = int(np.argwhere(outside)[0][0])
        given = array[row] if columns is None else array[row].tolist()
        raise InputError(f"{name}: row {row} is {given}, but there are {vertices} vertices, counted from 0")
    return _contiguous(array.astype(np.uint32, copy=False), np.uint32)


def flags(name: str, value: ArrayLike | None, vertices: int) -> NDArray[np.bool_]:
    """One truth value per vertex, from such an array or from the numbers of the vertices that are marked."""
    marked = np.zeros(vertices, np.bool_)
    if value is None:
        return marked
    expected = f"an array of shape ({vertices},) of bool, or the numbers of vertices"
    array = _array(name, value, expected)
    if array.dtype.kind == "b":
        if array.shape != (vertices,):
            raise InputError(f"{name}: expected {expected}, got {_shape(array)}")
        return _contiguous(array, np.bool_)
    if array.ndim != 1 or (array.dtype.kind not in "iu" and array.size > 0):
        raise (InputError if array.ndim != 1 else ArrayTypeError)(f"{name}: expected {expected}, got {_shape(array)}")
    marked[elements(name, array, None, vertices)] = True
    return marked


def whole(name: str, value: ArrayLike, rows: int, largest: int, none: int | None = None) -> NDArray[np.uint32]:
    """One whole number per vertex, from 0 to ``largest``; the largest of 32 bits for ``none``."""
    expected = f"an array of shape ({rows},) of integers from 0 to {largest}"
    if none is not None:
        expected += f", or {none} for none"
    array = _array(name, value, expected)
    if array.shape != (rows,):
        raise InputError(f"{name}: expected {expected}, got {_shape(array)}")
    if array.dtype.kind not in "iu" and array.size > 0:
        raise ArrayTypeError(f"{name}: expected {expected}, got {_shape(array)}")
    is_none = np.zeros(array.shape, np.bool_) if none is None else array == none
    outside = ((array < 0) | (array > largest)) & ~is_none
    if outside.any():
        vertex = int(np.flatnonzero(outside)[0])
        raise InputError(f"{name}: entry {vertex} is {array[vertex]}; expected {expected}")
    numbers_of_all = array.astype(np.uint32)
    numbers_of_all[is_none] = 2**32 - 1
    return numbers_of_all


def bodies(value: ArrayLike | None, obstacle: NDArray[np.bool_]) -> NDArray[np.uint32]:
    """The body of each vertex: as given, or by default 0, and 1 for the vertices of obstacles."""
    if value is None:
        return obstacle.astype(np.uint32)
    # None has more bodies than vertices, but the one of obstacles is 1 by default.
    return whole("bodies", value, len(obstacle), max(len(obstacle), 2) - 1)


def column(name: str, value: ArrayLike | None, rows: int) -> NDArray[np.float64]:
    """One number per row, from such an array or from one number for all; nan where nothing is given."""
    if value is None:
        return np.full(rows, np.nan)
    array = _array(name, value, f"a number, or an array of shape ({rows},)")
    if array.ndim == 0:
        if array.dtype.kind not in _NUMBERS:
            raise ArrayTypeError(f"{name}: expected a number, got {array.dtype}")
        return np.full(rows, float(array))
    return numbers(name, array, None, rows)


def is_list(name: str, value: ArrayLike) -> bool:
    """Whether a value has dimensions."""
    return _array(name, value, "a number, or an array").ndim > 0


def vector(name: str, value: ArrayLike) -> list[float]:
    """Three numbers."""
    return numbers(name, np.atleast_1d(_array(name, value, "three numbers")), None, 3).tolist()


def pose(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """A rigid transform, a matrix of shape (4, 4)."""
    matrix = numbers(name, value, 4, 4)
    rotation = matrix[:3, :3]
    is_rigid = (
        bool(np.isfinite(matrix).all())
        and bool((np.abs(rotation @ rotation.T - np.eye(3)) < 1e-6).all())
        and float(np.linalg.det(rotation)) > 0.0
        and bool((matrix[3] == [0.0, 0.0, 0.0, 1.0]).all())
    )
    if not is_rigid:
        raise InputError(
            f"{name}: expected a rigid transform: a rotation in the first three rows and columns, "
            "a displacement [m] in the last column, and (0, 0, 0, 1) as the last row"
        )
    return matrix


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    """The same array, which nobody can write to."""
    array.flags.writeable = False
    return array
