//! Co-rotational linear triangles: constant strain in the rotated frame, plane stress.
//!
//! The 3 x 2 deformation gradient F = sum x_a g_a^T (g_a: gradients of the shape functions at rest)
//! has singular values s1 >= s2 >= 0, F = s1 u1 v1^T + s2 u2 v2^T. With the nearest rotation
//! R = u1 v1^T + u2 v2^T the linear elastic energy of F - R per area is
//!
//! ```text
//! W = mu |F - R|^2 + lambda/2 tr(R^T F - I)^2 = mu (d1^2 + d2^2) + lambda/2 (d1 + d2)^2,   d_i = s_i - 1
//! ```
//!
//! so W is a function of singular values, and its Hessian is diagonal in a known basis (Smith,
//! de Goes and Kim 2019, "Analytic Eigensystems for Isotropic Distortion Energies", here for 3 x 2).
//! With p_i = dW/ds_i = 2 mu d_i + lambda (d1 + d2) and the normal n = u1 x u2 the eigenmatrices are
//!
//! | mode | eigenmatrix | curvature |
//! |---|---|---|
//! | scaling | span of u1 v1^T, u2 v2^T | [[2 mu + lambda, lambda], [lambda, 2 mu + lambda]] |
//! | flip | (u2 v1^T + u1 v2^T) / sqrt 2 | (p1 - p2) / (s1 - s2) = 2 mu |
//! | twist | (u2 v1^T - u1 v2^T) / sqrt 2 | (p1 + p2) / (s1 + s2) |
//! | normal | n v1^T, n v2^T | p1 / s1, p2 / s2 |
//!
//! Scaling and flip are positive for any nu in (-1, 1); twist and normal turn negative under
//! compression, where [`Filter`] decides. Nothing is divided by a small singular value without a
//! floor, so a triangle crushed to a line or a point still has finite forces.
//!
//! Damping is a potential of the Green strain increment since the start of the step,
//! `beta/dt (mu |dE|^2 + lambda/2 tr(dE)^2)`, dE = (F^T F - F0^T F0)/2. It does not see rotations,
//! so it takes neither linear nor angular momentum; its gradient is the viscous force of implicit
//! Euler.

use super::{Element, Filter, Linearisation, Start};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// Singular values below this count as this where something is divided by them. It only limits
/// curvatures normal to triangles crushed to less than a twentieth; forces do not use it.
const SINGULAR_FLOOR: f64 = 0.05;

/// A triangle of cloth.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    nodes: [u32; 3],
    /// Gradients g_a of the shape functions in the rest plane [1/m].
    gradients: [[f64; 2]; 3],
    /// Rest area [m^2].
    area: f64,
    /// Lame parameters times thickness [N/m].
    lambda: f64,
    mu: f64,
    /// Damping time [s].
    damping: f64,
}

/// F = s1 u1 v1^T + s2 u2 v2^T; `v1` is (c, s) and v2 is (-s, c).
struct Decomposition {
    s: [f64; 2],
    u: [Vector; 2],
    v1: [f64; 2],
}

impl Triangle {
    /// A triangle over `nodes` with rest positions `rest`; None if it has no area there.
    pub fn new(nodes: [u32; 3], rest: &[Vector; 3], (lambda, mu): (f64, f64), damping: f64) -> Option<Self> {
        let (e1, e2) = (rest[1] - rest[0], rest[2] - rest[0]);
        let length = e1.norm();
        // Rest plane coordinates: vertex 1 on the first axis.
        let (x1, x2) = (length, e1.dot(&e2) / length);
        let y2 = e1.cross(&e2).norm() / length;
        let determinant = x1 * y2;
        // The inverse of [[x1, x2], [0, y2]]: its rows are the gradients of vertices 1 and 2.
        let g1 = [1.0 / x1, -x2 / determinant];
        let g2 = [0.0, 1.0 / y2];
        let g0 = [-g1[0] - g2[0], -g1[1] - g2[1]];
        let finite = [g0, g1, g2].iter().flatten().all(|g: &f64| g.is_finite());
        (finite && determinant > 0.0).then_some(Self {
            nodes,
            gradients: [g0, g1, g2],
            area: 0.5 * determinant,
            lambda,
            mu,
            damping,
        })
    }

