//! Exact solves over strands.
//!
//! The edges of a strand are very stiff compared with the inertia of its nodes. Conjugate gradients with
//! block-Jacobi therefore take about n iterations for a strand of n nodes. Its part of H is a narrow band,
//! which is factorized instead: some 2 blocks per node, no more work than a product with H. Nodes are
//! eliminated from the far ends inwards: in that order trees, and bending between second neighbors, cause
//! hardly any fill-in.

use super::block::BlockPattern;
use super::cholesky::{Cholesky, PivotPolicy, Symbolic};
use super::lane::{Lane, Real};
use super::system::System;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::collections::VecDeque;

/// Smallest number of nodes in a group, the unit of parallel work: a group takes whole strands until it has
/// as many.
const MIN_GROUP_NODES: usize = 512;

/// Place of a node that is in no group.
const NO_PLACE: (u32, u32) = (u32::MAX, 0);

/// Factors of the diagonal blocks of H over groups of strands.
#[derive(Debug, Default)]
pub(crate) struct Direct {
    groups: Vec<Group>,
    /// Group of each node and the node's place in it.
    places: Vec<(u32, u32)>,
}

#[derive(Debug, Default)]
struct Group {
    /// In the order of elimination.
    nodes: Vec<u32>,
    symbolic: Symbolic,
    /// Compressed rows over places in the group, each with its diagonal first, and the index of each block in
    /// the pattern.
    starts: Vec<u32>,
    columns: Vec<u32>,
    slots: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
    factor: Cholesky<3>,
    x: Vec<Vector>,
}

impl Direct {
    /// Prepares the nodes that are `members`; None if there are none.
    pub fn new(pattern: &BlockPattern, members: &[bool]) -> Option<Self> {
        let mut direct = Self { groups: Vec::new(), places: vec![NO_PLACE; members.len()] };
        let mut seen = vec![false; members.len()];
        let mut nodes = Vec::new();
        for first in 0..members.len() {
            if members[first] && !seen[first] {
                append_component(pattern, members, first as u32, &mut seen, &mut nodes);
            }
            if nodes.len() >= MIN_GROUP_NODES || (first + 1 == members.len() && !nodes.is_empty()) {
                direct.add_group(pattern, std::mem::take(&mut nodes));
            }
        }
        (!direct.groups.is_empty()).then_some(direct)
    }

    fn add_group(&mut self, pattern: &BlockPattern, nodes: Vec<u32>) {
        let index = self.groups.len() as u32;
        nodes.iter().enumerate().for_each(|(k, &n)| self.places[n as usize] = (index, k as u32));
        let mut group = Group { starts: vec![0], ..Group::default() };
        for (place, &node) in nodes.iter().enumerate() {
            group.columns.push(place as u32);
            group.slots.push(u32::MAX);
            for slot in pattern.row(node as usize) {
                let (owner, other) = self.places[pattern.columns[slot] as usize];
                if owner == index {
                    group.columns.push(other);
                    group.slots.push(slot as u32);
                }
            }
            group.starts.push(group.columns.len() as u32);
        }
        group.symbolic =
            Symbolic::in_order((0..nodes.len() as u32).collect(), |k| &group.columns[group.range(k)]);
        group.blocks = vec![Matrix3::zeros(); group.columns.len()];
        group.nodes = nodes;
        self.groups.push(group);
    }

    /// Factorizes the blocks of `system`; rows of nodes that are not free are those of the identity.
    pub fn build(&mut self, system: &System<'_>) {
        self.groups.par_iter_mut().for_each(|group| group.build(system));
    }

    /// Solves with the right-hand side `r`; [`Self::displacement`] reads the solution.
    pub fn solve<T: Real>(&mut self, r: &[Lane<T>]) {
        self.groups.par_iter_mut().for_each(|group| {
            group.x.clear();
            group.x.extend(group.nodes.iter().map(|&n| r[n as usize].vector()));
            group.factor.solve(&group.symbolic, &mut group.x);
        });
    }

    /// The last solution at a node; None if it belongs to no strand.
    #[inline]
    pub fn displacement(&self, node: usize) -> Option<Vector> {
        let (group, place) = self.places[node];
        self.groups.get(group as usize).map(|group| group.x[place as usize])
    }
}

impl Group {
    fn range(&self, place: usize) -> std::ops::Range<usize> {
        self.starts[place] as usize..self.starts[place + 1] as usize
    }

    fn build(&mut self, system: &System<'_>) {
        for (place, &node) in self.nodes.iter().enumerate() {
            let free = system.free[node as usize];
            for k in self.range(place) {
                let other = self.nodes[self.columns[k] as usize];
                self.blocks[k] = match self.slots[k] {
                    u32::MAX if free => system.diagonal(node as usize),
                    u32::MAX => Matrix3::identity(),
                    slot if free && system.free[other as usize] => system.values.blocks[slot as usize],
                    _ => Matrix3::zeros(),
                };
            }
        }
        let (starts, columns, blocks) = (&self.starts, &self.columns, &self.blocks);
        self.factor.factorize(&self.symbolic, PivotPolicy::Raise, |k| {
            let range = starts[k] as usize..starts[k + 1] as usize;
            (&columns[range.clone()], &blocks[range])
        });
    }
}

/// Appends the members that are connected with `first`, in descending distance from one end of the strand.
fn append_component(
    pattern: &BlockPattern,
    members: &[bool],
    first: u32,
    seen: &mut [bool],
    nodes: &mut Vec<u32>,
) {
    let breadth_first = |from: u32, seen: &mut [bool]| {
        let mut order = Vec::new();
        let mut queue = VecDeque::from([from]);
        seen[from as usize] = true;
        while let Some(node) = queue.pop_front() {
            order.push(node);
            for &next in &pattern.columns[pattern.row(node as usize)] {
                if members[next as usize] && !seen[next as usize] {
                    seen[next as usize] = true;
                    queue.push_back(next);
                }
            }
        }
        order
    };
    // Search once more from the last node reached, which is an end of the strand.
    let order = breadth_first(first, seen);
    order.iter().for_each(|&n| seen[n as usize] = false);
    let order = breadth_first(order[order.len() - 1], seen);
    nodes.extend(order.iter().rev());
}

#[cfg(test)]
mod tests;
