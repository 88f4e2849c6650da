//! Orthotropic triangles: stiff along warp and weft, soft in shear.
//!
//! As for isotropic triangles ([`super::triangle`]) the energy is quadratic in the strain e = U - I of the
//! rotated frame, U = (F^T F)^(1/2), here with the axes of the weave:
//!
//! ```text
//! W = c11/2 e11^2 + c12 e11 e22 + c22/2 e22^2 + 2 G e12^2
//! c11 = E1/(1 - nu^2),  c22 = E2/(1 - nu^2),  c12 = nu sqrt(E1 E2)/(1 - nu^2)
//! ```
//!
//! A strip that is pulled along warp or weft with free sides then has the stiffness E1 or E2 exactly. W is
//! not a function of singular values, but U(F) has derivatives in closed form in the frames of F = sum s_i
//! u_i v_i^T. With increments d_ij of F along u_i v_j^T (i = n: along the normal), differentiating U U = F^T
//! F once and twice gives
//!
//! ```text
//! dU_ij = (s_i d_ij + s_j d_ji)/(s_i + s_j),   (d2U)_ij = 2/(s_i + s_j) [(d^T d)_ij - (dU dU)_ij]
//! ```
//!
//! and d2W = dU : C : dU + T : d2U with the stress T = C : e.

use super::element::{Element, Linearization, Start};
use super::filter::Filter;
use super::membrane::{
    Curvatures, Decomposition, MIN_SINGULAR_VALUE, assemble, decompose, deformation, filter_2, filter_4,
    forces, rest_gradients, strain_increment,
};
use crate::linear::assembly::{ElementModel, MembraneElement};
use crate::material::cloth::ClothMaterial;
use bowknot_geometry::Vector;
use nalgebra::{Matrix2, Matrix3, Matrix3x4, Matrix4, RowVector4};

/// Stiffnesses of a weave [N/m]: along warp and weft, between them, and in shear.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weave {
    pub c11: f64,
    pub c12: f64,
    pub c22: f64,
    pub shear: f64,
}

/// A triangle of woven cloth.
#[derive(Clone, Debug)]
pub(crate) struct WovenTriangle {
    nodes: [u32; 3],
    /// Gradients of the shape functions along warp and weft [1/m].
    gradients: [[f64; 2]; 3],
    /// Rest area [m^2].
    area: f64,
    weave: Weave,
    /// Damping time [s].
    damping: f64,
}

impl Weave {
    /// The stiffnesses of a fabric.
    pub fn new(material: &ClothMaterial) -> Self {
        let (warp, nu) = (material.stretch_stiffness, material.poisson_ratio);
        let weft = material.weft_stiffness.unwrap_or(warp);
        let (mean, plane) = ((warp * weft).sqrt(), 1.0 / (1.0 - nu * nu));
        Self {
            c11: warp * plane,
            c12: nu * mean * plane,
            c22: weft * plane,
            shear: material.shear_stiffness.unwrap_or(mean / (2.0 * (1.0 + nu))),
        }
    }

    /// Energy per area of a strain (11, 22, 12).
    #[inline]
    fn density(&self, [e11, e22, e12]: [f64; 3]) -> f64 {
        0.5 * self.c11 * e11 * e11
            + self.c12 * e11 * e22
            + 0.5 * self.c22 * e22 * e22
            + 2.0 * self.shear * e12 * e12
    }

    /// Stress of a strain, both in the axes of the weave.
    #[inline]
    fn stress(&self, [e11, e22, e12]: [f64; 3]) -> Matrix2<f64> {
        let shear = 2.0 * self.shear * e12;
        Matrix2::new(self.c11 * e11 + self.c12 * e22, shear, shear, self.c12 * e11 + self.c22 * e22)
    }

    /// Curvature over the strain components (11, 12, 22) in the frame v1 = (c, s).
    #[inline]
    fn turned(&self, [c, s]: [f64; 2]) -> Matrix3<f64> {
        // Rows: strains (11, 22, 12) in the axes of the weave.
        let turn =
            Matrix3::new(c * c, -2.0 * c * s, s * s, s * s, 2.0 * c * s, c * c, c * s, c * c - s * s, -c * s);
        let stiffness =
            Matrix3::new(self.c11, self.c12, 0.0, self.c12, self.c22, 0.0, 0.0, 0.0, 4.0 * self.shear);
        turn.tr_mul(&(stiffness * turn))
    }
}

