//! The coarse correction of the backward step: one factor for all multipliers.

use bowknot_geometry::Vector;
use bowknot_lcp as lcp;

/// Range of the factor: beyond it the linear model that it comes from says nothing.
const COARSE_RANGE: (f64, f64) = (0.3, 2.0);

/// Whether a friction multiplier is at its bound: the contact slides.
pub(crate) fn is_sliding(row: &lcp::FrictionRow, normal: f64, multiplier: lcp::TangentVector) -> bool {
    multiplier.norm() >= (1.0 - 1e-9) * row.friction * normal
}

/// The coarse correction: one factor s for all multipliers, the maximiser of the dual along that ray.
///
/// With delta = y - y' = W J^T lambda, scaling by s moves y to y' + s delta and each row value linearly; the dual's
/// derivative vanishes where sum lambda_p c_p(y) + sum (L |f| - f . (y_a - y_b)) = (1 - s) sum |delta|^2 / w.
///
/// Friction scales with its normals, which keeps it inside of its cone. A contact that sticks is an equation, slip = 0,
/// and counts with lambda_t . slip; one that slides is at rest with any slip against its multiplier (in De
/// Saxce's form, lambda (c + mu |slip|) + lambda_t . slip = 0 whatever the slip) and counts nothing.
pub(crate) fn scale_multipliers(system: &lcp::Problem<'_>, free: &[Vector], state: &mut lcp::State<'_>) {
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
    for (ball, force) in system.balls().rows.iter().zip(&*state.forces) {
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
    if energy <= 0.0 {
        return;
    }
    let s = (1.0 - slack / energy).clamp(COARSE_RANGE.0, COARSE_RANGE.1);
    if !s.is_finite() {
        return;
    }
    state.lambda.iter_mut().for_each(|l| *l *= s);
    state.forces.iter_mut().for_each(|f| *f *= s);
    state.friction.iter_mut().for_each(|f| *f *= s);
    for ((y, free), &weight) in state.y.iter_mut().zip(free).zip(system.weights()) {
        if weight > 0.0 {
            *y = free + s * (*y - free);
        }
    }
}
