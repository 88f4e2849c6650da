//! A set of indices that is cleared in time proportional to its size.

/// Some of the indices `0..count`, in the order in which they were added.
#[derive(Debug, Default)]
pub(crate) struct IndexSet {
    members: Vec<u32>,
    is_member: Vec<bool>,
}

impl IndexSet {
    /// Makes the set empty, for indices below `count`.
    pub fn reset(&mut self, count: usize) {
        self.clear();
        self.is_member.resize(count, false);
    }

    /// Removes all indices.
    pub fn clear(&mut self) {
        self.members.drain(..).for_each(|index| self.is_member[index as usize] = false);
    }

    /// Adds an index; returns whether it is new.
    #[inline]
    pub fn insert(&mut self, index: u32) -> bool {
        let is_new = !std::mem::replace(&mut self.is_member[index as usize], true);
        if is_new {
            self.members.push(index);
        }
        is_new
    }

    /// Whether the set has an index.
    #[inline]
    pub fn contains(&self, index: u32) -> bool {
        self.is_member[index as usize]
    }

    /// The indices, in the order in which they were added.
    pub fn members(&self) -> &[u32] {
        &self.members
    }

    /// Keeps the indices that `keep` accepts.
    pub fn retain(&mut self, mut keep: impl FnMut(u32) -> bool) {
        let Self { members, is_member } = self;
        members.retain(|&index| {
            is_member[index as usize] = keep(index);
            is_member[index as usize]
        });
    }
}