    /// Columns of F.
    #[inline]
    fn deformation(&self, x: &[Vector; 3]) -> [Vector; 2] {
        let [_, g1, g2] = &self.gradients;
        // Differences first: F does not depend on where the origin is.
        let (e1, e2) = (x[1] - x[0], x[2] - x[0]);
        [e1 * g1[0] + e2 * g2[0], e1 * g1[1] + e2 * g2[1]]
    }

    #[inline]
    fn elastic_density(&self, [s1, s2]: [f64; 2]) -> f64 {
        let (d1, d2) = (s1 - 1.0, s2 - 1.0);
        self.mu * (d1 * d1 + d2 * d2) + 0.5 * self.lambda * (d1 + d2) * (d1 + d2)
    }

    /// Green strain increment (00, 11, 2 * 01).
    #[inline]
    fn strain_increment(f: &[Vector; 2], f0: &[Vector; 2]) -> [f64; 3] {
        // a.a - b.b = (a - b).(a + b), without cancellation.
        let difference = |a: &Vector, b: &Vector| (a - b).dot(&(a + b));
        let shear = (f[0] - f0[0]).dot(&f[1]) + f0[0].dot(&(f[1] - f0[1]));
        [0.5 * difference(&f[0], &f0[0]), 0.5 * difference(&f[1], &f0[1]), shear]
    }

    #[inline]
    fn dissipation_density(&self, [e00, e11, shear]: [f64; 3]) -> f64 {
        self.mu * (e00 * e00 + e11 * e11 + 0.5 * shear * shear) + 0.5 * self.lambda * (e00 + e11) * (e00 + e11)
    }

    /// Adds damping with potential `scale` times the dissipation density.
    fn add_damping(
        &self,
        f: &[Vector; 2],
        f0: &[Vector; 2],
        scale: f64,
        filter: Filter,
        out: &mut Linearisation<3>,
    ) {
        let strain = Self::strain_increment(f, f0);
        let [e00, e11, shear] = strain;
        out.energy += scale * self.dissipation_density(strain);
        // Stress S = 2 mu dE + lambda tr(dE) I.
        let pressure = self.lambda * (e00 + e11);
        let (s00, s11, s01) = (2.0 * self.mu * e00 + pressure, 2.0 * self.mu * e11 + pressure, self.mu * shear);
        let stress = [f[0] * s00 + f[1] * s01, f[0] * s01 + f[1] * s11];
        // The geometric part of the Hessian is S itself: filter its two eigenvalues.
        let [c, s] = first_axis(s00, s11, s01);
        let along = c * c * s00 + 2.0 * c * s * s01 + s * s * s11;
        let across = s * s * s00 - 2.0 * c * s * s01 + c * c * s11;
        let (along, across) = (filter.apply(along), filter.apply(across));

        let g = &self.gradients;
        let strains = g.map(|g| (f[0] * g[0], f[1] * g[1], f[0] * g[1] + f[1] * g[0]));
        for a in 0..3 {
            out.gradient[a] += (stress[0] * g[a][0] + stress[1] * g[a][1]) * scale;
            for b in a..3 {
                let ((a00, a11, a01), (b00, b11, b01)) = (&strains[a], &strains[b]);
                let axial = 2.0 * self.mu + self.lambda;
                let geometric = along * (c * g[a][0] + s * g[a][1]) * (c * g[b][0] + s * g[b][1])
                    + across * (c * g[a][1] - s * g[a][0]) * (c * g[b][1] - s * g[b][0]);
                let block = (a00 * b00.transpose() + a11 * b11.transpose()) * axial
                    + (a00 * b11.transpose() + a11 * b00.transpose()) * self.lambda
                    + a01 * b01.transpose() * self.mu
                    + Matrix3::from_diagonal_element(geometric);
                out.hessian[a][b] += block * scale;
            }
        }
    }
}

