//! Named sets of vertices.

use std::collections::BTreeMap;

/// Sets of vertices by name, such as the hem of a skirt: groups, physical names and markers of mesh files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    /// Each ascending, without repetition.
    sets: BTreeMap<String, Vec<u32>>,
}

impl Groups {
    /// The vertices of a group, ascending; none if there is no such group.
    pub fn get(&self, name: &str) -> Option<&[u32]> {
        self.sets.get(name).map(Vec::as_slice)
    }

    /// The groups by name, each with its vertices, ascending.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[u32])> {
        self.sets.iter().map(|(name, vertices)| (name.as_str(), vertices.as_slice()))
    }

    /// Whether there is no group.
    pub fn is_empty(&self) -> bool {
        self.sets.is_empty()
    }

    /// Adds vertices to a group, which begins to be if it is not there.
    pub fn add(&mut self, name: &str, vertices: impl IntoIterator<Item = u32>) {
        let set = match self.sets.get_mut(name) {
            Some(set) => set,
            None => self.sets.entry(name.to_owned()).or_default(),
        };
        set.extend(vertices);
        set.sort_unstable();
        set.dedup();
    }

    /// Drops the groups without vertices.
    pub fn drop_empty(&mut self) {
        self.sets.retain(|_, vertices| !vertices.is_empty());
    }

    /// Gives each vertex another number; those without one leave their groups, which stay even if nothing is
    /// left of them.
    pub fn renumber(&mut self, number: impl Fn(u32) -> Option<u32>) {
        for set in self.sets.values_mut() {
            *set = set.iter().filter_map(|&v| number(v)).collect();
            set.sort_unstable();
            set.dedup();
        }
    }
}
