//! STL as text: one statement a line.

use super::{Corners, Fault};
use crate::error::Place;

/// Reads the solids of a text, one or more.
pub(super) fn parse(bytes: &[u8], corners: &mut Corners<'_>) -> Result<(), Fault> {
    // Names may be in any encoding; the numbers are ASCII.
    let text = String::from_utf8_lossy(crate::import::without_mark(bytes));
    let mut solid = Solid::default();
    for (index, line) in text.lines().enumerate() {
        solid.statement(line, corners).map_err(|message| (Place::Line(index + 1), message))?;
    }
    if solid.is_open {
        let message = "truncated: the last solid has no endsolid; add that line if the file is whole";
        return Err((Place::File, message.to_owned()));
    }
    Ok(())
}

/// Where in a solid a line stands.
#[derive(Default)]
struct Solid {
    is_open: bool,
    /// Corners of the facet at hand; none between facets.
    facet: Option<Vec<u32>>,
}

impl Solid {
    fn statement(&mut self, line: &str, corners: &mut Corners<'_>) -> Result<(), String> {
        let mut words = line.split_ascii_whitespace();
        let Some(first) = words.next() else { return Ok(()) };
        let keyword = first.to_ascii_lowercase();
        // Some programs write two words.
        let second =
            if keyword == "end" { words.next().unwrap_or("").to_ascii_lowercase() } else { String::new() };
        match (&*(keyword + &second), &mut self.facet) {
            ("solid", None) if !self.is_open => self.is_open = true,
            ("facet", None) if self.is_open => self.facet = Some(Vec::new()),
            ("outer" | "endloop", Some(_)) => {}
            ("vertex", Some(facet)) => {
                let mut raw = [0.0; 3];
                for coordinate in &mut raw {
                    let word = words.next().ok_or("the line ends before a coordinate")?;
                    *coordinate = word.parse().map_err(|_| format!("'{word}' is not a coordinate"))?;
                }
                facet.push(corners.vertex(raw)?);
            }
            ("endfacet", Some(facet)) => {
                let triangle = <[u32; 3]>::try_from(&facet[..])
                    .map_err(|_| format!("a facet has 3 vertices, this one has {}", facet.len()))?;
                corners.mesh.triangles.push(triangle);
                self.facet = None;
            }
            ("endsolid", None) if self.is_open => self.is_open = false,
            (_, facet) => {
                let place = match (self.is_open, facet) {
                    (false, _) => "between solids, where solid is expected",
                    (true, None) => "between facets, where facet or endsolid is expected",
                    (true, Some(_)) => "in a facet, where vertex or endfacet is expected",
                };
                return Err(format!("'{first}' stands {place}: not a text of STL, or a damaged one"));
            }
        }
        Ok(())
    }
}
