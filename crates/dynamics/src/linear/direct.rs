//! Exact solves over strands.
//!
//! A strand of n nodes is as stiff as its edges and as light as its nodes: along it, conjugate gradients take
//! about n iterations whatever block-Jacobi does. Its part of H is a narrow band, so it is factorised instead:
//! some 2 blocks a node, no more work than a product with H. Nodes are eliminated from the far ends inwards,
//! where trees, and bending between second neighbours, fill in next to nothing.

use super::block::BlockPattern;
use super::cholesky::{Cholesky, Symbolic, Vanished};
use super::system::System;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::collections::VecDeque;

/// Least nodes of a group, the unit of parallel work: whole strands until there are as many.
const GROUP: usize = 512;

/// "No place": the node is not in any group.
const NOWHERE: (u32, u32) = (u32::MAX, 0);

/// Factors of the diagonal blocks of H over groups of strands.
#[derive(Debug, Default)]
pub(crate) struct Direct {
    groups: Vec<Group>,
    /// Group and place there, by node.
    places: Vec<(u32, u32)>,
}

#[derive(Debug, Default)]
struct Group {
    /// In the order of elimination.
    nodes: Vec<u32>,
    symbolic: Symbolic,
    /// Rows over places in the group, the diagonal first, and where their blocks stand in the pattern.
    starts: Vec<u32>,
    columns: Vec<u32>,
    slots: Vec<u32>,
    blocks: Vec<Matrix3<f64>>,
    factor: Cholesky<3>,
    x: Vec<Vector>,
}

impl Direct {
    /// Prepares the nodes that are `members`; None if none is.
    pub fn new(pattern: &BlockPattern, members: &[bool]) -> Option<Self> {
        let mut direct = Self { groups: Vec::new(), places: vec![NOWHERE; members.len()] };
        let mut seen = vec![false; members.len()];
        let mut nodes = Vec::new();
        for first in 0..members.len() {
            if members[first] && !seen[first] {
                append_component(pattern, members, first as u32, &mut seen, &mut nodes);
            }
            if nodes.len() >= GROUP || (first + 1 == members.len() && !nodes.is_empty()) {
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

    /// Factorises for `system`; nodes that are not free count as the identity.
    pub fn build(&mut self, system: &System<'_>) {
        self.groups.par_iter_mut().for_each(|group| group.build(system));
    }

    /// Solves for `r`; read with [`Self::displacement`].
    pub fn solve(&mut self, r: &[Vector]) {
        self.groups.par_iter_mut().for_each(|group| {
            group.x.clear();
            group.x.extend(group.nodes.iter().map(|&n| r[n as usize]));
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
        self.factor.factorise(&self.symbolic, Vanished::Floored, |k| {
            let range = starts[k] as usize..starts[k + 1] as usize;
            (&columns[range.clone()], &blocks[range])
        });
    }
}

/// Appends the members that are joined with `first`, farthest first.
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
    // Again from the last one reached, an end of the strand.
    let order = breadth_first(first, seen);
    order.iter().for_each(|&n| seen[n as usize] = false);
    let order = breadth_first(order[order.len() - 1], seen);
    nodes.extend(order.iter().rev());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::block::BlockValues;
    use crate::linear::scalar::ScalarBuilder;

    #[test]
    fn strands_are_solved_exactly_and_fill_in_little() {
        // Two strands of 30 with links to first and second neighbours, the one with a branch of 5, and a node
        // beside them; some nodes are held.
        let count = 66u32;
        let pattern = BlockPattern::from_cliques(count as usize, |visit| {
            (0..28).for_each(|k| visit(&[k, k + 1, k + 2]));
            (30..58).for_each(|k| visit(&[k, k + 1, k + 2]));
            visit(&[40, 60, 61]);
            (60..63).for_each(|k| visit(&[k, k + 1, k + 2]));
        });
        let mut values = BlockValues::zeros(&pattern);
        for row in 0..count {
            values.diagonal[row as usize] = Matrix3::from_diagonal_element(9.0);
            for k in pattern.row(row as usize) {
                let column = pattern.columns[k];
                let (low, high) = (row.min(column), row.max(column));
                let block =
                    Matrix3::from_fn(|i, j| ((low * 7 + high * 3 + 3 * i as u32 + j as u32) as f64).sin());
                values.blocks[k] = if row < column { block } else { block.transpose() };
            }
        }
        let scalar = ScalarBuilder::new(count as usize).build().split(&pattern);
        let free: Vec<bool> = (0..count).map(|k| k != 0 && k != 45).collect();
        let system =
            System { pattern: &pattern, values: &values, scalar: &scalar, repulsion: None, free: &free };
        let members: Vec<bool> = (0..count).map(|k| k != 65).collect();
        let mut direct = Direct::new(&pattern, &members).expect("strands");
        assert_eq!(direct.groups.len(), 1);
        assert!(direct.groups[0].symbolic.fill() <= 3 * 65, "{}", direct.groups[0].symbolic.fill());

        direct.build(&system);
        let solution: Vec<Vector> = (0..count as usize)
            .map(|k| {
                if free[k] && members[k] {
                    Vector::new(1.0 + k as f64, (k as f64).cos(), 2.0)
                } else {
                    Vector::zeros()
                }
            })
            .collect();
        let mut r = vec![Vector::zeros(); count as usize];
        system.multiply(&solution, &mut r);
        direct.solve(&r);
        for k in 0..65 {
            let found = direct.displacement(k).expect("a member");
            assert!((found - solution[k]).norm() < 1e-11, "{k}: {found} {}", solution[k]);
        }
        assert_eq!(direct.displacement(65), None);
        assert!(Direct::new(&pattern, &[false; 66]).is_none());
    }
}
