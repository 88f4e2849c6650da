//! Edges of cloth at their stretch limits, as springs of the dynamics.
//!
//! The collision stage keeps edges within their limits, in the metric of mass: without knowing of limits, the dynamics would
//! stretch them beyond in each iteration, and the collision stage would draw them back at the cost of their neighbours, which it
//! crushes. A taut edge is a one-sided spring like a contact: it pulls from its limit on, and carries its force from iteration to
//! iteration.

use bowknot_constraints::{EdgeReference, Feature};
use bowknot_dynamics::RepulsionSpring;
use bowknot_geometry::{Point, Vector};
use bowknot_twoway::Problem;

/// Share of its limit from which on an edge counts as taut.
const TAUT: f64 = 0.99;

/// Share of the length at the start of a time step that the limit never falls below: what starts beyond is drawn back a little at a
/// time.
const START_SHARE: f64 = 0.97;

/// What a taut edge stands for among contacts: the edge with itself.
pub fn features(edge: u32) -> [Feature; 2] {
    [Feature::Edge(edge), Feature::Edge(edge)]
}

/// The edges between vertices that are `limited` and that are taut at `x` or of which a force `is_carried`, each as a spring; `start`
/// are positions at the start of the time step.
pub fn edges<'a>(
    problem: &'a Problem,
    x: &'a [Point],
    start: &'a [Point],
    stiffness: f64,
    limited: impl Fn(u32) -> bool + 'a,
    is_carried: impl Fn(&[Feature; 2]) -> bool + 'a,
) -> impl Iterator<Item = ([Feature; 2], RepulsionSpring)> + 'a {
    let constraints = &problem.params.constraints;
    let all = match constraints.edges && constraints.edge_reference == EdgeReference::Rest {
        true => problem.model.topology().edges.as_slice(),
        false => &[],
    };
    all.iter().enumerate().filter_map(move |(e, &[a, b])| {
        let [from, to] = [a, b].map(|v| v as usize);
        if !limited(a) {
            return None;
        }
        let body = problem.model.vertex_body()[from];
        let rest = (problem.rest[from] - problem.rest[to]).norm();
        let limit = problem.stretch_limit(body) * rest;
        if !limit.is_finite() {
            return None;
        }
        let limit = limit.max(START_SHARE * (start[from] - start[to]).norm());
        let (edge, features) = (x[from] - x[to], features(e as u32));
        let length = edge.norm();
        if length < TAUT * limit && !is_carried(&features) {
            return None;
        }
        // As a gap: minus the length, which must stay above minus the limit.
        let spring = RepulsionSpring {
            vertices: [a, b, a, a],
            weights: [-1.0, 1.0, 0.0, 0.0],
            normal: edge.try_normalize(0.0)?,
            offset: 0.0,
            desired: -limit,
            stiffness,
            friction: 0.0,
            force: Vector::zeros(),
        };
        Some((features, spring))
    })
}
