//! Meshes from OBJ and SEG files.

use super::faces::{Faces, add_groups};
use super::write::{NAMELESS, OBSTACLE_FROM};
use crate::error::{IoError, Place};
use crate::import::{Import, read_bytes, without_mark};
use crate::mesh::Mesh;
use crate::surface::{Corner, Surface};
use bowknot_errors::counted;
use std::path::Path;

/// Reads an OBJ file: vertices, faces (as fans around their first vertex), `l` polylines as strands, `p`
/// points. Polygons, texture coordinates (the first two numbers), normals, objects, groups, materials and
/// smoothing groups become [`Mesh::surface`]. [`Mesh::groups`] has the vertices of each group, `g`.
///
/// Indices count from 1, or backward from the last one read when negative; a `\` at the end of a line
/// continues it. Two comments count, as [`super::write_obj`] writes them: `# obstacle-from N` makes obstacles
/// of the vertices from N on, counted from 0, and a name after `# nameless` stands for none.
///
/// # Errors
/// A missing or malformed file, coordinates that are not finite, indices of vertices, texture coordinates or
/// normals that do not exist; with the line.
pub fn read_obj(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    parse_obj(path, &read_bytes(path, import)?, import)
}

/// As [`read_obj`], from the bytes of the file at `path`.
pub(crate) fn parse_obj(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    read(path, bytes, import, Dialect::Obj)
}

/// Reads an OBJ file that [`super::write_obj`] wrote: as [`read_obj`], but corners share a normal only where
/// the file says so. Which ones do must not depend on the state in which it was written.
///
/// # Errors
/// As [`read_obj`].
pub fn read_obj_surface(path: &Path) -> Result<Option<Surface>, IoError> {
    let import = Import::default();
    Ok(read(path, &read_bytes(path, &import)?, &import, Dialect::Ours)?.surface)
}

/// Reads a `.seg` file: as an OBJ, but `s a b ..` is a strand through these vertices, not a smoothing group.
///
/// # Errors
/// As [`read_obj`].
pub(crate) fn read_segments(path: &Path, bytes: &[u8], import: &Import) -> Result<Mesh, IoError> {
    read(path, bytes, import, Dialect::Segments)
}

const NO_VERTICES: &str = "no vertices: not of the OBJ manner, or empty";

/// What the statements mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dialect {
    Obj,
    /// An OBJ that we wrote, whose normals are numbered one by one.
    Ours,
    /// `s` is a strand.
    Segments,
}

fn read(path: &Path, bytes: &[u8], import: &Import, dialect: Dialect) -> Result<Mesh, IoError> {
    if bytes.trim_ascii().is_empty() {
        // Not a mesh without vertices: exports have comments or names at least.
        return Err(IoError::content(path, Place::File, NO_VERTICES));
    }
    // Names of groups and materials may be in any encoding; the numbers are ASCII.
    let text = String::from_utf8_lossy(without_mark(bytes));
    let mut reader = Reader {
        path,
        import,
        dialect,
        mesh: Mesh::default(),
        faces: Faces::default(),
        corners: Vec::new(),
        pending: Vec::new(),
        obstacle_from: None,
        nameless: false,
    };

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
        reader.nameless |= line == NAMELESS;
        let line = if is_name(line) { line } else { line.split('#').next().unwrap_or("") }.trim();
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

/// Whether the line names something. Names may contain what begins a comment elsewhere.
fn is_name(line: &str) -> bool {
    let keyword = line.split_ascii_whitespace().next();
    matches!(keyword, Some("o" | "g" | "usemtl" | "mtllib"))
}

/// What indices point at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Indexed {
    Vertex,
    TextureCoordinate,
    Normal,
}

impl Indexed {
    /// Its name, one and many.
    fn names(self) -> [&'static str; 2] {
        match self {
            Self::Vertex => ["vertex", "vertices"],
            Self::TextureCoordinate => ["texture coordinate", "texture coordinates"],
            Self::Normal => ["normal", "normals"],
        }
    }
}

