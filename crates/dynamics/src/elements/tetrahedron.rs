//! Tetrahedra of constant strain.
//!
//! F = sum x_a g_a^T, with g_a the gradients of the shape functions at rest. The energy is V W(F) with W a
//! [`SolidLaw`]. Its curvatures come from an analytic eigensystem in the frames of the singular vectors, and
//! each is filtered separately. Linear tetrahedra are too stiff in
//! bending, and lock as Poisson's ratio approaches 0.5; [`super::quadratic`] has others.
//!
//! Damping is a potential of the Green strain increment since the start of the step, as for triangles
//! ([`super::triangle`]): `beta/dt (mu |dE|^2 + lambda/2 tr(dE)^2)` with the Lame parameters of small strain.
//! It is invariant under rotations, so it conserves linear and angular momentum. The curvatures of a damped
//! element are the sum of those of both potentials, and the sum is filtered.

use super::element::{Element, Linearization, Start};
use super::filter::Filter;
use super::solid_law::{Principal, SolidLaw};
use super::svd::{Svd, signed_svds};
use crate::linear::assembly::{ElementModel, TetrahedronElement};
use crate::material::solid::SolidMaterial;
use bowknot_geometry::Vector;
use nalgebra::{Matrix3, SMatrix};

type Matrix9 = SMatrix<f64, 9, 9>;

/// A tetrahedron of a solid.
#[derive(Clone, Debug)]
pub(crate) struct Tetrahedron {
    nodes: [u32; 4],
    /// Rows: gradients g_1, g_2, g_3 of the shape functions at rest [1/m]; g_0 is minus their sum.
    gradients: Matrix3<f64>,
    /// Rest volume [m^3].
    volume: f64,
    law: SolidLaw,
    /// Lame parameters times the damping time [Pa s]: (lambda, mu).
    viscosity: (f64, f64),
}

impl Tetrahedron {
    /// A tetrahedron over `nodes` with rest positions `rest`; None unless its volume at rest is positive.
    pub fn new(nodes: [u32; 4], rest: &[Vector; 4], material: &SolidMaterial) -> Option<Self> {
        let edges = edges(rest);
        let volume = edges.determinant() / 6.0;
        let gradients = edges.try_inverse()?;
        let (lambda, mu) = material.lame();
        (volume > 0.0 && gradients.iter().all(|g| g.is_finite())).then_some(Self {
            nodes,
            gradients,
            volume,
            law: SolidLaw::new(material.model, (lambda, mu)),
            viscosity: (lambda * material.damping, mu * material.damping),
        })
    }

    /// The tetrahedron with a share of its volume.
    pub fn with_share(self, share: f64) -> Self {
        Self { volume: self.volume * share, ..self }
    }

    /// F with the corners at `x`.
    #[inline]
    pub fn deformation(&self, x: &[Vector; 4]) -> Matrix3<f64> {
        edges(x) * self.gradients
    }

    fn is_damped(&self) -> bool {
        self.viscosity.1 > 0.0
    }

    /// Dissipation potential per volume of a strain increment over a step of length 1 / `rate`.
    #[inline]
    fn dissipation_density(&self, strain: &Matrix3<f64>, rate: f64) -> f64 {
        let (lambda, mu) = self.viscosity;
        let trace = strain.trace();
        rate * (mu * strain.norm_squared() + 0.5 * lambda * trace * trace)
    }

    /// Stress P = F S of damping for a strain increment over a step of length 1 / `rate`.
    #[inline]
    fn viscous_stress(&self, f: &Matrix3<f64>, strain: &Matrix3<f64>, rate: f64) -> Matrix3<f64> {
        let (lambda, mu) = (self.viscosity.0 * rate, self.viscosity.1 * rate);
        f * (strain * (2.0 * mu) + Matrix3::from_diagonal_element(lambda * strain.trace()))
    }

