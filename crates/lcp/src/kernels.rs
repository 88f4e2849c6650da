//! One step of each kind of row: solve it alone, move its nodes.
//!
//! Each returns the correction of the row's value, |change of the multiplier| times its diagonal, if
//! `RESIDUAL` asks for it: keeping the largest costs a sweep a sixth.
//! A node is written only if it can move and the multiplier changed: nodes that cannot move are
//! shared by rows of one colour, and writing them would make threads fight for the cache line.
//!
//! # Why ball rows converge
//! Projecting y_free onto the intersection of convex sets by Dykstra's algorithm (Boyle and Dykstra
//! 1986): each set keeps the correction that it made last, takes it back, projects, and keeps the
//! new one. For the ball |y_a - y_b| <= L in the metric m = 1/w only e = y_a - y_b matters. With
//! the multiplier f, y_a -> y_a - w_a f and y_b -> y_b + w_b f, hence e -> e - W f, W = w_a + w_b.
//! Taking back the old f gives z = e + W f_old. Among the ways of changing e by -W f the cost is
//! (w_a + w_b)|f|^2 / 2 = |z - e_new|^2 / 2W, so e_new is the Euclidean projection of z onto the ball,
//! e_new = min(1, L/|z|) z, and f_new = (z - e_new)/W = max(0, |z| - L) / (W |z|) z. It is exact
//! minimisation of the dual by blocks; nothing is linearised, so sweeping cannot overshoot. For
//! a half-space Dykstra's correction is lambda times the gradient and the same procedure is
//! projected Gauss-Seidel, which is why both kinds may be swept together.

use crate::Vector;
use crate::params::FrictionBound;
use crate::problem::{BallRow, FrictionRow, Row};
use crate::slots::Slots;
use nalgebra::Vector2;

/// lambda <- clamp(lambda - relaxation s / diagonal, 0, upper), without the bounds if `EQUATION`.
#[inline(always)]
pub(crate) fn relax_row<const RESIDUAL: bool, const EQUATION: bool>(
    row: &Row,
    weights: &[f64],
    relaxation: f64,
    y: &impl Slots<Vector>,
    lambda: &impl Slots<f64>,
    index: usize,
) -> f64 {
    if row.inverse_diagonal == 0.0 {
        return 0.0;
    }
    let mut value = row.offset;
    for k in 0..4 {
        value += row.gradients[k].dot(&y.get(row.vertices[k] as usize));
    }
    let old = lambda.get(index);
    let step = relaxation * row.inverse_diagonal;
    let new =
        if EQUATION { equation_multiplier(value, old, step) } else { row_multiplier(row, value, old, step) };
    let change = new - old;
    if change == 0.0 {
        return 0.0;
    }
    lambda.set(index, new);
    for k in 0..4 {
        let node = row.vertices[k] as usize;
        let step = weights[node] * change;
        if step != 0.0 {
            // Read anew: an earlier place may have moved the same node.
            y.set(node, y.get(node) + row.gradients[k] * step);
        }
    }
    if RESIDUAL { change.abs() / row.inverse_diagonal } else { 0.0 }
}

/// The projected multiplier of a row. `max` and `min` rather than `clamp`: they let a NaN value, of
/// an overflow elsewhere, drop the row's force instead of spreading it.
#[inline(always)]
pub(crate) fn row_multiplier(row: &Row, value: f64, old: f64, step: f64) -> f64 {
    (old - value * step).max(0.0).min(row.upper)
}

/// The multiplier of a row that is taken for an equation; a NaN value drops its force likewise.
#[inline(always)]
pub(crate) fn equation_multiplier(value: f64, old: f64, step: f64) -> f64 {
    let new = old - value * step;
    if new.is_nan() { 0.0 } else { new }
}

/// Dykstra's step of a ball row, see the module's documentation.
#[inline(always)]
pub(crate) fn relax_ball<const RESIDUAL: bool>(
    ball: &BallRow,
    weights: &[f64],
    relaxation: f64,
    y: &impl Slots<Vector>,
    forces: &impl Slots<Vector>,
    index: usize,
) -> f64 {
    let [a, b] = ball.vertices.map(|v| v as usize);
    let difference = y.get(a) - y.get(b);
    let old = forces.get(index);
    let slack = old == Vector::zeros();
    if slack && difference.norm_squared() <= ball.limit * ball.limit {
        return 0.0;
    }
    let (w_a, w_b) = (weights[a], weights[b]);
    let total = w_a + w_b;
    // A node joined to itself has e = 0 for ever.
    if total == 0.0 || a == b {
        return 0.0;
    }
    let mut new = ball_multiplier(ball, difference, old, total);
    if relaxation != 1.0 {
        new = old + relaxation * (new - old);
    }
    let change = new - old;
    forces.set(index, new);
    if w_a != 0.0 {
        y.set(a, y.get(a) - w_a * change);
    }
    if w_b != 0.0 {
        y.set(b, y.get(b) + w_b * change);
    }
    if RESIDUAL { change.norm() * total } else { 0.0 }
}

/// The multiplier of a ball row whose difference y_a - y_b still contains `old`.
#[inline(always)]
pub(crate) fn ball_multiplier(ball: &BallRow, difference: Vector, old: Vector, total: f64) -> Vector {
    let z = difference + total * old;
    let norm = z.norm();
    // At z = 0 this is -L/0 or 0/0; `max` makes 0 of both.
    z * ((norm - ball.limit) / (norm * total)).max(0.0)
}

/// The friction step: lambda_t <- projection of lambda_t - relaxation slip / diagonal onto the region.
#[inline(always)]
pub(crate) fn relax_friction<const RESIDUAL: bool>(
    row: &FrictionRow,
    weights: &[f64],
    relaxation: f64,
    bound: FrictionBound,
    y: &impl Slots<Vector>,
    lambda: &impl Slots<f64>,
    friction: &impl Slots<Vector2<f64>>,
    index: usize,
) -> f64 {
    if row.inverse_diagonal == 0.0 {
        return 0.0;
    }
    let old = friction.get(index);
    let normal = lambda.get(row.normal as usize);
    if normal == 0.0 && old == Vector2::zeros() {
        return 0.0;
    }
    let mut point = Vector::zeros();
    for k in 0..4 {
        point += row.coefficients[k] * y.get(row.vertices[k] as usize);
    }
    let new = friction_multiplier(row, point, old, normal, relaxation * row.inverse_diagonal, bound);
    let change = new - old;
    if change == Vector2::zeros() {
        return 0.0;
    }
    friction.set(index, new);
    let direction = row.direction(change);
    for k in 0..4 {
        let node = row.vertices[k] as usize;
        let step = weights[node] * row.coefficients[k];
        if step != 0.0 {
            y.set(node, y.get(node) + direction * step);
        }
    }
    if RESIDUAL { change.norm() / row.inverse_diagonal } else { 0.0 }
}

/// The projected multiplier of a friction row whose slipping point is at `point`.
#[inline(always)]
pub(crate) fn friction_multiplier(
    row: &FrictionRow,
    point: Vector,
    old: Vector2<f64>,
    normal: f64,
    step: f64,
    bound: FrictionBound,
) -> Vector2<f64> {
    let slip = Vector2::new(
        row.offsets[0] + row.tangents[0].dot(&point),
        row.offsets[1] + row.tangents[1].dot(&point),
    );
    bound.project(old - slip * step, (row.friction * normal).max(0.0))
}
