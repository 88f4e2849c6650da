//! The physical groups of a Gmsh file: elements that belong together, by dimension and number.

use super::cursor::{Cursor, Fault};
use crate::groups::Groups;
use std::collections::BTreeMap;

/// Dimension, and the number among those of the dimension.
type Key = (i64, i64);

/// Physical groups, as far as they have been read.
#[derive(Default)]
pub(super) struct PhysicalGroups {
    names: BTreeMap<Key, String>,
    /// The groups of each geometrical entity, version 4.
    of_entity: BTreeMap<Key, Vec<i64>>,
    /// Vertices of their elements, as often as these have them.
    vertices: BTreeMap<Key, Vec<u32>>,
}

impl PhysicalGroups {
    /// Reads the content of `$PhysicalNames`, which is text in binary files too.
    pub(super) fn read_names(&mut self, cursor: &mut Cursor<'_>) -> Result<(), Fault> {
        let line = cursor.line();
        let count: u64 =
            line.parse().map_err(|_| cursor.fault_before(format!("'{line}' is not the number of names")))?;
        for _ in 0..count {
            let line = cursor.full_line().unwrap_or_default();
            let mut words = line.splitn(3, |c: char| c.is_ascii_whitespace());
            let mut number = || words.next().and_then(|word| word.parse().ok());
            let (dimension, number) = (number(), number());
            let name = words.next().map(|name| name.trim().trim_matches('"'));
            let (Some(dimension), Some(number), Some(name)) = (dimension, number, name) else {
                let message = format!("'{line}' is not a dimension, a number and a name");
                return Err(cursor.fault_before(message));
            };
            self.names.insert((dimension, number), name.to_owned());
        }
        Ok(())
    }

    /// Reads the content of `$Entities` of version 4: which groups each entity belongs to.
    pub(super) fn read_entities(&mut self, cursor: &mut Cursor<'_>) -> Result<(), Fault> {
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = cursor.count("the number of entities")?;
        }
        for (dimension, count) in (0..).zip(counts) {
            for _ in 0..count {
                let entity = cursor.integer("an entity's number")?;
                // A point, or the corners of a box.
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    cursor.number("a coordinate")?;
                }
                let groups = numbers(cursor, "physical groups")?;
                if !groups.is_empty() {
                    self.of_entity.insert((dimension, entity), groups);
                }
                if dimension > 0 {
                    numbers(cursor, "entities of the boundary")?;
                }
            }
        }
        Ok(())
    }

    /// The groups of an entity.
    pub(super) fn of_entity(&self, dimension: i64, entity: i64) -> Vec<i64> {
        self.of_entity.get(&(dimension, entity)).cloned().unwrap_or_default()
    }

    /// Adds vertices to a group. Number 0 stands for none, and a negative one for a reversed orientation.
    pub(super) fn add(&mut self, dimension: i64, number: i64, vertices: &[u32]) {
        if number != 0 {
            self.vertices.entry((dimension, number.saturating_abs())).or_default().extend(vertices);
        }
    }

    /// The groups by name; those without one are named as Gmsh does, such as `surface-3`.
    pub(super) fn into_groups(self) -> Groups {
        let mut groups = Groups::default();
        for (key, vertices) in self.vertices {
            let kind = ["point", "curve", "surface", "volume"].get(key.0 as usize).unwrap_or(&"group");
            let numbered = || format!("{kind}-{}", key.1);
            let name = self.names.get(&key).filter(|name| !name.is_empty()).cloned();
            groups.add(&name.unwrap_or_else(numbered), vertices);
        }
        groups
    }
}

/// Whole numbers behind their count.
fn numbers(cursor: &mut Cursor<'_>, what: &str) -> Result<Vec<i64>, Fault> {
    let count = cursor.count(&format!("the number of {what}"))?;
    cursor.expect(count, 1, what)?;
    (0..count).map(|_| cursor.integer("a number")).collect()
}
