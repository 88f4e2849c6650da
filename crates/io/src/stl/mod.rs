//! STL, text and binary: triangles without connectivity.
//!
//! Source: 3D Systems, "StereoLithography Interface Specification" (1989). A binary file has 80 bytes of
//! anything, the number of triangles (u32, little-endian) and 50 bytes for each: normal, three corners (f32),
//! two bytes that programs use for colors. Many binary files begin with `solid` too, the first word of a text.

mod binary;
mod text;

#[cfg(test)]
mod tests;

use crate::error::{IoError, Place};
use crate::import::{Import, without_mark};
use crate::mesh::Mesh;
use std::collections::HashMap;
use std::path::Path;

/// Reads an STL file. It lists the corners of each triangle anew; those with equal coordinates become one
/// vertex, and vertices are numbered as they first occur. How many corners became how many vertices is logged.
/// Corners that differ in the last digit stay apart. Triangles of fewer than three vertices are kept. Normals
/// and colors are not read.
///
/// # Errors
/// A malformed or truncated file, coordinates that are not finite; with the line of a text file or
/// the triangle of a binary one. A sound file without triangles is [`IoError::Empty`].
pub(crate) fn read_stl(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    let (mesh, note) =
        parse(bytes, import).map_err(|(place, message)| IoError::content(path, place, message))?;
    if mesh.triangles.is_empty() {
        return Err(IoError::Empty { path: path.to_owned(), message: "it has no triangles" });
    }
    if let Some(note) = note {
        tracing::warn!("{}: {note}", path.display());
    }
    let (corners, vertices) = (3 * mesh.triangles.len(), mesh.positions.len());
    tracing::info!(
        "{}: {corners} corners of triangles are at {vertices} places, its vertices",
        path.display()
    );
    Ok(mesh)
}

/// What is wrong, and where.
type Fault = (Place, String);

/// The mesh, and what was left out, in words.
fn parse(bytes: &[u8], import: &Import) -> Result<(Mesh, Option<String>), Fault> {
    let mut corners = Corners { import, mesh: Mesh::default(), known: HashMap::new() };
    let text = without_mark(bytes).trim_ascii_start();
    let is_solid = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let note = if is_solid && !binary::has_its_size(bytes) {
        text::parse(bytes, &mut corners)?;
        None
    } else {
        binary::parse(bytes, &mut corners)?
    };
    Ok((corners.mesh, note))
}

/// Makes vertices of corners.
struct Corners<'a> {
    import: &'a Import,
    mesh: Mesh,
    /// The vertex at the coordinates with these bits.
    known: HashMap<[u64; 3], u32>,
}

impl Corners<'_> {
    /// The vertex at these coordinates of the file.
    fn vertex(&mut self, raw: [f64; 3]) -> Result<u32, String> {
        let point = self.import.finite_point(raw)?;
        let next = self.mesh.positions.len();
        // The sum with 0 makes -0 and 0 equal.
        let vertex = *self.known.entry(raw.map(|c| (c + 0.0).to_bits())).or_insert(next as u32);
        if vertex as usize == next {
            if next >= u32::MAX as usize {
                return Err(format!("more than {} vertices", u32::MAX));
            }
            self.mesh.positions.push(point);
        }
        Ok(vertex)
    }
}