struct Reader<'a> {
    path: &'a Path,
    import: &'a Import,
    dialect: Dialect,
    mesh: Mesh,
    faces: Faces,
    /// Those of the face at hand.
    corners: Vec<Corner>,
    /// Indices that nothing had when they were read, with their line: vertices may follow the faces.
    pending: Vec<(Indexed, u32, usize)>,
    /// The first of the vertices that belong to obstacles.
    obstacle_from: Option<usize>,
    /// Whether the name that follows stands for none.
    nameless: bool,
}

impl Reader<'_> {
    fn statement(&mut self, line: &str, number: usize) -> Result<(), IoError> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => self.vertex(words, number),
            Some("vt") => self.texture_coordinate(words, number),
            Some("vn") => {
                self.normal(words);
                Ok(())
            }
            Some("f") => self.face(words, number),
            Some(word) if word == "l" || self.dialect == Dialect::Segments && word == "s" => {
                let line = self.indices(words, number, "a line", 2)?;
                self.mesh.strands.extend(line.windows(2).map(|pair| [pair[0], pair[1]]));
                self.faces.groups().for_each(|name| self.mesh.groups.add(name, line.iter().copied()));
                Ok(())
            }
            Some("p") => {
                let points = self.indices(words, number, "a point", 1)?;
                self.faces.groups().for_each(|name| self.mesh.groups.add(name, points.iter().copied()));
                self.mesh.particles.extend(points);
                Ok(())
            }
            Some(keyword) => {
                let folder = self.path.parent().unwrap_or(Path::new(""));
                let name = if std::mem::take(&mut self.nameless) { "" } else { &line[keyword.len()..] };
                self.faces.name(keyword, name.trim(), folder);
                Ok(())
            }
            None => Ok(()),
        }
    }

    fn face<'w>(&mut self, words: impl Iterator<Item = &'w str>, number: usize) -> Result<(), IoError> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in words {
            corners.push(self.corner(word, number)?);
        }
        self.check_count("a face", 3, corners.len(), number)?;
        self.faces.face(&corners, &self.mesh.triangles);
        let fan = corners[1..].windows(2).map(|pair| [corners[0].vertex, pair[0].vertex, pair[1].vertex]);
        self.mesh.triangles.extend(fan);
        self.corners = corners;
        Ok(())
    }

    /// A corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&mut self, word: &str, number: usize) -> Result<Corner, IoError> {
        let vertex = self.index(word, number)?;
        let mut rest = word.split('/').skip(1);
        let mut optional = |reader: &mut Self, indexed| match rest.next() {
            None | Some("") => Ok(None),
            Some(digits) => reader.index_of(indexed, digits, word, number).map(Some),
        };
        let texture = optional(self, Indexed::TextureCoordinate)?;
        let normal = optional(self, Indexed::Normal)?;
        if rest.next().is_some() {
            return Err(self.error(number, format!("'{word}' has more indices than v/vt/vn")));
        }
        Ok(Corner::new(vertex, texture, normal))
    }

    fn vertex<'w>(&mut self, words: impl Iterator<Item = &'w str>, number: usize) -> Result<(), IoError> {
        let mut coordinates = [0.0; 3];
        let mut count = 0;
        // A weight or a color may follow the three coordinates.
        for (slot, word) in coordinates.iter_mut().zip(words) {
            *slot = self.number(word, number)?;
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

    /// One to three numbers; the first two are kept.
    fn texture_coordinate<'w>(
        &mut self,
        words: impl Iterator<Item = &'w str>,
        number: usize,
    ) -> Result<(), IoError> {
        let mut coordinate = [0.0; 3];
        let mut count = 0;
        for (slot, word) in coordinate.iter_mut().zip(words) {
            *slot = self.number(word, number)?;
            count += 1;
        }
        if count == 0 {
            return Err(self.error(number, "a texture coordinate needs a number"));
        }
        let [u, v, _] = coordinate;
        self.faces.add_texture_coordinate([u, v]);
        Ok(())
    }

    /// Whatever stands there, since only its number counts and whether another one is equal.
    fn normal<'w>(&mut self, words: impl Iterator<Item = &'w str>) {
        let mut normal = [f64::NAN; 3];
        normal.iter_mut().zip(words).for_each(|(slot, word)| *slot = word.parse().unwrap_or(f64::NAN));
        self.faces.add_normal(normal);
    }

    /// A coordinate.
    fn number(&self, word: &str, number: usize) -> Result<f64, IoError> {
        let value: f64 = word.parse().map_err(|_| self.error(number, format!("'{word}' is not a number")))?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(number, format!("coordinate {word} is not finite")))
        }
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
        self.check_count(element, least, indices.len(), number)?;
        Ok(indices)
    }

    fn check_count(&self, element: &str, least: usize, count: usize, number: usize) -> Result<(), IoError> {
        if count >= least {
            return Ok(());
        }
        let plural = if least == 1 { "vertex" } else { "vertices" };
        Err(self.error(number, format!("{element} needs {least} {plural}, this one has {count}")))
    }

    fn index(&mut self, word: &str, number: usize) -> Result<u32, IoError> {
        self.index_of(Indexed::Vertex, word.split('/').next().unwrap_or(word), word, number)
    }

    /// The index, from 0, that `digits` of a `word` stand for.
    fn index_of(
        &mut self,
        indexed: Indexed,
        digits: &str,
        word: &str,
        number: usize,
    ) -> Result<u32, IoError> {
        let [one, many] = indexed.names();
        let index: i64 =
            digits.parse().map_err(|_| self.error(number, format!("'{word}' is not a {one} index")))?;
        let count = self.count(indexed) as i64;
        let zero_based = match index {
            0 => return Err(self.error(number, format!("{one} index 0: indices count from 1"))),
            i if i > 0 => i - 1,
            i if -i <= count => count + i,
            i => {
                let message = match count {
                    1 => format!("{one} index {i}, but only 1 {one} precedes it"),
                    count => format!("{one} index {i}, but only {count} {many} precede it"),
                };
                return Err(self.error(number, message));
            }
        };
        let zero_based = u32::try_from(zero_based)
            .ok()
            .filter(|index| *index < u32::MAX)
            .ok_or_else(|| self.error(number, format!("{one} index {index} is larger than any mesh")))?;
        if i64::from(zero_based) >= count {
            self.pending.push((indexed, zero_based, number));
        }
        Ok(zero_based)
    }

    /// How many there are so far.
    fn count(&self, indexed: Indexed) -> usize {
        match indexed {
            Indexed::Vertex => self.mesh.positions.len(),
            Indexed::TextureCoordinate => self.faces.texture_coordinates(),
            Indexed::Normal => self.faces.normals(),
        }
    }

    fn finish(mut self) -> Result<Mesh, IoError> {
        let is_missing =
            |(indexed, index, _): &&(Indexed, u32, usize)| *index as usize >= self.count(*indexed);
        if let Some(&(indexed, index, line)) = self.pending.iter().find(is_missing) {
            let ([one, many], count) = (indexed.names(), self.count(indexed));
            let has = counted(count, one, many);
            let message = format!("{one} index {}, but the file has {has}", u64::from(index) + 1);
            return Err(self.error(line, message));
        }
        let count = self.mesh.positions.len();
        if count == 0 {
            return Err(IoError::Empty { path: self.path.to_owned(), message: NO_VERTICES });
        }
        self.mesh.obstacle = self.obstacle_from.map(|first| (0..count).map(|v| v >= first).collect());
        self.mesh.surface = self.faces.finish(count, self.dialect == Dialect::Ours);
        if let Some(surface) = &self.mesh.surface {
            add_groups(surface, &mut self.mesh.groups);
        }
        Ok(self.mesh)
    }

    fn error(&self, line: usize, message: impl Into<String>) -> IoError {
        IoError::content(self.path, Place::Line(line), message)
    }
}
