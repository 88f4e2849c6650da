//! Preconditioned conjugate gradients.

use super::preconditioner::Preconditioner;
use super::system::System;
use super::vectors::{add_scaled, dot};
use crate::nodes::CHUNK;
use bowknot_geometry::Vector;
use rayon::prelude::*;
use serde::Serialize;

/// How a linear solve ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Residual relative to b, or to `min_scale` if that is larger [1].
    pub tolerance: f64,
    /// Residual relative to b itself at which the solve may end as well [1].
    pub own_tolerance: f64,
    /// Smallest squared norm that `tolerance` is relative to: that of the first solve of the time step, which
    /// the present one corrects.
    pub min_scale: f64,
    pub max_iterations: usize,
}

/// Buffers that are kept between solves.
#[derive(Debug, Default)]
pub(crate) struct CgWorkspace {
    residual: Vec<Vector>,
    preconditioned: Vec<Vector>,
    direction: Vec<Vector>,
    image: Vec<Vector>,
    guess_image: Vec<Vector>,
    scale: f64,
}

impl CgWorkspace {
    /// Squared norm of the last b in the preconditioner's norm.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// b - H x at the end of the last solve.
    pub fn residual(&self) -> &[Vector] {
        &self.residual
    }

    fn resize(&mut self, count: usize) {
        for vector in [
            &mut self.residual,
            &mut self.preconditioned,
            &mut self.direction,
            &mut self.image,
            &mut self.guess_image,
        ] {
            vector.resize(count, Vector::zeros());
        }
    }
}

/// Solves H x = b over the free nodes; b and x are zero elsewhere.
///
/// The start is the combination of `guesses` with the least energy, or zero if there are none. The tolerance
/// is relative to b, not to the first residual: a good guess saves iterations and does not raise the
/// accuracy.
pub(crate) fn solve(
    system: &System<'_>,
    preconditioner: &mut Preconditioner,
    b: &[Vector],
    guesses: &[&[Vector]],
    limits: Limits,
    x: &mut [Vector],
    workspace: &mut CgWorkspace,
) -> CgInfo {
    workspace.resize(b.len());
    let CgWorkspace { residual: r, preconditioned: z, direction: p, image: q, guess_image, scale: own_scale } =
        workspace;
    x.fill(Vector::zeros());
    r.copy_from_slice(b);
    let scale = preconditioner.apply(b, z);
    if scale <= 0.0 || !scale.is_finite() {
        return CgInfo { iterations: 0, residual: 0.0, converged: scale == 0.0 };
    }
    *own_scale = scale;
    let enough = limits.own_tolerance * limits.own_tolerance * scale;
    let scale = scale.max(limits.min_scale);

    // Conjugate the guesses one after the other: p is the guess made conjugate to the previous one.
    let mut previous: Option<(Vec<Vector>, Vec<Vector>, f64)> = None;
    for guess in guesses {
        p.copy_from_slice(guess);
        let mut curvature = system.multiply(p, guess_image);
        if let Some((direction, image, previous_curvature)) = &previous {
            let share = dot(p, image) / previous_curvature;
            add_scaled(p, -share, direction);
            add_scaled(guess_image, -share, image);
            curvature = dot(p, guess_image);
        }
        if curvature > 0.0 && curvature.is_finite() {
            let step = dot(p, r) / curvature;
            add_scaled(x, step, p);
            add_scaled(r, -step, guess_image);
            previous = Some((p.clone(), guess_image.clone(), curvature));
        }
    }

    let mut rz = preconditioner.apply(r, z);
    p.copy_from_slice(z);
    let goal = (limits.tolerance * limits.tolerance * scale).max(enough);
    let mut info = CgInfo { iterations: 0, residual: (rz / scale).sqrt(), converged: rz <= goal };
    while !info.converged && info.iterations < limits.max_iterations {
        let curvature = system.multiply(p, q);
        // H is positive definite; the loop ends here on numbers that are not finite and when p vanishes.
        if !(curvature > 0.0 && curvature.is_finite()) {
            break;
        }
        let step = rz / curvature;
        x.par_chunks_mut(CHUNK)
            .zip(r.par_chunks_mut(CHUNK))
            .zip(p.par_chunks(CHUNK).zip(q.par_chunks(CHUNK)))
            .for_each(|((x, r), (p, q))| {
                for k in 0..x.len() {
                    x[k] += p[k] * step;
                    r[k] -= q[k] * step;
                }
            });
        let next = preconditioner.apply(r, z);
        let ratio = next / rz;
        rz = next;
        p.par_chunks_mut(CHUNK).zip(z.par_chunks(CHUNK)).for_each(|(p, z)| {
            p.iter_mut().zip(z).for_each(|(p, z)| *p = z + *p * ratio);
        });
        info.iterations += 1;
        info.residual = (rz / scale).sqrt();
        info.converged = rz <= goal;
    }
    info
}
