//! Preconditioners: symmetric positive definite approximations of the inverse of H.

use super::coarse::Coarse;
use super::direct::Direct;
use super::system::System;
use super::vectors::chunk_dot;
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Block-Jacobi with an exact solve over strands and a coarse correction, each if the model has nodes for it.
/// It is rebuilt for every system.
#[derive(Debug, Default)]
pub(crate) struct Preconditioner {
    /// Inverses of the diagonal blocks; zero for nodes that are not free.
    inverses: Vec<Matrix3<f64>>,
    direct: Option<Direct>,
    coarse: Option<Coarse>,
}

impl Preconditioner {
    /// Block-Jacobi, replaced by `direct` at the nodes of strands, plus `coarse`.
    pub fn new(direct: Option<Direct>, coarse: Option<Coarse>) -> Self {
        Self { inverses: Vec::new(), direct, coarse }
    }

    /// Prepares for `system`, linearized at positions `x`.
    pub fn build(&mut self, system: &System<'_>, x: &[Vector]) {
        self.inverses.resize(system.node_count(), Matrix3::zeros());
        self.inverses.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, inverses)| {
            for (k, inverse) in inverses.iter_mut().enumerate() {
                let node = chunk * CHUNK + k;
                *inverse = if system.free[node] { invert(system.diagonal(node)) } else { Matrix3::zeros() };
            }
        });
        if let Some(direct) = &mut self.direct {
            direct.build(system);
        }
        if let Some(coarse) = &mut self.coarse {
            coarse.build(system, x);
        }
    }

    /// Sets z = M^-1 r; returns r . z.
    pub fn apply(&mut self, r: &[Vector], z: &mut [Vector]) -> f64 {
        if let Some(direct) = &mut self.direct {
            direct.solve(r);
        }
        if let Some(coarse) = &mut self.coarse {
            coarse.solve(r);
        }
        let (direct, coarse) = (self.direct.as_ref(), self.coarse.as_ref());
        let partial: Vec<f64> = z
            .par_chunks_mut(CHUNK)
            .zip(r.par_chunks(CHUNK))
            .zip(self.inverses.par_chunks(CHUNK))
            .enumerate()
            .map(|(chunk, ((z, r), inverses))| {
                for ((z, r), inverse) in z.iter_mut().zip(r).zip(inverses) {
                    *z = inverse * r;
                }
                if let Some(direct) = direct {
                    for (k, z) in z.iter_mut().enumerate() {
                        *z = direct.displacement(chunk * CHUNK + k).unwrap_or(*z);
                    }
                }
                if let Some(coarse) = coarse {
                    z.iter_mut().enumerate().for_each(|(k, z)| *z += coarse.displacement(chunk * CHUNK + k));
                }
                chunk_dot(r, z)
            })
            .collect();
        partial.iter().sum()
    }
}

/// The inverse of a symmetric positive definite block. The smallest eigenvalue is at least the inertia of the
/// node, so the block is singular only if the input is not finite. The identity is returned then, and CG
/// detects the non-finite numbers.
fn invert(block: Matrix3<f64>) -> Matrix3<f64> {
    block.try_inverse().map_or_else(Matrix3::identity, |inverse| (inverse + inverse.transpose()) * 0.5)
}
