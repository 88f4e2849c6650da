//! A coarse correction: every aggregate of nodes moves as a rigid body.
//!
//! Conjugate gradients are slow to find motions of large patches that hardly stretch the cloth. The columns
//! of P are the six rigid motions of each aggregate (a leaf of the numbering, [`super::ordering`]) about its
//! center at the current x. The Galerkin matrix P^T H P is factorized, and `P (P^T H P)^-1 P^T` is added to
//! the fine preconditioner. Springs join aggregates that the mesh does not join: the graph of the matrix is
//! then built anew, unless the factorization would take too long.

use super::cholesky::{Cholesky, PivotPolicy, Symbolic};
use super::lane::{Lane, Real};
use super::springs::LinearSprings;
use super::system::System;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::{Matrix3, Matrix6, Vector6};
use rayon::prelude::*;
use std::ops::{AddAssign, Range};

/// Largest number of block updates by which springs may make the factorization longer, per node and expected
/// iteration [1]. An update takes as long as an iteration of conjugate gradients takes per node, and the graph of
/// a pile of many layers is not that of a surface. Beyond this only the diagonal blocks of springs are used.
/// Larger: fewer iterations in piles, each system longer to prepare. Smaller: more iterations where solids rest
/// on each other.
const MAX_SHARE: f64 = 0.15;

/// Rigid motions of aggregates.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coarse {
    aggregates: Vec<Range<u32>>,
    /// The graph without springs.
    mesh: Graph,
    /// The graph with the springs of the current system, if they are used.
    joined: Option<Graph>,
    blocks: Vec<Matrix6<f64>>,
    factor: Cholesky<6>,
    arms: Vec<Arm>,
    aggregate_of: Vec<u32>,
    /// The last solution by aggregate, and the same in the order of the factor.
    motions: Vec<Vector6<f64>>,
    ordered: Vec<Vector6<f64>>,
}

/// The pairs of aggregates that the Galerkin matrix couples.
#[derive(Clone, Debug, Default)]
struct Graph {
    /// Neighbors of aggregate a, itself included, ascending: `neighbors[starts[a]..starts[a + 1]]`.
    starts: Vec<u32>,
    neighbors: Vec<u32>,
    symbolic: Symbolic,
}

impl Graph {
    /// From the pairs of neighbors, each in both orders, and the pairs of each aggregate with itself.
    fn new(mut pairs: Vec<[u32; 2]>, centers: &[Vector]) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        let starts: Vec<u32> =
            (0..=centers.len() as u32).map(|a| pairs.partition_point(|pair| pair[0] < a) as u32).collect();
        let neighbors: Vec<u32> = pairs.iter().map(|pair| pair[1]).collect();
        let mut graph = Self { starts, neighbors, symbolic: Symbolic::default() };
        graph.symbolic = Symbolic::new(centers, |a| graph.around(a));
        graph
    }

    fn around(&self, aggregate: usize) -> &[u32] {
        &self.neighbors[self.starts[aggregate] as usize..self.starts[aggregate + 1] as usize]
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        (0..self.starts.len() - 1).flat_map(|a| self.around(a).iter().map(move |&b| [a as u32, b]))
    }
}

impl Coarse {
    /// Prepares the graph of `aggregates`, at least one. With each node they contain all nodes that H couples
    /// to it; nodes in none of them get no correction. `rest` are the rest positions of all nodes; `row`
    /// visits the off-diagonal columns of a row of H.
    pub fn new(aggregates: &[Range<u32>], rest: &[Vector], row: impl Fn(usize, &mut dyn FnMut(u32))) -> Self {
        let mut aggregate_of = vec![0u32; rest.len()];
        for (a, range) in aggregates.iter().enumerate() {
            range.clone().for_each(|n| aggregate_of[n as usize] = a as u32);
        }
        let mut pairs = Vec::new();
        for (a, range) in aggregates.iter().enumerate() {
            pairs.push([a as u32; 2]);
            for node in range.clone() {
                row(node as usize, &mut |other| pairs.push([a as u32, aggregate_of[other as usize]]));
            }
        }
        let mesh = Graph::new(pairs, &centers(aggregates, rest));
        Self { aggregates: aggregates.to_vec(), mesh, aggregate_of, ..Self::default() }
    }

