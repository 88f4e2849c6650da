//! The candidate pairs that may be within contact range at x, and their data, which are carried over from one
//! step to the next.

use super::regions::Regions;
use crate::scene::CollisionScene;
use crate::spacing::MIN_SEPARATION_MARGIN;
use crate::state::ResolveState;
use crate::statistics::Statistics;
use bowknot_constraints::{DesiredDistance, FrictionModel};
use bowknot_geometry::{PairKind, Separation, Vector};
use bowknot_proximity::{CandidateList, Candidates, Pair, PairList, near_half_spaces, separate_all};
use rayon::prelude::*;
use std::ops::Range;

/// Elements whose candidates one task tests.
const ELEMENTS: usize = 1024;
/// Pairs whose geometry one task computes.
const PAIRS: usize = 1024;
/// Pairs that are computed together.
const BATCH: usize = 8;
/// Pairs of kinds that have candidates.
const KINDS: usize = 4;

/// Upper bound of the rounding of a sum of distances in `f32`, relative.
const LARGER: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Buffers of the selection.
#[derive(Debug, Default)]
pub(super) struct NearPairs {
    /// The previous list, from which the data of pairs are carried over.
    old: PairList,
    /// Distance of each vertex from the center of its ball plus its margin [m], rounded up.
    reach: Vec<f32>,
    /// Selected pairs by kind and task.
    found: [Vec<Vec<Pair>>; 5],
    matches: Vec<u32>,
    moved: Vec<bool>,
    separations: Vec<Separation>,
    values: Vec<Inherited>,
    friction: Vec<Vector>,
}

/// The data of a pair that are carried over from step to step.
#[derive(Clone, Copy, Debug, Default)]
struct Inherited {
    desired: f64,
    min_separation: f64,
    multiplier: f64,
    lowered: bool,
}

impl NearPairs {
    /// Starts a call.
    pub fn begin(&mut self, state: &mut ResolveState) {
        self.old.clear();
        state.contacts.pairs.clear();
        state.contacts.desired.clear();
        state.contacts.multipliers.clear();
        state.contacts.frictions.clear();
        state.contacts.friction_multipliers.clear();
    }

    /// Makes the candidates that may be within contact range at x the pairs of `state.contacts`. `complete`:
    /// all candidates.
    pub fn select(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        candidates: &CandidateList,
        regions: &Regions,
        complete: bool,
        statistics: &mut Statistics,
    ) {
        let model = scene.model();
        self.set_reach(scene, state, regions);
        let (reach, topology) = (&self.reach, model.topology());
        for (k, found) in self.found.iter_mut().enumerate().take(KINDS) {
            let kind = PairKind::ALL[k];
            let Some(list) = candidates.of(kind) else { continue };
            let largest = |side: &[u32]| side.iter().map(|&v| reach[v as usize]).fold(0.0, f32::max);
            for_each_range(list, found, |elements, pairs| {
                for a in elements {
                    for candidate in list.of(a) {
                        let pair = Pair::of_elements(topology, kind, [a as u32, candidate.element]);
                        let (own, other) = pair.vertices[..kind.vertex_count()].split_at(kind.side_a());
                        if complete || candidate.bound <= (largest(own) + largest(other)) * LARGER {
                            pairs.push(pair);
                        }
                    }
                }
            });
        }
        let bodies = model.vertex_body();
        let margin = |v: usize| scene.spacing().margin(bodies[v]);
        let radius = |v: usize| if complete { regions.radii[v] } else { margin(v) };
        near_half_spaces(model, &state.x, None, radius, &mut self.found[4]);
        self.keep(&mut state.contacts.pairs);
        state.contacts.pairs.refill(&self.found);
        state.contacts.pairs.match_with(&self.old, &mut self.matches);
        self.evaluate(scene, state, statistics);
        if !complete {
            self.keep_in_range(scene, state);
        }
        self.inherit(scene, state, statistics);
    }