impl WovenTriangle {
    /// A triangle over `nodes` with rest positions `rest`; None if it has no area at rest, or if `warp` is
    /// normal to it.
    pub fn new(
        nodes: [u32; 3],
        rest: &[Vector; 3],
        warp: &Vector,
        weave: Weave,
        damping: f64,
    ) -> Option<Self> {
        let (gradients, area) = rest_gradients(rest, Some(warp))?;
        Some(Self { nodes, gradients, area, weave, damping })
    }

    /// Strain U - I along warp and weft: U = (C + J I)/(s1 + s2), C = F^T F, J = s1 s2.
    #[inline]
    fn strain(f: &[Vector; 2]) -> [f64; 3] {
        let (c11, c22, c12) = (f[0].norm_squared(), f[1].norm_squared(), f[0].dot(&f[1]));
        let j = f[0].cross(&f[1]).norm();
        let sum = (c11 + c22 + 2.0 * j).sqrt();
        if sum > 0.0 { [(c11 + j) / sum - 1.0, (c22 + j) / sum - 1.0, c12 / sum] } else { [-1.0, -1.0, 0.0] }
    }

    /// The strain U - I from the singular values and `frame` = V: U = V diag(s) V^T.
    #[inline]
    fn strain_in(frame: &Matrix2<f64>, [s1, s2]: [f64; 2]) -> [f64; 3] {
        let strain = frame * Matrix2::new(s1 - 1.0, 0.0, 0.0, s2 - 1.0) * frame.transpose();
        [strain[(0, 0)], strain[(1, 1)], strain[(0, 1)]]
    }

    /// Increment of the Green strain (11, 22, 12).
    #[inline]
    fn increment(f: &[Vector; 2], f0: &[Vector; 2]) -> [f64; 3] {
        let [e11, e22, twice] = strain_increment(f, f0);
        [e11, e22, 0.5 * twice]
    }
}

/// The singular values over their sum.
#[inline]
fn shares([s1, s2]: [f64; 2]) -> [f64; 2] {
    let sum = s1 + s2;
    if sum > 0.0 { [s1 / sum, s2 / sum] } else { [0.5, 0.5] }
}

/// The stress along u_i v_j^T of the stress T in the frame v.
#[inline]
fn elastic_stress(t: &Matrix2<f64>, [r1, r2]: [f64; 2]) -> [[f64; 2]; 2] {
    let (off1, off2) = (2.0 * t[(0, 1)] * r1, 2.0 * t[(0, 1)] * r2);
    [[t[(0, 0)], off1], [off2, t[(1, 1)]]]
}

/// T : d2U over d11, d12, d21, d22 with the stress T in the frame v. The only divisor is s1 + s2.
#[inline]
fn geometric(t: &Matrix2<f64>, [s1, s2]: [f64; 2]) -> Matrix4<f64> {
    let sum = (s1 + s2).max(MIN_SINGULAR_VALUE);
    let over = 1.0 / (sum * sum);
    let (t1, t2, t12) = (t[(0, 0)], t[(1, 1)], 2.0 * t[(0, 1)] / sum);
    // T11/s1 (d21^2 - q^2) + T22/s2 (d12^2 - q^2) with q = dU12; s1 and s2 cancel.
    let k12 = (t2 * (s2 + 2.0 * s1) - t1 * s1) * over;
    let k21 = (t1 * (s1 + 2.0 * s2) - t2 * s2) * over;
    let across = -(t1 * s2 + t2 * s1) * over;
    // 4 T12/(s1 + s2) [d11 d12 + d21 d22 - q (d11 + d22)].
    let (r1, r2) = (s1 / sum, s2 / sum);
    Matrix4::new(
        0.0,
        t12 * r2,
        -t12 * r2,
        0.0,
        t12 * r2,
        k12,
        across,
        -t12 * r1,
        -t12 * r2,
        across,
        k21,
        t12 * r1,
        0.0,
        -t12 * r1,
        t12 * r1,
        0.0,
    )
}

