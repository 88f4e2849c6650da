//! Union-find, with a mark for groups that something else holds.

/// Disjoint sets of 0..n. The smallest member represents its set.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    parent: Vec<usize>,
    held: Vec<bool>,
}

impl Groups {
    /// Each of 0..`count` is a group of its own.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count).collect(), held: vec![false; count] }
    }

    /// The smallest member of a group.
    pub fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    /// Joins the groups of two members.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
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
        let mut lists: Vec<Vec<usize>> = vec![Vec::new(); self.parent.len()];
        for member in 0..self.parent.len() {
            let root = self.root(member);
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