impl Element<3> for Triangle {
    #[inline]
    fn nodes(&self) -> [u32; 3] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> f64 {
        let f = self.deformation(x);
        let mut density = self.elastic_density(decompose(&f).s);
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let strain = Self::strain_increment(&f, &self.deformation(start.x));
            density += self.damping * start.rate * self.dissipation_density(strain);
        }
        self.area * density
    }

    fn linearise(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>, filter: Filter) -> Linearisation<3> {
        let f = self.deformation(x);
        let Decomposition { s: [s1, s2], u: [u1, u2], v1: [c, s] } = decompose(&f);
        let trace = self.lambda * (s1 + s2 - 2.0);
        let (p1, p2) = (2.0 * self.mu * (s1 - 1.0) + trace, 2.0 * self.mu * (s2 - 1.0) + trace);
        let axial = 2.0 * self.mu + self.lambda;
        let flip = 2.0 * self.mu;
        let twist = filter.apply((p1 + p2) / (s1 + s2).max(SINGULAR_FLOOR));
        let normal_1 = filter.apply(p1 / s1.max(SINGULAR_FLOOR));
        let normal_2 = filter.apply(p2 / s2.max(SINGULAR_FLOOR));
        let (even, odd) = (0.5 * (flip + twist), 0.5 * (flip - twist));

        // Shape function gradients along v1 and v2.
        let along = self.gradients.map(|g| c * g[0] + s * g[1]);
        let across = self.gradients.map(|g| c * g[1] - s * g[0]);
        let basis = Matrix3::from_columns(&[u1, u2, u1.cross(&u2)]);
        let mut out = Linearisation {
            energy: self.area * self.elastic_density([s1, s2]),
            gradient: [Vector::zeros(); 3],
            hessian: [[Matrix3::zeros(); 3]; 3],
        };
        for k in 0..3 {
            out.gradient[k] = (u1 * (p1 * along[k]) + u2 * (p2 * across[k])) * self.area;
            for l in k..3 {
                let (ak, al, bk, bl) = (along[k], along[l], across[k], across[l]);
                // The block in the frame u1, u2, n.
                let local = Matrix3::new(
                    axial * ak * al + even * bk * bl,
                    self.lambda * ak * bl + odd * bk * al,
                    0.0,
                    self.lambda * bk * al + odd * ak * bl,
                    axial * bk * bl + even * ak * al,
                    0.0,
                    0.0,
                    0.0,
                    normal_1 * ak * al + normal_2 * bk * bl,
                );
                out.hessian[k][l] = basis * (local * self.area) * basis.transpose();
            }
        }
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let scale = self.area * self.damping * start.rate;
            self.add_damping(&f, &self.deformation(start.x), scale, filter, &mut out);
        }
        out
    }
}

/// The unit eigenvector (c, s) of the larger eigenvalue of [[a, b], [b, d]].
#[inline]
fn first_axis(a: f64, d: f64, b: f64) -> [f64; 2] {
    // A Jacobi rotation; algebraic, so that no trigonometric function of the platform enters.
    let (c, s) = if b == 0.0 {
        (1.0, 0.0)
    } else {
        let tau = (d - a) / (2.0 * b);
        let t = 1.0f64.copysign(tau) / (tau.abs() + (1.0 + tau * tau).sqrt());
        let c = 1.0 / (1.0 + t * t).sqrt();
        (c, -t * c)
    };
    // (c, s) belongs to a - t b, (-s, c) to d + t b; take the larger.
    let along = c * c * a + 2.0 * c * s * b + s * s * d;
    let across = s * s * a - 2.0 * c * s * b + c * c * d;
    if along >= across { [c, s] } else { [-s, c] }
}

/// Singular values and vectors of the 3 x 2 matrix with columns `f`, finite whatever its rank.
#[inline]
fn decompose(f: &[Vector; 2]) -> Decomposition {
    let [c, s] = first_axis(f[0].norm_squared(), f[1].norm_squared(), f[0].dot(&f[1]));
    let (w1, w2) = (f[0] * c + f[1] * s, f[1] * c - f[0] * s);
    let s1 = w1.norm();
    let u1 = if s1 > f64::MIN_POSITIVE { w1 / s1 } else { Vector::x() };
    // What rounding left of w1 in w2 is taken out, so that u stays orthonormal near rank one.
    let w2 = w2 - u1 * u1.dot(&w2);
    let s2 = w2.norm();
    let u2 = if s2 > 1e-14 * s1 && s2 > f64::MIN_POSITIVE { w2 / s2 } else { any_normal(&u1) };
    Decomposition { s: [s1, s2], u: [u1, u2], v1: [c, s] }
}

/// Some unit vector orthogonal to the unit vector `u`.
fn any_normal(u: &Vector) -> Vector {
    let axis = if u.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    u.cross(&axis).normalize()
}

#[cfg(test)]
#[path = "triangle_tests.rs"]
mod tests;