impl Element<3> for WovenTriangle {
    #[inline]
    fn nodes(&self) -> [u32; 3] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> f64 {
        let f = deformation(&self.gradients, x);
        let mut density = self.weave.density(Self::strain(&f));
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let strain = Self::increment(&f, &deformation(&self.gradients, start.x));
            density += self.damping * start.rate * self.weave.density(strain);
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
        let f = deformation(&self.gradients, x);
        let Decomposition { s: [s1, s2], v1: [c, s], .. } = *decomposition;
        let frame = Matrix2::new(c, -s, s, c);
        let strain = Self::strain_in(&frame, [s1, s2]);
        let mut energy = self.weave.density(strain);
        let t = frame.tr_mul(&self.weave.stress(strain)) * frame;
        let sum = s1 + s2;
        let [r1, r2] = shares([s1, s2]);
        let mut stress = elastic_stress(&t, [r1, r2]);

        let turned = self.weave.turned([c, s]);
        let rows = |row: RowVector4<f64>, first: f64, last: f64| {
            Matrix3x4::from_rows(&[
                RowVector4::new(first, 0.0, 0.0, 0.0),
                row,
                RowVector4::new(0.0, 0.0, 0.0, last),
            ])
        };
        let du = rows(RowVector4::new(0.0, r1, r2, 0.0), 1.0, 1.0);
        let mut plane = du.tr_mul(&(turned * du)) + geometric(&t, [s1, s2]);
        let mixed = 2.0 * t[(0, 1)] / sum.max(MIN_SINGULAR_VALUE);
        let mut normal = Matrix2::new(
            t[(0, 0)] / s1.max(MIN_SINGULAR_VALUE),
            mixed,
            mixed,
            t[(1, 1)] / s2.max(MIN_SINGULAR_VALUE),
        );
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let factor = self.damping * start.rate;
            let increment = Self::increment(&f, &deformation(&self.gradients, start.x));
            energy += factor * self.weave.density(increment);
            let viscous = frame.tr_mul(&self.weave.stress(increment)) * frame * factor;
            // P = F S.
            for (i, s) in [s1, s2].into_iter().enumerate() {
                (0..2).for_each(|j| stress[i][j] += s * viscous[(i, j)]);
            }
            let de = rows(RowVector4::new(0.0, 0.5 * s1, 0.5 * s2, 0.0), s1, s2);
            plane += de.tr_mul(&(turned * de)) * factor;
            for side in [0, 2] {
                let mut view = plane.fixed_view_mut::<2, 2>(side, side);
                view += viscous;
            }
            normal += viscous;
        }
        let curvatures = Curvatures { plane: filter_4(plane, filter), normal: filter_2(normal, filter) };
        assemble(&self.gradients, self.area, decomposition, energy, stress, &curvatures)
    }

    fn gradient(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> [Vector; 3] {
        let f = deformation(&self.gradients, x);
        let [decomposition, ..] = decompose(&[f; 4]);
        let Decomposition { s, v1: [cosine, sine], .. } = decomposition;
        let frame = Matrix2::new(cosine, -sine, sine, cosine);
        let t = frame.tr_mul(&self.weave.stress(Self::strain_in(&frame, s))) * frame;
        let mut stress = elastic_stress(&t, shares(s));
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let increment = Self::increment(&f, &deformation(&self.gradients, start.x));
            let viscous = frame.tr_mul(&self.weave.stress(increment)) * frame * (self.damping * start.rate);
            // P = F S.
            for (i, s) in s.into_iter().enumerate() {
                (0..2).for_each(|j| stress[i][j] += s * viscous[(i, j)]);
            }
        }
        forces(&self.gradients, self.area, &decomposition, stress)
    }

    fn describe(&self, model: &mut ElementModel) {
        let [_, g1, g2] = self.gradients;
        let Weave { c11, c12, c22, shear } = self.weave;
        model.membranes.push(MembraneElement {
            nodes: self.nodes,
            gradients: [g1, g2],
            area: self.area,
            stiffness: [c11, c12, c22, shear],
            damping: self.damping,
        });
    }
}

#[cfg(test)]
mod tests;
