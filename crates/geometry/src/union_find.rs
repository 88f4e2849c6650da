//! Disjoint sets.

/// Disjoint sets of the numbers below a count, each represented by its smallest member.
///
/// Sets and representatives do not depend on the order in which members were joined.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnionFind {
    /// A member of the same set that is at most the member itself; equal to it only at the smallest.
    parent: Vec<u32>,
}

impl UnionFind {
    /// `count` sets of one member each.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The number of members of all sets together.
    pub fn len(&self) -> usize {
        self.parent.len()
    }

    /// Whether there are no members.
    pub fn is_empty(&self) -> bool {
        self.parent.is_empty()
    }

    /// The smallest member of the set of `member`. It halves the path on the way.
    ///
    /// # Panics
    /// If `member` is not below the count.
    pub fn find(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let next = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = next;
            member = next;
        }
        member
    }

    /// The smallest member of the set of `member`, as [`Self::find`], without shortening the path.
    ///
    /// # Panics
    /// If `member` is not below the count.
    pub fn root(&self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            member = self.parent[member as usize];
        }
        member
    }

    /// Joins the sets of two members.
    ///
    /// # Panics
    /// If a member is not below the count.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_member_represents_a_set_whatever_the_order() {
        let pairs = [[5, 0], [0, 4], [4, 2], [3, 1]];
        let mut forward = UnionFind::new(7);
        pairs.iter().for_each(|&[a, b]| forward.join(a, b));
        let mut backward = UnionFind::new(7);
        pairs.iter().rev().for_each(|&[a, b]| backward.join(b, a));
        for sets in [&mut forward, &mut backward] {
            assert_eq!((0..7).map(|v| sets.root(v)).collect::<Vec<_>>(), [0, 1, 0, 1, 0, 0, 6]);
            assert_eq!((0..7).map(|v| sets.find(v)).collect::<Vec<_>>(), [0, 1, 0, 1, 0, 0, 6]);
        }
        assert_eq!(forward.len(), 7);
        assert!(UnionFind::default().is_empty());
    }
}
