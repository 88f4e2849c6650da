//! Bending of sheets that are curved at rest.
//!
//! The flat form ([`super::bending`]) measures the jumps K_e x of the surface's derivative across the edges
//! of a triangle, which are vectors along the normal, and combines them to the curvature tensor. A sheet that
//! is curved at rest has jumps at rest, which rotate with the triangle:
//!
//! ```text
//! r_e = K_e x - (a_e f1 + b_e f2 + c_e n),   E_T = D/(8 A_T) sum_ef (n_e.n_f)^2 r_e . r_f
//! ```
//!
//! f1 and f2 are the columns of the triangle's deformation gradient, n is its unit normal (f1 x f2 scaled
//! smoothly, shorter than 1 only for crushed triangles), and a, b, c are the components of K_e x at rest
//! along f1, f2 and n. E is zero for rigid motions of the rest shape and equals the flat form for flat rest
//! shapes. Only n is nonlinear in x. The Hessian is the Gauss-Newton matrix, which is positive semi-definite.

use super::bending::{Merged, for_each_stencil};
use super::element::{Element, Linearization, Start};
use super::filter::Filter;
use super::membrane::{deformation, rest_gradients};
use crate::linear::assembly::{BendElement, ElementModel};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// Below about this share of a triangle's rest area the normal becomes shorter, smoothly.
const CRUSHED_AREA_RATIO: f64 = 0.05;

/// Bending around one triangle. Its nodes are the corners, then the opposite vertices across the inner edges.
#[derive(Clone, Debug)]
pub(crate) struct CurvedBend<const N: usize> {
    nodes: [u32; N],
    /// Weights of K_e over the nodes [1].
    jumps: [[f64; N]; 3],
    /// (n_e.n_f)^2 with free edges condensed, times D/(4 A) [N/m].
    gram: [[f64; 3]; 3],
    /// Gradients of the shape functions in the rest plane [1/m].
    gradients: [[f64; 2]; 3],
    /// Components (a, b, c) of each jump at rest [m].
    rest: [[f64; 3]; 3],
}

impl<const N: usize> CurvedBend<N> {
    /// The element of a stencil of N distinct nodes; None if the triangle has no area at rest.
    pub fn new(stencil: &Merged, rest: &[Vector], stiffness: f64) -> Option<Self> {
        let nodes: [u32; N] = stencil.nodes.as_slice().try_into().ok()?;
        let at = nodes.map(|n| rest[n as usize]);
        let corners = [at[0], at[1], at[2]];
        let (gradients, _) = rest_gradients(&corners, None)?;
        let weight = stiffness / (4.0 * stencil.area);
        let mut bend = Self {
            nodes,
            jumps: std::array::from_fn(|e| std::array::from_fn(|p| stencil.jumps[e][p])),
            gram: stencil.gram.map(|row| row.map(|g| g * weight)),
            gradients,
            rest: [[0.0; 3]; 3],
        };
        let [f1, f2] = deformation(&gradients, &corners);
        let normal = f1.cross(&f2);
        bend.rest = std::array::from_fn(|e| {
            let jump = bend.jump(e, &at);
            [f1.dot(&jump), f2.dot(&jump), normal.dot(&jump)]
        });
        Some(bend)
    }

    /// K_e x, from differences.
    #[inline]
    fn jump(&self, e: usize, x: &[Vector; N]) -> Vector {
        (1..N).map(|p| (x[p] - x[0]) * self.jumps[e][p]).sum()
    }

    /// The residuals r_e; f1, f2 and f1 x f2; and the factor between f1 x f2 and n.
    #[inline]
    fn residuals(&self, x: &[Vector; N]) -> ([Vector; 3], [Vector; 3], f64) {
        let [f1, f2] = deformation(&self.gradients, &[x[0], x[1], x[2]]);
        let cross = f1.cross(&f2);
        let scale = ((1.0 + CRUSHED_AREA_RATIO * CRUSHED_AREA_RATIO)
            / (cross.norm_squared() + CRUSHED_AREA_RATIO * CRUSHED_AREA_RATIO))
            .sqrt();
        let normal = cross * scale;
        let residuals = std::array::from_fn(|e| {
            let [a, b, c] = self.rest[e];
            self.jump(e, x) - f1 * a - f2 * b - normal * c
        });
        (residuals, [f1, f2, cross], scale)
    }

