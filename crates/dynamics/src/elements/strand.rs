//! Strands: springs along edges, and bending springs at inner vertices.
//!
//! | element | energy | over |
//! |---|---|---|
//! | [`StrandEdge`] | EA/2 L (l/L - 1)^2 | an edge of rest length L, length l |
//! | [`StrandTurn`] | EI/(2 M) (\|w\| - w0)^2, w = (x_c - x_b)/L_c - (x_b - x_a)/L_a | two edges that meet in b, M = (L_a + L_c)/2 |
//!
//! w is the jump of the tangent and linear in positions; \|w\|/M is the curvature (2 sin(angle/2)/M
//! unstretched) and w0 the length of w at rest. For a straight rest shape, w0 = 0, the Hessian is constant
//! (Bergou, Wardetzky, Robinson, Audoly and Grinspun 2008, "Discrete Elastic Rods", bending of isotropic
//! rods). A curved rest shape fixes the angle between the edges, but not the plane of bending: there is no
//! twist, and a curl may roll over.
//!
//! Where k edges meet, each pair of them resists bending with 2/k of the stiffness. A path through a
//! branching vertex then bends nearly as it would without the branches (by a sixth more easily if one branch
//! stands at right angles), because the branches rotate with it.
//!
//! Damping of edges is a potential of the Green strain increment since the start of the step, `beta/dt EA/2 L
//! dE^2`, dE = (l^2 - l0^2)/(2 L^2); it is invariant under rotations. Damping of bending is `beta/dt EI/(2 M)
//! |w - w_start|^2`, which depends slightly on rotations of bent strands.

use super::element::{Element, Linearization, Start};
use super::filter::Filter;
use crate::linear::assembly::{ElementModel, StrandElement};
use crate::material::rest_shape::RestShape;
use crate::material::strand::StrandMaterial;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Lower bound of divisors in transverse curvatures: lengths over the rest length, and jumps of the tangent
/// over the jump at rest. Forces do not depend on it.
const MIN_RATIO: f64 = 0.05;

/// A spring along an edge.
#[derive(Clone, Debug)]
pub(crate) struct StrandEdge {
    nodes: [u32; 2],
    /// Rest length [m].
    length: f64,
    /// EA [N].
    stiffness: f64,
    /// Damping time [s].
    damping: f64,
}

impl StrandEdge {
    /// An edge over `nodes` with rest positions `rest`; None if it has no length at rest.
    pub fn new(nodes: [u32; 2], rest: &[Vector; 2], stiffness: f64, damping: f64) -> Option<Self> {
        let length = (rest[1] - rest[0]).norm();
        (length > 0.0 && length.is_finite()).then_some(Self { nodes, length, stiffness, damping })
    }

    /// Increment of the Green strain from edge vector `d0` to `d`.
    #[inline]
    fn strain_increment(&self, d: &Vector, d0: &Vector) -> f64 {
        (d - d0).dot(&(d + d0)) / (2.0 * self.length * self.length)
    }
}

impl Element<2> for StrandEdge {
    #[inline]
    fn nodes(&self) -> [u32; 2] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 2], start: Option<Start<'_, 2>>) -> f64 {
        let d = x[1] - x[0];
        let strain = d.norm() / self.length - 1.0;
        let mut twice = strain * strain;
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            twice +=
                self.damping * start.rate * self.strain_increment(&d, &(start.x[1] - start.x[0])).powi(2);
        }
        0.5 * self.stiffness * self.length * twice
    }

    type Frame = ();

    fn linearize_in(
        &self,
        (): &(),
        x: &[Vector; 2],
        start: Option<Start<'_, 2>>,
        filter: Filter,
    ) -> Linearization<2> {
        let d = x[1] - x[0];
        let stretch = d.norm() / self.length;
        let along = if stretch > 0.0 { d / (stretch * self.length) } else { Vector::x() };
        // Force over EA, and axial and transverse curvature over EA / L.
        let mut force = stretch - 1.0;
        let mut axial = 1.0;
        let mut across = 1.0 - 1.0 / stretch.max(MIN_RATIO);
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let factor = self.damping * start.rate;
            let strain = factor * self.strain_increment(&d, &(start.x[1] - start.x[0]));
            force += strain * stretch;
            axial += factor * stretch * stretch + strain;
            across += strain;
        }
        let (axial, across) = (filter.apply(axial), filter.apply(across));
        let gradient = along * (self.stiffness * force);
        let scale = self.stiffness / self.length;
        let block =
            (Matrix3::from_diagonal_element(across) + along * along.transpose() * (axial - across)) * scale;
        let mut out = Linearization {
            energy: self.energy(x, start),
            gradient: [-gradient, gradient],
            hessian: [[block; 2]; 2],
        };
        out.hessian[0][1] = -block;
        out
    }

    fn gradient(&self, x: &[Vector; 2], start: Option<Start<'_, 2>>) -> [Vector; 2] {
        let d = x[1] - x[0];
        let stretch = d.norm() / self.length;
        let along = if stretch > 0.0 { d / (stretch * self.length) } else { Vector::x() };
        let mut force = stretch - 1.0;
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let strain = self.strain_increment(&d, &(start.x[1] - start.x[0]));
            force += self.damping * start.rate * strain * stretch;
        }
        let gradient = along * (self.stiffness * force);
        [-gradient, gradient]
    }

    fn describe(&self, model: &mut ElementModel) {
        let [a, b] = self.nodes;
        model.strands.push(StrandElement {
            nodes: [u32::MAX, a, b],
            inverse_lengths: [0.0, 1.0 / self.length],
            stiffness: self.stiffness * self.length,
            rest: 1.0,
            damping: self.damping,
        });
    }
}