    /// Stress and filtered curvatures of elasticity and damping together. Index 3 i + j belongs to the
    /// increment d_ij along u_i v_j^T; `strain` is the increment since the start of the step, in the frame v.
    fn damped(
        &self,
        principal: &Principal,
        s: &Vector,
        strain: &Matrix3<f64>,
        rate: f64,
        filter: Filter,
    ) -> (Matrix3<f64>, Matrix9) {
        let (lambda, mu) = (self.viscosity.0 * rate, self.viscosity.1 * rate);
        let mut viscous = strain * (2.0 * mu);
        (0..3).for_each(|i| viscous[(i, i)] += lambda * strain.trace());
        // P = F S.
        let stress = Matrix3::from_diagonal(&principal.stress) + Matrix3::from_diagonal(s) * viscous;
        let mut curvature = Matrix9::zeros();
        for i in 0..3 {
            for j in 0..3 {
                curvature[(4 * i, 4 * j)] += principal.scaling[(i, j)] + lambda * s[i] * s[j];
                for k in 0..3 {
                    curvature[(3 * i + j, 3 * i + k)] += viscous[(j, k)];
                }
            }
            curvature[(4 * i, 4 * i)] += 2.0 * mu * s[i] * s[i];
        }
        for (i, j, k) in [(1, 2, 0), (0, 2, 1), (0, 1, 2)] {
            let (ij, ji) = (3 * i + j, 3 * j + i);
            let (even, odd) = mixed(principal.flip[k], principal.twist[k]);
            // dE_ij = (s_i d_ij + s_j d_ji) / 2; it counts twice in the norm.
            curvature[(ij, ij)] += even + mu * s[i] * s[i];
            curvature[(ji, ji)] += even + mu * s[j] * s[j];
            curvature[(ij, ji)] += odd + mu * s[i] * s[j];
            curvature[(ji, ij)] += odd + mu * s[i] * s[j];
        }
        (stress, filter_9(curvature, filter))
    }
}

/// Edges from vertex 0 as columns; they do not depend on where the origin is.
#[inline]
fn edges(x: &[Vector; 4]) -> Matrix3<f64> {
    Matrix3::from_columns(&[x[1] - x[0], x[2] - x[0], x[3] - x[0]])
}

/// (F^T F - F0^T F0) / 2 = sym((F + F0)^T (F - F0)) / 2, without cancellation.
#[inline]
fn strain_increment(f: &Matrix3<f64>, f0: &Matrix3<f64>) -> Matrix3<f64> {
    let product = (f + f0).tr_mul(&(f - f0));
    (product + product.transpose()) * 0.25
}

/// The diagonal and the off-diagonal curvature over d_ij and d_ji.
#[inline]
fn mixed(flip: f64, twist: f64) -> (f64, f64) {
    (0.5 * (flip + twist), 0.5 * (flip - twist))
}

/// Whether a symmetric matrix is positive definite, so that nothing must be filtered.
#[inline]
fn is_positive(m: &Matrix3<f64>) -> bool {
    let minor = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
    m[(0, 0)] > 0.0 && minor > 0.0 && m.determinant() > 0.0
}

fn filter_3(matrix: Matrix3<f64>, filter: Filter) -> Matrix3<f64> {
    if is_positive(&matrix) {
        return matrix;
    }
    let mut eigen = matrix.symmetric_eigen();
    eigen.eigenvalues.apply(|value| *value = filter.apply(*value));
    eigen.recompose()
}

fn filter_9(matrix: Matrix9, filter: Filter) -> Matrix9 {
    if matrix.cholesky().is_some() || !matrix.iter().all(|m| m.is_finite()) {
        return matrix;
    }
    let mut eigen = matrix.symmetric_eigen();
    eigen.eigenvalues.apply(|value| *value = filter.apply(*value));
    eigen.recompose()
}

