//! The nodes of a Gmsh file and their numbers.

use super::cursor::{Cursor, Fault};
use super::version::Version;
use crate::import::Import;
use crate::numbering::Numbering;
use bowknot_geometry::Point;

/// Nodes in the order of the file.
pub(super) struct Nodes {
    /// Positions [m].
    pub positions: Vec<Point>,
    /// The file's numbers for them.
    pub numbering: Numbering,
}

impl Nodes {
    /// Reads the content of `$Nodes`.
    pub(super) fn read(cursor: &mut Cursor<'_>, version: Version, import: &Import) -> Result<Self, Fault> {
        let mut numbers = Vec::new();
        let mut positions = Vec::new();
        match version {
            Version::V2 => {
                let line = cursor.line();
                let count = line
                    .parse()
                    .map_err(|_| cursor.fault_before(format!("'{line}' is not the number of nodes")))?;
                let count = limited(cursor, count)?;
                numbers.reserve(count);
                positions.reserve(count);
                for _ in 0..count {
                    let number = cursor.integer("a node's number")?;
                    numbers.push(number);
                    positions.push(point(cursor, import, number)?);
                }
            }
            Version::V4 => {
                let blocks = cursor.count("the number of blocks")?;
                let total = cursor.count("the number of nodes")?;
                let total = limited(cursor, total)?;
                let (_, _) = (cursor.count("the smallest node")?, cursor.count("the largest node")?);
                numbers.reserve(total);
                positions.reserve(total);
                for _ in 0..blocks {
                    let dimension = cursor.integer("an entity's dimension")?;
                    cursor.integer("an entity's number")?;
                    let parametric = cursor.integer("0 or 1 for parameters")? != 0;
                    let count = cursor.count("the number of nodes of a block")?;
                    let count = limited(cursor, count)?;
                    if numbers.len() + count > total {
                        return Err(cursor.fault_before(format!("more nodes than the {total} declared")));
                    }
                    let first = numbers.len();
                    for _ in 0..count {
                        let number = cursor.count("a node's number")?;
                        numbers.push(i64::try_from(number).unwrap_or(i64::MAX));
                    }
                    for k in 0..count {
                        positions.push(point(cursor, import, numbers[first + k])?);
                        // Parameters on the curve or surface that the node lies on.
                        for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                            cursor.number("a parameter")?;
                        }
                    }
                }
                if numbers.len() < total {
                    return Err(
                        cursor.fault_before(format!("{} of the {total} declared nodes", numbers.len()))
                    );
                }
            }
        }
        let numbering = Numbering::new(numbers)
            .map_err(|number| cursor.fault_before(format!("node {number} is given twice")))?;
        Ok(Self { positions, numbering })
    }
}

/// A number of nodes that the file can hold and an index can name.
fn limited(cursor: &Cursor<'_>, count: u64) -> Result<usize, Fault> {
    if count > u64::from(u32::MAX) {
        return Err(cursor.fault_before(format!("{count} nodes; at most {} are possible", u32::MAX)));
    }
    cursor.expect(count, 4, "nodes")
}

fn point(cursor: &mut Cursor<'_>, import: &Import, number: i64) -> Result<Point, Fault> {
    let mut raw = [0.0; 3];
    for coordinate in &mut raw {
        *coordinate = cursor.number("a coordinate")?;
    }
    let point = import.point(raw);
    if point.iter().all(|c| c.is_finite()) {
        Ok(point)
    } else {
        Err(cursor.fault_before(format!("coordinates {raw:?} of node {number} are not finite")))
    }
}
