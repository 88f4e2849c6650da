//! Tetrahedra of constant strain, and the principal curvatures of their laws: twin of `shader/shared/solid.wgsl`.

use super::elements::{TINY, any_normal, length};
use super::{added, crossed, divided, dot, negated, scaled, subtracted};
use crate::assembly::Tetrahedron;

type V3 = [f32; 3];

/// Columns whose angle has a smaller cosine count as orthogonal.
const ORTHOGONAL: f32 = 3e-7;

const SVD_SWEEPS: usize = 8;

/// The columns of F V, made orthogonal by rotations, and V; sorted by length.
fn decompose(f: [V3; 3]) -> ([V3; 3], [V3; 3]) {
    let mut b = f;
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SVD_SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (pp, qq, pq) = (dot(b[p], b[p]), dot(b[q], b[q]), dot(b[p], b[q]));
            if pq * pq > ORTHOGONAL * ORTHOGONAL * pp * qq {
                let tau = (qq - pp) / (2.0 * pq);
                let size = 1.0 / (tau.abs() + (1.0 + tau * tau).sqrt());
                let t = if tau >= 0.0 { size } else { -size };
                let c = 1.0 / (1.0 + t * t).sqrt();
                let s = t * c;
                for columns in [&mut b, &mut v] {
                    let (x, y) = (columns[p], columns[q]);
                    columns[p] = subtracted(scaled(x, c), scaled(y, s));
                    columns[q] = added(scaled(x, s), scaled(y, c));
                }
            }
        }
    }
    for p in [0, 1, 0] {
        let q = p + 1;
        if dot(b[p], b[p]) < dot(b[q], b[q]) {
            (b[p], b[q]) = (b[q], negated(b[p]));
            (v[p], v[q]) = (v[q], negated(v[p]));
        }
    }
    (b, v)
}

/// F = u diag(s) v^T with rotations u and v.
pub struct Singular {
    pub u: [V3; 3],
    pub s: V3,
    pub v: [V3; 3],
}

pub fn singular_of(f: [V3; 3]) -> Singular {
    let (b, v) = decompose(f);
    let s1 = length(b[0]);
    let u1 = if s1 > TINY { divided(b[0], s1) } else { [1.0, 0.0, 0.0] };
    let rest = subtracted(b[1], scaled(u1, dot(u1, b[1])));
    let s2 = length(rest);
    let u2 = if s2 > 1e-6 * s1 && s2 > TINY { divided(rest, s2) } else { any_normal(u1) };
    let u3 = crossed(u1, u2);
    Singular { u: [u1, u2, u3], s: [s1, dot(u2, b[1]), dot(u3, b[2])], v }
}

/// Principal curvatures: of scaling, flip and twist.
pub fn curvatures_of(tet: &Tetrahedron, s: V3) -> ([[f32; 3]; 3], V3, V3) {
    let mut scaling = [[0.0; 3]; 3];
    let (mut flip, mut twist) = ([0.0; 3], [0.0; 3]);
    if tet.law == 0 {
        let strain = s.map(|s| 0.5 * (s - 1.0) * (s + 1.0));
        let pressure = tet.lambda * (strain[0] + strain[1] + strain[2]);
        for i in 0..3 {
            for j in 0..3 {
                scaling[i][j] = tet.lambda * s[i] * s[j];
            }
            scaling[i][i] += tet.mu * (3.0 * s[i] * s[i] - 1.0) + pressure;
            let (a, b) = (s[(i + 1) % 3], s[(i + 2) % 3]);
            flip[i] = tet.mu * (a * a + a * b + b * b - 1.0) + pressure;
            twist[i] = tet.mu * (a * a - a * b + b * b - 1.0) + pressure;
        }
    } else {
        let invariant = dot(s, s) + 1.0;
        let shear = tet.mu * (1.0 - 1.0 / invariant);
        let cofactor = [s[1] * s[2], s[2] * s[0], s[0] * s[1]];
        let pressure = tet.lambda * (s[0] * s[1] * s[2] - 1.0) - 0.75 * tet.mu;
        for i in 0..3 {
            for j in 0..3 {
                let value = 2.0 * tet.mu / (invariant * invariant) * s[i] * s[j]
                    + tet.lambda * cofactor[i] * cofactor[j];
                scaling[i][j] = value + if i == j { shear } else { pressure * s[3 - i - j] };
            }
            flip[i] = shear - pressure * s[i];
            twist[i] = shear + pressure * s[i];
        }
    }
    (scaling, flip, twist)
}

/// F, or a change of F, by columns, from the ways to nodes 1, 2 and 3.
pub fn columns(tet: &Tetrahedron, way: impl Fn(u32, u32) -> V3) -> [V3; 3] {
    let mut f = [[0.0; 3]; 3];
    for a in 0..3 {
        let edge = way(tet.nodes[0], tet.nodes[a + 1]);
        for (k, column) in f.iter_mut().enumerate() {
            *column = added(*column, scaled(edge, tet.gradients[3 * a + k]));
        }
    }
    f
}

/// Gradients of the shape functions of all nodes along v1, v2, v3.
pub fn shape_of(tet: &Tetrahedron, axes: [V3; 3]) -> [V3; 4] {
    let mut shape = [[0.0; 3]; 4];
    for a in 0..3 {
        let g = [tet.gradients[3 * a], tet.gradients[3 * a + 1], tet.gradients[3 * a + 2]];
        shape[a + 1] = axes.map(|axis| dot(g, axis));
    }
    shape[0] = negated(added(added(shape[1], shape[2]), shape[3]));
    shape
}

/// Green's strain (F^T F - I) / 2.
pub fn green_strain(f: [V3; 3]) -> [V3; 3] {
    let (xy, xz, yz) = (0.5 * dot(f[0], f[1]), 0.5 * dot(f[0], f[2]), 0.5 * dot(f[1], f[2]));
    let axial = |k: usize| 0.5 * (dot(f[k], f[k]) - 1.0);
    [[axial(0), xy, xz], [xy, axial(1), yz], [xz, yz, axial(2)]]
}

/// The increment of Green's strain to F, which has changed by d, without cancellation.
pub fn green_increment(f: [V3; 3], d: [V3; 3]) -> [V3; 3] {
    let sum = [0, 1, 2].map(|k| subtracted(scaled(f[k], 2.0), d[k]));
    let mixed = |i: usize, j: usize| 0.25 * (dot(d[i], sum[j]) + dot(d[j], sum[i]));
    let axial = |k: usize| 0.5 * dot(d[k], sum[k]);
    let (xy, xz, yz) = (mixed(0, 1), mixed(0, 2), mixed(1, 2));
    [[axial(0), xy, xz], [xy, axial(1), yz], [xz, yz, axial(2)]]
}

/// 2 mu E + lambda tr(E) I.
pub fn law_stress(strain: [V3; 3], lambda: f32, mu: f32) -> [V3; 3] {
    let pressure = lambda * (strain[0][0] + strain[1][1] + strain[2][2]);
    [0, 1, 2].map(|k| {
        let mut column = scaled(strain[k], 2.0 * mu);
        column[k] += pressure;
        column
    })
}