    /// Builds and factorizes the Galerkin matrix for `system` at positions `x`, for solves that are expected
    /// to take some number of `iterations`.
    pub fn build(&mut self, system: &System<'_>, x: &[Vector], iterations: usize) {
        self.place_arms(system, x);
        let most = self.mesh.symbolic.updates() + (MAX_SHARE * (iterations * x.len()) as f64) as usize;
        self.joined = system
            .springs
            .map(|springs| self.join(springs, x))
            .filter(|graph| graph.symbolic.updates() <= most);
        let couplings = system.springs.filter(|_| self.joined.is_some());
        let graph = self.joined.as_ref().unwrap_or(&self.mesh);
        self.blocks.resize(graph.neighbors.len(), Matrix6::zeros());
        let (starts, arms, aggregate_of) = (&graph.starts, &self.arms, &self.aggregate_of);
        let mut rows = Vec::with_capacity(self.aggregates.len());
        let mut rest = self.blocks.as_mut_slice();
        for (a, range) in self.aggregates.iter().enumerate() {
            let (mine, others) = rest.split_at_mut((starts[a + 1] - starts[a]) as usize);
            rows.push((mine, graph.around(a), range));
            rest = others;
        }
        rows.into_par_iter().with_min_len(4).for_each(|(blocks, around, range)| {
            blocks.fill(Matrix6::zeros());
            for node in range.start as usize..range.end as usize {
                if arms[node].free == 0.0 {
                    continue;
                }
                // The row of H P, neighbor by neighbor. Neighbors in one aggregate mostly follow each
                // other; their sum is formed before P^T is applied.
                let mut sum = RowSum { aggregate: aggregate_of[node], ..RowSum::default() };
                let mut flush = |sum: &RowSum| {
                    let slot = around.binary_search(&sum.aggregate);
                    debug_assert!(slot.is_ok(), "aggregates of coupled nodes are neighbors");
                    if let Some(block) = slot.ok().and_then(|slot| blocks.get_mut(slot)) {
                        sum.add_to(&arms[node], block);
                    }
                };
                sum.add(&system.diagonal(node), &arms[node]);
                let row = system.pattern.row(node);
                for (block, &column) in
                    system.values.blocks[row.clone()].iter().zip(&system.pattern.columns[row])
                {
                    sum.switch_to(aggregate_of[column as usize], &mut flush);
                    sum.add(block, &arms[column as usize]);
                }
                let (columns, values) = system.scalar.off_pattern(node);
                for (&column, &value) in columns.iter().zip(values) {
                    sum.switch_to(aggregate_of[column as usize], &mut flush);
                    sum.add_scalar(value, &arms[column as usize]);
                }
                if let Some(springs) = couplings {
                    springs.for_each_coupling(node, |other, block| {
                        if arms[other].free > 0.0 {
                            sum.switch_to(aggregate_of[other], &mut flush);
                            sum.add(&block, &arms[other]);
                        }
                    });
                }
                flush(&sum);
            }
        });
        let blocks = &self.blocks;
        self.factor.factorize(&graph.symbolic, PivotPolicy::Drop, |a| {
            (graph.around(a), &blocks[starts[a] as usize..starts[a + 1] as usize])
        });
    }

    /// The graph of the mesh and the springs.
    fn join(&self, springs: &LinearSprings, x: &[Vector]) -> Graph {
        let mut pairs: Vec<[u32; 2]> = self.mesh.pairs().collect();
        springs.for_each_spring(|nodes| {
            let moving = || nodes.iter().filter(|n| self.arms[**n as usize].free > 0.0);
            let aggregate = |n: &u32| self.aggregate_of[*n as usize];
            for a in moving().map(aggregate) {
                pairs.extend(moving().map(aggregate).filter(|b| *b != a).map(|b| [a, b]));
            }
        });
        Graph::new(pairs, &centers(&self.aggregates, x))
    }

    fn place_arms(&mut self, system: &System<'_>, x: &[Vector]) {
        self.arms.resize(x.len(), Arm::default());
        for range in &self.aggregates {
            let nodes = range.start as usize..range.end as usize;
            let center = x[nodes.clone()].iter().sum::<Vector>() / nodes.len() as f64;
            let size = x[nodes.clone()].iter().map(|x| (x - center).norm()).fold(f64::MIN_POSITIVE, f64::max);
            for node in nodes {
                let free = if system.free[node] { 1.0 } else { 0.0 };
                self.arms[node] = Arm { offset: (x[node] - center) * (free / size), free };
            }
        }
    }

