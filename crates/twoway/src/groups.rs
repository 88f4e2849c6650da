//! Groups of pinned vertices that move together.

use crate::input::ResolveInput;

/// The groups of a call, numbered from 0. Obstacles move together anyway, so their vertices are in none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    /// Group of each vertex, [`ResolveInput::NO_GROUP`] for none. Empty: no groups.
    of_vertices: Vec<u32>,
    /// The caller's names of the groups, ascending.
    names: Vec<u32>,
}

impl Groups {
    /// The groups of the `prescribed` vertices, by the caller's names. `given` may be empty.
    pub(crate) fn new(given: &[u32], prescribed: &[bool], is_obstacle: impl Fn(usize) -> bool) -> Self {
        let is_grouped = |v: usize| given[v] != ResolveInput::NO_GROUP && prescribed[v];
        let mut names: Vec<u32> = (0..given.len()).filter(|&v| is_grouped(v)).map(|v| given[v]).collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            return Self::default();
        }
        let number = |v: usize| {
            if is_grouped(v) && !is_obstacle(v) {
                names.binary_search(&given[v]).map_or(ResolveInput::NO_GROUP, |number| number as u32)
            } else {
                ResolveInput::NO_GROUP
            }
        };
        Self { of_vertices: (0..given.len()).map(number).collect(), names }
    }

    /// Group of each vertex, [`ResolveInput::NO_GROUP`] for none. Empty: no groups.
    pub fn of_vertices(&self) -> &[u32] {
        &self.of_vertices
    }

    /// The group of a vertex.
    pub fn of(&self, vertex: usize) -> Option<u32> {
        self.of_vertices.get(vertex).copied().filter(|&group| group != ResolveInput::NO_GROUP)
    }

    /// Number of groups.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// The caller's name of the group of a vertex.
    pub fn name_of(&self, vertex: usize) -> Option<u32> {
        self.of(vertex).and_then(|group| self.names.get(group as usize).copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_those_of_prescribed_vertices_without_obstacles() {
        const NONE: u32 = ResolveInput::NO_GROUP;
        let prescribed = [true, true, true, false, true];
        let groups = Groups::new(&[7, 7, 3, 3, NONE], &prescribed, |v| v == 1);
        assert_eq!(groups.of_vertices(), [1, NONE, 0, NONE, NONE]);
        assert_eq!(groups.count(), 2);
        assert_eq!((groups.name_of(0), groups.name_of(1), groups.name_of(2)), (Some(7), None, Some(3)));
        assert_eq!(Groups::new(&[], &prescribed, |_| false), Groups::default());
        assert_eq!(Groups::new(&[NONE; 5], &prescribed, |_| false).count(), 0);
    }
}
