//! The proximal term of the backward step: it replaces part of the curvature that linearization drops.
//!
//! An edge of length |e| with a multiplier lambda has the curvature lambda/|e| sideways, and a contact
//! lambda/r, where r is the radius of curvature of the contact. This is the local edge length h if a face or
//! two crossing edges define the normal. It is the distance d if a vertex or one of two parallel edges does,
//! because grains and hairs roll about each other; with h in place of d they do not come to rest.

use crate::index_set::IndexSet;
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::{PairKind, Point, Separation};
use bowknot_lcp::DistanceLimit;

/// Largest proximal weight of a vertex, in its mass.
///
/// The weight is made of multipliers, and the larger the weight, the larger the multipliers that move the
/// vertex. Without a bound both grow without limit where rows ask for more than a fraction of an edge, and x
/// stops before it reaches the limits.
pub(crate) const MAX_PROXIMAL_MASS: f64 = 100.0;

/// A closest point is at a vertex if the other weights of its side are at most this.
const AT_VERTEX: f64 = 1e-6;

/// Proximal weights mu of the vertices [1]: of a few, which are listed.
#[derive(Debug, Default)]
pub(crate) struct ProximalWeights {
    weights: Vec<f64>,
    /// The vertices with a weight.
    damped: IndexSet,
}

impl ProximalWeights {
    /// Starts a call with so many vertices.
    pub fn begin(&mut self, vertices: usize) {
        self.clear();
        self.damped.reset(vertices);
        self.weights.resize(vertices, 0.0);
    }

    /// Makes all weights 0.
    pub fn clear(&mut self) {
        self.damped.members().iter().for_each(|&v| self.weights[v as usize] = 0.0);
        self.damped.clear();
    }

    /// The vertices with a weight, and perhaps some more.
    pub fn damped(&self) -> &[u32] {
        self.damped.members()
    }

    /// The weight of a vertex [1].
    pub fn of(&self, vertex: u32) -> f64 {
        self.weights[vertex as usize]
    }

    fn add(&mut self, vertex: u32, weight: f64) {
        self.damped.insert(vertex);
        self.weights[vertex as usize] += weight;
    }

    /// Adds the curvature of edge limits, each with its scalar multiplier [m].
    pub fn add_edges<'a>(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        edges: impl Iterator<Item = (&'a DistanceLimit, f64)>,
    ) {
        let strength = scene.params().solver.backward.edge_proximal;
        if strength == 0.0 {
            return;
        }
        for (ball, lambda) in edges.filter(|(_, lambda)| *lambda > 0.0) {
            let [a, b] = ball.vertices;
            let length = (state.x[a as usize] - state.x[b as usize]).norm().max(f64::MIN_POSITIVE);
            let mu = strength * lambda / length;
            self.add(a, mu);
            self.add(b, mu);
        }
    }

    /// Adds the curvature of the contacts with a multiplier, `pressing`.
    pub fn add_contacts(&mut self, scene: &CollisionScene, state: &ResolveState, pressing: &[u32]) {
        let strength = scene.params().solver.backward.contact_proximal;
        if strength == 0.0 {
            return;
        }
        let contacts = &state.contacts;
        for p in pressing.iter().map(|&p| p as usize) {
            let (kind, lambda) = (contacts.pairs.kind(p), contacts.multipliers[p]);
            let (vertices, separation) = (&contacts.pairs.pairs()[p].vertices, &contacts.separations[p]);
            let origin = origin(kind, separation, vertices, &state.x);
            let distance = separation.distance.max(contacts.deltas[p]);
            for k in 0..kind.vertex_count() {
                let radius = curvature_radius(origin, distance, scene.local_edge(vertices[k] as usize));
                self.add(vertices[k], strength * lambda * separation.weights[k] / radius);
            }
        }
    }
}

/// The features that define the normal of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
enum NormalOrigin {
    /// A face.
    Face,
    /// Two edges that cross at an angle of this sine.
    Crossing(f64),
    /// A vertex and an edge.
    Edge,
    /// Two vertices.
    Point,
}

fn origin(kind: PairKind, separation: &Separation, vertices: &[u32; 4], x: &[Point]) -> NormalOrigin {
    let inside = |weights: &[f64]| weights.iter().filter(|w| **w > AT_VERTEX).count();
    let w = &separation.weights;
    let (a, b) = match kind {
        PairKind::VertexHalfSpace => return NormalOrigin::Face,
        PairKind::VertexVertex => (1, 1),
        PairKind::VertexEdge => (1, inside(&w[1..3])),
        PairKind::VertexTriangle => (1, inside(&w[1..4])),
        PairKind::EdgeEdge => (inside(&w[..2]), inside(&w[2..])),
    };
    match (a, b) {
        (2, 2) => {
            let edge = |k: usize| x[vertices[k] as usize] - x[vertices[k + 1] as usize];
            let (first, second) = (edge(0), edge(2));
            let area = first.cross(&second).norm();
            NormalOrigin::Crossing(area / (first.norm() * second.norm()).max(f64::MIN_POSITIVE))
        }
        (1, 3) => NormalOrigin::Face,
        (1, 2) | (2, 1) => NormalOrigin::Edge,
        _ => NormalOrigin::Point,
    }
}

/// Radius of curvature of a contact [m]: how far a vertex moves while the normal turns by about one radian.
/// The pair is `distance` apart, its edges are of length `edge`.
fn curvature_radius(origin: NormalOrigin, distance: f64, edge: f64) -> f64 {
    match origin {
        NormalOrigin::Face => edge,
        NormalOrigin::Crossing(sine) => (edge * sine).max(distance).min(edge),
        NormalOrigin::Edge => distance.min(edge),
        NormalOrigin::Point => distance,
    }
}

#[cfg(test)]
mod tests;
