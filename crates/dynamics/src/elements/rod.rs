//! Rods: strands that resist twist as well, and whose bending knows its direction.
//!
//! Each edge (a, b) has a frame point p beside its middle. With m = (a + b)/2, the tangent t and u = p - m, the
//! directors of the edge are d1 along u - (u . t) t and d2 = t x d1. Springs along (a, p) and (b, p) keep p in place
//! but for turns about the edge, which only this element resists:
//!
//! ```text
//! energy = EI/(2 M) ((k1 - k1_0)^2 + (k2 - k2_0)^2) + GJ/(2 M) (m - m_0)^2,    M = (L + L')/2
//! k1 = kb . (d2 + d2')/2,   k2 = -kb . (d1 + d1')/2,   kb = 2 t x t' / (1 + t . t')
//! ```
//!
//! m is the angle about t' from d1, transported from t to t', to d1': the twist, up to half a turn. Source: Bergou,
//! Wardetzky, Robinson, Audoly and Grinspun, "Discrete Elastic Rods", 2008, and the derivatives by edges in Bergou,
//! Audoly, Vouga, Wardetzky and Grinspun, "Discrete Viscous Threads", 2010. Points in place of angles: Umetani, Schmidt
//! and Stam, "Position-based Elastic Rods", 2014.
//!
//! A small rotation of d1 about t, beyond what transport makes of a change of t, is d2 . du/h - (u . t) d2 . de/(h l)
//! for u, the edge e of length l, and h = |u - (u . t) t|. The Hessian is that of Gauss and Newton: K/M times the outer
//! product of the gradient of each of k1, k2 and m. It has no negative eigenvalue.
//!
//! Damping is `beta/dt K/(2 M)` times the squared change of each since the start of the step; it does not depend on
//! rotations.

use super::element::{Element, Linearization, Start};
use super::filter::Filter;
use super::strand::StrandEdge;
use crate::material::rest_shape::RestShape;
use crate::material::strand::StrandMaterial;
use bowknot_geometry::{Vector, transported};
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Lower bound of 1 + t . t': forces stay finite where edges fold back.
const MIN_OPENNESS: f64 = 1e-9;

/// Lower bound of the length of an edge and of the distance of its frame point, over its length at rest.
const MIN_RATIO: f64 = 1e-3;

/// Bending and twist between two edges that meet.
#[derive(Clone, Debug)]
pub(crate) struct RodTurn {
    /// The vertices a, b, c of the edges (a, b) and (b, c), and their frame points.
    nodes: [u32; 5],
    /// k1, k2 and m at rest.
    rest: [f64; 3],
    /// EI/M, EI/M and GJ/M [N m].
    stiffness: [f64; 3],
    /// Damping time [s].
    damping: f64,
    /// Lengths of the edges at rest [m].
    lengths: [f64; 2],
}

/// The directors of an edge.
struct Frame {
    /// Tangent and length of the edge.
    t: Vector,
    length: f64,
    d1: Vector,
    d2: Vector,
    /// Distance of the frame point from the line of the edge, and its place along it from the middle.
    height: f64,
    along: f64,
}

impl Frame {
    /// Of the edge (a, b) with the frame point p; lengths are bounded by that `at_rest`.
    fn new([a, b, p]: [&Vector; 3], at_rest: f64) -> Self {
        let least = (MIN_RATIO * at_rest).max(f64::MIN_POSITIVE);
        let edge = b - a;
        let length = edge.norm().max(least);
        let t = edge / length;
        let u = p - (a + b) * 0.5;
        let along = u.dot(&t);
        let across = u - t * along;
        let height = across.norm().max(least);
        let d1 = across / height;
        Self { t, length, d1, d2: t.cross(&d1), height, along }
    }

    /// Gradients of the rotation of d1 about t by the edge and by the frame point; its ends take half of the latter
    /// each, with the other sign.
    fn turn(&self) -> (Vector, Vector) {
        let by_point = self.d2 / self.height;
        (by_point * (-self.along / self.length), by_point)
    }
}

/// Curvatures and twist of two edges that meet.
struct Bend {
    frames: [Frame; 2],
    /// kb.
    curvature: Vector,
    /// 1 + t . t'.
    openness: f64,
    /// k1, k2, m.
    values: [f64; 3],
}

