//! Typed arrays as points and elements, and back.

use crate::error::{Thrown, input};
use bowknot::geometry::{HalfSpace, Point, Vector};
use js_sys::{Float64Array, Uint32Array};

/// Rows of N numbers.
pub fn rows<const N: usize>(name: &str, array: &Float64Array) -> Result<Vec<[f64; N]>, Thrown> {
    let values = array.to_vec();
    let (rows, rest) = values.as_chunks();
    if rest.is_empty() {
        return Ok(rows.to_vec());
    }
    Err(input(format!("{name}: {} numbers are not a multiple of {N}", values.len())))
}

/// Points, x y z of each [m].
pub fn points(name: &str, array: &Float64Array) -> Result<Vec<Point>, Thrown> {
    Ok(rows(name, array)?.into_iter().map(Point::from).collect())
}

/// Vectors, x y z of each.
pub fn vectors(name: &str, array: &Float64Array) -> Result<Vec<Vector>, Thrown> {
    Ok(rows(name, array)?.into_iter().map(Vector::from).collect())
}

/// One vector.
pub fn vector(name: &str, array: &Float64Array) -> Result<Vector, Thrown> {
    match vectors(name, array)?.as_slice() {
        [vector] => Ok(*vector),
        all => Err(input(format!("{name}: {} numbers instead of 3", 3 * all.len()))),
    }
}

/// Elements of N vertices.
pub fn elements<const N: usize>(name: &str, array: &Uint32Array) -> Result<Vec<[u32; N]>, Thrown> {
    let values = array.to_vec();
    let (elements, rest) = values.as_chunks();
    if rest.is_empty() {
        return Ok(elements.to_vec());
    }
    Err(input(format!("{name}: {} indices are not a multiple of {N}", values.len())))
}

/// Half-spaces: a normal and an offset along it [m] for each.
pub fn half_spaces(name: &str, array: &Float64Array) -> Result<Vec<HalfSpace>, Thrown> {
    let plane = |(index, [x, y, z, offset]): (usize, [f64; 4])| {
        HalfSpace::of_plane(Vector::new(x, y, z), offset).ok_or_else(|| {
            let message = "needs a normal that is not zero and an offset, all finite";
            input(format!("{name}: plane {index} {message}"))
        })
    };
    rows(name, array)?.into_iter().enumerate().map(plane).collect()
}

/// Points as x y z of each.
pub fn from_points(points: &[Point]) -> Float64Array {
    from_rows(points.iter().map(|point| point.coords.into()))
}

/// Vectors as x y z of each.
pub fn from_vectors(vectors: &[Vector]) -> Float64Array {
    from_rows(vectors.iter().map(|vector| (*vector).into()))
}

/// Rows of N numbers.
pub fn from_rows<const N: usize>(rows: impl Iterator<Item = [f64; N]>) -> Float64Array {
    let flat: Vec<f64> = rows.flatten().collect();
    Float64Array::from(flat.as_slice())
}

/// Elements of N vertices.
pub fn from_elements<const N: usize>(elements: impl Iterator<Item = [u32; N]>) -> Uint32Array {
    let flat: Vec<u32> = elements.flatten().collect();
    Uint32Array::from(flat.as_slice())
}
