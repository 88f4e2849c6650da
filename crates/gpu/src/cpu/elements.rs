//! What the kernels of elements share: twin of `shader/shared/elements.wgsl` and `shader/shared/blocks.wgsl`.

use super::{scaled, to_f32};
use crate::assembly::ElementParams;

type V3 = [f32; 3];

/// Lengths up to this count as zero.
pub const TINY: f32 = 1e-18;

/// Divisors that are ratios of lengths are at least this large.
pub const MIN_RATIO: f32 = 0.05;

/// What elements read and write.
pub struct Elements<'a> {
    pub params: ElementParams,
    pub positions: &'a [[i32; 4]],
    pub start: &'a [[i32; 4]],
    pub blocks: &'a mut [f32],
}

impl Elements<'_> {
    pub fn way(&self, a: u32, b: u32) -> V3 {
        scaled(to_f32(way(self.positions, a, b)), self.params.quantum)
    }

    /// How much the way from node a to node b has changed since the start of the time step.
    pub fn moved(&self, a: u32, b: u32) -> V3 {
        let [x, x0] = [self.positions, self.start].map(|at| way(at, a, b));
        scaled(to_f32([0, 1, 2].map(|k| x[k].wrapping_sub(x0[k]))), self.params.quantum)
    }

    pub fn filtered(&self, curvature: f32) -> f32 {
        if self.params.absolute == 1 { curvature.abs() } else { curvature.max(0.0) }
    }

    /// Writes a block, given by its columns.
    pub fn put(&mut self, block: usize, columns: [V3; 3]) {
        let at = 9 * (self.params.first_block as usize + block);
        self.blocks[at..at + 9].copy_from_slice(columns.as_flattened());
    }

    /// [`super::eigen::filtered_matrix`] with the filter of the parameters.
    pub fn filtered_matrix<const ORDER: usize>(
        &self,
        matrix: [[f32; ORDER]; ORDER],
    ) -> [[f32; ORDER]; ORDER] {
        super::eigen::filtered_matrix(matrix, |curvature| self.filtered(curvature))
    }
}

/// The way from node a to node b in quanta.
pub fn way(at: &[[i32; 4]], a: u32, b: u32) -> [i32; 3] {
    let (from, to) = (at[a as usize], at[b as usize]);
    [0, 1, 2].map(|k| to[k].wrapping_sub(from[k]))
}

/// The unit eigenvector (c, s) of the larger eigenvalue of [[a, b], [b, d]]: a Jacobi rotation.
pub fn first_axis(a: f32, d: f32, b: f32) -> [f32; 2] {
    let (mut c, mut s) = (1.0, 0.0);
    if b.abs() > 1e-9 * (a.abs() + d.abs()) {
        let tau = (d - a) / (2.0 * b);
        let size = 1.0 / (tau.abs() + (1.0 + tau * tau).sqrt());
        let t = if tau >= 0.0 { size } else { -size };
        c = 1.0 / (1.0 + t * t).sqrt();
        s = -t * c;
    }
    let along = c * c * a + 2.0 * c * s * b + s * s * d;
    let across = s * s * a - 2.0 * c * s * b + c * c * d;
    if along >= across { [c, s] } else { [-s, c] }
}

/// A unit vector orthogonal to the unit vector `u`.
pub fn any_normal(u: V3) -> V3 {
    let normal = if u[0].abs() < 0.6 { [0.0, u[2], -u[1]] } else { [-u[2], 0.0, u[0]] };
    super::divided(normal, length(normal))
}

pub fn length(v: V3) -> f32 {
    super::dot(v, v).sqrt()
}