    /// Positions of nodes relative to their aggregates, as [`Lane`]s: offsets, and 1 if the node is free.
    pub fn arms<'a, T: Real>(&'a self) -> impl IndexedParallelIterator<Item = Lane<T>> + 'a {
        self.arms.par_iter().with_min_len(CHUNK).map(|arm| Lane::from_parts(&arm.offset, arm.free))
    }

    /// Solves for the motions of the aggregates that balance `r`; [`Self::motion`] reads them. `arms` are
    /// [`Self::arms`].
    pub fn solve<T: Real>(&mut self, r: &[Lane<T>], arms: &[Lane<T>]) {
        let forces = self.aggregates.par_iter().with_min_len(32).map(|range| {
            let range = range.start as usize..range.end as usize;
            // Sums of the force and of its products with the offset: the torque is their antisymmetric part.
            let mut sums = [Lane::<T>::default(); 4];
            for (r, arm) in r[range.clone()].iter().zip(&arms[range]) {
                let arm = arm.numbers();
                (0..4).for_each(|k| sums[k] += *r * arm[k]);
            }
            let [x, y, z, force] = sums.map(|sum| sum.vector());
            Vector6::new(force.x, force.y, force.z, y.z - z.y, z.x - x.z, x.y - y.x)
        });
        forces.collect_into_vec(&mut self.motions);
        let symbolic = &self.joined.as_ref().unwrap_or(&self.mesh).symbolic;
        self.ordered.clear();
        self.ordered.extend(symbolic.order.iter().map(|&a| self.motions[a as usize]));
        self.factor.solve(symbolic, &mut self.ordered);
        for (&a, motion) in symbolic.order.iter().zip(&self.ordered) {
            self.motions[a as usize] = *motion;
        }
    }

    /// The aggregate of a node; 0 for nodes that are in none and have no arm.
    #[inline]
    pub fn aggregate_of(&self, node: usize) -> u32 {
        self.aggregate_of[node]
    }

    /// Motion of an aggregate in the last solution.
    #[inline]
    pub fn motion<T: Real>(&self, aggregate: u32) -> Motion<T> {
        let m = &self.motions[aggregate as usize];
        Motion([
            Lane::new(&Vector::new(0.0, m[5], -m[4]), 1.0),
            Lane::new(&Vector::new(-m[5], 0.0, m[3]), 1.0),
            Lane::new(&Vector::new(m[4], -m[3], 0.0), 1.0),
            Lane::new(&Vector::new(m[0], m[1], m[2]), 1.0),
        ])
    }
}

/// A rigid motion: the displacements of the three unit offsets, and the shift.
#[derive(Clone, Copy, Default)]
pub(crate) struct Motion<T: Real>([Lane<T>; 4]);

impl<T: Real> Motion<T> {
    /// Displacement of a node.
    #[inline(always)]
    pub fn displacement(&self, arm: &Lane<T>) -> Lane<T> {
        let [x, y, z, shift] = self.0;
        let arm = arm.numbers();
        x * arm[0] + y * arm[1] + z * arm[2] + shift * arm[3]
    }
}

/// Mean position of the nodes of each aggregate.
fn centers(aggregates: &[Range<u32>], x: &[Vector]) -> Vec<Vector> {
    let center = |range: &Range<u32>| {
        x[range.start as usize..range.end as usize].iter().sum::<Vector>() / range.len() as f64
    };
    aggregates.iter().map(center).collect()
}

/// A node moves with its aggregate by `free * shift + spin x offset`.
#[derive(Clone, Copy, Debug, Default)]
struct Arm {
    /// Vector from the aggregate's center to the node over the aggregate's size [1]; zero if the node is not
    /// free.
    offset: Vector,
    /// 1 if the node is free, 0 otherwise.
    free: f64,
}

/// A row of H times the columns of P of one aggregate, 3 x 6: the columns of shifts and those of spins.
#[derive(Default)]
struct RowSum {
    aggregate: u32,
    shift: Matrix3<f64>,
    spin: Matrix3<f64>,
}

impl RowSum {
    /// Starts the sum of another aggregate, unless it is the current one.
    #[inline]
    fn switch_to(&mut self, aggregate: u32, flush: &mut impl FnMut(&RowSum)) {
        if self.aggregate != aggregate {
            flush(self);
            *self = Self { aggregate, ..Self::default() };
        }
    }

    #[inline]
    fn add(&mut self, block: &Matrix3<f64>, arm: &Arm) {
        self.shift += block * arm.free;
        // The block times the spin matrix; the products with its zeros are left out.
        let [a, b, c] = [block.column(0), block.column(1), block.column(2)];
        let o = &arm.offset;
        let mut spin = |k: usize, column: Vector| self.spin.column_mut(k).add_assign(&column);
        spin(0, c * o.y - b * o.z);
        spin(1, a * o.z - c * o.x);
        spin(2, b * o.x - a * o.y);
    }

    #[inline]
    fn add_scalar(&mut self, value: f64, arm: &Arm) {
        (0..3).for_each(|k| self.shift[(k, k)] += value * arm.free);
        self.spin += spin_matrix(arm) * value;
    }

    /// Adds P_node^T times the sum to `block`.
    #[inline]
    fn add_to(&self, arm: &Arm, block: &mut Matrix6<f64>) {
        let turn = spin_matrix(arm).transpose();
        let mut part = |i: usize, j: usize, value: Matrix3<f64>| {
            let mut view = block.fixed_view_mut::<3, 3>(i, j);
            view += value;
        };
        part(0, 0, self.shift);
        part(0, 3, self.spin);
        part(3, 0, turn * self.shift);
        part(3, 3, turn * self.spin);
    }
}

/// The matrix of the map spin -> spin x offset.
#[inline]
fn spin_matrix(arm: &Arm) -> Matrix3<f64> {
    let o = &arm.offset;
    Matrix3::new(0.0, o.z, -o.y, -o.z, 0.0, o.x, o.y, -o.x, 0.0)
}

#[cfg(test)]
mod tests;
