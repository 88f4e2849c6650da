//! When a linear solve ends and how it has ended; what solves in single precision need.

use super::system::System;
use bowknot_geometry::Vector;
#[cfg(feature = "serde")]
use serde::Serialize;

/// How a linear solve ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize))]
pub struct CgInfo {
    /// Number of iterations, each with one matrix-vector product.
    pub iterations: usize,
    /// Residual in the preconditioner's norm, relative to that of the right-hand side [1].
    pub residual: f64,
    /// Whether the residual fell below the tolerance. If not, the last iterate is used all the same: the
    /// target is less accurate, but the step does not fail.
    pub converged: bool,
}

/// When to stop. Norms are those of the preconditioner.
#[derive(Clone, Debug)]
pub(crate) struct Limits {
    /// Residual relative to b, or to `min_scale` if that is larger [1].
    pub tolerance: f64,
    /// Residual relative to b itself at which the solve may end as well [1].
    pub own_tolerance: f64,
    /// Smallest squared norm of each part that `tolerance` is relative to: that of the first solve of the time step, which
    /// the present one corrects.
    pub min_scales: Vec<f64>,
    pub max_iterations: usize,
}

impl Limits {
    /// That of all parts together, where they end as one: the smallest.
    pub fn min_scale_of_whole(&self) -> f64 {
        self.min_scales.iter().copied().reduce(f64::min).unwrap_or(0.0)
    }
}

/// Share of the tolerance at which conjugate gradients end, so that the residual in double precision is below
/// the tolerance as well.
pub(super) const MARGIN: f64 = 0.95;

/// Share of the residual that a round in single precision must take away at least.
pub(super) const MIN_GAIN: f64 = 0.5;

/// Sets `residual` to b - H x over free nodes.
pub(super) fn subtract_product(system: &System<'_>, x: &[Vector], b: &[Vector], residual: &mut [Vector]) {
    system.multiply(x, residual);
    residual.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
}

/// A power of two that makes the largest entry nearly 1, so that numbers of any unit fit into single
/// precision; 1 if that is not possible.
pub(super) fn unit_factor(values: &[Vector]) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    let largest: f64 = values.iter().map(|v| v.amax()).fold(0.0, f64::max);
    let factor = 1.0 / f64::from_bits(largest.to_bits() & EXPONENT);
    if factor.is_normal() { factor } else { 1.0 }
}
