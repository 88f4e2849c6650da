//! The coarse correction of the backward step: one factor for all multipliers.

use bowknot_geometry::Vector;
use bowknot_lcp as lcp;

/// Range of the factor. The linear model that it comes from is not valid beyond.
const MIN_FACTOR: f64 = 0.3;
const MAX_FACTOR: f64 = 2.0;

/// Largest growth of the multipliers in a call. In the 61st time step of `bow-knot` at scale 1, with chains
/// of 600 taut edges, the first 16 sweeps ask for 870.
const MAX_GROWTH: f64 = 1e3;

/// Whether a friction multiplier is at its bound: the contact slides.
pub(crate) fn is_sliding(row: &lcp::FrictionRow, normal: f64, multiplier: lcp::TangentVector) -> bool {
    multiplier.norm() >= (1.0 - 1e-9) * row.friction * normal
}

/// The coarse correction: one factor s for all multipliers, the maximizer of the dual along that ray.
///
/// With delta = y - y' = W J^T lambda, scaling by s moves y to y' + s delta and each row value linearly. The
/// dual's derivative vanishes where
///
/// sum lambda_p c_p(y) + sum (L |f| - f . (y_a - y_b)) = (1 - s) sum |delta|^2 / w.
///
/// Friction scales with its normals, so it stays within its cone. A sticking contact is the equation
/// slip = 0 and counts with lambda_t . slip. A sliding contact is solved by any slip opposite to its
/// multiplier (in De Saxce's form, lambda (c + mu |slip|) + lambda_t . slip = 0 for every such slip) and does
/// not count.
///
/// In a call it multiplies the multipliers by a bounded factor in all. Where rows contradict each other, such
/// as between pins too far apart, the dual has no maximum. The growing multipliers of such rows would raise
/// all others, those of other bodies included.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoarseCorrection {
    /// The factor by which multipliers may still grow. It increases when they shrink.
    growth_left: f64,
}

impl Default for CoarseCorrection {
    fn default() -> Self {
        Self { growth_left: MAX_GROWTH }
    }
}

impl CoarseCorrection {
    /// Starts a call.
    pub fn begin(&mut self) {
        *self = Self::default();
    }

    /// Scales the multipliers, and y with them.
    pub fn apply(&mut self, system: &lcp::LcpProblem<'_>, free: &[Vector], state: &mut lcp::LcpState<'_>) {
        let best = best_factor(system, free, state);
        if !best.is_finite() {
            return;
        }
        let s = best.clamp(MIN_FACTOR, MAX_FACTOR.min(self.growth_left).max(1.0));
        self.growth_left /= s;
        state.lambda.iter_mut().for_each(|l| *l *= s);
        state.limit_multipliers.iter_mut().for_each(|f| *f *= s);
        state.friction.iter_mut().for_each(|f| *f *= s);
        for ((y, free), &weight) in state.y.iter_mut().zip(free).zip(system.weights()) {
            if weight > 0.0 {
                *y = free + s * (*y - free);
            }
        }
    }
}

/// The maximizer. It is not finite if no multiplier acts.
fn best_factor(system: &lcp::LcpProblem<'_>, free: &[Vector], state: &lcp::LcpState<'_>) -> f64 {
    let mut slack = 0.0;
    for (row, &lambda) in system.rows().rows.iter().zip(&*state.lambda) {
        if lambda > 0.0 {
            slack += lambda * row.value(state.y);
        }
    }
    for (row, &multiplier) in system.friction().rows.iter().zip(&*state.friction) {
        if multiplier != lcp::TangentVector::zeros()
            && !is_sliding(row, state.lambda[row.normal as usize], multiplier)
        {
            slack += multiplier.dot(&row.slip(state.y));
        }
    }
    for (ball, force) in system.distance_limits().rows.iter().zip(&*state.limit_multipliers) {
        if *force != Vector::zeros() {
            let [a, b] = ball.vertices.map(|v| v as usize);
            slack += ball.limit * force.norm() - force.dot(&(state.y[a] - state.y[b]));
        }
    }
    let mut energy = 0.0;
    for ((y, free), &weight) in state.y.iter().zip(free).zip(system.weights()) {
        if weight > 0.0 {
            energy += (y - free).norm_squared() / weight;
        }
    }
    1.0 - slack / energy
}
