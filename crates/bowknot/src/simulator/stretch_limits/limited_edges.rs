//! Edges of cloth at their stretch limits, as springs of the dynamics.
//!
//! The collision stage keeps edges within their limits, in the metric of mass. If the dynamics did not know
//! the limits, it would stretch edges beyond them in each iteration, and the collision stage would pull them
//! back and crush their neighbors. So an edge at its limit is a spring with the law of a contact: it pulls
//! beyond the limit, without bound a little farther. The rows of the collision stage begin behind that, and
//! only guard.

use bowknot_constraints::EdgeReference;
use bowknot_dynamics::{RepulsionSpring, SpringKind};
use bowknot_geometry::{Point, Vector};
use bowknot_scene::BodyKind;
use bowknot_scene::world::World;
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{CollisionScene, GUARDED_STRETCH};
use rayon::prelude::*;

/// Share of its limit above which an edge counts as taut.
const TAUT: f64 = 0.98;

/// Way beyond its limit within which the force of an edge grows without bound [1], most of the way to its
/// row. Larger: edges are longer. Smaller: the system is stiffer.
pub(super) const ROOM: f64 = 0.8 * (GUARDED_STRETCH - 1.0);

/// The part of the way that is left to an edge that starts far beyond its limit, so that it is pulled back
/// gently.
const LEFT: f64 = 0.3;

/// How much farther an edge that starts behind its row may be, per meter that it starts behind it [1]. Above
/// 1, so that those a little behind are held as all others, and the force does not jump.
const YIELD: f64 = 3.0;

/// Edges that one thread looks at, at least.
const MIN_EDGES: usize = 4096;

/// The edges that have a stretch limit.
#[derive(Clone, Debug, Default)]
pub(crate) struct LimitedEdges {
    /// By the scene.
    edges: Vec<DistanceLimit>,
    /// The limits in force [m].
    limits: Vec<f64>,
    /// The edges that have a larger limit in force, with it.
    yielding: Vec<DistanceLimit>,
}

impl LimitedEdges {
    /// The edges of cloth and strands with limits relative to their rest lengths. Limits relative to the
    /// start of each call do not bound the stretch over several calls, so these edges get no springs.
    pub fn new(scene: &CollisionScene, world: &World) -> Self {
        let constraints = &scene.params().contact;
        if !constraints.edges || constraints.edge_reference != EdgeReference::Rest {
            return Self::default();
        }
        let limited = |&vertices: &[u32; 2]| {
            let [a, b] = vertices.map(|v| scene.rest()[v as usize]);
            let body = scene.model().vertex_body()[vertices[0] as usize];
            let limit = scene.stretch_limit(body) * (a - b).norm();
            let kind = world.bodies[body as usize].kind;
            // Bodies asleep are obstacles for the collision stage.
            let limits = matches!(kind, Some(BodyKind::Cloth | BodyKind::Strands))
                && limit.is_finite()
                && limit > 0.0
                && !scene.model().is_obstacle(vertices[0]);
            limits.then_some(DistanceLimit { vertices, limit })
        };
        let edges: Vec<DistanceLimit> = scene.model().topology().edges.iter().filter_map(limited).collect();
        Self { limits: edges.iter().map(|edge| edge.limit).collect(), edges, yielding: Vec::new() }
    }

    /// The edges with the limits of the scene [m].
    pub fn edges(&self) -> &[DistanceLimit] {
        &self.edges
    }

    /// Puts the larger limits of some edges, by index [m], in force in place of those before.
    pub fn set_limits(&mut self, larger: impl Iterator<Item = (u32, f64)>) {
        let Self { edges, limits, yielding } = self;
        limits.clear();
        limits.extend(edges.iter().map(|edge| edge.limit));
        larger.for_each(|(k, limit)| limits[k as usize] = limits[k as usize].max(limit));
        let yields = |(edge, &limit): (&DistanceLimit, &f64)| {
            (limit > edge.limit).then_some(DistanceLimit { limit, ..*edge })
        };
        yielding.clear();
        yielding.extend(edges.iter().zip(limits.iter()).filter_map(yields));
    }

    /// The edges that have a larger limit in force than by the scene, with it [m].
    pub fn yielding(&self) -> &[DistanceLimit] {
        &self.yielding
    }

    /// The edges that are nearly taut at `x`: each as a spring of the given `stiffness`. `start` are
    /// positions at the start of the time step.
    pub fn taut_springs(&self, x: &[Point], start: &[Point], stiffness: f64) -> Vec<RepulsionSpring> {
        let length = |x: &[Point], [a, b]: [u32; 2]| x[a as usize] - x[b as usize];
        let taut = |(edge, &limit): (&DistanceLimit, &f64)| {
            let now = length(x, edge.vertices);
            if now.norm_squared() < (TAUT * limit).powi(2) {
                return None;
            }
            let [a, b] = edge.vertices;
            let first = length(start, edge.vertices).norm();
            let longest = longest(limit, first);
            Some(RepulsionSpring {
                kind: SpringKind::Limit,
                vertices: [a, b, a, a],
                weights: [-1.0, 1.0, 0.0, 0.0],
                normal: now.try_normalize(0.0)?,
                offset: -longest,
                reach: ROOM * limit,
                floor: 0.0,
                start_gap: longest - first,
                stiffness,
                friction: 0.0,
                friction_ratio: Vector::zeros(),
            })
        };
        self.edges.par_iter().zip(&self.limits).with_min_len(MIN_EDGES).filter_map(taut).collect()
    }
}

/// Length at which the force of an edge with this `limit` becomes infinite, if it is `first` long at the
/// start of the time step [m].
fn longest(limit: f64, first: f64) -> f64 {
    let room = ROOM * limit;
    let wall = limit + room;
    let beyond = (first - GUARDED_STRETCH * limit).max(0.0);
    (wall + YIELD * beyond).min(wall.max(first + LEFT * room))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_within_their_rows_have_one_wall_and_those_far_beyond_are_pulled_back_gently() {
        let wall = 1.0 + ROOM;
        for first in [0.9, 1.0, wall, GUARDED_STRETCH] {
            assert_eq!(longest(1.0, first), wall, "{first}");
        }
        assert_eq!(longest(1.0, 1.5), 1.5 + LEFT * ROOM);
        let lengths = (0..1000).map(|k| longest(1.0, GUARDED_STRETCH + 1e-5 * f64::from(k)));
        let steps: Vec<f64> = lengths.collect::<Vec<_>>().windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (0.0..=YIELD * 1.001e-5).contains(step)), "it jumps");
    }
}
