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
//! Euler. A damped element's curvatures are those of both potentials together, filtered together.

use super::{Element, Filter, Linearisation, Start, any_normal};
use bowknot_geometry::Vector;
use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2};

/// Singular values below this count as this where something is divided by them. It only limits
/// curvatures normal to triangles crushed to less than a twentieth; forces do not use it.
pub(super) const SINGULAR_FLOOR: f64 = 0.05;

/// Singular values up to this are zero: their reciprocals, and the squares on the way, must be finite.
const SINGULAR_ZERO: f64 = 1e-150;

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
pub(super) struct Decomposition {
    pub s: [f64; 2],
    pub u: [Vector; 2],
    pub v1: [f64; 2],
}

impl Triangle {
    /// A triangle over `nodes` with rest positions `rest`; None if it has no area there.
    pub fn new(nodes: [u32; 3], rest: &[Vector; 3], (lambda, mu): (f64, f64), damping: f64) -> Option<Self> {
        let (gradients, area) = rest_gradients(rest, None)?;
        Some(Self { nodes, gradients, area, lambda, mu, damping })
    }

    /// Columns of F.
    #[inline]
    fn deformation(&self, x: &[Vector; 3]) -> [Vector; 2] {
        deformation(&self.gradients, x)
    }

    #[inline]
    fn elastic_density(&self, [s1, s2]: [f64; 2]) -> f64 {
        let (d1, d2) = (s1 - 1.0, s2 - 1.0);
        self.mu * (d1 * d1 + d2 * d2) + 0.5 * self.lambda * (d1 + d2) * (d1 + d2)
    }

    /// [`Self::elastic_density`] without the singular vectors, for line searches: with C = F^T F and
    /// J = |f0 x f1| = s1 s2, (s1 + s2)^2 = tr C + 2 J and (s1 - s2)^2 = tr C - 2 J, the latter from
    /// (s1^2 - s2^2)^2 = (c00 - c11)^2 + 4 c01^2 without cancellation.
    #[inline]
    fn elastic_density_of(&self, f: &[Vector; 2]) -> f64 {
        let (c00, c11, c01) = (f[0].norm_squared(), f[1].norm_squared(), f[0].dot(&f[1]));
        let sum_squared = c00 + c11 + 2.0 * f[0].cross(&f[1]).norm();
        let sum = (sum_squared - 4.0) / (sum_squared.sqrt() + 2.0);
        let spread = (c00 - c11) * (c00 - c11) + 4.0 * c01 * c01;
        let difference_squared = if spread > 0.0 { spread / sum_squared } else { 0.0 };
        0.5 * self.mu * (sum * sum + difference_squared) + 0.5 * self.lambda * sum * sum
    }

    #[inline]
    fn dissipation_density(&self, [e00, e11, shear]: [f64; 3]) -> f64 {
        self.mu * (e00 * e00 + e11 * e11 + 0.5 * shear * shear)
            + 0.5 * self.lambda * (e00 + e11) * (e00 + e11)
    }

    /// Energy density, stress and unfiltered curvatures in the frames u and v, damping left out.
    #[inline]
    fn elastic(&self, [s1, s2]: [f64; 2]) -> Local {
        let trace = self.lambda * (s1 + s2 - 2.0);
        let (p1, p2) = (2.0 * self.mu * (s1 - 1.0) + trace, 2.0 * self.mu * (s2 - 1.0) + trace);
        Local {
            energy: self.elastic_density([s1, s2]),
            stress: [[p1, 0.0], [0.0, p2]],
            axial: Matrix2::new(
                2.0 * self.mu + self.lambda,
                self.lambda,
                self.lambda,
                2.0 * self.mu + self.lambda,
            ),
            flip: 2.0 * self.mu,
            twist: (p1 + p2) / (s1 + s2).max(SINGULAR_FLOOR),
            normal: Matrix2::new(p1 / s1.max(SINGULAR_FLOOR), 0.0, 0.0, p2 / s2.max(SINGULAR_FLOOR)),
        }
    }

