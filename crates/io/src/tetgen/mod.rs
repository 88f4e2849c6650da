//! TetGen's `.node` and `.ele`: points and tetrahedra in two files; Triangle writes triangles in the same way.
//!
//! Source: Si, TetGen user's manual (1.5), "File formats"; Shewchuk, Triangle, "File formats". One entry a line,
//! `#` begins a comment, numbers count from 0 or from 1.

#[cfg(test)]
mod tests;

use crate::elements::{Becomes, Elements};
use crate::error::{IoError, Place};
use crate::groups::Groups;
use crate::import::{Import, read_bytes, without_mark};
use crate::mesh::Mesh;
use crate::numbering::Numbering;
use bowknot_geometry::Point;
use std::collections::BTreeMap;
use std::path::Path;
use std::str::{FromStr, SplitAsciiWhitespace};

/// Reads the points and elements of a `.node` and the `.ele` beside it, given either: tetrahedra, or triangles
/// where there are three or six nodes for each; of more nodes the corners. Points of a plane get z = 0.
/// [`Mesh::groups`] has the points of each boundary marker but 0, such as `marker-1`, and the vertices of the
/// elements of each region but 0, such as `region-2`. Attributes of points, `.face`, `.edge` and other files are
/// not read.
///
/// # Errors
/// Either file missing, malformed or truncated, coordinates that are not finite, points that do not exist or
/// are given twice; with the line.
pub(crate) fn read_tetgen(path: &Path, import: &Import) -> Result<Mesh, IoError> {
    // The ending may be in capitals; the other file's then is.
    let is_upper = path.extension().is_some_and(|ending| ending.to_ascii_lowercase() != ending);
    let [node, ele] =
        if is_upper { ["NODE", "ELE"] } else { ["node", "ele"] }.map(|ending| path.with_extension(ending));
    let at = |path: &Path| {
        let path = path.to_owned();
        move |(place, message): Fault| IoError::content(&path, place, message)
    };
    let text = |path: &Path| -> Result<String, IoError> {
        Ok(String::from_utf8_lossy(without_mark(&read_bytes(path, import)?)).into_owned())
    };
    let mut groups = BTreeMap::new();
    let (positions, numbering) = points(&text(&node)?, import, &mut groups).map_err(at(&node))?;
    let elements = elements(&text(&ele)?, &numbering, &mut groups).map_err(at(&ele))?;
    let mut named = Groups::default();
    for ((kind, number), vertices) in groups {
        named.add(&format!("{kind}-{number}"), vertices);
    }
    Ok(elements.into_mesh(positions, named))
}

/// What is wrong, and where.
type Fault = (Place, String);