    /// Keeps the pairs whose distance is within contact range: what the other stages see does not depend on
    /// which pairs are listed.
    fn keep_in_range(&mut self, scene: &CollisionScene, state: &mut ResolveState) {
        let (model, spacing) = (scene.model(), scene.spacing());
        let contacts = &mut state.contacts;
        let (separations, matches) = (&mut contacts.separations, &mut self.matches);
        let mut end = 0;
        contacts.pairs.retain(|p, kind, pair| {
            let keeps = separations[p].distance <= spacing.reach(model, kind, pair);
            if keeps {
                separations[end] = separations[p];
                matches[end] = matches[p];
                end += 1;
            }
            keeps
        });
        separations.truncate(end);
        matches.truncate(end);
    }

    /// Keeps `pairs`, to carry their data over to those that replace them.
    pub fn keep(&mut self, pairs: &mut PairList) {
        std::mem::swap(&mut self.old, pairs);
    }

    /// Carries the data of the pairs that were [kept](Self::keep) over to those of the state, which were found
    /// otherwise, with their geometry.
    pub fn replace(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        state.contacts.pairs.match_with(&self.old, &mut self.matches);
        self.inherit(scene, state, statistics);
    }

    fn set_reach(&mut self, scene: &CollisionScene, state: &ResolveState, regions: &Regions) {
        let bodies = scene.model().vertex_body();
        self.reach.clear();
        self.reach.extend(
            regions
                .balls
                .centers
                .iter()
                .zip(&state.x)
                .zip(bodies)
                .map(|((center, x), &body)| round_up((x - center).norm() + scene.spacing().margin(body))),
        );
    }

    /// Computes the contact geometry of the pairs at x. That of pairs that have not moved is copied.
    fn evaluate(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        self.moved.clear();
        self.moved.extend(state.x.iter().zip(&state.previous).map(|(a, b)| a != b));
        let contacts = &mut state.contacts;
        std::mem::swap(&mut self.separations, &mut contacts.separations);
        contacts.separations.resize(contacts.pairs.len(), BLANK);
        let (moved, old, x) = (&self.moved, &self.separations, &state.x);
        let mut reused = 0;
        for kind in PairKind::ALL {
            let range = contacts.pairs.range(kind);
            let (pairs, matches) = (&contacts.pairs.pairs()[range.clone()], &self.matches[range.clone()]);
            let jobs = contacts.separations[range].par_chunks_mut(PAIRS);
            reused += jobs
                .zip(pairs.par_chunks(PAIRS).zip(matches.par_chunks(PAIRS)))
                .map(|(separations, (pairs, matches))| {
                    let mut reused = 0;
                    let batches = separations.chunks_mut(BATCH).zip(pairs.chunks(BATCH));
                    for ((separations, pairs), matches) in batches.zip(matches.chunks(BATCH)) {
                        let keeps = |(pair, matched): (&Pair, &u32)| {
                            let used = &pair.vertices[..kind.vertex_count()];
                            *matched != u32::MAX && !used.iter().any(|&v| moved[v as usize])
                        };
                        if pairs.iter().zip(matches).all(keeps) {
                            for (separation, &matched) in separations.iter_mut().zip(matches) {
                                *separation = old[matched as usize];
                            }
                            reused += pairs.len();
                        } else {
                            separate_all(scene.model(), kind, pairs, x, separations);
                        }
                    }
                    reused
                })
                .sum::<usize>();
        }
        statistics.skipped.evaluations += reused;
    }

