//! Groups of things that are joined pair by pair, and which of them something else holds.

/// Disjoint sets of 0..n; the smallest member stands for its set.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    parent: Vec<usize>,
    held: Vec<bool>,
}

impl Groups {
    /// Each of 0..`count` on its own.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count).collect(), held: vec![false; count] }
    }

    fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }

    /// Makes the groups of two members one.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
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
