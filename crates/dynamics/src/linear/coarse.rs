//! A coarse correction: every aggregate of nodes moves as a rigid body.
//!
//! What conjugate gradients find slowly are motions of large patches that hardly stretch the cloth.
//! Each aggregate (a leaf of the numbering, [`super::ordering`]) gets the six rigid motions about
//! its centre at the current x, P; the Galerkin matrix P^T H P is factorised, and
//! `P (P^T H P)^-1 P^T` is added to the fine preconditioner. Repulsion joins aggregates that the mesh does not:
//! where there is any, the matrix's graph is made anew, unless that fills the factor.

use super::cholesky::{Cholesky, Symbolic, Vanished};
use super::system::System;
use crate::repulsion::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::{Matrix3, Matrix6, Vector6};
use rayon::prelude::*;
use std::ops::{AddAssign, Range};

/// Most fill of a factor with repulsion, in that of the mesh's: a heap of many layers is no surface, and its factor costs
/// more than it saves. Without, springs count with their diagonal blocks.
const MOST_FILL: usize = 8;

/// Rigid motions of aggregates.
#[derive(Clone, Debug, Default)]
pub(crate) struct Coarse {
    aggregates: Vec<Range<u32>>,
    /// Without repulsion.
    mesh: Graph,
    /// With that of the present system, if it has any.
    joined: Option<Graph>,
    blocks: Vec<Matrix6<f64>>,
    factor: Cholesky<6>,
    arms: Vec<Arm>,
    aggregate_of: Vec<u32>,
    /// The last solution by aggregate, and in the order of the factor.
    motions: Vec<Vector6<f64>>,
    ordered: Vec<Vector6<f64>>,
}

/// Which aggregates the Galerkin matrix joins.
#[derive(Clone, Debug, Default)]
struct Graph {
    /// Aggregates next to each, itself included, ascending: `neighbours[starts[a]..starts[a + 1]]`.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    symbolic: Symbolic,
}

impl Graph {
    /// From pairs of aggregates that are neighbours, in both orders, each aggregate with itself included.
    fn new(mut pairs: Vec<[u32; 2]>, centres: &[Vector]) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        let starts: Vec<u32> =
            (0..=centres.len() as u32).map(|a| pairs.partition_point(|pair| pair[0] < a) as u32).collect();
        let neighbours: Vec<u32> = pairs.iter().map(|pair| pair[1]).collect();
        let mut graph = Self { starts, neighbours, symbolic: Symbolic::default() };
        graph.symbolic = Symbolic::new(centres, |a| graph.around(a));
        graph
    }

    fn around(&self, aggregate: usize) -> &[u32] {
        &self.neighbours[self.starts[aggregate] as usize..self.starts[aggregate + 1] as usize]
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        (0..self.starts.len() - 1).flat_map(|a| self.around(a).iter().map(move |&b| [a as u32, b]))
    }
}

