//! Pairs that are not near, but that vertices could reach in one step: candidates, and what a swept search
//! finds. They are visited as they are found, and not stored.

use super::near::{BLANK, Listed, round_up};
use super::regions::longest_path;
use super::sides::{Sides, range_count, range_of};
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_geometry::{PairKind, Separation, Vector};
use bowknot_proximity::{Candidate, CandidateList, Pair, near_half_spaces, separate_all};
use rayon::prelude::*;

/// Is called with kind, vertices, contact geometry and minimum separation [m] of a pair, by several threads.
pub type AheadVisitor<'a> = dyn Fn(PairKind, &[u32; 4], &Separation, f64) + Sync + 'a;

/// Share of the damping at which pairs count as ahead. A pair is left out if the vertices use up less of its
/// distance: then its slab, which is at least 0.9 times as wide, does not limit them either.
const SHARE: f64 = 0.8;

/// Upper bound of the rounding of sums of distances in `f32`, relative.
const LARGER: f32 = 1.0 + 16.0 * f32::EPSILON;

/// Vertices that one task looks at.
const CHUNK: usize = 1024;
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
    /// What the vertices of each element may use up: the largest offset and the largest travel.
    sides: Sides,
    /// Pairs of half-spaces by task.
    half_space_pairs: Vec<Vec<Pair>>,
}

impl AheadPairs {
    /// Calls `visit` with all candidate pairs that are not pairs of `state.contacts` and that could limit a
    /// step along `displacements` [m], with their contact geometry at x.
    pub fn visit(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        listed: Listed<'_>,
        displacements: &[Vector],
        visit: &AheadVisitor<'_>,
    ) {
        let share = SHARE * scene.params().solver.forward.damping.min(1.0);
        self.set_motions(scene, state, listed, displacements, share);
        let (motions, topology) = (&self.motions, scene.model().topology());
        self.sides.fill(topology, listed.candidates, |vertices| {
            let largest = vertices.iter().map(|&v| motions[v as usize]).fold(Motion::default(), Motion::max);
            largest.offset + largest.travel
        });
        // Rounded down.
        let bound_share = share as f32 * (1.0 - f32::EPSILON);
        let sides = &self.sides;
        visit_candidates(scene, state, listed.candidates, visit, |kind, a, candidate| {
            let [own, other] = sides.of(kind);
            candidate.bound * bound_share <= (own[a] + other[candidate.element as usize]) * LARGER
        });
        let radius = |v: usize| f64::from(motions[v].travel) / share;
        near_half_spaces(scene.model(), &state.x, None, radius, &mut self.half_space_pairs);
        visit_half_spaces(scene, state, &self.half_space_pairs, visit);
    }

    /// Calls `visit` with all pairs of a swept search that are not pairs of `state.contacts`: `candidates`
    /// and the pairs of half-spaces that come within twice the `radius` of a vertex along `displacements`
    /// [m].
    pub fn visit_swept(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        candidates: &CandidateList,
        displacements: &[Vector],
        radius: impl Fn(usize) -> f64 + Sync,
        visit: &AheadVisitor<'_>,
    ) {
        visit_candidates(scene, state, candidates, visit, |_, _, _| true);
        near_half_spaces(scene.model(), &state.x, Some(displacements), radius, &mut self.half_space_pairs);
        visit_half_spaces(scene, state, &self.half_space_pairs, visit);
    }

    fn set_motions(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        Listed { regions, rounding, .. }: Listed<'_>,
        displacements: &[Vector],
        share: f64,
    ) {
        let smallest = 0.5 * scene.lengths().min_separation;
        let motion = |v: usize| {
            let keep = scene.spacing().min_separation_margin(scene.model().vertex_body()[v]).max(smallest);
            Motion {
                offset: round_up(share * (rounding + (state.x[v] - regions.balls.centers[v]).norm())),
                travel: round_up(displacements[v].norm().min(longest_path(scene, v)) + keep),
            }
        };
        self.motions.resize(state.x.len(), Motion::default());
        let motions = self.motions.par_iter_mut().enumerate().with_min_len(CHUNK);
        motions.for_each(|(v, entry)| *entry = motion(v));
    }
}

impl Motion {
    fn max(self, other: Self) -> Self {
        Self { offset: self.offset.max(other.offset), travel: self.travel.max(other.travel) }
    }
}

/// Visits the candidates that are `wanted` and are not pairs of the state. `wanted` is called with kind,
/// element of side *a* and candidate.
fn visit_candidates(
    scene: &CollisionScene,
    state: &ResolveState,
    candidates: &CandidateList,
    visit: &AheadVisitor<'_>,
    wanted: impl Fn(PairKind, usize, &Candidate) -> bool + Sync,
) {
    let topology = scene.model().topology();
    for kind in PairKind::ALL {
        let Some(list) = candidates.of(kind) else { continue };
        (0..range_count(list)).into_par_iter().filter_map(|index| range_of(list, index)).for_each(|range| {
            let mut near = state.contacts.pairs.lookup(kind, [range.start as u32, 0]);
            let mut batch = Batch::new(scene, state, kind, visit);
            for a in range {
                for candidate in list.of(a) {
                    let elements = [a as u32, candidate.element];
                    if wanted(kind, a, candidate) && near.find(elements).is_none() {
                        batch.push(Pair::of_elements(topology, kind, elements));
                    }
                }
            }
            batch.visit();
        });
    }
}

/// Visits the pairs of half-spaces that are not pairs of the state.
fn visit_half_spaces(
    scene: &CollisionScene,
    state: &ResolveState,
    lists: &[Vec<Pair>],
    visit: &AheadVisitor<'_>,
) {
    let kind = PairKind::VertexHalfSpace;
    lists.par_iter().filter(|pairs| !pairs.is_empty()).for_each(|pairs| {
        let mut near = state.contacts.pairs.lookup(kind, pairs[0].elements);
        let mut batch = Batch::new(scene, state, kind, visit);
        pairs.iter().filter(|pair| near.find(pair.elements).is_none()).for_each(|pair| batch.push(*pair));
        batch.visit();
    });
}

/// Pairs whose geometry is computed together before they are visited.
struct Batch<'a> {
    scene: &'a CollisionScene,
    state: &'a ResolveState,
    kind: PairKind,
    visitor: &'a AheadVisitor<'a>,
    pairs: [Pair; BATCH],
    count: usize,
}

impl<'a> Batch<'a> {
    fn new(
        scene: &'a CollisionScene,
        state: &'a ResolveState,
        kind: PairKind,
        visitor: &'a AheadVisitor<'a>,
    ) -> Self {
        Self {
            scene,
            state,
            kind,
            visitor,
            pairs: [Pair { elements: [0; 2], vertices: [0; 4] }; BATCH],
            count: 0,
        }
    }

    fn push(&mut self, pair: Pair) {
        self.pairs[self.count] = pair;
        self.count += 1;
        if self.count == BATCH {
            self.visit();
        }
    }

    /// Visits the pairs that are left.
    fn visit(&mut self) {
        let Self { scene, state, kind, visitor, .. } = *self;
        let (model, spacing) = (scene.model(), scene.spacing());
        let default = scene.lengths().min_separation;
        let pairs = &self.pairs[..std::mem::take(&mut self.count)];
        let mut separations = [BLANK; BATCH];
        let separations = &mut separations[..pairs.len()];
        separate_all(model, kind, pairs, &state.x, separations);
        for (pair, separation) in pairs.iter().zip(&*separations) {
            let min_separation = spacing.of(model, kind, pair).min_separation.unwrap_or(default);
            visitor(kind, &pair.vertices, separation, min_separation);
        }
    }
}
