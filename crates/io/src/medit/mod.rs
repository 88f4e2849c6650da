//! Medit `.mesh`, as text: vertices and elements with a number, the reference, for each.
//!
//! Source: Frey, "MEDIT: An interactive mesh visualization software", INRIA RT-0253 (2001), appendix; names of
//! sections of order 2 from libMeshb. A file is a sequence of keywords, each with its numbers.

mod words;

#[cfg(test)]
mod tests;

use crate::elements::{Becomes, Elements};
use crate::error::{IoError, Place};
use crate::groups::Groups;
use crate::import::{Import, without_mark};
use crate::mesh::Mesh;
use bowknot_geometry::Point;
use std::collections::BTreeMap;
use std::path::Path;
use words::{Fault, Words};

/// Sections of elements: keyword, vertices of each, what it becomes, what its references are named after.
const SECTIONS: [(&str, usize, Becomes, &str); 8] = [
    ("Edges", 2, Becomes::Line, "edges"),
    ("Triangles", 3, Becomes::Triangle, "triangles"),
    ("Quadrilaterals", 4, Becomes::Quad, "quadrilaterals"),
    ("Tetrahedra", 4, Becomes::Tet, "tetrahedra"),
    ("EdgesP2", 3, Becomes::Line, "edges"),
    ("TrianglesP2", 6, Becomes::Triangle, "triangles"),
    ("QuadrilateralsQ2", 9, Becomes::Quad, "quadrilaterals"),
    ("TetrahedraP2", 10, Becomes::Tet, "tetrahedra"),
];

/// Reads a Medit file: tetrahedra, triangles, quadrilaterals, edges as strands; of elements of order 2 their
/// corners. Elements that are the boundary of others are left out, as of a Gmsh file. [`Mesh::groups`] has the
/// vertices of each reference but 0, named by the section, such as `triangles-3` or `vertices-1`. Vertices of a
/// plane get z = 0. Other sections are skipped; their names are logged as a warning.
///
/// # Errors
/// A malformed or truncated file, a binary one, coordinates that are not finite, vertices that do not
/// exist; with the line.
pub(crate) fn read_medit(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    let text = String::from_utf8_lossy(without_mark(bytes));
    let (mesh, notes) =
        parse(&text, import).map_err(|(place, message)| IoError::content(path, place, message))?;
    for note in notes {
        tracing::warn!("{}: {note}", path.display());
    }
    Ok(mesh)
}

/// Refuses a binary Medit file.
pub(crate) fn refuse_binary(path: &Path) -> IoError {
    let message = "binary Medit files are not read: convert it with `meshio convert IN.meshb OUT.mesh`";
    IoError::content(path, Place::File, message)
}

/// The mesh, and what was skipped, in words.
fn parse(text: &str, import: &Import) -> Result<(Mesh, Vec<String>), Fault> {
    let mut words = Words::new(text);
    if words.next() != Some("MeshVersionFormatted") {
        let message = "not a Medit file: it must begin with MeshVersionFormatted";
        return Err((Place::File, message.to_owned()));
    }
    words.number::<u32>("the version, a whole number")?;
    let mut reader = Reader::default();
    loop {
        match words.next() {
            Some("End") => return reader.finish(),
            Some(keyword) => reader.section(keyword, &mut words, import)?,
            None => {
                let message = "truncated: it does not end with End; add that line if the file is whole";
                return Err((Place::File, message.to_owned()));
            }
        }
    }
}

