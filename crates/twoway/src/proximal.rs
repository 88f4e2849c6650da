//! The proximal term of the backward step: it replaces part of the curvature that linearization drops.
//!
//! An edge of length |e| with a multiplier lambda has the curvature lambda/|e| sideways, and a contact
//! lambda/r, where r is the radius of curvature of the contact. This is the local edge length h if a face or
//! two crossing edges define the normal. It is the distance d if a vertex or one of two parallel edges does,
//! because grains and hairs roll about each other; with h in place of d they do not come to rest.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_constraints::EdgeForm;
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_lcp::DistanceLimit;

/// Largest proximal weight of a vertex, in its mass.
///
/// The weight is made of multipliers, and the larger the weight, the larger the multipliers that move the
/// vertex. Without a bound both grow without limit where rows ask for more than a fraction of an edge, and x
/// stops before it reaches the limits.
pub(crate) const MAX_PROXIMAL_MASS: f64 = 100.0;

/// A closest point is at a vertex if the other weights of its side are at most this.
const AT_VERTEX: f64 = 1e-6;

/// Adds the curvature of the edge limits to `proximal`, one entry per vertex [1]. Multipliers [m] are
/// `forces` in the ball form and `scalars` in the linear form.
pub(crate) fn add_edges(
    proximal: &mut [f64],
    scene: &CollisionScene,
    state: &ResolveState,
    balls: &[DistanceLimit],
    forces: &[Vector],
    scalars: &[f64],
) {
    let strength = scene.params().solver.backward.edge_proximal;
    if strength == 0.0 {
        return;
    }
    for (k, ball) in balls.iter().enumerate() {
        let lambda = match scene.params().contact.edge_form {
            EdgeForm::Ball => forces[k].norm(),
            EdgeForm::Linear => scalars[k],
        };
        if lambda > 0.0 {
            let [a, b] = ball.vertices.map(|v| v as usize);
            let length = (state.x[a] - state.x[b]).norm().max(f64::MIN_POSITIVE);
            let mu = strength * lambda / length;
            proximal[a] += mu;
            proximal[b] += mu;
        }
    }
}

/// Adds the curvature of the contacts.
pub(crate) fn add_contacts(proximal: &mut [f64], scene: &CollisionScene, state: &ResolveState) {
    let strength = scene.params().solver.backward.contact_proximal;
    if strength == 0.0 {
        return;
    }
    let contacts = &state.contacts;
    for kind in PairKind::ALL {
        for p in contacts.pairs.range(kind) {
            let lambda = contacts.multipliers[p];
            if lambda == 0.0 {
                continue;
            }
            let (vertices, separation) = (&contacts.pairs.pairs()[p].vertices, &contacts.separations[p]);
            let origin = origin(kind, separation, vertices, &state.x);
            let distance = separation.distance.max(contacts.desired[p]);
            for k in 0..kind.vertex_count() {
                let v = vertices[k] as usize;
                let radius = curvature_radius(origin, distance, scene.local_edge(v));
                proximal[v] += strength * lambda * separation.weights[k] / radius;
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