    /// Adds damping to the elastic part and filters the sum: filtered apart, the two would not
    /// cancel where they do, and Newton would crawl.
    fn damped(
        &self,
        local: &mut Local,
        decomposition: &Decomposition,
        strain: [f64; 3],
        factor: f64,
        filter: Filter,
    ) -> Matrix4<f64> {
        let [e00, e11, shear] = strain;
        let ([s1, s2], [c, s]) = (decomposition.s, decomposition.v1);
        local.energy += factor * self.dissipation_density(strain);
        // Stress S = 2 mu dE + lambda tr(dE) I, in the frame v1, v2.
        let pressure = self.lambda * (e00 + e11);
        let (s00, s11, s01) =
            (2.0 * self.mu * e00 + pressure, 2.0 * self.mu * e11 + pressure, self.mu * shear);
        let stress = Matrix2::new(s00, s01, s01, s11) * factor;
        let turn = Matrix2::new(c, -s, s, c);
        let stress = turn.transpose() * stress * turn;
        // P = F S.
        local.stress[0][0] += s1 * stress[(0, 0)];
        local.stress[0][1] += s1 * stress[(0, 1)];
        local.stress[1][0] += s2 * stress[(1, 0)];
        local.stress[1][1] += s2 * stress[(1, 1)];
        local.normal = filter_2(local.normal + stress, filter);

        // dE = (s1 d11, s2 d22, s1 d12 + s2 d21) for the in-plane increments d_ij along u_i v_j^T.
        let mut plane = local.plane();
        let axial = factor * (2.0 * self.mu + self.lambda);
        let (couple, mix) = (factor * self.lambda * s1 * s2, factor * self.mu);
        plane[(0, 0)] += axial * s1 * s1;
        plane[(3, 3)] += axial * s2 * s2;
        plane[(0, 3)] += couple;
        plane[(3, 0)] += couple;
        plane[(1, 1)] += mix * s1 * s1;
        plane[(2, 2)] += mix * s2 * s2;
        plane[(1, 2)] += mix * s1 * s2;
        plane[(2, 1)] += mix * s1 * s2;
        for side in [0, 2] {
            let mut view = plane.fixed_view_mut::<2, 2>(side, side);
            view += stress;
        }
        filter_4(plane, filter)
    }
}

/// A state in the frames u1, u2, n and v1, v2: increments of F are d_ij along u_i v_j^T.
struct Local {
    energy: f64,
    /// P, component (i, j) along u_i v_j^T.
    stress: [[f64; 2]; 2],
    /// Curvatures of the modes, see the table above.
    axial: Matrix2<f64>,
    flip: f64,
    twist: f64,
    /// Over n v1^T, n v2^T.
    normal: Matrix2<f64>,
}

impl Local {
    /// In-plane curvatures over d11, d12, d21, d22.
    #[inline]
    fn plane(&self) -> Matrix4<f64> {
        let (even, odd) = (0.5 * (self.flip + self.twist), 0.5 * (self.flip - self.twist));
        let axial = &self.axial;
        Matrix4::new(
            axial[(0, 0)],
            0.0,
            0.0,
            axial[(0, 1)],
            0.0,
            even,
            odd,
            0.0,
            0.0,
            odd,
            even,
            0.0,
            axial[(1, 0)],
            0.0,
            0.0,
            axial[(1, 1)],
        )
    }
}

pub(super) fn filter_2(matrix: Matrix2<f64>, filter: Filter) -> Matrix2<f64> {
    let [c, s] = first_axis(matrix[(0, 0)], matrix[(1, 1)], matrix[(0, 1)]);
    let turn = Matrix2::new(c, -s, s, c);
    let diagonal = turn.transpose() * matrix * turn;
    let (along, across) = (filter.apply(diagonal[(0, 0)]), filter.apply(diagonal[(1, 1)]));
    turn * Matrix2::new(along, 0.0, 0.0, across) * turn.transpose()
}