impl Coarse {
    /// Prepares the graph of `aggregates`, at least one, ranges that cover what H joins with them; other
    /// nodes are left out. `rest` are the nodes' rest positions, `row` visits the off-diagonal columns of a
    /// row of H.
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
        let mesh = Graph::new(pairs, &centres(aggregates, rest));
        Self { aggregates: aggregates.to_vec(), mesh, aggregate_of, ..Self::default() }
    }

    /// Builds and factorises the Galerkin matrix for `system` at positions `x`.
    pub fn build(&mut self, system: &System<'_>, x: &[Vector]) {
        self.place_arms(system, x);
        self.joined = system
            .repulsion
            .map(|repulsion| self.join(repulsion, x))
            .filter(|graph| graph.symbolic.fill() <= MOST_FILL * self.mesh.symbolic.fill().max(1));
        let couplings = system.repulsion.filter(|_| self.joined.is_some());
        let graph = self.joined.as_ref().unwrap_or(&self.mesh);
        self.blocks.resize(graph.neighbours.len(), Matrix6::zeros());
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
                // The row of H P, neighbour by neighbour: those of one aggregate mostly follow each
                // other, and are summed before P^T is applied.
                let mut sum = RowSum { aggregate: aggregate_of[node], ..RowSum::default() };
                let mut flush = |sum: &RowSum| {
                    let slot = around.binary_search(&sum.aggregate);
                    debug_assert!(slot.is_ok(), "aggregates of neighbours are neighbours");
                    if let Some(block) = slot.ok().and_then(|slot| blocks.get_mut(slot)) {
                        sum.add_to(&arms[node], block);
                    }
                };
                sum.add(&system.diagonal(node), &arms[node]);
                let row = system.pattern.row(node);
                for (block, &column) in
                    system.values.blocks[row.clone()].iter().zip(&system.pattern.columns[row])
                {
                    sum.turn_to(aggregate_of[column as usize], &mut flush);
                    sum.add(block, &arms[column as usize]);
                }
                let (columns, values) = system.scalar.far(node);
                for (&column, &value) in columns.iter().zip(values) {
                    sum.turn_to(aggregate_of[column as usize], &mut flush);
                    sum.add_scalar(value, &arms[column as usize]);
                }
                if let Some(repulsion) = couplings {
                    repulsion.for_each_coupling(node, |other, block| {
                        if arms[other].free > 0.0 {
                            sum.turn_to(aggregate_of[other], &mut flush);
                            sum.add(&block, &arms[other]);
                        }
                    });
                }
                flush(&sum);
            }
        });
        let blocks = &self.blocks;
        self.factor.factorise(&graph.symbolic, Vanished::Dropped, |a| {
            (graph.around(a), &blocks[starts[a] as usize..starts[a + 1] as usize])
        });
    }

    /// The graph with the aggregates joined that springs join.
    fn join(&self, repulsion: &Repulsion, x: &[Vector]) -> Graph {
        let mut pairs: Vec<[u32; 2]> = self.mesh.pairs().collect();
        repulsion.for_each_bond(|nodes, _| {
            let moving = || nodes.iter().filter(|n| self.arms[**n as usize].free > 0.0);
            let aggregate = |n: &u32| self.aggregate_of[*n as usize];
            for a in moving().map(aggregate) {
                pairs.extend(moving().map(aggregate).filter(|b| *b != a).map(|b| [a, b]));
            }
        });
        Graph::new(pairs, &centres(&self.aggregates, x))
    }

    fn place_arms(&mut self, system: &System<'_>, x: &[Vector]) {
        self.arms.resize(x.len(), Arm::default());
        for range in &self.aggregates {
            let nodes = range.start as usize..range.end as usize;
            let centre = x[nodes.clone()].iter().sum::<Vector>() / nodes.len() as f64;
            let size = x[nodes.clone()].iter().map(|x| (x - centre).norm()).fold(f64::MIN_POSITIVE, f64::max);
            for node in nodes {
                let free = if system.free[node] { 1.0 } else { 0.0 };
                self.arms[node] = Arm { offset: (x[node] - centre) * (free / size), free };
            }
        }
    }

    /// Solves for the motions of the aggregates that balance `r`; kept for [`Self::displacement`].
    pub fn solve(&mut self, r: &[Vector]) {
        let arms = &self.arms;
        let forces = self.aggregates.par_iter().with_min_len(32).map(|range| {
            let (mut force, mut torque) = (Vector::zeros(), Vector::zeros());
            for node in range.start as usize..range.end as usize {
                force += r[node] * arms[node].free;
                torque += arms[node].offset.cross(&r[node]);
            }
            Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
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

    /// Displacement of a node in the last solution.
    #[inline]
    pub fn displacement(&self, node: usize) -> Vector {
        let m = &self.motions[self.aggregate_of[node] as usize];
        let arm = &self.arms[node];
        Vector::new(m[0], m[1], m[2]) * arm.free + Vector::new(m[3], m[4], m[5]).cross(&arm.offset)
    }
}

fn centres(aggregates: &[Range<u32>], x: &[Vector]) -> Vec<Vector> {
    let centre = |range: &Range<u32>| {
        x[range.start as usize..range.end as usize].iter().sum::<Vector>() / range.len() as f64
    };
    aggregates.iter().map(centre).collect()
}

/// How a node moves with its aggregate: by `free * shift + spin x offset`.
#[derive(Clone, Copy, Debug, Default)]
struct Arm {
    /// From the aggregate's centre, over its size; zero if the node is not free.
    offset: Vector,
    /// 1, or 0 if the node is not free.
    free: f64,
}

/// A row of H times the columns of P of one aggregate: 3 x 6, shifts and spins apart.
#[derive(Default)]
struct RowSum {
    aggregate: u32,
    shift: Matrix3<f64>,
    spin: Matrix3<f64>,
}

impl RowSum {
    #[inline]
    fn turn_to(&mut self, aggregate: u32, flush: &mut impl FnMut(&RowSum)) {
        if self.aggregate != aggregate {
            flush(self);
            *self = Self { aggregate, ..Self::default() };
        }
    }

    #[inline]
    fn add(&mut self, block: &Matrix3<f64>, arm: &Arm) {
        self.shift += block * arm.free;
        // The block times the spin matrix, without its zeros.
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

    /// P_node^T times the sum.
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

/// spin -> spin x offset.
#[inline]
fn spin_matrix(arm: &Arm) -> Matrix3<f64> {
    let o = &arm.offset;
    Matrix3::new(0.0, o.z, -o.y, -o.z, 0.0, o.x, o.y, -o.x, 0.0)
}

#[cfg(test)]
#[path = "coarse_tests.rs"]
mod tests;
