//! Tetrahedra of linear strain: ten nodes, the corners and the middles of the edges.
//!
//! The shape functions are L_i (2 L_i - 1) for corner i and 4 L_i L_j for the middle of edge (i, j), with the
//! barycentric coordinates L (Zienkiewicz and Taylor, "The Finite Element Method"). Edges are straight at
//! rest and divided in half, so the gradients of L are constant, and F at a point is that of a
//! [`Tetrahedron`] with its corners at
//!
//! ```text
//! y_k = sum_a (dN_a / dL_k) x_a
//! ```
//!
//! The energy is integrated at four points, L = (a, b, b, b) and so on, exactly for polynomials of second
//! order (Hammer, Marlowe and Stroud 1956): exactly for small strains. The element is therefore four
//! tetrahedra of constant strain whose corners are sums of nodes. It bends without shear locking, and locks
//! little as Poisson's ratio approaches 0.5.

use super::element::{Element, Linearization, Start};
use super::filter::Filter;
use super::svd::{Svd, signed_svds};
use super::tetrahedron::Tetrahedron;
use crate::material::solid::SolidMaterial;
use bowknot_geometry::{TETRAHEDRON_EDGES, Vector};
use nalgebra::Matrix3;

/// Barycentric coordinate of point q: (5 + 3 sqrt 5) / 20 for corner q, and (5 - sqrt 5) / 20 for the others.
const NEAR: f64 = 0.585_410_196_624_968_5;
const FAR: f64 = 0.138_196_601_125_010_5;

/// At each point, the derivatives of each node's shape function by L that are not zero, with the index of L.
/// A corner has one; a zero fills the second place.
const DERIVATIVES: [[[(usize, f64); 2]; 10]; 4] = derivatives();

const fn derivatives() -> [[[(usize, f64); 2]; 10]; 4] {
    let mut all = [[[(0, 0.0); 2]; 10]; 4];
    let mut q = 0;
    while q < 4 {
        let mut i = 0;
        while i < 4 {
            all[q][i] = [(i, 4.0 * coordinate(q, i) - 1.0), (i, 0.0)];
            i += 1;
        }
        let mut e = 0;
        while e < 6 {
            let [i, j] = TETRAHEDRON_EDGES[e];
            all[q][4 + e] = [(i, 4.0 * coordinate(q, j)), (j, 4.0 * coordinate(q, i))];
            e += 1;
        }
        q += 1;
    }
    all
}

const fn coordinate(point: usize, corner: usize) -> f64 {
    if point == corner { NEAR } else { FAR }
}

/// A tetrahedron of a solid, with nodes in the middles of its edges.
#[derive(Clone, Debug)]
pub(crate) struct QuadraticTetrahedron {
    nodes: [u32; 10],
    /// That of the corners, with a quarter of the volume.
    quarter: Tetrahedron,
}

impl QuadraticTetrahedron {
    /// A tetrahedron over `nodes`, the corners first, with its corners at `rest`; None unless its volume at
    /// rest is positive.
    pub fn new(nodes: [u32; 10], rest: &[Vector; 4], material: &SolidMaterial) -> Option<Self> {
        let corners = [nodes[0], nodes[1], nodes[2], nodes[3]];
        let quarter = Tetrahedron::new(corners, rest, material)?.with_share(0.25);
        Some(Self { nodes, quarter })
    }
}

/// The corners y of the tetrahedron at a point, relative to corner 0 of the element.
#[inline]
fn corners(point: usize, x: &[Vector; 10]) -> [Vector; 4] {
    let mut y = [Vector::zeros(); 4];
    for (x_a, terms) in x.iter().zip(&DERIVATIVES[point]) {
        let from_corner = x_a - x[0];
        for &(k, weight) in terms {
            y[k] += from_corner * weight;
        }
    }
    y
}

/// Sum over the four points of what `at` makes of the corners at a point and at the start of the step.
#[inline]
fn at_points(
    x: &[Vector; 10],
    start: Option<Start<'_, 10>>,
    mut at: impl FnMut(usize, &[Vector; 4], Option<Start<'_, 4>>),
) {
    for point in 0..4 {
        let y = corners(point, x);
        let y0 = start.map(|start| (corners(point, start.x), start.rate));
        at(point, &y, y0.as_ref().map(|(y0, rate)| Start { x: y0, rate: *rate }));
    }
}

/// Adds a gradient by the corners y to that by the nodes.
#[inline]
fn add_gradient(point: usize, by_corner: &[Vector; 4], by_node: &mut [Vector; 10]) {
    for (sum, terms) in by_node.iter_mut().zip(&DERIVATIVES[point]) {
        terms.iter().for_each(|&(k, weight)| *sum += by_corner[k] * weight);
    }
}

impl Element<10> for QuadraticTetrahedron {
    #[inline]
    fn nodes(&self) -> [u32; 10] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 10], start: Option<Start<'_, 10>>) -> f64 {
        let mut energy = 0.0;
        at_points(x, start, |_, y, start| energy += self.quarter.energy(y, start));
        energy
    }

    /// The decompositions of F at the four points.
    type Frame = [Svd; 4];

    fn frames(elements: [&Self; 4], x: &[[Vector; 10]; 4]) -> [[Svd; 4]; 4] {
        std::array::from_fn(|e| {
            let at = |point| elements[e].quarter.deformation(&corners(point, &x[e]));
            signed_svds(&std::array::from_fn(at))
        })
    }

    fn linearize_in(
        &self,
        frame: &[Svd; 4],
        x: &[Vector; 10],
        start: Option<Start<'_, 10>>,
        filter: Filter,
    ) -> Linearization<10> {
        let mut out = Linearization {
            energy: 0.0,
            gradient: [Vector::zeros(); 10],
            hessian: [[Matrix3::zeros(); 10]; 10],
        };
        at_points(x, start, |point, y, start| {
            let part = self.quarter.linearize_in(&frame[point], y, start, filter);
            out.energy += part.energy;
            add_gradient(point, &part.gradient, &mut out.gradient);
            for (a, terms) in DERIVATIVES[point].iter().enumerate() {
                // The row of node a by the corners y.
                let mut row = [Matrix3::zeros(); 4];
                for &(k, weight) in terms {
                    for (l, sum) in row.iter_mut().enumerate() {
                        let block = if k <= l { part.hessian[k][l] } else { part.hessian[l][k].transpose() };
                        *sum += block * weight;
                    }
                }
                for (sum, terms) in out.hessian[a].iter_mut().zip(&DERIVATIVES[point]).skip(a) {
                    terms.iter().for_each(|&(l, weight)| *sum += row[l] * weight);
                }
            }
        });
        out
    }

    fn gradient(&self, x: &[Vector; 10], start: Option<Start<'_, 10>>) -> [Vector; 10] {
        let mut gradient = [Vector::zeros(); 10];
        at_points(x, start, |point, y, start| {
            add_gradient(point, &self.quarter.gradient(y, start), &mut gradient);
        });
        gradient
    }
}

#[cfg(test)]
mod tests;
