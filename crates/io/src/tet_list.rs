//! Lists of tetrahedra, `.t`: lines `Vertex NUMBER x y z` and `Tet NUMBER a b c d`, as MeshLib and its users
//! write.

use crate::atomic::write_atomic;
use crate::error::{IoError, Place};
use crate::import::{Import, without_mark};
use crate::mesh::{Mesh, MeshView};
use crate::numbering::Numbering;
use bowknot_errors::counted;
use std::io::Write;
use std::path::Path;

/// Reads a list of tetrahedra. `Vertex` lines may have any numbers, which `Tet` lines and `Face` lines (three
/// vertices) refer to; what follows the last number of a line, such as `{attributes}`, and lines that begin
/// with another word are skipped, the latter with their number logged as a warning.
///
/// # Errors
/// A malformed file, coordinates that are not finite, vertices that do not exist or are given
/// twice; with the line.
pub(crate) fn read_tet_list(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    let text = String::from_utf8_lossy(without_mark(bytes));
    let (mesh, skipped) =
        parse(&text, import).map_err(|(place, message)| IoError::content(path, place, message))?;
    if skipped > 0 {
        tracing::warn!(
            "{}: skipped {} neither Vertex nor Tet nor Face",
            path.display(),
            counted(skipped, "line that is", "lines that are")
        );
    }
    Ok(mesh)
}

/// Writes vertices, tetrahedra and triangles as a list, atomically; coordinates round-trip exactly. Vertices
/// are numbered from
/// 0. Lines and points are not written.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_tet_list(path: &Path, mesh: &MeshView<'_>) -> Result<(), IoError> {
    write_atomic(path, |out| {
        for (number, p) in mesh.positions.iter().enumerate() {
            writeln!(out, "Vertex {number} {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
        for (number, [a, b, c, d]) in mesh.tets.iter().enumerate() {
            writeln!(out, "Tet {number} {a} {b} {c} {d}")?;
        }
        for (number, [a, b, c]) in mesh.triangles.iter().enumerate() {
            writeln!(out, "Face {number} {a} {b} {c}")?;
        }
        Ok(())
    })
}

/// The mesh, and how many lines were skipped.
fn parse(text: &str, import: &Import) -> Result<(Mesh, usize), (Place, String)> {
    let mut mesh = Mesh::default();
    let mut numbers = Vec::new();
    // Elements may stand before their vertices.
    let mut tets: Vec<(usize, [i64; 4])> = Vec::new();
    let mut faces: Vec<(usize, [i64; 3])> = Vec::new();
    let mut skipped = 0;
    for (index, line) in text.lines().enumerate() {
        let fault = |message: String| (Place::Line(index + 1), message);
        let mut words = line.split('#').next().unwrap_or("").split_ascii_whitespace();
        match words.next() {
            None => {}
            Some("Vertex") => {
                numbers.push(number(words.next(), "the vertex's number").map_err(fault)?);
                let mut raw = [0.0; 3];
                for coordinate in &mut raw {
                    *coordinate = number(words.next(), "a coordinate").map_err(fault)?;
                }
                let point = import.point(raw);
                if !point.iter().all(|c| c.is_finite()) {
                    return Err(fault(format!("coordinates {raw:?} are not finite")));
                }
                mesh.positions.push(point);
            }
            Some("Tet") => tets.push((index + 1, corners(&mut words).map_err(fault)?)),
            Some("Face") => faces.push((index + 1, corners(&mut words).map_err(fault)?)),
            Some(_) => skipped += 1,
        }
    }
    if mesh.positions.is_empty() {
        let message = "no line begins with Vertex: not a list of tetrahedra, or an empty one";
        return Err((Place::File, message.to_owned()));
    }
    if mesh.positions.len() > u32::MAX as usize {
        return Err((Place::File, format!("more than {} vertices", u32::MAX)));
    }
    let numbering = Numbering::new(numbers).map_err(|number| {
        (Place::File, format!("vertex {number} is given twice: number them differently"))
    })?;
    mesh.tets = tets.iter().map(|tet| indices(&numbering, tet)).collect::<Result<_, _>>()?;
    mesh.triangles = faces.iter().map(|face| indices(&numbering, face)).collect::<Result<_, _>>()?;
    Ok((mesh, skipped))
}

fn number<T: std::str::FromStr>(word: Option<&str>, what: &str) -> Result<T, String> {
    let word = word.ok_or_else(|| format!("the line ends before {what}"))?;
    word.parse().map_err(|_| format!("'{word}' is not {what}"))
}

/// The vertices of an element, behind its number.
fn corners<'w, const N: usize>(words: &mut impl Iterator<Item = &'w str>) -> Result<[i64; N], String> {
    number::<i64>(words.next(), "the element's number")?;
    let mut corners = [0; N];
    for corner in &mut corners {
        *corner = number(words.next(), "a vertex")?;
    }
    Ok(corners)
}

fn indices<const N: usize>(
    numbering: &Numbering,
    (line, corners): &(usize, [i64; N]),
) -> Result<[u32; N], (Place, String)> {
    let mut indices = [0; N];
    for (index, corner) in indices.iter_mut().zip(corners) {
        *index = numbering.index(*corner).ok_or_else(|| {
            (
                Place::Line(*line),
                format!("there is no vertex {corner}: no line begins with `Vertex {corner}`"),
            )
        })?;
    }
    Ok(indices)
}
