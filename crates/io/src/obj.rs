//! Wavefront OBJ: `v`, `f`, `l` and `p`; every other statement is skipped. And `.seg`, of the same manner,
//! with strand segments as `s`.
//!
//! The format has no word for obstacles, without which nobody could tell a ball that rests on the ground from
//! one that intersects it; a comment says from which vertex on there are obstacles only.

use crate::atomic::write_atomic;
use crate::error::{IoError, Place};
use crate::import::Import;
use crate::mesh::{Mesh, MeshView};
use bowknot_errors::Parameters;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Begins the comment that names the first vertex, from 0, of those that all belong to obstacles.
const OBSTACLE_FROM: &str = "# obstacle-from ";

/// Reads an OBJ file: vertices, faces (as fans around their first vertex), `l` polylines as strands, `p`
/// points.
///
/// Indices count from 1, or backward from the last vertex read when negative; `v/vt/vn` triples are read for
/// their first number; a `\` at the end of a line continues it. The comment `# obstacle-from N`, as
/// [`write_obj`] writes it, makes obstacles of the vertices from N on, counted from 0.
///
/// # Errors
/// A missing or malformed file, coordinates that are not finite, indices of vertices that do not exist; with
/// the line.
pub fn read_obj(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    read(path, import, false)
}

/// Reads a `.seg` file: as an OBJ, but `s a b ..` is a strand through these vertices, not a smoothing group.
///
/// # Errors
/// As [`read_obj`].
pub fn read_segments(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    read(path, import, true)
}

fn read(path: &Path, import: &Import, segments: bool) -> Result<Mesh, IoError> {
    import.validate().map_err(|errors| IoError::content(path, Place::File, errors.to_string()))?;
    let bytes = fs::read(path).map_err(|source| IoError::system("read", path, source))?;
    // Names of groups and materials may be in any encoding; the numbers are ASCII.
    let text = String::from_utf8_lossy(&bytes);
    let mut reader =
        Reader { path, import, segments, mesh: Mesh::default(), pending: Vec::new(), obstacle_from: None };

    let mut joined = String::new();
    let mut first_line = 0;
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        if let Some(count) = line.strip_prefix(OBSTACLE_FROM) {
            let count = count
                .trim()
                .parse()
                .map_err(|_| reader.error(number, "the comment needs a vertex, from 0"))?;
            reader.obstacle_from = Some(count);
        }
        let line = line.split('#').next().unwrap_or("").trim();
        if joined.is_empty() {
            first_line = number;
        }
        if let Some(start) = line.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
        } else if joined.is_empty() {
            reader.statement(line, number)?;
        } else {
            joined.push_str(line);
            reader.statement(&joined, first_line)?;
            joined.clear();
        }
    }
    reader.statement(&joined, first_line)?;
    reader.finish()
}

/// Writes positions, faces, strands and particles as an OBJ file, atomically; coordinates round-trip exactly.
/// If the last vertices, and only they, belong to obstacles, a comment says so for [`read_obj`]; bodies are
/// not written.
///
/// # Errors
/// The system's refusal, with the path.
pub fn write_obj(path: &Path, mesh: &MeshView<'_>) -> Result<(), IoError> {
    let deformable = mesh.obstacle.iter().take_while(|flag| !**flag).count();
    let suffix = deformable < mesh.obstacle.len() && mesh.obstacle[deformable..].iter().all(|&flag| flag);
    write_atomic(path, |out| {
        if suffix {
            writeln!(out, "{OBSTACLE_FROM}{deformable}")?;
        }
        for p in mesh.positions {
            writeln!(out, "v {:?} {:?} {:?}", p.x, p.y, p.z)?;
        }
        for [i, j, k] in mesh.triangles {
            writeln!(out, "f {} {} {}", i + 1, j + 1, k + 1)?;
        }
        for [i, j, k, l] in mesh.quads {
            writeln!(out, "f {} {} {} {}", i + 1, j + 1, k + 1, l + 1)?;
        }
        for [i, j] in mesh.strands {
            writeln!(out, "l {} {}", i + 1, j + 1)?;
        }
        for i in mesh.particles {
            writeln!(out, "p {}", i + 1)?;
        }
        Ok(())
    })
}

