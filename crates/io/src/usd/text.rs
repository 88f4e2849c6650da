//! Values as `.usda` writes them.

use bowknot_geometry::Point;
use std::fmt::Debug;
use std::io::{Result, Write};

/// An attribute of a list of plain values.
pub(super) fn write_list(
    out: &mut impl Write,
    name: &str,
    values: impl IntoIterator<Item = impl Debug>,
) -> Result<()> {
    write!(out, "        {name} = [")?;
    for (k, value) in values.into_iter().enumerate() {
        write!(out, "{}{value:?}", separator(k))?;
    }
    out.write_all(b"]\n")
}

/// Single precision, in the fewest digits that are read back the same.
pub(super) fn write_point(out: &mut impl Write, index: usize, point: &Point) -> Result<()> {
    let [x, y, z] = [point.x as f32, point.y as f32, point.z as f32];
    write!(out, "{}({x:?}, {y:?}, {z:?})", separator(index))
}

/// What stands before an entry of a list.
pub(super) fn separator(index: usize) -> &'static str {
    if index == 0 { "" } else { ", " }
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> String {
    let plain: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("\"{}\"", plain.replace('\\', "\\\\").replace('"', "\\\""))
}
