//! Preconditioners: symmetric positive definite approximations of the inverse of H.

use super::coarse::Coarse;
use super::direct::Direct;
use super::lane::{Lane, PackedBlocks, Real, pack};
use super::parts::Parts;
use super::system::System;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// The parts of a preconditioner that join nodes, each if the model has nodes for it.
#[derive(Debug, Default)]
pub(crate) struct Levels {
    /// Exact solves over strands, which replace the blocks there.
    pub direct: Option<Direct>,
    /// A coarse correction, which is added.
    pub coarse: Option<Coarse>,
}

impl Levels {
    /// Prepares for `system`, linearized at positions `x`, for solves that are expected to take some number of
    /// `iterations`.
    pub fn build(&mut self, system: &System<'_>, x: &[Vector], iterations: usize) {
        if let Some(direct) = &mut self.direct {
            direct.build(system);
        }
        if let Some(coarse) = &mut self.coarse {
            coarse.build(system, x, iterations);
        }
    }
}

/// Block-Jacobi with [`Levels`], in the numbers that a solve computes with.
#[derive(Debug, Default)]
pub(crate) struct Preconditioner<T: Real> {
    /// Inverses of the diagonal blocks; zero for nodes that are not free.
    inverses: PackedBlocks<T>,
    /// Those of the coarse correction.
    arms: Vec<Lane<T>>,
    /// Partial sums of a dot product.
    partial: Vec<f64>,
}

impl<T: Real> Preconditioner<T> {
    /// Prepares for `system`, for which `levels` were built.
    pub fn fill(&mut self, system: &System<'_>, levels: &Levels) {
        self.inverses.resize(system.node_count());
        self.inverses.as_mut_slice().par_chunks_mut(9 * CHUNK).enumerate().for_each(|(chunk, inverses)| {
            for (k, numbers) in inverses.chunks_exact_mut(9).enumerate() {
                let node = chunk * CHUNK + k;
                let free = system.free[node];
                pack(numbers, &if free { invert(system.diagonal(node)) } else { Matrix3::zeros() });
            }
        });
        if let Some(coarse) = &levels.coarse {
            coarse.arms().collect_into_vec(&mut self.arms);
        }
    }

    /// Sets z = M^-1 r in the parts that are `active`; returns r . z by part.
    pub fn apply(
        &mut self,
        levels: &mut Levels,
        (parts, active): (&Parts, &[bool]),
        r: &[Lane<T>],
        z: &mut [Lane<T>],
    ) -> Vec<f64> {
        if let Some(direct) = &mut levels.direct {
            direct.solve(r);
        }
        if let Some(coarse) = &mut levels.coarse {
            coarse.solve(r, &self.arms);
        }
        let (direct, coarse) = (levels.direct.as_ref(), levels.coarse.as_ref());
        let (inverses, arms) = (&self.inverses, &self.arms);
        let chunks = z.par_chunks_mut(CHUNK).zip(parts.room(&mut self.partial)).enumerate();
        chunks.for_each(|(chunk, (z, sums))| {
            let first = chunk * CHUNK;
            let (mut aggregate, mut motion) = (u32::MAX, super::coarse::Motion::default());
            let pieces = parts.of_chunk(chunk).iter().zip(sums);
            for (piece, sum) in pieces.filter(|(piece, _)| active[piece.part]) {
                for node in piece.nodes.clone() {
                    let mut value = match direct.and_then(|direct| direct.displacement(node)) {
                        Some(exact) => Lane::new(&exact, 1.0),
                        None => inverses.product(node, r[node]),
                    };
                    if let Some(coarse) = coarse {
                        if coarse.aggregate_of(node) != aggregate {
                            aggregate = coarse.aggregate_of(node);
                            motion = coarse.motion(aggregate);
                        }
                        value += motion.displacement(&arms[node]);
                    }
                    let value = value.without_fourth();
                    *sum += r[node].dot(&value);
                    z[node - first] = value;
                }
            }
        });
        parts.sums(&self.partial)
    }
}

/// The inverse of a symmetric positive definite block. The smallest eigenvalue is at least the inertia of the
/// node, so the block is singular only if the input is not finite. The identity is returned then, and CG
/// detects the non-finite numbers.
fn invert(block: Matrix3<f64>) -> Matrix3<f64> {
    block.try_inverse().map_or_else(Matrix3::identity, |inverse| (inverse + inverse.transpose()) * 0.5)
}