impl Bend {
    fn new([a, b, c, p, q]: &[Vector; 5], lengths: [f64; 2]) -> Self {
        let frames = [Frame::new([a, b, p], lengths[0]), Frame::new([b, c, q], lengths[1])];
        let [f, g] = &frames;
        let openness = (1.0 + f.t.dot(&g.t)).max(MIN_OPENNESS);
        let curvature = f.t.cross(&g.t) * (2.0 / openness);
        let carried = transported(&f.d1, &f.t, &g.t);
        let twist = libm::atan2(carried.cross(&g.d1).dot(&g.t), carried.dot(&g.d1));
        let k1 = curvature.dot(&(f.d2 + g.d2)) * 0.5;
        let k2 = -curvature.dot(&(f.d1 + g.d1)) * 0.5;
        Self { frames, curvature, openness, values: [k1, k2, twist] }
    }

    /// Gradients of k1, k2 and m by the five nodes.
    fn gradients(&self) -> [[Vector; 5]; 3] {
        let [f, g] = &self.frames;
        let kb = &self.curvature;
        let tilde = |v: Vector| v / self.openness;
        let (t, d1, d2) = (tilde(f.t + g.t), tilde(f.d1 + g.d1), tilde(f.d2 + g.d2));
        let [k1, k2, _] = self.values;
        // By the edges, with directors that are transported.
        let by_edges = [
            [(g.t.cross(&d2) - t * k1) / f.length, -(f.t.cross(&d2) + t * k1) / g.length],
            [-(g.t.cross(&d1) + t * k2) / f.length, (f.t.cross(&d1) - t * k2) / g.length],
            [kb / (2.0 * f.length), kb / (2.0 * g.length)],
        ];
        // By rotations of the directors.
        let by_turns = [
            [-0.5 * kb.dot(&f.d1), -0.5 * kb.dot(&g.d1)],
            [-0.5 * kb.dot(&f.d2), -0.5 * kb.dot(&g.d2)],
            [-1.0, 1.0],
        ];
        let turns = [f.turn(), g.turn()];
        std::array::from_fn(|k| {
            let mut gradient = [Vector::zeros(); 5];
            for (end, (by_edge, by_point)) in turns.iter().enumerate() {
                let edge = by_edges[k][end] + by_edge * by_turns[k][end];
                let point = by_point * by_turns[k][end];
                gradient[end] -= edge + point * 0.5;
                gradient[end + 1] += edge - point * 0.5;
                gradient[end + 3] += point;
            }
            gradient
        })
    }
}

impl RodTurn {
    /// The bending and twist between the edges (0, 1) and (1, 2) of the `nodes`, whose frame points are 3 and 4. The rest
    /// shape is straight without twist, or that of the rest positions `rest`. It has this `share` of the stiffness of the
    /// material. Returns `None` if an edge has no length at rest.
    pub fn new(nodes: [u32; 5], rest: &[Vector; 5], material: &StrandMaterial, share: f64) -> Option<Self> {
        let lengths = [rest[1] - rest[0], rest[2] - rest[1]].map(|edge| edge.norm());
        let bend = Bend::new(rest, lengths);
        let per_length = share * 2.0 / (lengths[0] + lengths[1]);
        let StrandMaterial { bend_stiffness, twist_stiffness, .. } = *material;
        let values = if material.rest_shape == RestShape::Flat { [0.0; 3] } else { bend.values };
        let turn = Self {
            nodes,
            rest: values,
            stiffness: [bend_stiffness, bend_stiffness, twist_stiffness].map(|k| k * per_length),
            damping: material.bend_damping,
            lengths,
        };
        lengths.iter().all(|length| *length > 0.0 && length.is_finite()).then_some(turn)
    }

    /// k1, k2 and m at the start of the step, and the factor of their damping; None without damping.
    fn before(&self, start: Option<Start<'_, 5>>) -> Option<([f64; 3], f64)> {
        let start = start.filter(|_| self.damping > 0.0)?;
        Some((Bend::new(start.x, self.lengths).values, self.damping * start.rate))
    }

    /// The energy [J] at these k1, k2 and m.
    fn energy_of(&self, values: &[f64; 3], before: Option<([f64; 3], f64)>) -> f64 {
        let sum = |other: &[f64; 3]| -> f64 {
            (0..3).map(|k| self.stiffness[k] * (values[k] - other[k]) * (values[k] - other[k])).sum()
        };
        0.5 * (sum(&self.rest) + before.map_or(0.0, |(before, factor)| factor * sum(&before)))
    }

