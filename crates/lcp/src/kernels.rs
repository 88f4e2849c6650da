//! One step of each type of constraint: solve it alone and move its nodes.
//!
//! With `RESIDUAL` each step returns the correction of the row's value, |change of the multiplier| times its
//! diagonal. Keeping the largest correction costs a sixth of a sweep.
//!
//! A node is written only if it can move and the multiplier changed. Rows of one color may share nodes that
//! cannot move, and several threads writing them would contend for the cache line.
//!
//! # Why distance limits converge
//! Dykstra's algorithm (Boyle and Dykstra 1986) projects y_free onto the intersection of convex sets: each
//! set keeps the correction that it made last, takes it back, projects, and keeps the new one. For the
//! ball |y_a - y_b| <= L in the metric m = 1/w only e = y_a - y_b matters. With the multiplier f, y_a ->
//! y_a - w_a f and y_b -> y_b + w_b f, hence e -> e - W f, W = w_a + w_b. Taking back the old f gives z = e +
//! W f_old. The cost of changing e by -W f is (w_a + w_b)|f|^2 / 2 = |z - e_new|^2 / 2W, so e_new is the
//! Euclidean projection of z onto the ball, e_new = min(1, L/|z|) z, and f_new = (z - e_new)/W = max(0, |z| -
//! L) / (W |z|) z. This is exact block minimization of the dual; nothing is linearized, so a sweep cannot
//! overshoot. For a half-space Dykstra's correction is lambda times the gradient, and the same procedure is
//! projected Gauss-Seidel. So both types may be swept together.

use crate::params::FrictionBound;
use crate::rows::{DistanceLimit, FrictionRow, Row};
use crate::slots::Slots;
use crate::vector::{TangentVector, Vector};

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
            // Read again: an earlier place may have moved the same node.
            y.set(node, y.get(node) + row.gradients[k] * step);
        }
    }
    if RESIDUAL { change.abs() / row.inverse_diagonal } else { 0.0 }
}

/// The projected multiplier of a row. Unlike `clamp`, `max` and `min` turn NaN, from an overflow elsewhere,
/// into 0: the row then does nothing, and NaN does not spread.
#[inline(always)]
pub(crate) fn row_multiplier(row: &Row, value: f64, old: f64, step: f64) -> f64 {
    (old - value * step).max(0.0).min(row.upper)
}

/// The multiplier of a row that is an equation; it is 0 where the value is NaN, as in [`row_multiplier`].
#[inline(always)]
pub(crate) fn equation_multiplier(value: f64, old: f64, step: f64) -> f64 {
    let new = old - value * step;
    if new.is_nan() { 0.0 } else { new }
}

/// Dykstra's step of a distance limit; see the documentation of the module.
#[inline(always)]
pub(crate) fn relax_limit<const RESIDUAL: bool>(
    edge: &DistanceLimit,
    weights: &[f64],
    relaxation: f64,
    y: &impl Slots<Vector>,
    multipliers: &impl Slots<Vector>,
    index: usize,
) -> f64 {
    let [a, b] = edge.vertices.map(|v| v as usize);
    let difference = y.get(a) - y.get(b);
    let old = multipliers.get(index);
    let slack = old == Vector::zeros();
    if slack && difference.norm_squared() <= edge.limit * edge.limit {
        return 0.0;
    }
    let (w_a, w_b) = (weights[a], weights[b]);
    let total = w_a + w_b;
    // Of a node joined to itself, e is always 0.
    if total == 0.0 || a == b {
        return 0.0;
    }
    let mut new = limit_multiplier(edge, difference, old, total);
    if relaxation != 1.0 {
        new = old + relaxation * (new - old);
    }
    let change = new - old;
    multipliers.set(index, new);
    if w_a != 0.0 {
        y.set(a, y.get(a) - w_a * change);
    }
    if w_b != 0.0 {
        y.set(b, y.get(b) + w_b * change);
    }
    if RESIDUAL { change.norm() * total } else { 0.0 }
}

/// The multiplier of a distance limit; the difference y_a - y_b still contains the effect of `old`.
#[inline(always)]
pub(crate) fn limit_multiplier(edge: &DistanceLimit, difference: Vector, old: Vector, total: f64) -> Vector {
    let z = difference + total * old;
    let norm = z.norm();
    // At z = 0 the factor is -L/0 or 0/0; `max` turns both into 0.
    z * ((norm - edge.limit) / (norm * total)).max(0.0)
}

/// How a friction step is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionRule {
    pub relaxation: f64,
    pub bound: FrictionBound,
}

/// The friction step: lambda_t <- projection of lambda_t - relaxation slip / diagonal onto the region.
#[inline(always)]
pub(crate) fn relax_friction<const RESIDUAL: bool>(
    row: &FrictionRow,
    weights: &[f64],
    rule: FrictionRule,
    y: &impl Slots<Vector>,
    lambda: &impl Slots<f64>,
    friction: &impl Slots<TangentVector>,
    index: usize,
) -> f64 {
    if row.inverse_diagonal == 0.0 {
        return 0.0;
    }
    let old = friction.get(index);
    let normal = lambda.get(row.normal as usize);
    if normal == 0.0 && old == TangentVector::zeros() {
        return 0.0;
    }
    let mut point = Vector::zeros();
    for k in 0..4 {
        point += row.coefficients[k] * y.get(row.vertices[k] as usize);
    }
    let new =
        friction_multiplier(row, point, old, normal, rule.relaxation * row.inverse_diagonal, rule.bound);
    let change = new - old;
    if change == TangentVector::zeros() {
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

/// The projected multiplier of a friction row with its contact point at `point`.
#[inline(always)]
pub(crate) fn friction_multiplier(
    row: &FrictionRow,
    point: Vector,
    old: TangentVector,
    normal: f64,
    step: f64,
    bound: FrictionBound,
) -> TangentVector {
    let slip = TangentVector::new(
        row.offsets[0] + row.tangents[0].dot(&point),
        row.offsets[1] + row.tangents[1].dot(&point),
    );
    bound.project(old - slip * step, (row.friction * normal).max(0.0))
}
