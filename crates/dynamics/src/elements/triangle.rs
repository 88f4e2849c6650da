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
//! so W is a function of the singular values, and its Hessian is block-diagonal in a known basis (Smith, de
//! Goes and Kim 2019, "Analytic Eigensystems for Isotropic Distortion Energies", here for 3 x 2). With p_i =
//! dW/ds_i = 2 mu d_i + lambda (d1 + d2) and the normal n = u1 x u2 the eigenmatrices are
//!
//! | mode | eigenmatrix | curvature |
//! |---|---|---|
//! | scaling | span of u1 v1^T, u2 v2^T | [[2 mu + lambda, lambda], [lambda, 2 mu + lambda]] |
//! | flip | (u2 v1^T + u1 v2^T) / sqrt 2 | (p1 - p2) / (s1 - s2) = 2 mu |
//! | twist | (u2 v1^T - u1 v2^T) / sqrt 2 | (p1 + p2) / (s1 + s2) |
//! | normal | n v1^T, n v2^T | p1 / s1, p2 / s2 |
//!
//! Scaling and flip are positive for any nu in (-1, 1). Twist and normal become negative under compression
//! and are filtered ([`Filter`]). Divisors have a lower bound, so that a triangle crushed to a line or a
//! point still has finite forces and curvatures.
//!
//! Damping is a potential of the Green strain increment since the start of the step, `beta/dt (mu |dE|^2 +
//! lambda/2 tr(dE)^2)`, dE = (F^T F - F0^T F0)/2. It is invariant under rotations, so it conserves linear and
//! angular momentum; its gradient is the viscous force of implicit Euler. The curvatures of a damped element
//! are the sum of those of both potentials, and the sum is filtered.

mod lanes;

use super::element::{BATCH, Element, Linearization, Start};
use super::filter::Filter;
use super::membrane::{
    Curvatures, Decomposition, MIN_SINGULAR_VALUE, assemble, decompose, deformation, filter_2, filter_4,
    forces, rest_gradients, strain_increment,
};
use crate::linear::assembly::{ElementModel, MembraneElement};
use bowknot_geometry::Vector;
use nalgebra::{Matrix2, Matrix4};

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

impl Triangle {
    /// A triangle over `nodes` with rest positions `rest`; None if it has no area at rest.
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

    /// [`Self::elastic_density`] from the columns of F, without its singular vectors, for line searches. With
    /// C = F^T F and J = |f0 x f1| = s1 s2: (s1 + s2)^2 = tr C + 2 J and (s1 - s2)^2 = tr C - 2 J. The latter
    /// is computed from (s1^2 - s2^2)^2 = (c00 - c11)^2 + 4 c01^2, without cancellation.
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

