//! Springs between nodes as a part of the Newton system, see [`super::system`].
//!
//! A spring acts on the weighted sum s = sum beta_i x_i of up to four nodes, with a force and a 3 x 3 Hessian
//! over s. The Hessian over all nodes is applied without being stored: a product first computes the reaction
//! of each spring, then each node gathers the reactions of its springs. Preconditioners ask for single
//! blocks.

use crate::nodes::{CHUNK, NO_NODE};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// A linearized spring.
#[derive(Clone, Copy, Debug)]
pub struct LinearSpring {
    /// `u32::MAX` for vertices of obstacles and vertices with weight 0.
    pub nodes: [u32; 4],
    /// The weights beta [1].
    pub weights: [f64; 4],
    /// Second derivative of the energy by s [N/m].
    pub hessian: Matrix3<f64>,
    /// Minus the derivative of the energy by s [N].
    pub force: Vector,
}

/// The active springs, linearized.
#[derive(Clone, Debug, Default)]
pub(crate) struct LinearSprings {
    springs: Vec<LinearSpring>,
    /// Springs of each node with the node's weight: `entries[starts[n]..starts[n + 1]]`.
    starts: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

impl LinearSprings {
    /// No springs.
    pub fn new(node_count: usize) -> Self {
        Self { springs: Vec::new(), starts: vec![0; node_count + 1], entries: Vec::new() }
    }

    /// Replaces the springs; `fill` overwrites the vector that holds them.
    pub fn set(&mut self, fill: impl FnOnce(&mut Vec<LinearSpring>)) {
        fill(&mut self.springs);
        // Counting sort by node: entries of a node stay in the order of springs.
        self.starts.fill(0);
        for &node in self.springs.iter().flat_map(|s| &s.nodes).filter(|node| **node != NO_NODE) {
            self.starts[node as usize + 1] += 1;
        }
        (1..self.starts.len()).for_each(|n| self.starts[n] += self.starts[n - 1]);
        let mut next = self.starts.clone();
        self.entries.clear();
        self.entries.resize(next.last().map_or(0, |end| *end as usize), (0, 0.0));
        for (index, spring) in self.springs.iter().enumerate() {
            for (&node, weight) in spring.nodes.iter().zip(spring.weights) {
                if node != NO_NODE {
                    let slot = &mut next[node as usize];
                    self.entries[*slot as usize] = (index as u32, weight);
                    *slot += 1;
                }
            }
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.springs.is_empty()
    }

    /// The diagonal block of a node [N/m].
    pub fn block(&self, node: usize) -> Matrix3<f64> {
        self.entries(node).iter().fold(Matrix3::zeros(), |sum, &(spring, weight)| {
            sum + self.springs[spring as usize].hessian * (weight * weight)
        })
    }

    /// A node's share of the gradient [N].
    pub fn gradient(&self, node: usize) -> Vector {
        self.entries(node).iter().fold(Vector::zeros(), |sum, &(spring, weight)| {
            sum - self.springs[spring as usize].force * weight
        })
    }

    /// The reaction of each spring to displacements `x` of the nodes: Hessian times sum beta_i x_i.
    pub fn reactions(&self, x: &[Vector]) -> Vec<Vector> {
        let reaction = |spring: &LinearSpring| {
            let mut sum = Vector::zeros();
            for (&node, weight) in spring.nodes.iter().zip(spring.weights) {
                if node != NO_NODE {
                    sum += x[node as usize] * weight;
                }
            }
            spring.hessian * sum
        };
        self.springs.par_iter().with_min_len(CHUNK).map(reaction).collect()
    }

    /// A node's row of the Hessian times the displacements that the [`Self::reactions`] were computed from.
    #[inline]
    pub fn row_product(&self, node: usize, reactions: &[Vector]) -> Vector {
        self.entries(node)
            .iter()
            .fold(Vector::zeros(), |sum, &(spring, weight)| sum + reactions[spring as usize] * weight)
    }

    /// Calls `visit` with each off-diagonal block of a row and its column.
    pub fn for_each_coupling(&self, node: usize, mut visit: impl FnMut(usize, Matrix3<f64>)) {
        for &(spring, weight) in self.entries(node) {
            let spring = &self.springs[spring as usize];
            for (&other, other_weight) in spring.nodes.iter().zip(spring.weights) {
                if other != NO_NODE && other as usize != node {
                    visit(other as usize, spring.hessian * (weight * other_weight));
                }
            }
        }
    }

    /// Calls `visit` with the nodes of each spring.
    pub fn for_each_spring(&self, mut visit: impl FnMut(&[u32])) {
        self.springs
            .iter()
            .for_each(|spring| visit_nodes(&spring.nodes, &spring.weights, |nodes, _| visit(nodes)));
    }

    /// All springs.
    pub fn all(&self) -> &[LinearSpring] {
        &self.springs
    }

    /// Springs and weights of all nodes, node by node: those of a node are in its [`Self::entry_range`].
    pub fn all_entries(&self) -> &[(u32, f64)] {
        &self.entries
    }

    /// Where the springs of each node begin, and the number of all entries.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Where the springs of a node stand.
    #[inline]
    pub fn entry_range(&self, node: usize) -> std::ops::Range<usize> {
        self.starts[node] as usize..self.starts[node + 1] as usize
    }

    fn entries(&self, node: usize) -> &[(u32, f64)] {
        &self.entries[self.entry_range(node)]
    }
}

/// Calls `visit` with the nodes of a spring, and whether an obstacle or a half-space holds them: their
/// weights then do not sum to 0.
pub(crate) fn visit_nodes(nodes: &[u32; 4], weights: &[f64; 4], visit: impl FnOnce(&[u32], bool)) {
    let mut joined = [NO_NODE; 4];
    let (mut count, mut sum) = (0, 0.0);
    for (&node, weight) in nodes.iter().zip(weights) {
        if node != NO_NODE {
            joined[count] = node;
            count += 1;
            sum += weight;
        }
    }
    visit(&joined[..count], sum.abs() > 1e-9);
}
