//! Binary STL.

use super::{Corners, Fault};
use crate::error::Place;
use bowknot_errors::counted;

/// Bytes before the first triangle, and of a triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Whether the bytes are as many as those of a binary file that declares as many triangles as they do.
pub(super) fn has_its_size(bytes: &[u8]) -> bool {
    declared(bytes).is_some_and(|count| bytes.len() as u64 == size(count))
}

/// Reads the triangles. Returns what stands behind them, in words.
pub(super) fn parse(bytes: &[u8], corners: &mut Corners<'_>) -> Result<Option<String>, Fault> {
    let Some(count) = declared(bytes) else {
        let message = "not an STL file: a text begins with 'solid', and a binary file has 84 bytes at least";
        return Err((Place::File, message.to_owned()));
    };
    let (needed, length) = (size(count), bytes.len() as u64);
    if length < needed {
        let message = format!(
            "truncated, or not an STL file: {} would take {needed} bytes, it has {length}",
            counted(count as usize, "triangle", "triangles")
        );
        return Err((Place::File, message));
    }
    let (triangles, _) = bytes[HEADER..needed as usize].as_chunks::<TRIANGLE>();
    corners.mesh.triangles.reserve(triangles.len());
    for (index, triangle) in triangles.iter().enumerate() {
        // Behind the normal; colors follow.
        let (numbers, _) = triangle[12..48].as_chunks::<4>();
        let number = |k: usize| f64::from(f32::from_le_bytes(numbers[k]));
        let mut vertices = [0; 3];
        for (corner, vertex) in vertices.iter_mut().enumerate() {
            let raw = [0, 1, 2].map(|axis| number(3 * corner + axis));
            let fault = |message| (Place::Element("triangle".to_owned(), index), message);
            *vertex = corners.vertex(raw).map_err(fault)?;
        }
        corners.mesh.triangles.push(vertices);
    }
    let extra = (length - needed) as usize;
    Ok((extra > 0).then(|| format!("skipped {} behind its triangles", counted(extra, "byte", "bytes"))))
}

/// How many triangles a binary file declares.
fn declared(bytes: &[u8]) -> Option<u32> {
    Some(u32::from_le_bytes(*bytes.get(HEADER - 4..)?.first_chunk()?))
}

/// Size of a binary file [bytes].
fn size(triangles: u32) -> u64 {
    HEADER as u64 + TRIANGLE as u64 * u64::from(triangles)
}