/// A bending spring between two edges that meet.
#[derive(Clone, Debug)]
pub(crate) struct StrandTurn {
    nodes: [u32; 3],
    /// 1 / L_a and 1 / L_c [1/m].
    inverse_lengths: [f64; 2],
    /// Length of w at rest [1].
    rest: f64,
    /// EI / M [N m].
    stiffness: f64,
    /// Damping time [s].
    damping: f64,
}

impl StrandTurn {
    /// The bending spring at `nodes[1]`. Its rest shape is straight, or that of the rest positions `rest`.
    /// Returns `None` if an edge has no length at rest. `stiffness` is the bending stiffness EI [N m^2].
    pub fn new(
        nodes: [u32; 3],
        rest: &[Vector; 3],
        straight: bool,
        stiffness: f64,
        damping: f64,
    ) -> Option<Self> {
        let (la, lc) = ((rest[1] - rest[0]).norm(), (rest[2] - rest[1]).norm());
        let mut turn = Self {
            nodes,
            inverse_lengths: [1.0 / la, 1.0 / lc],
            rest: 0.0,
            stiffness: 2.0 * stiffness / (la + lc),
            damping,
        };
        if !straight {
            turn.rest = turn.jump(rest).norm();
            // For a straight strand rounding leaves a small vector with a meaningless direction.
            if turn.rest < 1e-12 {
                turn.rest = 0.0;
            }
        }
        turn.inverse_lengths.iter().all(|i| i.is_finite()).then_some(turn)
    }

    #[inline]
    fn jump(&self, x: &[Vector; 3]) -> Vector {
        (x[2] - x[1]) * self.inverse_lengths[1] - (x[1] - x[0]) * self.inverse_lengths[0]
    }
}

impl Element<3> for StrandTurn {
    #[inline]
    fn nodes(&self) -> [u32; 3] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> f64 {
        let jump = self.jump(x);
        let turning = jump.norm() - self.rest;
        let mut twice = turning * turning;
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            twice += self.damping * start.rate * (jump - self.jump(start.x)).norm_squared();
        }
        0.5 * self.stiffness * twice
    }

    type Frame = ();

    fn linearize_in(
        &self,
        (): &(),
        x: &[Vector; 3],
        start: Option<Start<'_, 3>>,
        filter: Filter,
    ) -> Linearization<3> {
        let jump = self.jump(x);
        let turning = jump.norm();
        let along = if turning > 0.0 { jump / turning } else { Vector::zeros() };
        let mut force = jump - along * self.rest;
        let mut axial = 1.0;
        let mut across =
            if self.rest > 0.0 { 1.0 - self.rest / turning.max(MIN_RATIO * self.rest) } else { 1.0 };
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            let factor = self.damping * start.rate;
            force += (jump - self.jump(start.x)) * factor;
            axial += factor;
            across += factor;
        }
        let (axial, across) = (filter.apply(axial), filter.apply(across));
        let block = (Matrix3::from_diagonal_element(across) + along * along.transpose() * (axial - across))
            * self.stiffness;
        let [a, c] = self.inverse_lengths;
        let weights = [a, -a - c, c];
        Linearization {
            energy: self.energy(x, start),
            gradient: weights.map(|w| force * (w * self.stiffness)),
            hessian: weights.map(|wa| weights.map(|wb| block * (wa * wb))),
        }
    }

    fn gradient(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>) -> [Vector; 3] {
        let jump = self.jump(x);
        let turning = jump.norm();
        let along = if turning > 0.0 { jump / turning } else { Vector::zeros() };
        let mut force = jump - along * self.rest;
        if let Some(start) = start.filter(|_| self.damping > 0.0) {
            force += (jump - self.jump(start.x)) * (self.damping * start.rate);
        }
        let [a, c] = self.inverse_lengths;
        [a, -a - c, c].map(|w| force * (w * self.stiffness))
    }

    fn describe(&self, model: &mut ElementModel) {
        model.strands.push(StrandElement {
            nodes: self.nodes,
            inverse_lengths: self.inverse_lengths,
            stiffness: self.stiffness,
            rest: self.rest,
            damping: self.damping,
        });
    }
}

/// Elements of one body of strands: `edges` over nodes with rest positions `rest`.
pub(crate) fn strand_elements(
    edges: &[[u32; 2]],
    rest: &[Vector],
    material: &StrandMaterial,
) -> (Vec<StrandEdge>, Vec<StrandTurn>) {
    let at = |n: u32| rest[n as usize];
    let springs = edges.iter().filter_map(|&nodes| {
        StrandEdge::new(nodes, &nodes.map(at), material.stretch_stiffness, material.stretch_damping)
    });
    let mut turns = Vec::new();
    if material.bend_stiffness > 0.0 {
        // Neighbors by vertex, in the order of edges.
        let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &[a, b] in edges {
            around.entry(a).or_default().push(b);
            around.entry(b).or_default().push(a);
        }
        for (&center, others) in &around {
            for (k, &c) in others.iter().enumerate() {
                for &a in &others[..k] {
                    let nodes = [a, center, c];
                    turns.extend(StrandTurn::new(
                        nodes,
                        &nodes.map(at),
                        material.rest_shape == RestShape::Flat,
                        material.bend_stiffness * 2.0 / others.len() as f64,
                        material.bend_damping,
                    ));
                }
            }
        }
    }
    (springs.collect(), turns)
}

#[cfg(test)]
mod tests;
