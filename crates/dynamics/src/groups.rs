//! Groups of things that are joined pair by pair, and which of them something else holds.

use bowknot_geometry::UnionFind;

/// Disjoint sets of 0..n; the smallest member stands for its set.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    sets: UnionFind,
    held: Vec<bool>,
}

impl Groups {
    /// Each of 0..`count` on its own.
    pub fn new(count: usize) -> Self {
        Self { sets: UnionFind::new(count), held: vec![false; count] }
    }

    /// Makes the groups of two members one.
    pub fn join(&mut self, a: usize, b: usize) {
        self.sets.join(a as u32, b as u32);
    }

    /// Says that something holds a member, and so its group.
    pub fn hold(&mut self, member: usize) {
        self.held[member] = true;
    }

    /// Joins all of `members`; `holds` says whether something holds them.
    pub fn join_all(&mut self, members: impl IntoIterator<Item = usize>, holds: bool) {
        let mut members = members.into_iter();
        let Some(first) = members.next() else { return };
        self.held[first] |= holds;
        members.for_each(|member| self.join(first, member));
    }

    /// The members of each group that nothing holds, ascending, in the order of their first.
    pub fn free(mut self) -> Vec<Vec<usize>> {
        let mut lists: Vec<Vec<usize>> = vec![Vec::new(); self.held.len()];
        for member in 0..self.held.len() {
            let root = self.sets.find(member as u32) as usize;
            lists[root].push(member);
        }
        lists.retain(|list| !list.is_empty() && list.iter().all(|&member| !self.held[member]));
        lists
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_joined_stands_together_in_order() {
        let mut groups = Groups::new(6);
        groups.join(4, 1);
        groups.join(5, 4);
        groups.join_all([2, 0], false);
        assert_eq!(groups.clone().free(), [vec![0, 2], vec![1, 4, 5], vec![3]]);
        groups.hold(5);
        assert_eq!(groups.free(), [vec![0, 2], vec![3]]);
    }
}
