//! Edges of cloth at their stretch limits, as springs of the dynamics.
//!
//! The collision stage keeps edges within their limits, in the metric of mass. If the dynamics did not know
//! the limits, it would stretch edges beyond them in each iteration, and the collision stage would pull them
//! back and crush their neighbors. So a taut edge is a one-sided spring like a contact: it pulls beyond its
//! limit, and its force passes to the next iteration. Forces that rows of the collision stage add are not
//! passed on.

use bowknot_constraints::{EdgeLimits, EdgeReference, Feature};
use bowknot_dynamics::RepulsionSpring;
use bowknot_geometry::{Point, Vector};
use bowknot_scene::BodyKind;
use bowknot_scene::world::World;
use bowknot_twoway::CollisionScene;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// Share of its limit above which an edge counts as taut.
const TAUT: f64 = 0.99;

/// Edges that one thread looks at, at least.
const MIN_EDGES: usize = 4096;

/// The edges that have a stretch limit.
#[derive(Clone, Debug, Default)]
pub(super) struct LimitedEdges {
    edges: Vec<LimitedEdge>,
}

#[derive(Clone, Copy, Debug)]
struct LimitedEdge {
    /// Index in the topology.
    index: u32,
    vertices: [u32; 2],
    /// Largest length [m].
    limit: f64,
}

impl LimitedEdges {
    /// The edges of cloth and strands with limits relative to their rest lengths. Limits relative to the
    /// start of each call do not bound the stretch over several calls, so these edges get no springs.
    pub fn new(scene: &CollisionScene, world: &World) -> Self {
        let constraints = &scene.params().contact;
        if !constraints.edges || constraints.edge_reference != EdgeReference::Rest {
            return Self::default();
        }
        let limited = |(index, &vertices): (usize, &[u32; 2])| {
            let [a, b] = vertices.map(|v| scene.rest()[v as usize]);
            let body = scene.model().vertex_body()[vertices[0] as usize];
            let limit = scene.stretch_limit(body) * (a - b).norm();
            let kind = world.bodies[body as usize].kind;
            // Bodies asleep are obstacles for the collision stage.
            let limits = matches!(kind, Some(BodyKind::Cloth | BodyKind::Strands))
                && limit.is_finite()
                && !scene.model().is_obstacle(vertices[0]);
            limits.then_some(LimitedEdge { index: index as u32, vertices, limit })
        };
        Self { edges: scene.model().topology().edges.iter().enumerate().filter_map(limited).collect() }
    }

    /// The edges that are taut at `x` or carry a force: each as a spring of the given `stiffness`, and the
    /// edge twice as its features. `start` are positions at the start of the time step.
    pub fn taut(
        &self,
        x: &[Point],
        start: &[Point],
        stiffness: f64,
        loaded: &FxHashSet<[Feature; 2]>,
    ) -> Vec<([Feature; 2], RepulsionSpring)> {
        let of_edge = |features: &[Feature; 2]| match features {
            [Feature::Edge(a), Feature::Edge(b)] if a == b => Some(*a),
            _ => None,
        };
        let loaded: FxHashSet<u32> = loaded.iter().filter_map(of_edge).collect();
        let length = |x: &[Point], [a, b]: [u32; 2]| x[a as usize] - x[b as usize];
        let taut = |edge: &LimitedEdge| {
            let now = length(x, edge.vertices);
            let slack = now.norm_squared() < (TAUT * edge.limit).powi(2);
            if slack && (loaded.is_empty() || !loaded.contains(&edge.index)) {
                return None;
            }
            let [a, b] = edge.vertices;
            let spring = RepulsionSpring {
                vertices: [a, b, a, a],
                weights: [-1.0, 1.0, 0.0, 0.0],
                normal: now.try_normalize(0.0)?,
                offset: 0.0,
                // The gap is minus the length, which must stay above minus the limit.
                desired: -EdgeLimits::of_rest(edge.limit, length(start, edge.vertices).norm()),
                stiffness,
                friction: 0.0,
                force: Vector::zeros(),
            };
            Some(([Feature::Edge(edge.index); 2], spring))
        };
        self.edges.par_iter().with_min_len(MIN_EDGES).filter_map(taut).collect()
    }
}
