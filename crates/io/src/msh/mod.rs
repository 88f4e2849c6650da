//! Gmsh `.msh`, versions 2.2 and 4.1, text and binary: tetrahedra, triangles, lines and points.
//!
//! Source: the Gmsh reference manual, "Gmsh file formats" (MSH 4.1 and the legacy MSH 2). A file is a
//! sequence of sections `$Name` .. `$EndName`; those that are not about nodes, elements or physical groups
//! (data, partitions, other programs' own) are skipped.

mod cursor;
mod elements;
mod groups;
mod nodes;
mod version;
mod write;

#[cfg(test)]
mod tests;

use crate::error::{IoError, Place};
use crate::import::Import;
use crate::mesh::Mesh;
use cursor::{Cursor, Fault};
use elements::Elements;
use groups::PhysicalGroups;
use nodes::Nodes;
use std::path::Path;
use version::Version;

pub use write::write_msh;

/// Reads a Gmsh file: tetrahedra, triangles and quadrilaterals (as two triangles), lines as strands, points
/// as particles; of higher-order elements their corners. Node numbers may be any, vertices are numbered in
/// the order of the file. [`Mesh::groups`] has the vertices of each physical group.
///
/// Gmsh writes the boundary of a volume or surface as elements of their own. A triangle that is a face of a
/// tetrahedron, a line that is an edge of either, and a point that is a vertex of any of these are therefore
/// left out: what remains in [`Mesh::triangles`], [`Mesh::strands`] and [`Mesh::particles`] is not part of
/// something larger. Elements of other types, such as hexahedra, are skipped; their number is logged as a
/// warning.
///
/// # Errors
/// A malformed or truncated file, another version, the other byte order, coordinates that are not
/// finite, nodes that do not exist or are given twice; with the line of a text file or the byte of a binary
/// one.
pub(crate) fn read_msh(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    let (mesh, notes) =
        parse(bytes, import).map_err(|(place, message)| IoError::content(path, place, message))?;
    for note in notes {
        tracing::warn!("{}: {note}", path.display());
    }
    Ok(mesh)
}

/// The mesh, and what was skipped, in words.
fn parse(bytes: &[u8], import: &Import) -> Result<(Mesh, Vec<String>), Fault> {
    let mut cursor = Cursor::new(bytes);
    match cursor.section()?.as_deref() {
        Some("MeshFormat") => {}
        _ => {
            let message =
                "not a Gmsh file: it must begin with $MeshFormat; other formats convert with `gmsh -save`";
            return Err((Place::File, message.to_owned()));
        }
    }
    let version = format(&mut cursor)?;
    let (mut nodes, mut elements) = (None, None);
    let mut groups = PhysicalGroups::default();
    while let Some(name) = cursor.section()? {
        match name.as_str() {
            "Nodes" if nodes.is_some() => {
                return Err(cursor.fault("a second section $Nodes: save one mesh a file"));
            }
            "Elements" if elements.is_some() => {
                return Err(cursor.fault("a second section $Elements: save one mesh a file"));
            }
            "Nodes" => {
                nodes = Some(Nodes::read(&mut cursor, version, import)?);
                cursor.end(&name)?;
            }
            "Elements" => {
                let Some(nodes) = &nodes else {
                    return Err(cursor.fault("the elements stand before the nodes: save it with Gmsh again"));
                };
                elements = Some(Elements::read(&mut cursor, version, nodes, std::mem::take(&mut groups))?);
                cursor.end(&name)?;
            }
            "PhysicalNames" => {
                groups.read_names(&mut cursor)?;
                cursor.end(&name)?;
            }
            "Entities" if version == Version::V4 => {
                groups.read_entities(&mut cursor)?;
                cursor.end(&name)?;
            }
            _ => cursor.skip_section(&name)?,
        }
    }
    let nodes = nodes.filter(|nodes| !nodes.positions.is_empty());
    let nodes = nodes.ok_or_else(|| (Place::File, "it has no nodes".to_owned()))?;
    let elements = elements.unwrap_or_default();
    let notes = elements.notes();
    if elements.taken.is_empty() {
        let notes = if notes.is_empty() { String::new() } else { format!(" ({})", notes.join("; ")) };
        let message =
            format!("no tetrahedra, triangles, lines or points in it{notes}: mesh it with tetrahedra");
        return Err((Place::File, message));
    }
    let groups = elements.groups.into_groups();
    Ok((elements.taken.into_mesh(nodes.positions, groups), notes))
}

/// Reads the content of `$MeshFormat`: version, text or binary, sizes and byte order.
fn format(cursor: &mut Cursor<'_>) -> Result<Version, Fault> {
    let line = cursor.line();
    let mut words = line.split_ascii_whitespace();
    let (number, kind, size) = (words.next(), words.next(), words.next());
    let version = match number {
        Some("2" | "2.0" | "2.1" | "2.2") => Version::V2,
        Some("4.1") => Version::V4,
        _ => {
            let given = number.unwrap_or("missing");
            let message = format!(
                "version {given} is not read, only 2.2 and 4.1: convert it with `gmsh IN.msh -save -format \
                 msh41 -o OUT.msh`"
            );
            return Err(cursor.fault_before(message));
        }
    };
    match kind {
        Some("0") => {}
        Some("1") => {
            // Of a floating-point number in version 2, of the type that counts in version 4.
            let allowed: &[&str] = if version == Version::V2 { &["8"] } else { &["4", "8"] };
            let size = size.filter(|size| allowed.contains(size));
            let Some(size) = size else {
                let message = format!("the size of numbers must be {}", allowed.join(" or "));
                return Err(cursor.fault_before(message));
            };
            cursor.binary(if size == "4" { 4 } else { 8 });
            match cursor.bytes::<4>()? {
                one if i32::from_le_bytes(one) == 1 => {}
                one if i32::from_be_bytes(one) == 1 => {
                    return Err(
                        cursor.fault_before("it is big-endian, only little-endian is read: save it as text")
                    );
                }
                _ => return Err(cursor.fault_before("the number that tells the byte order is not 1")),
            }
        }
        _ => return Err(cursor.fault_before("the line must say 0 (text) or 1 (binary) after the version")),
    }
    cursor.end("MeshFormat")?;
    Ok(version)
}