    /// Carries the data of pairs over to the new list, and initializes those of new pairs.
    fn inherit(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let contacts = &mut state.contacts;
        let growth = state.call.time_step().map_or(f64::INFINITY, |dt| scene.lengths().separation_speed * dt);
        let model = scene.model();
        let (pairs, separations) = (&contacts.pairs, &contacts.separations);
        let (old_desired, old_multipliers) = (&contacts.desired, &contacts.multipliers);
        let old_min_separations = &contacts.min_separations;
        self.values.resize(pairs.len(), Inherited::default());
        let places = self.values.par_iter_mut().zip(&self.matches).enumerate().with_min_len(PAIRS);
        places.for_each(|(p, (value, &old))| {
            *value = match old_desired.get(old as usize) {
                Some(&desired) => Inherited {
                    desired,
                    min_separation: old_min_separations[old as usize],
                    multiplier: old_multipliers[old as usize],
                    lowered: false,
                },
                None => {
                    let (kind, pair) = (pairs.kind(p), &pairs.pairs()[p]);
                    first_values(scene, kind, pair, &separations[p], growth)
                }
            };
        });
        let values = &self.values;
        statistics.lowered_pairs += values.iter().filter(|v| v.lowered).count();
        contacts.desired.clear();
        contacts.desired.extend(values.iter().map(|v| v.desired));
        contacts.multipliers.clear();
        contacts.multipliers.extend(values.iter().map(|v| v.multiplier));
        contacts.min_separations.clear();
        contacts.min_separations.extend(values.iter().map(|v| v.min_separation));
        if scene.friction_model() == FrictionModel::Coulomb {
            std::mem::swap(&mut self.friction, &mut contacts.friction_multipliers);
            contacts.friction_multipliers.clear();
            let old = |p: &u32| self.friction.get(*p as usize).copied().unwrap_or_else(Vector::zeros);
            contacts.friction_multipliers.extend(self.matches.iter().map(old));
            contacts.frictions.clear();
            for kind in PairKind::ALL {
                let list = &contacts.pairs.pairs()[contacts.pairs.range(kind)];
                let friction = |pair| scene.contact().friction_of_pair(model, kind, pair);
                contacts.frictions.extend(list.iter().map(friction));
            }
        }
    }
}

/// Desired distance and minimum separation of a pair that is new in this call. `growth`: by how much its gap
/// may grow in the call [m].
fn first_values(
    scene: &CollisionScene,
    kind: PairKind,
    pair: &Pair,
    separation: &Separation,
    growth: f64,
) -> Inherited {
    let (model, rest) = (scene.model(), scene.rest());
    let spacing = scene.spacing().of(model, kind, pair);
    let rule = DesiredDistance { delta: spacing.delta, growth };
    let (desired, lowered) = rule.of(model, kind, pair, rest, separation.distance);
    let min_separation = match spacing.min_separation {
        None => scene.lengths().min_separation.min(0.1 * desired),
        Some(guaranteed) => {
            // The rest distance of neighbors bounds their minimum separation. A pair that starts closer has
            // its own gap as minimum separation, which grows from call to call.
            let (unlimited, _) = rule.without_growth_limit(model, kind, pair, rest);
            guaranteed.min(unlimited / MIN_SEPARATION_MARGIN).min(separation.width.max(0.0))
        }
    };
    Inherited { desired, min_separation, multiplier: 0.0, lowered }
}

/// Fills lists of separations before they are written.
pub(super) const BLANK: Separation =
    Separation { normal: Vector::new(0.0, 0.0, 0.0), weights: [0.0; 4], distance: 0.0, width: 0.0 };

/// Calls `visit` for ranges of elements, with the list of each range. Ranges without candidates are skipped.
pub(super) fn for_each_range(
    list: &Candidates,
    found: &mut Vec<Vec<Pair>>,
    visit: impl Fn(Range<usize>, &mut Vec<Pair>) + Sync,
) {
    let elements = list.elements().len();
    found.resize_with(elements.div_ceil(ELEMENTS), Vec::new);
    found.par_iter_mut().enumerate().for_each(|(chunk, pairs)| {
        pairs.clear();
        let range = chunk * ELEMENTS..((chunk + 1) * ELEMENTS).min(elements);
        if list.count(range.clone()) > 0 {
            visit(range, pairs);
        }
    });
}

/// A number of `f32` that is not below `value`.
#[inline]
pub(super) fn round_up(value: f64) -> f32 {
    (value as f32) * (1.0 + f32::EPSILON) + f32::MIN_POSITIVE
}
