//! The elements of a Gmsh file.

use super::cursor::{Cursor, Fault};
use super::groups::PhysicalGroups;
use super::nodes::Nodes;
use super::version::Version;
use crate::elements::{self, Becomes};
use bowknot_errors::counted;
use std::collections::BTreeMap;

/// Number of an element type, its nodes, what it becomes, its name in the plural. Gmsh reference manual, "MSH
/// file format", and `GmshDefines.h` for the numbers that the manual leaves out.
const TYPES: [(i64, usize, Becomes, &str); 33] = [
    (1, 2, Becomes::Line, "lines"),
    (2, 3, Becomes::Triangle, "triangles"),
    (3, 4, Becomes::Quad, "quadrilaterals"),
    (4, 4, Becomes::Tet, "tetrahedra"),
    (5, 8, Becomes::Nothing, "hexahedra"),
    (6, 6, Becomes::Nothing, "prisms"),
    (7, 5, Becomes::Nothing, "pyramids"),
    (8, 3, Becomes::Line, "lines of order 2"),
    (9, 6, Becomes::Triangle, "triangles of order 2"),
    (10, 9, Becomes::Quad, "quadrilaterals of order 2"),
    (11, 10, Becomes::Tet, "tetrahedra of order 2"),
    (12, 27, Becomes::Nothing, "hexahedra of order 2"),
    (13, 18, Becomes::Nothing, "prisms of order 2"),
    (14, 14, Becomes::Nothing, "pyramids of order 2"),
    (15, 1, Becomes::Point, "points"),
    (16, 8, Becomes::Quad, "quadrilaterals of order 2"),
    (17, 20, Becomes::Nothing, "hexahedra of order 2"),
    (18, 15, Becomes::Nothing, "prisms of order 2"),
    (19, 13, Becomes::Nothing, "pyramids of order 2"),
    (20, 9, Becomes::Triangle, "triangles of order 3"),
    (21, 10, Becomes::Triangle, "triangles of order 3"),
    (22, 12, Becomes::Triangle, "triangles of order 4"),
    (23, 15, Becomes::Triangle, "triangles of order 4"),
    (24, 15, Becomes::Triangle, "triangles of order 5"),
    (25, 21, Becomes::Triangle, "triangles of order 5"),
    (26, 4, Becomes::Line, "lines of order 3"),
    (27, 5, Becomes::Line, "lines of order 4"),
    (28, 6, Becomes::Line, "lines of order 5"),
    (29, 20, Becomes::Tet, "tetrahedra of order 3"),
    (30, 35, Becomes::Tet, "tetrahedra of order 4"),
    (31, 56, Becomes::Tet, "tetrahedra of order 5"),
    (92, 64, Becomes::Nothing, "hexahedra of order 3"),
    (93, 125, Becomes::Nothing, "hexahedra of order 4"),
];

/// Most tags that an element of version 2 can reasonably have; Gmsh writes 2 and, for partitions, some more.
const MOST_TAGS: i64 = 1 << 16;

/// Elements, the physical groups that they belong to, and what was not taken as it is.
#[derive(Default)]
pub(super) struct Elements {
    pub taken: elements::Elements,
    pub groups: PhysicalGroups,
    /// Number of elements of each type that was skipped or reduced to its corners.
    noted: BTreeMap<i64, usize>,
}

/// How one type of element is read.
#[derive(Clone, Copy)]
enum Reading {
    Known {
        nodes: usize,
        becomes: Becomes,
    },
    /// Of a text file, where the line tells its length.
    Unknown,
}

impl Elements {
    /// Reads the content of `$Elements`.
    pub(super) fn read(
        cursor: &mut Cursor<'_>,
        version: Version,
        nodes: &Nodes,
        groups: PhysicalGroups,
    ) -> Result<Self, Fault> {
        let mut elements = Self { groups, ..Self::default() };
        match version {
            Version::V2 if cursor.is_binary() => elements.read_v2_binary(cursor, nodes)?,
            Version::V2 => elements.read_v2_text(cursor, nodes)?,
            Version::V4 => elements.read_v4(cursor, nodes)?,
        }
        Ok(elements)
    }

    fn read_v2_text(&mut self, cursor: &mut Cursor<'_>, nodes: &Nodes) -> Result<(), Fault> {
        let count = element_count(cursor)?;
        for _ in 0..count {
            cursor.integer("an element's number")?;
            let kind = cursor.integer("an element's type")?;
            match self.reading(cursor, kind)? {
                Reading::Known { nodes: size, becomes } => {
                    let tags = cursor.integer("the number of tags")?;
                    let group = first_tag(cursor, tags)?;
                    let corners = self.element(cursor, nodes, size, becomes, Cursor::integer)?;
                    self.add_to_group(becomes, group, &corners);
                }
                Reading::Unknown => drop(cursor.line()),
            }
            self.note(kind);
        }
        Ok(())
    }

    fn read_v2_binary(&mut self, cursor: &mut Cursor<'_>, nodes: &Nodes) -> Result<(), Fault> {
        let count = element_count(cursor)?;
        let mut read = 0;
        while read < count {
            let kind = cursor.integer("a type")?;
            let following = cursor.integer("the number of elements that follow")?;
            let tags = cursor.integer("the number of tags")?;
            let following = usize::try_from(following).unwrap_or(0);
            if following == 0 || following > count - read {
                return Err(
                    cursor.fault_before(format!("{following} elements where {} are left", count - read))
                );
            }
            let Reading::Known { nodes: size, becomes } = self.reading(cursor, kind)? else { continue };
            cursor.expect(following as u64, 1 + size as u64, "elements")?;
            for _ in 0..following {
                cursor.integer("a number")?;
                let group = first_tag(cursor, tags)?;
                let corners = self.element(cursor, nodes, size, becomes, Cursor::integer)?;
                self.add_to_group(becomes, group, &corners);
                self.note(kind);
            }
            read += following;
        }
        Ok(())
    }

