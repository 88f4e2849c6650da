//! Several triangles at once, in the lanes of registers.
//!
//! The formulas are those of [`super`] and [`crate::elements::membrane`], without branches, so that compilers
//! make one instruction for several triangles of each operation. No operation is fused, and each lane is on its
//! own: results do not depend on the instruction set. Triangles of which a formula does not hold are left out:
//! those of rank one or less, and damped ones whose curvatures in the plane must be filtered.

use super::Triangle;
use crate::elements::element::{BATCH, Linearization};
use crate::elements::filter::Filter;
use crate::elements::membrane::{MIN_SINGULAR_VALUE, ZERO_SINGULAR_VALUE};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// A number of each triangle.
type Lane = [f64; BATCH];

/// What is known of the triangles.
struct Input {
    /// Edges from node 0 to nodes 1 and 2, and those at the start of the time step [m].
    edges: [[Lane; 3]; 2],
    start: [[Lane; 3]; 2],
    /// Gradients of the shape functions of nodes 1 and 2 [1/m].
    gradients: [[Lane; 2]; 2],
    area: Lane,
    lambda: Lane,
    mu: Lane,
    /// Damping time over the time step; 0 without damping.
    damping: Lane,
}

/// What is computed.
struct Output {
    energy: Lane,
    /// Gradients by nodes 1 and 2.
    forces: [[Lane; 3]; 2],
    /// Blocks (1, 1), (1, 2) and (2, 2) of the Hessian, by rows.
    blocks: [[[Lane; 3]; 3]; 3],
    /// Whether the formulas hold.
    holds: [bool; BATCH],
}

/// Calls `visit` with the index and the linearization of each triangle for which the formulas hold; returns which
/// these are.
pub(super) fn linearize(
    triangles: [&Triangle; BATCH],
    x: &[[Vector; 3]; BATCH],
    start: &[[Vector; 3]; BATCH],
    rate: f64,
    filter: Filter,
    visit: &mut impl FnMut(usize, &Linearization<3>),
) -> [bool; BATCH] {
    let absolute = match filter {
        Filter::Clamp => false,
        Filter::Absolute => true,
        #[cfg(test)]
        Filter::Exact => return [false; BATCH],
    };
    let edge = |x: &[[Vector; 3]; BATCH], node: usize| -> [Lane; 3] {
        std::array::from_fn(|axis| std::array::from_fn(|k| x[k][node][axis] - x[k][0][axis]))
    };
    let of = |number: &dyn Fn(&Triangle) -> f64| -> Lane { std::array::from_fn(|k| number(triangles[k])) };
    let input = Input {
        edges: [edge(x, 1), edge(x, 2)],
        start: [edge(start, 1), edge(start, 2)],
        gradients: [1, 2].map(|node| [0, 1].map(|axis| of(&|t| t.gradients[node][axis]))),
        area: of(&|t| t.area),
        lambda: of(&|t| t.lambda),
        mu: of(&|t| t.mu),
        damping: of(&|t| t.damping * rate),
    };
    let mut output = Output {
        energy: [0.0; BATCH],
        forces: [[[0.0; BATCH]; 3]; 2],
        blocks: [[[[0.0; BATCH]; 3]; 3]; 3],
        holds: [false; BATCH],
    };
    compute(&input, absolute, &mut output);
    for k in (0..BATCH).filter(|&k| output.holds[k]) {
        let [f1, f2] = [0, 1].map(|node| Vector::from_fn(|row, _| output.forces[node][row][k]));
        let [h11, h12, h22] = [0, 1, 2].map(|block| Matrix3::from_fn(|i, j| output.blocks[block][i][j][k]));
        visit(k, &Linearization::of_translations(output.energy[k], [f1, f2], [h11, h12, h22]));
    }
    output.holds
}

#[inline(always)]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn combine(a: [f64; 3], s: f64, b: [f64; 3], t: f64) -> [f64; 3] {
    [a[0] * s + b[0] * t, a[1] * s + b[1] * t, a[2] * s + b[2] * t]
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The unit eigenvector of the larger eigenvalue of [[a, b], [b, d]].
#[inline(always)]
fn first_axis(a: f64, d: f64, b: f64) -> [f64; 2] {
    let tau = (d - a) / (2.0 * b);
    let size = 1.0 / (tau.abs() + (1.0 + tau * tau).sqrt());
    let t = if tau >= 0.0 { size } else { -size };
    let t = if b == 0.0 { 0.0 } else { t };
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = -t * c;
    let along = c * c * a + 2.0 * c * s * b + s * s * d;
    let across = s * s * a - 2.0 * c * s * b + c * c * d;
    let first = along >= across;
    [if first { c } else { -s }, if first { s } else { c }]
}

