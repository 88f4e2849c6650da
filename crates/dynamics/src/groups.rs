//! Union-find, with a mark for groups that something else holds.

use bowknot_geometry::UnionFind;

/// Disjoint sets of 0..n. The smallest member represents its set.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    sets: UnionFind,
    held: Vec<bool>,
}

impl Groups {
    /// Each of 0..`count` is a group of its own.
    pub fn new(count: usize) -> Self {
        Self { sets: UnionFind::new(count), held: vec![false; count] }
    }

    /// Joins the groups of two members.
    pub fn join(&mut self, a: usize, b: usize) {
        self.sets.join(a as u32, b as u32);
    }

    /// Marks a member, and thereby its group, as held by something else.
    pub fn hold(&mut self, member: usize) {
        self.held[member] = true;
    }

    /// Joins all of `members`; `held` says whether something else holds them.
    pub fn join_all(&mut self, members: impl IntoIterator<Item = usize>, held: bool) {
        let mut members = members.into_iter();
        let Some(first) = members.next() else { return };
        self.held[first] |= held;
        members.for_each(|member| self.join(first, member));
    }

    /// The members of each group that nothing holds, ascending, in the order of the smallest members.
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
    fn groups_are_sorted_and_held_ones_are_left_out() {
        let mut groups = Groups::new(6);
        groups.join(4, 1);
        groups.join(5, 4);
        groups.join_all([2, 0], false);
        assert_eq!(groups.clone().free(), [vec![0, 2], vec![1, 4, 5], vec![3]]);
        groups.hold(5);
        assert_eq!(groups.free(), [vec![0, 2], vec![3]]);
    }
}