struct Reader<'a> {
    path: &'a Path,
    import: &'a Import,
    /// Whether `s` is a strand.
    segments: bool,
    mesh: Mesh,
    /// Indices that no vertex had when they were read, with their line: vertices may follow the faces.
    pending: Vec<(u32, usize)>,
    /// The first of the vertices that belong to obstacles.
    obstacle_from: Option<usize>,
}

impl Reader<'_> {
    fn statement(&mut self, line: &str, number: usize) -> Result<(), IoError> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => self.vertex(words, number),
            Some("f") => {
                let corners = self.indices(words, number, "a face", 3)?;
                self.mesh
                    .triangles
                    .extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
                Ok(())
            }
            Some(word) if word == "l" || self.segments && word == "s" => {
                let line = self.indices(words, number, "a line", 2)?;
                self.mesh.strands.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
                Ok(())
            }
            Some("p") => {
                let points = self.indices(words, number, "a point", 1)?;
                self.mesh.particles.extend(points);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn vertex<'w>(&mut self, words: impl Iterator<Item = &'w str>, number: usize) -> Result<(), IoError> {
        let mut coordinates = [0.0; 3];
        let mut count = 0;
        // A weight or a color may follow the three coordinates.
        for (slot, word) in coordinates.iter_mut().zip(words) {
            *slot =
                word.parse::<f64>().map_err(|_| self.error(number, format!("'{word}' is not a number")))?;
            if !slot.is_finite() {
                return Err(self.error(number, format!("coordinate {word} is not finite")));
            }
            count += 1;
        }
        if count < 3 {
            return Err(self.error(number, format!("a vertex needs 3 coordinates, this one has {count}")));
        }
        let point = self.import.point(coordinates);
        if !point.iter().all(|c| c.is_finite()) {
            return Err(
                self.error(number, format!("a coordinate overflows when scaled by {}", self.import.scale))
            );
        }
        if self.mesh.positions.len() >= u32::MAX as usize {
            return Err(self.error(number, "more than 4294967295 vertices"));
        }
        self.mesh.positions.push(point);
        Ok(())
    }

    fn indices<'w>(
        &mut self,
        words: impl Iterator<Item = &'w str>,
        number: usize,
        element: &str,
        least: usize,
    ) -> Result<Vec<u32>, IoError> {
        let mut indices = Vec::new();
        for word in words {
            indices.push(self.index(word, number)?);
        }
        if indices.len() < least {
            let plural = if least == 1 { "vertex" } else { "vertices" };
            return Err(self
                .error(number, format!("{element} needs {least} {plural}, this one has {}", indices.len())));
        }
        Ok(indices)
    }

    fn index(&mut self, word: &str, number: usize) -> Result<u32, IoError> {
        let digits = word.split('/').next().unwrap_or(word);
        let index: i64 =
            digits.parse().map_err(|_| self.error(number, format!("'{word}' is not a vertex index")))?;
        let count = self.mesh.positions.len() as i64;
        let zero_based = match index {
            0 => return Err(self.error(number, "vertex index 0: indices count from 1")),
            i if i > 0 => i - 1,
            i if -i <= count => count + i,
            i => {
                return Err(
                    self.error(number, format!("vertex index {i}, but only {count} vertices precede it"))
                );
            }
        };
        let zero_based = u32::try_from(zero_based)
            .map_err(|_| self.error(number, format!("vertex index {index} is larger than any mesh")))?;
        if i64::from(zero_based) >= count {
            self.pending.push((zero_based, number));
        }
        Ok(zero_based)
    }

    fn finish(mut self) -> Result<Mesh, IoError> {
        let count = self.mesh.positions.len();
        if let Some((index, line)) = self.pending.iter().find(|(index, _)| *index as usize >= count) {
            let message =
                format!("vertex index {}, but the file has {count} vertices", u64::from(*index) + 1);
            return Err(self.error(*line, message));
        }
        if count == 0 {
            return Err(IoError::content(
                self.path,
                Place::File,
                "no vertices: not of the OBJ manner, or empty",
            ));
        }
        self.mesh.obstacle = self.obstacle_from.map(|first| (0..count).map(|v| v >= first).collect());
        Ok(self.mesh)
    }

    fn error(&self, line: usize, message: impl Into<String>) -> IoError {
        IoError::content(self.path, Place::Line(line), message)
    }
}