/// The gradient by a node whose shape function has the gradient `g` along v1 and v2.
#[inline(always)]
fn force([u1, u2]: [[f64; 3]; 2], p: [[f64; 2]; 2], g: [f64; 2], area: f64) -> [f64; 3] {
    combine(u1, (p[0][0] * g[0] + p[0][1] * g[1]) * area, u2, (p[1][0] * g[0] + p[1][1] * g[1]) * area)
}

/// A block of the Hessian by the nodes whose shape functions have the gradients `g` and `h` along v1 and v2. It is a11
/// u1 u1^T + a12 u1 u2^T + a21 u2 u1^T + a22 u2 u2^T + an n n^T.
#[inline(always)]
fn block(
    [u1, u2, n]: [[f64; 3]; 3],
    [[k00, k01], [k11, k12], [k03, k22], [k23, k33]]: [[f64; 2]; 4],
    [n11, n12, n22]: [f64; 3],
    g: [f64; 2],
    h: [f64; 2],
    area: f64,
) -> [[f64; 3]; 3] {
    let a11 = ((k00 * g[0] + k01 * g[1]) * h[0] + (k01 * g[0] + k11 * g[1]) * h[1]) * area;
    let a12 = (k12 * g[1] * h[0] + k03 * g[0] * h[1]) * area;
    let a21 = (k03 * g[1] * h[0] + k12 * g[0] * h[1]) * area;
    let a22 = ((k22 * g[0] + k23 * g[1]) * h[0] + (k23 * g[0] + k33 * g[1]) * h[1]) * area;
    let an = ((n11 * g[0] + n12 * g[1]) * h[0] + (n12 * g[0] + n22 * g[1]) * h[1]) * area;
    let (right1, right2) = (combine(u1, a11, u2, a12), combine(u1, a21, u2, a22));
    [
        combine(combine(right1, u1[0], right2, u2[0]), 1.0, n, an * n[0]),
        combine(combine(right1, u1[1], right2, u2[1]), 1.0, n, an * n[1]),
        combine(combine(right1, u1[2], right2, u2[2]), 1.0, n, an * n[2]),
    ]
}

/// Half of the increment of a squared length from `b` to `a`, without cancellation.
#[inline(always)]
fn half_increment(a: [f64; 3], b: [f64; 3]) -> f64 {
    0.5 * dot(combine(a, 1.0, b, -1.0), combine(a, 1.0, b, 1.0))
}

/// The vector of one triangle.
#[inline(always)]
fn vector(of: &[Lane; 3], k: usize) -> [f64; 3] {
    [of[0][k], of[1][k], of[2][k]]
}