    fn read_v4(&mut self, cursor: &mut Cursor<'_>, nodes: &Nodes) -> Result<(), Fault> {
        let blocks = cursor.count("the number of blocks")?;
        let total = cursor.count("the number of elements")?;
        let total = cursor.expect(total, 2, "elements")?;
        let (_, _) = (cursor.count("the smallest element")?, cursor.count("the largest element")?);
        let mut read = 0;
        for _ in 0..blocks {
            let dimension = cursor.integer("an entity's dimension")?;
            let entity = cursor.integer("an entity's number")?;
            let groups = self.groups.of_entity(dimension, entity);
            let kind = cursor.integer("an element's type")?;
            let count = cursor.count("the number of elements of a block")?;
            let count = cursor.expect(count, 2, "elements")?;
            read += count;
            if read > total {
                return Err(cursor.fault_before(format!("more elements than the {total} declared")));
            }
            match self.reading(cursor, kind)? {
                Reading::Known { nodes: size, becomes } => {
                    for _ in 0..count {
                        cursor.count("an element's number")?;
                        let corners = self.element(cursor, nodes, size, becomes, |cursor, what| {
                            Ok(i64::try_from(cursor.count(what)?).unwrap_or(i64::MAX))
                        })?;
                        groups.iter().for_each(|&group| self.add_to_group(becomes, group, &corners));
                        self.note(kind);
                    }
                }
                Reading::Unknown => {
                    cursor.line();
                    for _ in 0..count {
                        if cursor.full_line().is_none_or(|line| line.starts_with('$')) {
                            return Err(cursor.fault_before("truncated: an element is expected"));
                        }
                        self.note(kind);
                    }
                }
            }
        }
        if read < total {
            return Err(cursor.fault_before(format!("{read} of the {total} declared elements")));
        }
        Ok(())
    }

    fn reading(&self, cursor: &Cursor<'_>, kind: i64) -> Result<Reading, Fault> {
        match TYPES.iter().find(|entry| entry.0 == kind) {
            Some(&(_, nodes, becomes, _)) => Ok(Reading::Known { nodes, becomes }),
            None if cursor.is_binary() => Err(cursor.fault_before(format!(
                "element type {kind} is unknown, so that its end is too: save it as text, or without such \
                 elements"
            ))),
            None => Ok(Reading::Unknown),
        }
    }

    /// Takes an element. Returns its vertices, the corners first.
    fn element<'a>(
        &mut self,
        cursor: &mut Cursor<'a>,
        nodes: &Nodes,
        size: usize,
        becomes: Becomes,
        read: impl Fn(&mut Cursor<'a>, &str) -> Result<i64, Fault>,
    ) -> Result<[u32; 4], Fault> {
        let mut corners = [0; 4];
        for k in 0..size {
            let number = read(cursor, "a node's number")?;
            let index = nodes.numbering.index(number).ok_or_else(|| {
                cursor.fault_before(format!("an element names node {number}, which $Nodes does not have"))
            })?;
            if let Some(corner) = corners.get_mut(k) {
                *corner = index;
            }
        }
        self.taken.add(becomes, &corners);
        Ok(corners)
    }

    fn add_to_group(&mut self, becomes: Becomes, group: i64, corners: &[u32; 4]) {
        let dimension = match becomes {
            Becomes::Point => 0,
            Becomes::Line => 1,
            Becomes::Triangle | Becomes::Quad => 2,
            Becomes::Tet => 3,
            Becomes::Nothing => return,
        };
        self.groups.add(dimension, group, &corners[..becomes.corners()]);
    }

    /// Counts what is not taken as it is.
    fn note(&mut self, kind: i64) {
        let is_plain = matches!(kind, 1..=4 | 15);
        if !is_plain {
            *self.noted.entry(kind).or_default() += 1;
        }
    }

    /// What was skipped or reduced to its corners, in words.
    pub(super) fn notes(&self) -> Vec<String> {
        let note = |(kind, count): (&i64, &usize)| match TYPES.iter().find(|entry| entry.0 == *kind) {
            Some((_, _, Becomes::Nothing, name)) => format!("skipped {count} {name}"),
            Some((_, _, _, name)) => format!("took the corners only of {count} {name}"),
            None => format!("skipped {} of the unknown type {kind}", counted(*count, "element", "elements")),
        };
        self.noted.iter().map(note).collect()
    }
}

fn element_count(cursor: &mut Cursor<'_>) -> Result<usize, Fault> {
    let line = cursor.line();
    let count =
        line.parse().map_err(|_| cursor.fault_before(format!("'{line}' is not the number of elements")))?;
    cursor.expect(count, 2, "elements")
}

/// The first tag of an element, its physical group; the others are skipped.
fn first_tag(cursor: &mut Cursor<'_>, tags: i64) -> Result<i64, Fault> {
    if !(0..=MOST_TAGS).contains(&tags) {
        return Err(cursor.fault_before(format!("{tags} tags; from 0 to {MOST_TAGS} are possible")));
    }
    let mut first = 0;
    for index in 0..tags {
        let tag = cursor.integer("a tag")?;
        if index == 0 {
            first = tag;
        }
    }
    Ok(first)
}