pub(super) fn filter_4(matrix: Matrix4<f64>, filter: Filter) -> Matrix4<f64> {
    if matrix.cholesky().is_some() {
        return matrix;
    }
    let mut eigen = matrix.symmetric_eigen();
    eigen.eigenvalues.apply(|value| *value = filter.apply(*value));
    eigen.recompose()
}

impl Element<3> for Triangle {
    #[inline]
    fn nodes(&self) -> [u32; 3] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> f64 {
        let f = self.deformation(x);
        let mut density = self.elastic_density_of(&f);
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let strain = strain_increment(&f, &self.deformation(start.x));
            density += self.damping * start.rate * self.dissipation_density(strain);
        }
        self.area * density
    }

    fn linearise(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>, filter: Filter) -> Linearisation<3> {
        let f = self.deformation(x);
        let decomposition = decompose(&f);
        let mut local = self.elastic(decomposition.s);
        let plane = match start.filter(|_| self.damping > 0.0) {
            Some(start) => {
                let strain = strain_increment(&f, &self.deformation(start.x));
                self.damped(&mut local, &decomposition, strain, self.damping * start.rate, filter)
            }
            None => {
                local.twist = filter.apply(local.twist);
                local.normal[(0, 0)] = filter.apply(local.normal[(0, 0)]);
                local.normal[(1, 1)] = filter.apply(local.normal[(1, 1)]);
                local.plane()
            }
        };

        let curvatures = Curvatures { plane, normal: local.normal };
        assemble(&self.gradients, self.area, &decomposition, local.energy, local.stress, &curvatures)
    }
}

/// Filtered curvatures in the frames u1, u2, n and v1, v2.
pub(super) struct Curvatures {
    /// Over d11, d12, d21, d22.
    pub plane: Matrix4<f64>,
    /// Over n v1^T, n v2^T.
    pub normal: Matrix2<f64>,
}

/// Energy, forces and Hessian of a triangle from a state in the frames: `stress` [i][j] belongs to u_i v_j^T.
#[inline]
pub(super) fn assemble(
    gradients: &[[f64; 2]; 3],
    area: f64,
    decomposition: &Decomposition,
    energy: f64,
    stress: [[f64; 2]; 2],
    curvatures: &Curvatures,
) -> Linearisation<3> {
    let Decomposition { u: [u1, u2], v1: [cosine, sine], .. } = *decomposition;
    // Shape function gradients along v1 and v2.
    let shape = gradients.map(|[g0, g1]| Vector2::new(cosine * g0 + sine * g1, cosine * g1 - sine * g0));
    let corner = |i: usize, j: usize| curvatures.plane.fixed_view::<2, 2>(2 * i, 2 * j).into_owned();
    let (k11, k12, k22) = (corner(0, 0), corner(0, 1), corner(1, 1));
    let basis = Matrix3::from_columns(&[u1, u2, u1.cross(&u2)]);
    let [[p11, p12], [p21, p22]] = stress;
    let mut out = Linearisation {
        energy: area * energy,
        gradient: [Vector::zeros(); 3],
        hessian: [[Matrix3::zeros(); 3]; 3],
    };
    for k in 1..3 {
        let g = shape[k];
        out.gradient[k] = (u1 * (p11 * g.x + p12 * g.y) + u2 * (p21 * g.x + p22 * g.y)) * area;
        let (g11, g12, g21, g22) = (k11 * g, k12.transpose() * g, k12 * g, k22 * g);
        let gn = curvatures.normal * g;
        for l in k..3 {
            let h = shape[l];
            let block = Matrix3::new(
                g11.dot(&h),
                g12.dot(&h),
                0.0,
                g21.dot(&h),
                g22.dot(&h),
                0.0,
                0.0,
                0.0,
                gn.dot(&h),
            );
            out.hessian[k][l] = basis * (block * area) * basis.transpose();
        }
    }
    // Translations cost nothing: what is left belongs to node 0.
    out.gradient[0] = -(out.gradient[1] + out.gradient[2]);
    let [_, [_, h11, h12], [.., h22]] = out.hessian;
    let (h01, h02) = (-(h11 + h12.transpose()), -(h12 + h22));
    out.hessian[0] = [-(h01 + h02), h01, h02];
    out
}

