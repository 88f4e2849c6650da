//! Patches of nodes and the hierarchy of groups above them, for the preconditioner.
//!
//! A patch has up to 64 nodes in up to eight groups of up to eight nodes. Groups move as rigid bodies; so do
//! patches, eight successive patches, eight times as many, and so on. Nodes alone in their patch, such as
//! grains, get block-Jacobi only.

use super::layout::{CHILDREN, PATCH_SLOTS};
use bowknot_geometry::Vector;
use std::ops::Range;

/// The patches of a system.
#[derive(Debug, Default)]
pub struct Patches {
    /// Node of each slot, 64 per patch; None for an empty slot. Patches with groups come first.
    pub slots: Vec<Option<u32>>,
    /// Number of patches with groups.
    pub grouped: usize,
    /// Number of groups of each coarse level: the patches with groups, the groups of eight of them, and so on
    /// until at most eight are left. Empty if there is at most one patch with groups.
    pub levels: Vec<usize>,
}

impl Patches {
    /// Divides the `free` nodes at `positions`, range by range if `divided` is not empty.
    pub fn new(free: &[bool], positions: &[Vector], divided: &[Range<u32>]) -> Self {
        let mut patches = Self::default();
        let mut alone: Vec<u32> = Vec::new();
        let whole = 0..free.len() as u32;
        let ranges: &[Range<u32>] = if divided.is_empty() { std::slice::from_ref(&whole) } else { divided };
        for range in ranges {
            let mut nodes: Vec<u32> = range.clone().filter(|&n| free[n as usize]).collect();
            if divided.is_empty() || range.len() == 1 {
                alone.append(&mut nodes);
            } else {
                bisect(&mut nodes, positions, PATCH_SLOTS, &mut |patch| patches.add(patch, positions));
            }
        }
        patches.grouped = patches.slots.len() / PATCH_SLOTS;
        patches.slots.extend(alone.into_iter().map(Some));
        patches.slots.resize(patches.slots.len().next_multiple_of(PATCH_SLOTS), None);
        let mut count = patches.grouped;
        while count > 1 {
            patches.levels.push(count);
            count = if count <= CHILDREN { 1 } else { count.div_ceil(CHILDREN) };
        }
        patches
    }

    /// Number of patches.
    pub fn count(&self) -> usize {
        self.slots.len() / PATCH_SLOTS
    }

    /// Adds a patch with groups.
    fn add(&mut self, nodes: &mut [u32], positions: &[Vector]) {
        let start = self.slots.len();
        bisect(nodes, positions, CHILDREN, &mut |group| {
            self.slots.extend(group.iter().map(|&n| Some(n)));
            self.slots.resize(self.slots.len().next_multiple_of(CHILDREN), None);
        });
        self.slots.resize(start + PATCH_SLOTS, None);
    }
}

/// Halves `nodes` across the longest side of their box until at most `most` are left, and visits the parts.
/// Halves of at most 64 nodes have at most eight parts of at most eight.
fn bisect(nodes: &mut [u32], positions: &[Vector], most: usize, visit: &mut dyn FnMut(&mut [u32])) {
    if nodes.is_empty() {
        return;
    }
    if nodes.len() <= most {
        nodes.sort_unstable();
        visit(nodes);
        return;
    }
    let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    for &n in nodes.iter() {
        low = low.inf(&positions[n as usize]);
        high = high.sup(&positions[n as usize]);
    }
    let axis = (high - low).imax();
    let coordinate = |n: u32| positions[n as usize][axis];
    nodes.sort_unstable_by(|&a, &b| coordinate(a).total_cmp(&coordinate(b)).then(a.cmp(&b)));
    // Whole groups of the smallest size on one side, so that few slots stay empty.
    let parts = nodes.len().div_ceil(most);
    let (left, right) = nodes.split_at_mut(most * (parts / 2).max(1));
    bisect(left, positions, most, visit);
    bisect(right, positions, most, visit);
}
