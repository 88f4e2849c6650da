//! NumPy arrays as points and elements, and back.

use crate::error;
use bowknot::geometry::{HalfSpace, Point, Vector};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// A C-contiguous array of coordinates.
pub type Rows<'py> = PyReadonlyArray2<'py, f64>;
/// A C-contiguous array of vertices.
pub type Indices<'py> = PyReadonlyArray2<'py, u32>;

/// The rows of an array of so many columns. The Python part has checked shapes and types already.
fn rows<'a, T: Element + Copy, const N: usize>(array: &'a PyReadonlyArray2<'_, T>) -> PyResult<&'a [[T; N]]> {
    let columns = array.as_array().ncols();
    let flat = array.as_slice().map_err(|error| error::input(error.to_string()))?;
    // An array without rows may have any number of columns.
    if columns != N && !flat.is_empty() {
        return Err(error::input(format!("expected an array of {N} columns, got {columns}")));
    }
    Ok(flat.as_chunks::<N>().0)
}

/// The points of an array of shape (n, 3).
pub fn points(array: &Rows<'_>) -> PyResult<Vec<Point>> {
    Ok(rows::<_, 3>(array)?.iter().map(|x| Point::from(*x)).collect())
}

/// The vectors of an array of shape (n, 3).
pub fn vectors(array: &Rows<'_>) -> PyResult<Vec<Vector>> {
    Ok(rows::<_, 3>(array)?.iter().map(|v| Vector::from(*v)).collect())
}

/// The elements of an array of shape (m, N).
pub fn elements<const N: usize>(array: &Indices<'_>) -> PyResult<Vec<[u32; N]>> {
    Ok(rows::<_, N>(array)?.to_vec())
}

/// The numbers of an array of so many columns.
pub fn table<const N: usize>(array: &Rows<'_>) -> PyResult<Vec<[f64; N]>> {
    Ok(rows::<_, N>(array)?.to_vec())
}

/// The entries of a one-dimensional array.
pub fn column<T: Element + Copy>(array: &PyReadonlyArray1<'_, T>) -> Vec<T> {
    array.as_array().to_vec()
}

/// Half-spaces from rows of a unit normal and an offset [m].
pub fn half_spaces(array: &Rows<'_>) -> PyResult<Vec<HalfSpace>> {
    let plane = |(index, [x, y, z, offset]): (usize, [f64; 4])| {
        HalfSpace::of_plane(Vector::new(x, y, z), offset).ok_or_else(|| {
            error::input(format!("planes: row {index} needs a normal (finite, not zero) and a finite offset"))
        })
    };
    table::<4>(array)?.into_iter().enumerate().map(plane).collect()
}

/// An array of shape (n, 3).
pub fn point_array<'py>(py: Python<'py>, points: &[Point]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    row_array(py, points.iter().map(|p| [p.x, p.y, p.z]))
}

/// An array of shape (n, 3).
pub fn vector_array<'py>(py: Python<'py>, vectors: &[Vector]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    row_array(py, vectors.iter().map(|v| [v.x, v.y, v.z]))
}

/// An array with one row for each of `rows`.
pub fn row_array<'py, T: Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: impl Iterator<Item = [T; N]>,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let flat = rows.collect::<Vec<[T; N]>>().into_flattened();
    let count = flat.len() / N;
    PyArray1::from_vec(py, flat).reshape([count, N])
}

/// A one-dimensional array.
pub fn list<'py, T: Element>(py: Python<'py>, entries: impl Iterator<Item = T>) -> Bound<'py, PyArray1<T>> {
    PyArray1::from_vec(py, entries.collect())
}