/// Gradients of the shape functions [1/m] in the rest plane, and the area [m^2]; None if there is none. The first
/// axis runs along the projection of `axis`, or to vertex 1.
pub(super) fn rest_gradients(rest: &[Vector; 3], axis: Option<&Vector>) -> Option<([[f64; 2]; 3], f64)> {
    let (e1, e2) = (rest[1] - rest[0], rest[2] - rest[0]);
    let (g1, g2, determinant) = match axis {
        None => {
            let length = e1.norm();
            let (x1, x2) = (length, e1.dot(&e2) / length);
            let y2 = e1.cross(&e2).norm() / length;
            let determinant = x1 * y2;
            // The inverse of [[x1, x2], [0, y2]]: its rows are the gradients of vertices 1 and 2.
            ([1.0 / x1, -x2 / determinant], [0.0, 1.0 / y2], determinant)
        }
        Some(axis) => {
            let normal = e1.cross(&e2).try_normalize(0.0)?;
            let first = (axis - normal * normal.dot(axis)).try_normalize(0.0)?;
            let second = normal.cross(&first);
            let (x1, y1, x2, y2) = (e1.dot(&first), e1.dot(&second), e2.dot(&first), e2.dot(&second));
            let determinant = x1 * y2 - x2 * y1;
            ([y2 / determinant, -x2 / determinant], [-y1 / determinant, x1 / determinant], determinant)
        }
    };
    let g0 = [-g1[0] - g2[0], -g1[1] - g2[1]];
    let finite = [g0, g1, g2].iter().flatten().all(|g: &f64| g.is_finite());
    (finite && determinant > 0.0).then_some(([g0, g1, g2], 0.5 * determinant))
}

/// Columns of F.
#[inline]
pub(super) fn deformation(gradients: &[[f64; 2]; 3], x: &[Vector; 3]) -> [Vector; 2] {
    let [_, g1, g2] = gradients;
    // Differences first: F does not depend on where the origin is.
    let (e1, e2) = (x[1] - x[0], x[2] - x[0]);
    [e1 * g1[0] + e2 * g2[0], e1 * g1[1] + e2 * g2[1]]
}

/// Green strain increment (00, 11, 2 * 01).
#[inline]
pub(super) fn strain_increment(f: &[Vector; 2], f0: &[Vector; 2]) -> [f64; 3] {
    // a.a - b.b = (a - b).(a + b), without cancellation.
    let difference = |a: &Vector, b: &Vector| (a - b).dot(&(a + b));
    let shear = (f[0] - f0[0]).dot(&f[1]) + f0[0].dot(&(f[1] - f0[1]));
    [0.5 * difference(&f[0], &f0[0]), 0.5 * difference(&f[1], &f0[1]), shear]
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
pub(super) fn decompose(f: &[Vector; 2]) -> Decomposition {
    let [c, s] = first_axis(f[0].norm_squared(), f[1].norm_squared(), f[0].dot(&f[1]));
    let (w1, w2) = (f[0] * c + f[1] * s, f[1] * c - f[0] * s);
    let s1 = w1.norm();
    let u1 = if s1 > SINGULAR_ZERO { w1 * (1.0 / s1) } else { Vector::x() };
    // What rounding left of w1 in w2 is taken out, so that u stays orthonormal near rank one.
    let w2 = w2 - u1 * u1.dot(&w2);
    let s2 = w2.norm();
    let u2 = if s2 > 1e-14 * s1 && s2 > SINGULAR_ZERO { w2 * (1.0 / s2) } else { any_normal(&u1) };
    Decomposition { s: [s1, s2], u: [u1, u2], v1: [c, s] }
}

#[cfg(test)]
#[path = "triangle_tests.rs"]
mod tests;