impl Element<4> for Tetrahedron {
    #[inline]
    fn nodes(&self) -> [u32; 4] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 4], start: Option<Start<'_, 4>>) -> f64 {
        let f = self.deformation(x);
        let mut density = self.law.density(&f);
        if let Some(start) = start.filter(|_| self.is_damped()) {
            density +=
                self.dissipation_density(&strain_increment(&f, &self.deformation(start.x)), start.rate);
        }
        self.volume * density
    }

    /// The decomposition of F.
    type Frame = Svd;

    fn frames(elements: [&Self; 4], x: &[[Vector; 4]; 4]) -> [Svd; 4] {
        signed_svds(&std::array::from_fn(|k| elements[k].deformation(&x[k])))
    }

    fn linearize_in(
        &self,
        Svd { u, s, v }: &Svd,
        x: &[Vector; 4],
        start: Option<Start<'_, 4>>,
        filter: Filter,
    ) -> Linearization<4> {
        let f = self.deformation(x);
        let principal = self.law.principal(s);
        // Shape function gradients along v_j, as rows.
        let shape = self.gradients * v;
        let h: [Vector; 3] = std::array::from_fn(|a| shape.row(a).transpose());
        let mut out = Linearization {
            energy: self.volume * self.law.density(&f),
            gradient: [Vector::zeros(); 4],
            hessian: [[Matrix3::zeros(); 4]; 4],
        };
        let stress = if let Some(start) = start.filter(|_| self.is_damped()) {
            let strain = strain_increment(&f, &self.deformation(start.x));
            out.energy += self.volume * self.dissipation_density(&strain, start.rate);
            let strain = v.tr_mul(&strain) * v;
            let (stress, curvature) = self.damped(&principal, s, &strain, start.rate, filter);
            for a in 0..3 {
                for b in a..3 {
                    let block = Matrix3::from_fn(|i, k| {
                        let view = curvature.fixed_view::<3, 3>(3 * i, 3 * k);
                        h[a].dot(&(view * h[b]))
                    });
                    out.hessian[a + 1][b + 1] = u * (block * self.volume) * u.transpose();
                }
            }
            stress
        } else {
            let scaling = filter_3(principal.scaling, filter);
            let (mut even, mut odd) = (Matrix3::zeros(), Matrix3::zeros());
            for (i, j, k) in [(1, 2, 0), (0, 2, 1), (0, 1, 2)] {
                let (e, o) = mixed(filter.apply(principal.flip[k]), filter.apply(principal.twist[k]));
                (even[(i, j)], even[(j, i)]) = (e, e);
                (odd[(i, j)], odd[(j, i)]) = (o, o);
            }
            for a in 0..3 {
                for b in a..3 {
                    // d_ij d_kl has a curvature where i = k, j = l (even), i = l, j = k (odd), i = j, k = l
                    // (scaling).
                    let mut block = (scaling.component_mul(&(h[a] * h[b].transpose()))
                        + odd.component_mul(&(h[b] * h[a].transpose())))
                        * self.volume;
                    let across = even * h[a].component_mul(&h[b]) * self.volume;
                    (0..3).for_each(|i| block[(i, i)] += across[i]);
                    out.hessian[a + 1][b + 1] = u * block * u.transpose();
                }
            }
            Matrix3::from_diagonal(&principal.stress)
        };
        let stress = u * stress * self.volume;
        for a in 0..3 {
            out.gradient[a + 1] = stress * h[a];
            out.gradient[0] -= out.gradient[a + 1];
        }
        // Translations store no energy: the rows of vertex 0 are minus the sum of the others.
        for b in 1..4 {
            for a in 1..4 {
                let block = if a <= b { out.hessian[a][b] } else { out.hessian[b][a].transpose() };
                out.hessian[0][b] -= block;
            }
        }
        for b in 1..4 {
            let block = out.hessian[0][b];
            out.hessian[0][0] -= block;
        }
        out
    }

    fn gradient(&self, x: &[Vector; 4], start: Option<Start<'_, 4>>) -> [Vector; 4] {
        let f = self.deformation(x);
        let mut stress = self.law.stress(&f);
        if let Some(start) = start.filter(|_| self.is_damped()) {
            let strain = strain_increment(&f, &self.deformation(start.x));
            stress += self.viscous_stress(&f, &strain, start.rate);
        }
        let forces = stress * self.gradients.transpose() * self.volume;
        let force = |a: usize| forces.column(a).into_owned();
        [-(force(0) + force(1) + force(2)), force(0), force(1), force(2)]
    }

    fn describe(&self, model: &mut ElementModel) {
        let (kind, constants) = self.law.describe();
        model.tetrahedra.push(TetrahedronElement {
            nodes: self.nodes,
            gradients: std::array::from_fn(|a| std::array::from_fn(|k| self.gradients[(a, k)])),
            volume: self.volume,
            kind,
            constants,
            viscosity: self.viscosity.1,
        });
    }
}

#[cfg(test)]
mod tests;