#[multiversion::multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512cd+avx512dq+avx512vl+avx2+bmi1+bmi2+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+lzcnt+popcnt",
))]
fn compute(input: &Input, absolute: bool, output: &mut Output) {
    for k in 0..BATCH {
        let [[g1x, g1y], [g2x, g2y]] = [
            [input.gradients[0][0][k], input.gradients[0][1][k]],
            [input.gradients[1][0][k], input.gradients[1][1][k]],
        ];
        let (lambda, mu, factor) = (input.lambda[k], input.mu[k], input.damping[k]);
        // Columns of F, and of F at the start.
        let (e1, e2) = (vector(&input.edges[0], k), vector(&input.edges[1], k));
        let (f1, f2) = (combine(e1, g1x, e2, g2x), combine(e1, g1y, e2, g2y));
        let (e1, e2) = (vector(&input.start[0], k), vector(&input.start[1], k));
        let (b1, b2) = (combine(e1, g1x, e2, g2x), combine(e1, g1y, e2, g2y));

        // F = s1 u1 v1^T + s2 u2 v2^T with v1 = (c, s).
        let [c, s] = first_axis(dot(f1, f1), dot(f2, f2), dot(f1, f2));
        let (w1, w2) = (combine(f1, c, f2, s), combine(f2, c, f1, -s));
        let s1 = dot(w1, w1).sqrt();
        let inverse = 1.0 / s1;
        let u1 = [w1[0] * inverse, w1[1] * inverse, w1[2] * inverse];
        let w = combine(w2, 1.0, u1, -dot(u1, w2));
        let s2 = dot(w, w).sqrt();
        let inverse = 1.0 / s2;
        let u2 = [w[0] * inverse, w[1] * inverse, w[2] * inverse];
        let has_rank = (s1 > ZERO_SINGULAR_VALUE) & (s2 > 1e-14 * s1) & (s2 > ZERO_SINGULAR_VALUE);

        // Elastic energy, principal stresses and curvatures.
        let (d1, d2) = (s1 - 1.0, s2 - 1.0);
        let trace = lambda * (d1 + d2);
        let (p1, p2) = (2.0 * mu * d1 + trace, 2.0 * mu * d2 + trace);
        let elastic = mu * (d1 * d1 + d2 * d2) + 0.5 * lambda * (d1 + d2) * (d1 + d2);
        let twist = (p1 + p2) / larger(s1 + s2, MIN_SINGULAR_VALUE);
        let is_damped = factor > 0.0;
        let positive = if absolute { twist.abs() } else { larger(twist, 0.0) };
        let twist = if is_damped { twist } else { positive };

        // Damping: the increment of Green's strain, and its stress in the frame v.
        let (e11, e22) = (half_increment(f1, b1), half_increment(f2, b2));
        let e12 = dot(combine(f1, 1.0, b1, -1.0), f2) + dot(b1, combine(f2, 1.0, b2, -1.0));
        let viscous =
            mu * (e11 * e11 + e22 * e22 + 0.5 * e12 * e12) + 0.5 * lambda * (e11 + e22) * (e11 + e22);
        let pressure = lambda * (e11 + e22);
        let (q11, q22, q12) =
            ((2.0 * mu * e11 + pressure) * factor, (2.0 * mu * e22 + pressure) * factor, mu * e12 * factor);
        let (cc, cs, ss) = (c * c, c * s, s * s);
        let t11 = cc * q11 + 2.0 * cs * q12 + ss * q22;
        let t22 = ss * q11 - 2.0 * cs * q12 + cc * q22;
        let t12 = cs * (q22 - q11) + (cc - ss) * q12;

        // Stress along u_i v_j^T, and the curvatures over these: [d11, d12, d21, d22] in the plane.
        let (p11, p12, p21, p22) = (p1 + s1 * t11, s1 * t12, s2 * t12, p2 + s2 * t22);
        let (axial, mix) = (factor * (2.0 * mu + lambda), factor * mu);
        let (even, odd) = (0.5 * (2.0 * mu + twist), 0.5 * (2.0 * mu - twist));
        let k00 = 2.0 * mu + lambda + axial * s1 * s1 + t11;
        let k33 = 2.0 * mu + lambda + axial * s2 * s2 + t22;
        let k03 = lambda + factor * lambda * s1 * s2;
        let k11 = even + mix * s1 * s1 + t22;
        let k22 = even + mix * s2 * s2 + t11;
        let k12 = odd + mix * s1 * s2;
        // The pivots of an elimination in this order.
        let (l1, l3) = (t12 / k00, k03 / k00);
        let (m11, m13, m33) = (k11 - t12 * l1, -k03 * l1, k33 - k03 * l3);
        let (l2, l3) = (k12 / m11, m13 / m11);
        let (m22, m23, m33) = (k22 - k12 * l2, t12 - m13 * l2, m33 - m13 * l3);
        let m33 = m33 - m23 * (m23 / m22);
        let is_positive = (k00 > 0.0) & (m11 > 0.0) & (m22 > 0.0) & (m33 > 0.0);

        // Over n v1^T, n v2^T.
        let n11 = p1 / larger(s1, MIN_SINGULAR_VALUE) + t11;
        let n22 = p2 / larger(s2, MIN_SINGULAR_VALUE) + t22;
        let [a, b] = first_axis(n11, n22, t12);
        let (along, across) =
            (a * a * n11 + 2.0 * a * b * t12 + b * b * n22, b * b * n11 - 2.0 * a * b * t12 + a * a * n22);
        let along = if absolute { along.abs() } else { larger(along, 0.0) };
        let across = if absolute { across.abs() } else { larger(across, 0.0) };
        let (n11, n22, n12) =
            (a * a * along + b * b * across, b * b * along + a * a * across, a * b * (along - across));

        // Shape function gradients along v1 and v2, and forces.
        let (g1, g2) = ([c * g1x + s * g1y, c * g1y - s * g1x], [c * g2x + s * g2y, c * g2y - s * g2x]);
        let area = input.area[k];
        let stress = [[p11, p12], [p21, p22]];
        let (force1, force2) = (force([u1, u2], stress, g1, area), force([u1, u2], stress, g2, area));
        let n = [u1[1] * u2[2] - u1[2] * u2[1], u1[2] * u2[0] - u1[0] * u2[2], u1[0] * u2[1] - u1[1] * u2[0]];
        let (frame, normal) = ([u1, u2, n], [n11, n12, n22]);
        let plane = [[k00, t12], [k11, k12], [k03, k22], [t12, k33]];
        let block11 = block(frame, plane, normal, g1, g1, area);
        let block12 = block(frame, plane, normal, g1, g2, area);
        let block22 = block(frame, plane, normal, g2, g2, area);

        output.energy[k] = area * (elastic + factor * viscous);
        for row in 0..3 {
            output.forces[0][row][k] = force1[row];
            output.forces[1][row][k] = force2[row];
            for column in 0..3 {
                output.blocks[0][row][column][k] = block11[row][column];
                output.blocks[1][row][column][k] = block12[row][column];
                output.blocks[2][row][column][k] = block22[row][column];
            }
        }
        output.holds[k] = has_rank & (is_positive | !is_damped);
    }
}
