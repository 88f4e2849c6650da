//! What holds back the vertices that have farthest to go: the answer to why a call takes many steps.

use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::{PairKind, Separation};
use bowknot_proximity::Pair;
use bowknot_stepper::{Bound, Stepper};

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Largest number of waits that are told.
const MOST: usize = 3;
/// Vertices that are looked at for them: of the same two bodies only the farthest counts.
const LOOKED_AT: usize = 64;

/// A vertex that has far to go, and what holds it back in the last two-way step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Wait {
    /// The vertex.
    pub vertex: u32,
    /// Its body.
    pub body: u32,
    /// Where it was before the step [m].
    pub place: [f64; 3],
    /// Distance that it has left to its modified target after the step [m].
    pub remaining_m: f64,
    /// Why it did not go on.
    pub reason: WaitReason,
    /// The pair that stops it, or what it moves as one with, if it is in contact range.
    pub pair: Option<WaitPair>,
}

/// Why a vertex did not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum WaitReason {
    /// The planes of a pair of its own.
    Planes,
    /// It moves as one with a vertex of its obstacle or group, which the planes of a pair stop.
    Group,
    /// The gap of its pair is so small that rounding could close it: nothing in the pair moves.
    Frozen,
    /// A pair farther than contact range.
    FartherPair,
    /// The end of its trust region, or of its longest travel in one step.
    TrustRegion,
}

/// A pair that stops a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct WaitPair {
    /// Its kind.
    pub kind: PairKind,
    /// Its primitives, as [`Pair::elements`].
    pub elements: [u32; 2],
    /// Its vertices, in [`PairKind`] order.
    pub vertices: [u32; 4],
    /// Distance of its primitives before the step [m].
    pub gap_m: f64,
}

/// The vertices that have farthest to go after a step, one for each two bodies, farthest first. The stepper
/// has made the step from `state.previous`, limited by `state.contacts` among others. `held` tells which
/// vertices pairs hold back; it may be empty.
pub(crate) fn waits(
    scene: &CollisionScene,
    state: &ResolveState,
    stepper: &Stepper,
    held: &[bool],
) -> Vec<Wait> {
    let left = |v: usize| (1.0 - stepper.alpha(v)) * stepper.displacements()[v].norm();
    let mut slow: Vec<(f64, u32)> =
        (0..state.x.len()).map(|v| (left(v), v as u32)).filter(|(left, _)| *left > 0.0).collect();
    slow.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    slow.truncate(LOOKED_AT);

    let stops = stops(scene, state, stepper, &slow);
    let mut waits: Vec<(Wait, [Option<u32>; 2])> = Vec::new();
    for (remaining_m, vertex) in slow {
        let (v, body) = (vertex as usize, scene.model().vertex_body()[vertex as usize]);
        let stop = stops.get(&entity(scene, state, v));
        let (reason, pair) = match stop {
            Some(stop) if stop.frozen => (WaitReason::Frozen, Some(stop.pair)),
            Some(stop) if has(&stop.pair, vertex) => (WaitReason::Planes, Some(stop.pair)),
            Some(stop) => (WaitReason::Group, Some(stop.pair)),
            None if held.get(v) == Some(&true) => (WaitReason::FartherPair, None),
            None => (WaitReason::TrustRegion, None),
        };
        let mut bodies = pair.map_or([Some(body), None], |pair| sides(scene, &pair));
        bodies.sort_unstable();
        if waits.iter().all(|(_, others)| *others != bodies) {
            let place = state.previous[v].coords.into();
            waits.push((Wait { vertex, body, place, remaining_m, reason, pair }, bodies));
        }
        if waits.len() == MOST {
            break;
        }
    }
    waits.into_iter().map(|(wait, _)| wait).collect()
}

/// What moves as one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Entity {
    Vertex(usize),
    Obstacle(u32),
    Group(u32),
}

fn entity(scene: &CollisionScene, state: &ResolveState, vertex: usize) -> Entity {
    if scene.model().is_obstacle(vertex as u32) {
        return Entity::Obstacle(scene.model().vertex_body()[vertex]);
    }
    state.call.groups().of(vertex).map_or(Entity::Vertex(vertex), Entity::Group)
}

/// The pair that allows an entity the step size that it took.
struct Stop {
    pair: WaitPair,
    frozen: bool,
}

/// The first pair in range that allows the entities of some vertices no more than the step that they took, to
/// the bit.
fn stops(
    scene: &CollisionScene,
    state: &ResolveState,
    stepper: &Stepper,
    slow: &[(f64, u32)],
) -> BTreeMap<Entity, Stop> {
    let wanted: BTreeMap<Entity, f64> =
        slow.iter().map(|&(_, v)| (entity(scene, state, v as usize), stepper.alpha(v as usize))).collect();
    let forward = &scene.params().solver.forward;
    let contacts = &state.contacts;
    let mut stops: BTreeMap<Entity, Stop> = BTreeMap::new();
    for kind in PairKind::ALL {
        for p in contacts.pairs.range(kind) {
            let Some(separation) = contacts.separations.get(p) else { continue };
            let Pair { elements, vertices } = contacts.pairs.pairs()[p];
            let pair = WaitPair { kind, elements, vertices, gap_m: separation.distance };
            let mut note = |v: usize, is_stop: &dyn Fn(f64, Option<&Stop>) -> bool, frozen: bool| {
                let entity = entity(scene, state, v);
                let is_new = wanted.get(&entity).is_some_and(|&alpha| is_stop(alpha, stops.get(&entity)));
                if is_new {
                    stops.insert(entity, Stop { pair, frozen });
                }
            };
            match forward.bound {
                Bound::Planes => {
                    let least = contacts.min_separations[p];
                    let mut limits = [(usize::MAX, 0.0); 4];
                    let mut count = 0;
                    let visit = |v: usize, limit: f64| {
                        limits[count] = (v, limit);
                        count += 1;
                    };
                    let frozen = stepper.visit_plane_limits(
                        kind,
                        &vertices,
                        separation,
                        least,
                        forward.damping,
                        visit,
                    );
                    for &(v, limit) in &limits[..count] {
                        note(v, &|alpha, known| alpha == limit.max(0.0) && known.is_none(), frozen);
                    }
                }
                // The nearest pair limits most, whatever its direction.
                Bound::Isotropic => {
                    for &v in &vertices[..kind.vertex_count()] {
                        let gap = |separation: &Separation| separation.distance;
                        note(
                            v as usize,
                            &|_, known| known.is_none_or(|known| gap(separation) < known.pair.gap_m),
                            false,
                        );
                    }
                }
            }
        }
    }
    stops
}

fn has(pair: &WaitPair, vertex: u32) -> bool {
    pair.vertices[..pair.kind.vertex_count()].contains(&vertex)
}

/// The bodies of both sides; none for a half-space.
fn sides(scene: &CollisionScene, pair: &WaitPair) -> [Option<u32>; 2] {
    let body = |v: u32| Some(scene.model().vertex_body()[v as usize]);
    let other = pair.kind.side_a();
    let second = if other < pair.kind.vertex_count() { body(pair.vertices[other]) } else { None };
    [body(pair.vertices[0]), second]
}