    /// Energy density, stress and unfiltered curvatures in the frames u and v, without damping.
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
            twist: (p1 + p2) / (s1 + s2).max(MIN_SINGULAR_VALUE),
            normal: Matrix2::new(p1 / s1.max(MIN_SINGULAR_VALUE), 0.0, 0.0, p2 / s2.max(MIN_SINGULAR_VALUE)),
        }
    }

    /// Stress S = 2 mu dE + lambda tr(dE) I of damping, in the frame v1, v2.
    #[inline]
    fn viscous_stress(
        &self,
        decomposition: &Decomposition,
        [e00, e11, shear]: [f64; 3],
        factor: f64,
    ) -> Matrix2<f64> {
        let [c, s] = decomposition.v1;
        let pressure = self.lambda * (e00 + e11);
        let (s00, s11, s01) =
            (2.0 * self.mu * e00 + pressure, 2.0 * self.mu * e11 + pressure, self.mu * shear);
        let stress = Matrix2::new(s00, s01, s01, s11) * factor;
        let turn = Matrix2::new(c, -s, s, c);
        turn.transpose() * stress * turn
    }

    /// Adds damping to the elastic part and filters the sum. Filtered separately, the two parts would not
    /// cancel each other where they should, and Newton's method would converge slowly.
    fn damped(
        &self,
        local: &mut Local,
        decomposition: &Decomposition,
        strain: [f64; 3],
        factor: f64,
        filter: Filter,
    ) -> Matrix4<f64> {
        let [s1, s2] = decomposition.s;
        local.energy += factor * self.dissipation_density(strain);
        let stress = self.viscous_stress(decomposition, strain, factor);
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

/// A state in the frames (u1, u2, n) and (v1, v2); increments of F are d_ij along u_i v_j^T.
struct Local {
    energy: f64,
    /// Stress P; component [i][j] is along u_i v_j^T.
    stress: [[f64; 2]; 2],
    /// Curvatures of the modes, see the table at the top of this file; `axial` is that of scaling.
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

    type Frame = Decomposition;

    fn frames(elements: [&Self; 4], x: &[[Vector; 3]; 4]) -> [Decomposition; 4] {
        decompose(&std::array::from_fn(|k| deformation(&elements[k].gradients, &x[k])))
    }

    fn linearize_in(
        &self,
        decomposition: &Decomposition,
        x: &[Vector; 3],
        start: Option<Start<'_, 3>>,
        filter: Filter,
    ) -> Linearization<3> {
        let f = self.deformation(x);
        let mut local = self.elastic(decomposition.s);
        let plane = match start.filter(|_| self.damping > 0.0) {
            Some(start) => {
                let strain = strain_increment(&f, &self.deformation(start.x));
                self.damped(&mut local, decomposition, strain, self.damping * start.rate, filter)
            }
            None => {
                local.twist = filter.apply(local.twist);
                local.normal[(0, 0)] = filter.apply(local.normal[(0, 0)]);
                local.normal[(1, 1)] = filter.apply(local.normal[(1, 1)]);
                local.plane()
            }
        };

        let curvatures = Curvatures { plane, normal: local.normal };
        assemble(&self.gradients, self.area, decomposition, local.energy, local.stress, &curvatures)
    }

    fn linearize_batch(
        elements: [&Self; BATCH],
        x: &[[Vector; 3]; BATCH],
        start: &[[Vector; 3]; BATCH],
        rate: f64,
        filter: Filter,
        visit: &mut impl FnMut(usize, &Linearization<3>),
    ) {
        let holds = lanes::linearize(elements, x, start, rate, filter, visit);
        for k in (0..BATCH).filter(|&k| !holds[k]) {
            let [decomposition, ..] = decompose(&[elements[k].deformation(&x[k]); 4]);
            let start = (rate > 0.0).then_some(Start { x: &start[k], rate });
            visit(k, &elements[k].linearize_in(&decomposition, &x[k], start, filter));
        }
    }

    fn gradient(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> [Vector; 3] {
        let f = self.deformation(x);
        let [decomposition, ..] = decompose(&[f; 4]);
        let [s1, s2] = decomposition.s;
        let trace = self.lambda * (s1 + s2 - 2.0);
        let elastic = |s: f64| 2.0 * self.mu * (s - 1.0) + trace;
        let mut stress = [[elastic(s1), 0.0], [0.0, elastic(s2)]];
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let strain = strain_increment(&f, &self.deformation(start.x));
            let viscous = self.viscous_stress(&decomposition, strain, self.damping * start.rate);
            // P = F S.
            for (i, s) in [s1, s2].into_iter().enumerate() {
                (0..2).for_each(|j| stress[i][j] += s * viscous[(i, j)]);
            }
        }
        forces(&self.gradients, self.area, &decomposition, stress)
    }

    /// An isotropic law is that of a weave with these stiffnesses: mu |E|^2 + lambda/2 tr(E)^2.
    fn describe(&self, model: &mut ElementModel) {
        let [_, g1, g2] = self.gradients;
        let axial = 2.0 * self.mu + self.lambda;
        model.membranes.push(MembraneElement {
            nodes: self.nodes,
            gradients: [g1, g2],
            area: self.area,
            stiffness: [axial, self.lambda, axial, self.mu],
            damping: self.damping,
        });
    }
}

#[cfg(test)]
mod tests;