    /// dr_e / dx_p from f1, f2, f1 x f2 and the factor between f1 x f2 and n.
    #[inline]
    fn derivatives(&self, [f1, f2, cross]: [Vector; 3], scale: f64) -> [[Matrix3<f64>; 3]; N] {
        // With m = f1 x f2: dn = scale (I - m m^T / (m^2 + crushed^2)) (df1 x f2 + f1 x df2).
        let along =
            cross * cross.transpose() / (cross.norm_squared() + CRUSHED_AREA_RATIO * CRUSHED_AREA_RATIO);
        let across = (Matrix3::identity() - along) * scale;
        let (by_f1, by_f2) = (across * -f2.cross_matrix(), across * f1.cross_matrix());
        std::array::from_fn(|p| {
            let [g1, g2] = if p < 3 { self.gradients[p] } else { [0.0; 2] };
            let turn = by_f1 * g1 + by_f2 * g2;
            std::array::from_fn(|e| {
                let [a, b, c] = self.rest[e];
                Matrix3::from_diagonal_element(self.jumps[e][p] - a * g1 - b * g2) - turn * c
            })
        })
    }

    /// The stresses G r of the residuals.
    #[inline]
    fn weighted<T: Copy + std::ops::Mul<f64, Output = T> + std::iter::Sum>(&self, r: &[T; 3]) -> [T; 3] {
        self.gram.map(|row| (0..3).map(|f| r[f] * row[f]).sum())
    }
}

impl<const N: usize> Element<N> for CurvedBend<N> {
    #[inline]
    fn nodes(&self) -> [u32; N] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; N], _start: Option<Start<'_, N>>) -> f64 {
        let (r, _, _) = self.residuals(x);
        let stress = self.weighted(&r);
        0.5 * (0..3).map(|e| r[e].dot(&stress[e])).sum::<f64>()
    }

    type Frame = ();

    fn linearize_in(
        &self,
        (): &(),
        x: &[Vector; N],
        _start: Option<Start<'_, N>>,
        _filter: Filter,
    ) -> Linearization<N> {
        let (r, frame, scale) = self.residuals(x);
        let stress = self.weighted(&r);
        let derivative = self.derivatives(frame, scale);
        let mut out = Linearization {
            energy: 0.5 * (0..3).map(|e| r[e].dot(&stress[e])).sum::<f64>(),
            gradient: [Vector::zeros(); N],
            hessian: [[Matrix3::zeros(); N]; N],
        };
        for p in 0..N {
            out.gradient[p] = (0..3).map(|e| derivative[p][e].tr_mul(&stress[e])).sum();
            let weighted = self.weighted(&derivative[p]);
            for q in p..N {
                out.hessian[p][q] = (0..3).map(|e| weighted[e].tr_mul(&derivative[q][e])).sum();
            }
        }
        out
    }

    fn gradient(&self, x: &[Vector; N], _start: Option<Start<'_, N>>) -> [Vector; N] {
        let (r, frame, scale) = self.residuals(x);
        let stress = self.weighted(&r);
        let derivative = self.derivatives(frame, scale);
        std::array::from_fn(|p| (0..3).map(|e| derivative[p][e].tr_mul(&stress[e])).sum())
    }

    fn describe(&self, model: &mut ElementModel) {
        let [_, g1, g2] = self.gradients;
        model.bends.push(BendElement {
            nodes: std::array::from_fn(|p| self.nodes.get(p).copied().unwrap_or(u32::MAX)),
            jumps: self.jumps.map(|jump| std::array::from_fn(|p| jump.get(p).copied().unwrap_or(0.0))),
            gram: self.gram,
            gradients: [g1, g2],
            rest: self.rest,
            crushed: CRUSHED_AREA_RATIO,
        });
    }
}

/// Bending elements of a sheet, by the number of neighbors of their triangles.
#[derive(Default)]
pub(crate) struct CurvedBends {
    pub one: Vec<CurvedBend<4>>,
    pub two: Vec<CurvedBend<5>>,
    pub three: Vec<CurvedBend<6>>,
}

impl CurvedBends {
    /// Adds a sheet over nodes with rest positions `rest`, with stiffness `stiffness` [N m].
    pub fn add(&mut self, triangles: &[[u32; 3]], rest: &[Vector], stiffness: f64) {
        for_each_stencil(triangles, rest, |stencil| {
            let stencil = stencil.merged();
            match stencil.nodes.len() {
                4 => self.one.extend(CurvedBend::new(&stencil, rest, stiffness)),
                5 => self.two.extend(CurvedBend::new(&stencil, rest, stiffness)),
                6 => self.three.extend(CurvedBend::new(&stencil, rest, stiffness)),
                // A triangle without neighbors cannot bend.
                _ => {}
            }
        });
    }
}

#[cfg(test)]
mod tests;
