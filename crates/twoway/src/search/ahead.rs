//! The candidate pairs that are not near, but that vertices could reach in one step.

use super::near::{BLANK, for_each_range, round_up};
use super::regions::{Regions, longest_path};
use crate::scene::CollisionScene;
use crate::stages::AheadVisitor;
use crate::state::ResolveState;
use bowknot_geometry::{PairKind, Vector};
use bowknot_proximity::{CandidateList, Pair, near_half_spaces, separate_all};

/// Share of the damping at which pairs count as ahead. A pair is left out if the vertices use up less of its
/// distance: then its slab, which is at least 0.9 times as wide, does not limit them either.
const SHARE: f64 = 0.8;

/// Upper bound of the rounding of sums of distances in `f32`, relative.
const LARGER: f32 = 1.0 + 16.0 * f32::EPSILON;

/// Pairs whose geometry is computed at once.
const BATCH: usize = 32;

/// How a vertex may use up the distances of its pairs in a step [m], rounded up.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    /// Distance from the center of its ball, times the share.
    offset: f32,
    /// Longest possible move, and its part of minimum separations.
    travel: f32,
}

/// Buffers of the selection.
#[derive(Debug, Default)]
pub(super) struct AheadPairs {
    motions: Vec<Motion>,
    /// Pairs ahead by kind and task.
    found: [Vec<Vec<Pair>>; 5],
}

impl AheadPairs {
    /// Calls `visit` with all candidate pairs that are not pairs of `state.contacts` and that could limit a
    /// step along `displacements` [m], with their contact geometry at x.
    pub fn visit(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        candidates: &CandidateList,
        regions: &Regions,
        displacements: &[Vector],
        visit: &AheadVisitor<'_>,
    ) {
        let share = SHARE * scene.params().solver.forward.damping.min(1.0);
        self.set_motions(scene, state, regions, displacements, share);
        let (motions, topology) = (&self.motions, scene.model().topology());
        // Rounded down.
        let bound_share = share as f32 * (1.0 - f32::EPSILON);
        for kind in PairKind::ALL {
            let Some(list) = candidates.of(kind) else { continue };
            let near = &state.contacts.pairs.pairs()[state.contacts.pairs.range(kind)];
            for_each_range(list, &mut self.found[kind as usize], |elements, pairs| {
                let first = near.partition_point(|pair| (pair.elements[0] as usize) < elements.start);
                let mut near = near[first..].iter().peekable();
                for a in elements {
                    for candidate in list.of(a) {
                        let pair = Pair::of_elements(topology, kind, [a as u32, candidate.element]);
                        while near.next_if(|near| near.elements < pair.elements).is_some() {}
                        let is_near = near.peek().is_some_and(|near| near.elements == pair.elements);
                        if !is_near && could_meet(kind, &pair, candidate.bound * bound_share, motions) {
                            pairs.push(pair);
                        }
                    }
                }
                visit_batches(scene, state, kind, pairs, visit);
            });
        }
        let kind = PairKind::VertexHalfSpace;
        let found = &mut self.found[kind as usize];
        let radius = |v: usize| f64::from(motions[v].travel) / share;
        near_half_spaces(scene.model(), &state.x, None, radius, found);
        let near = &state.contacts.pairs.pairs()[state.contacts.pairs.range(kind)];
        for pairs in found {
            pairs.retain(|pair| near.binary_search_by_key(&pair.elements, |near| near.elements).is_err());
            visit_batches(scene, state, kind, pairs, visit);
        }
    }

    fn set_motions(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        regions: &Regions,
        displacements: &[Vector],
        share: f64,
    ) {
        let smallest = 0.5 * scene.lengths().min_separation;
        let motion = |v: usize| {
            let keep = scene.spacing().min_separation_margin(scene.model().vertex_body()[v]).max(smallest);
            Motion {
                offset: round_up(share * (state.x[v] - regions.balls.centers[v]).norm()),
                travel: round_up(displacements[v].norm().min(longest_path(scene, v)) + keep),
            }
        };
        self.motions.clear();
        self.motions.extend((0..state.x.len()).map(motion));
    }
}

/// Whether the vertices could use up the distance of a pair. `bound`: its share of the lower bound of that
/// distance [m].
#[inline]
fn could_meet(kind: PairKind, pair: &Pair, bound: f32, motions: &[Motion]) -> bool {
    let largest = |side: &[u32]| {
        side.iter().map(|&v| motions[v as usize]).fold(Motion::default(), |a, b| Motion {
            offset: a.offset.max(b.offset),
            travel: a.travel.max(b.travel),
        })
    };
    let (a, b) = pair.vertices[..kind.vertex_count()].split_at(kind.side_a());
    let (a, b) = (largest(a), largest(b));
    bound <= (a.offset + b.offset + a.travel + b.travel) * LARGER
}

/// Computes the geometry of pairs and visits them.
fn visit_batches(
    scene: &CollisionScene,
    state: &ResolveState,
    kind: PairKind,
    pairs: &[Pair],
    visit: &AheadVisitor<'_>,
) {
    let (model, spacing) = (scene.model(), scene.spacing());
    let default = scene.lengths().min_separation;
    let mut separations = [BLANK; BATCH];
    for pairs in pairs.chunks(BATCH) {
        let separations = &mut separations[..pairs.len()];
        separate_all(model, kind, pairs, &state.x, separations);
        for (pair, separation) in pairs.iter().zip(&*separations) {
            let min_separation = spacing.of(model, kind, pair).min_separation.unwrap_or(default);
            visit(kind, &pair.vertices, separation, min_separation);
        }
    }
}