/// Vertices by what their numbers mean and the number.
type Numbered = BTreeMap<(&'static str, i64), Vec<u32>>;

fn points(text: &str, import: &Import, groups: &mut Numbered) -> Result<(Vec<Point>, Numbering), Fault> {
    let mut lines = Lines::new(text);
    let mut header = lines.next("the number of points")?;
    let count: usize = header.number("the number of points")?;
    if count == 0 {
        return Err(header.fault("its points are in another file, such as a .poly: save them as .node"));
    }
    let dimension = header.optional("the dimension", 3)?;
    if !(2..=3).contains(&dimension) {
        return Err(header.fault(format!("dimension {dimension} must be 2 or 3")));
    }
    let attributes: usize = header.optional("the number of attributes", 0)?;
    let has_markers = header.optional("the number of boundary markers", 0)? > 0;
    lines.expect(count, dimension + 1, "points")?;
    let (mut positions, mut numbers) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for index in 0..count {
        let mut line = lines.next("a point")?;
        numbers.push(line.number("the point's number")?);
        let mut raw = [0.0; 3];
        for coordinate in &mut raw[..dimension] {
            *coordinate = line.number("a coordinate")?;
        }
        positions.push(import.finite_point(raw).map_err(|message| line.fault(message))?);
        // TetGen takes missing attributes and markers for 0.
        line.skip(attributes);
        let marker: i64 =
            if has_markers { line.optional("a boundary marker, a whole number", 0)? } else { 0 };
        if marker != 0 {
            groups.entry(("marker", marker)).or_default().push(index as u32);
        }
    }
    let numbering =
        Numbering::new(numbers).map_err(|number| (Place::File, format!("point {number} is given twice")))?;
    Ok((positions, numbering))
}

fn elements(text: &str, numbering: &Numbering, groups: &mut Numbered) -> Result<Elements, Fault> {
    let mut lines = Lines::new(text);
    let mut header = lines.next("the number of elements")?;
    let count: usize = header.number("the number of elements")?;
    let size: usize = header.optional("the number of nodes of an element", 4)?;
    let becomes = match size {
        3 | 6 => Becomes::Triangle,
        4 | 10 => Becomes::Tet,
        _ => {
            let message =
                format!("{size} nodes for each element; 4 or 10 make a tetrahedron, 3 or 6 a triangle");
            return Err(header.fault(message));
        }
    };
    if count == 0 {
        return Err(header.fault("it has no elements: mesh it with tetrahedra"));
    }
    let has_regions = header.optional("the number of attributes", 0)? > 0;
    lines.expect(count, size + 1, "elements")?;
    let mut elements = Elements::default();
    let mut vertices = Vec::with_capacity(size);
    for _ in 0..count {
        let mut line = lines.next("an element")?;
        line.number::<i64>("the element's number")?;
        vertices.clear();
        for _ in 0..size {
            let number = line.number("a point's number")?;
            let index = numbering.index(number);
            vertices.push(
                index.ok_or_else(|| line.fault(format!("there is no point {number} in the .node file")))?,
            );
        }
        elements.add(becomes, &vertices);
        // TetGen writes whole numbers, Triangle those that it was given.
        let region = if has_regions { line.optional("a region, a number", 0.0)? } else { 0.0 };
        if region != 0.0 {
            groups.entry(("region", region as i64)).or_default().extend(&vertices[..becomes.corners()]);
        }
    }
    Ok(elements)
}

/// The lines of a file that are not empty, without comments.
struct Lines<'a> {
    rest: &'a str,
    /// Lines before the rest.
    number: usize,
}

/// The words of a line.
struct Line<'a> {
    words: SplitAsciiWhitespace<'a>,
    number: usize,
}

impl<'a> Lines<'a> {
    fn new(text: &'a str) -> Self {
        Self { rest: text, number: 0 }
    }

    fn next(&mut self, what: &str) -> Result<Line<'a>, Fault> {
        while !self.rest.is_empty() {
            let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
            self.rest = rest;
            self.number += 1;
            let line = line.split('#').next().unwrap_or("");
            if !line.trim_ascii().is_empty() {
                return Ok(Line { words: line.split_ascii_whitespace(), number: self.number });
            }
        }
        Err((Place::File, format!("truncated: the file ends where {what} is expected")))
    }

    /// Refuses more things of so many numbers each than the rest of the file can hold.
    fn expect(&self, count: usize, numbers: usize, what: &str) -> Result<(), Fault> {
        let left = self.rest.len();
        if count > u32::MAX as usize {
            return Err((
                Place::Line(self.number),
                format!("{count} {what}; at most {} are possible", u32::MAX),
            ));
        }
        // A digit and a blank for each number; the last may lack its line end.
        match count.checked_mul(2 * numbers).is_some_and(|needed| needed <= left + 1) {
            true => Ok(()),
            false => {
                let message = format!("truncated: {count} {what} are declared, {left} bytes are left");
                Err((Place::Line(self.number), message))
            }
        }
    }
}

impl Line<'_> {
    fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Fault> {
        let word = self.words.next().ok_or_else(|| self.fault(format!("the line ends before {what}")))?;
        word.parse().map_err(|_| self.fault(format!("'{word}' is not {what}")))
    }

    /// A number that may be missing at the end of the line.
    fn optional<T: FromStr>(&mut self, what: &str, default: T) -> Result<T, Fault> {
        let mut ahead = self.words.clone();
        if ahead.next().is_none() { Ok(default) } else { self.number(what) }
    }

    /// Skips words, or what is left of them.
    fn skip(&mut self, count: usize) {
        // Not a loop over the count, which may be any number: this ends with the line.
        if let Some(last) = count.checked_sub(1) {
            self.words.nth(last);
        }
    }

    fn fault(&self, message: impl Into<String>) -> Fault {
        (Place::Line(self.number), message.into())
    }
}