/// What has been read.
#[derive(Default)]
struct Reader {
    dimension: Option<usize>,
    positions: Vec<Point>,
    elements: Elements,
    /// Vertices of each reference, as often as elements have them.
    references: BTreeMap<(&'static str, i64), Vec<u32>>,
    /// Keywords of skipped sections, of those reduced to corners.
    skipped: Vec<String>,
    reduced: Vec<String>,
}

impl Reader {
    fn section(&mut self, keyword: &str, words: &mut Words<'_>, import: &Import) -> Result<(), Fault> {
        match keyword {
            "Dimension" => {
                let dimension = words.number("the dimension")?;
                if !(2..=3).contains(&dimension) {
                    return Err(words.fault(format!("dimension {dimension} must be 2 or 3")));
                }
                self.dimension = Some(dimension);
                Ok(())
            }
            "Vertices" => self.vertices(words, import),
            _ if keyword.parse::<f64>().is_ok() => Err(words.fault(format!(
                "'{keyword}' stands where a section is expected: more entries than declared?"
            ))),
            _ => match SECTIONS.iter().find(|section| section.0 == keyword) {
                Some(&(_, size, becomes, name)) => self.elements(keyword, size, becomes, name, words),
                None => {
                    self.skipped.push(keyword.to_owned());
                    words.skip_numbers();
                    Ok(())
                }
            },
        }
    }

    fn vertices(&mut self, words: &mut Words<'_>, import: &Import) -> Result<(), Fault> {
        if !self.positions.is_empty() {
            return Err(words.fault("a second section Vertices: save one mesh a file"));
        }
        let Some(dimension) = self.dimension else {
            return Err(words.fault("Dimension must stand before Vertices"));
        };
        let count = words.count("vertices", dimension + 1)?;
        if count > u32::MAX as usize {
            return Err(words.fault(format!("{count} vertices; at most {} are possible", u32::MAX)));
        }
        self.positions.reserve(count);
        for vertex in 0..count as u32 {
            let mut raw = [0.0; 3];
            for coordinate in &mut raw[..dimension] {
                *coordinate = words.number("a coordinate")?;
            }
            self.positions.push(import.finite_point(raw).map_err(|message| words.fault(message))?);
            self.refer(words, "vertices", &[vertex])?;
        }
        Ok(())
    }

    fn elements(
        &mut self,
        keyword: &str,
        size: usize,
        becomes: Becomes,
        name: &'static str,
        words: &mut Words<'_>,
    ) -> Result<(), Fault> {
        let count = words.count(keyword, size + 1)?;
        if size > becomes.corners() && count > 0 {
            self.reduced.push(keyword.to_owned());
        }
        let mut vertices = Vec::with_capacity(size);
        for _ in 0..count {
            vertices.clear();
            for _ in 0..size {
                let number: usize = words.number("a vertex, a whole number from 1 on")?;
                if number == 0 || number > self.positions.len() {
                    let message = format!(
                        "vertex {number}, but the vertices before have the numbers 1 to {}",
                        self.positions.len()
                    );
                    return Err(words.fault(message));
                }
                vertices.push((number - 1) as u32);
            }
            self.elements.add(becomes, &vertices);
            self.refer(words, name, &vertices[..becomes.corners()])?;
        }
        Ok(())
    }

    /// Takes the reference of an element.
    fn refer(&mut self, words: &mut Words<'_>, name: &'static str, vertices: &[u32]) -> Result<(), Fault> {
        let reference = words.number("a reference, a whole number")?;
        if reference != 0 {
            self.references.entry((name, reference)).or_default().extend(vertices);
        }
        Ok(())
    }

    fn finish(self) -> Result<(Mesh, Vec<String>), Fault> {
        let mut notes = Vec::new();
        if !self.skipped.is_empty() {
            notes.push(format!("skipped the sections {}", self.skipped.join(", ")));
        }
        if !self.reduced.is_empty() {
            notes.push(format!("took the corners only of {}", self.reduced.join(", ")));
        }
        if self.elements.is_empty() {
            let notes = if notes.is_empty() { String::new() } else { format!(" ({})", notes.join("; ")) };
            let message = format!("no tetrahedra, triangles, quadrilaterals or edges in it{notes}");
            return Err((Place::File, message));
        }
        let mut groups = Groups::default();
        for ((name, reference), vertices) in self.references {
            groups.add(&format!("{name}-{reference}"), vertices);
        }
        Ok((self.elements.into_mesh(self.positions, groups), notes))
    }
}