    /// For k1, k2 and m, the derivative of the energy by it [N m] and the second one.
    fn moments(&self, values: &[f64; 3], before: Option<([f64; 3], f64)>) -> [[f64; 2]; 3] {
        let mut moments = std::array::from_fn(|k| {
            let stiffness = self.stiffness[k];
            [stiffness * (values[k] - self.rest[k]), stiffness]
        });
        if let Some((before, factor)) = before {
            for (k, before) in before.iter().enumerate() {
                moments[k][0] += factor * self.stiffness[k] * (values[k] - before);
                moments[k][1] += factor * self.stiffness[k];
            }
        }
        moments
    }
}

impl Element<5> for RodTurn {
    #[inline]
    fn nodes(&self) -> [u32; 5] {
        self.nodes
    }

    fn energy(&self, x: &[Vector; 5], start: Option<Start<'_, 5>>) -> f64 {
        self.energy_of(&Bend::new(x, self.lengths).values, self.before(start))
    }

    type Frame = ();

    fn linearize_in(
        &self,
        (): &(),
        x: &[Vector; 5],
        start: Option<Start<'_, 5>>,
        _: Filter,
    ) -> Linearization<5> {
        let (bend, before) = (Bend::new(x, self.lengths), self.before(start));
        let mut out = Linearization {
            energy: self.energy_of(&bend.values, before),
            gradient: [Vector::zeros(); 5],
            hessian: [[Matrix3::zeros(); 5]; 5],
        };
        for (gradient, [moment, stiffness]) in bend.gradients().iter().zip(self.moments(&bend.values, before))
        {
            for a in 0..5 {
                out.gradient[a] += gradient[a] * moment;
                for b in a..5 {
                    out.hessian[a][b] += gradient[a] * gradient[b].transpose() * stiffness;
                }
            }
        }
        out
    }

    fn gradient(&self, x: &[Vector; 5], start: Option<Start<'_, 5>>) -> [Vector; 5] {
        let bend = Bend::new(x, self.lengths);
        let mut sum = [Vector::zeros(); 5];
        for (gradient, [moment, _]) in
            bend.gradients().iter().zip(self.moments(&bend.values, self.before(start)))
        {
            sum.iter_mut().zip(gradient).for_each(|(sum, gradient)| *sum += gradient * moment);
        }
        sum
    }
}

/// Elements of one body of rods: `edges` with their frame points, over nodes with rest positions `rest`. Where several
/// edges meet, each pair of them has a share of the stiffness, as for [`super::strand`].
pub(crate) fn rod_elements(
    edges: &[[u32; 3]],
    rest: &[Vector],
    material: &StrandMaterial,
) -> (Vec<StrandEdge>, Vec<RodTurn>) {
    let at = |n: u32| rest[n as usize];
    let mut springs = Vec::with_capacity(3 * edges.len());
    // Neighbors by vertex with the frame points of the edges to them, in the order of edges.
    let mut around: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
    for &[a, b, p] in edges {
        let StrandMaterial { stretch_stiffness, bend_stiffness, twist_stiffness, stretch_damping, .. } =
            *material;
        let length = (at(b) - at(a)).norm();
        // A frame point is held as firmly as the edge, or as a short thick edge resists a turn.
        let hold = stretch_stiffness.max(16.0 * (bend_stiffness + twist_stiffness) / (length * length));
        for (nodes, stiffness) in [([a, b], stretch_stiffness), ([a, p], hold), ([b, p], hold)] {
            springs.extend(StrandEdge::new(nodes, &nodes.map(at), stiffness, stretch_damping));
        }
        around.entry(a).or_default().push([b, p]);
        around.entry(b).or_default().push([a, p]);
    }
    let mut turns = Vec::new();
    for (&center, others) in &around {
        for (k, &[c, q]) in others.iter().enumerate() {
            for &[a, p] in &others[..k] {
                let nodes = [a, center, c, p, q];
                turns.extend(RodTurn::new(nodes, &nodes.map(at), material, 2.0 / others.len() as f64));
            }
        }
    }
    (springs, turns)
}

#[cfg(test)]
mod tests;
