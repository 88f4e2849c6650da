//! Strands: springs along edges, and springs on the turning at inner vertices.
//!
//! | element | energy | over |
//! |---|---|---|
//! | [`StrandEdge`] | EA/2 L (l/L - 1)^2 | an edge of rest length L, length l |
//! | [`StrandTurn`] | EI/(2 M) (\|w\| - w0)^2, w = (x_c - x_b)/L_c - (x_b - x_a)/L_a | two edges that meet in b, M = (L_a + L_c)/2 |
//!
//! w is the jump of the tangent, linear in positions, \|w\|/M the curvature (2 sin(angle/2)/M unstretched)
//! and w0 its value at rest. A straight rest shape, w0 = 0, gives a constant Hessian (Bergou, Wardetzky,
//! Robinson, Audoly and Grinspun 2008, "Discrete Elastic Rods", bending of isotropic rods). A curved one
//! keeps how much the strand turns, not in which plane: there is no twist, and a curl may roll over.
//!
//! Where k edges meet, every two of them turn against each other with 2/k of the stiffness: a path through a
//! branching vertex then bends nearly as it would without branches, whose own turning gives way (by a sixth
//! more easily where the branch stands at right angles).
//!
//! Damping of edges is a potential of the Green strain increment since the start of the step,
//! `beta/dt EA/2 L dE^2`, dE = (l^2 - l0^2)/(2 L^2): blind to rotations. Damping of turns is
//! `beta/dt EI/(2 M) |w - w_start|^2`, which sees rotations of bent strands, slightly.

use super::{Element, Filter, Linearisation, Start};
use bowknot_geometry::Vector;
use nalgebra::Matrix3;

/// Lengths (over rest length) and turnings below this count as this in curvatures across; forces do not use it.
const FLOOR: f64 = 0.05;

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
    /// An edge over `nodes` with rest positions `rest`; None if it has no length there.
    pub fn new(nodes: [u32; 2], rest: &[Vector; 2], stiffness: f64, damping: f64) -> Option<Self> {
        let length = (rest[1] - rest[0]).norm();
        (length > 0.0 && length.is_finite()).then_some(Self { nodes, length, stiffness, damping })
    }

    /// Increment of Green's strain from edge vector `d0` to `d`.
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

    fn linearise(&self, x: &[Vector; 2], start: Option<Start<'_, 2>>, filter: Filter) -> Linearisation<2> {
        let d = x[1] - x[0];
        let stretch = d.norm() / self.length;
        let along = if stretch > 0.0 { d / (stretch * self.length) } else { Vector::x() };
        // Force, and curvatures along and across, all over EA / L.
        let mut force = stretch - 1.0;
        let mut axial = 1.0;
        let mut across = 1.0 - 1.0 / stretch.max(FLOOR);
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
        let mut out = Linearisation {
            energy: self.energy(x, start),
            gradient: [-gradient, gradient],
            hessian: [[block; 2]; 2],
        };
        out.hessian[0][1] = -block;
        out
    }
}

/// A spring on the turning between two edges that meet.
#[derive(Clone, Debug)]
pub(crate) struct StrandTurn {
    nodes: [u32; 3],
    /// 1 / L_a and 1 / L_c [1/m].
    inverse_lengths: [f64; 2],
    /// Rest length of w [1].
    rest: f64,
    /// EI / M [N m].
    stiffness: f64,
    /// Damping time [s].
    damping: f64,
}

impl StrandTurn {
    /// The turning at `nodes[1]` with rest positions `rest`, straight or as they are; None if an edge has no
    /// length there. `stiffness` is EI [N m^2].
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
            // What rounding leaves of a straight strand would have a direction.
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

    fn linearise(&self, x: &[Vector; 3], start: Option<Start<'_, 3>>, filter: Filter) -> Linearisation<3> {
        let jump = self.jump(x);
        let turning = jump.norm();
        let along = if turning > 0.0 { jump / turning } else { Vector::zeros() };
        let mut force = jump - along * self.rest;
        let mut axial = 1.0;
        let mut across = if self.rest > 0.0 { 1.0 - self.rest / turning.max(FLOOR * self.rest) } else { 1.0 };
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
        Linearisation {
            energy: self.energy(x, start),
            gradient: weights.map(|w| force * (w * self.stiffness)),
            hessian: weights.map(|wa| weights.map(|wb| block * (wa * wb))),
        }
    }
}

/// Elements of one body of strands: `edges` over nodes with rest positions `rest`.
pub(crate) fn strand_elements(
    edges: &[[u32; 2]],
    rest: &[Vector],
    material: &crate::StrandMaterial,
) -> (Vec<StrandEdge>, Vec<StrandTurn>) {
    let at = |n: u32| rest[n as usize];
    let springs = edges.iter().filter_map(|&nodes| {
        StrandEdge::new(nodes, &nodes.map(at), material.stretch_stiffness, material.stretch_damping)
    });
    let mut turns = Vec::new();
    if material.bend_stiffness > 0.0 {
        // Neighbours by vertex, in the order of edges.
        let mut around: std::collections::BTreeMap<u32, Vec<u32>> = std::collections::BTreeMap::new();
        for &[a, b] in edges {
            around.entry(a).or_default().push(b);
            around.entry(b).or_default().push(a);
        }
        for (&centre, others) in &around {
            for (k, &c) in others.iter().enumerate() {
                for &a in &others[..k] {
                    let nodes = [a, centre, c];
                    turns.extend(StrandTurn::new(
                        nodes,
                        &nodes.map(at),
                        material.rest_shape == crate::RestShape::Flat,
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
#[path = "strand_tests.rs"]
mod tests;
