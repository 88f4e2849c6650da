//! The candidate pairs that are not near, but that vertices could reach in one step.

use super::near::{BLANK, round_up};
use super::regions::{Regions, longest_path};
use super::sides::{Sides, range_count, range_of};
use crate::scene::CollisionScene;
use crate::stages::AheadVisitor;
use crate::state::ResolveState;
use bowknot_geometry::{PairKind, Vector};
use bowknot_proximity::{CandidateList, Pair, near_half_spaces, separate_all};
use rayon::prelude::*;

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
        candidates: &CandidateList,
        regions: &Regions,
        displacements: &[Vector],
        visit: &AheadVisitor<'_>,
    ) {
        let share = SHARE * scene.params().solver.forward.damping.min(1.0);
        self.set_motions(scene, state, regions, displacements, share);
        let (motions, topology) = (&self.motions, scene.model().topology());
        self.sides.fill(topology, candidates, |vertices| {
            let largest = vertices.iter().map(|&v| motions[v as usize]).fold(Motion::default(), Motion::max);
            largest.offset + largest.travel
        });
        // Rounded down.
        let bound_share = share as f32 * (1.0 - f32::EPSILON);
        let contacts = &state.contacts.pairs;
        for kind in PairKind::ALL {
            let Some(list) = candidates.of(kind) else { continue };
            let [own, other] = self.sides.of(kind);
            (0..range_count(list)).into_par_iter().filter_map(|index| range_of(list, index)).for_each(
                |range| {
                    let mut near = contacts.lookup(kind, [range.start as u32, 0]);
                    let mut batch = Batch::new(scene, state, kind, visit);
                    for a in range {
                        for candidate in list.of(a) {
                            let elements = [a as u32, candidate.element];
                            let used_up = (own[a] + other[candidate.element as usize]) * LARGER;
                            if candidate.bound * bound_share <= used_up && near.find(elements).is_none() {
                                batch.push(Pair::of_elements(topology, kind, elements));
                            }
                        }
                    }
                    batch.visit();
                },
            );
        }
        let kind = PairKind::VertexHalfSpace;
        let radius = |v: usize| f64::from(motions[v].travel) / share;
        near_half_spaces(scene.model(), &state.x, None, radius, &mut self.half_space_pairs);
        self.half_space_pairs.par_iter().filter(|pairs| !pairs.is_empty()).for_each(|pairs| {
            let mut near = contacts.lookup(kind, pairs[0].elements);
            let mut batch = Batch::new(scene, state, kind, visit);
            pairs.iter().filter(|pair| near.find(pair.elements).is_none()).for_each(|pair| batch.push(*pair));
            batch.visit();
        });
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
