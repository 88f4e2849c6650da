//! The candidate pairs that are within contact range at x, and their data, which are carried over from one
//! step to the next.
//!
//! One parallel pass over the candidates tests their 8 bytes, computes the geometry of those that may be in
//! range, and keeps those that are.

use super::regions::Regions;
use super::sides::{Sides, range_count, range_of};
use crate::call::CallInput;
use crate::multipliers::PairMultipliers;
use crate::scene::CollisionScene;
use crate::spacing::MIN_SEPARATION_MARGIN;
use crate::state::{ContactSet, ResolveState};
use crate::statistics::Statistics;
use bowknot_constraints::{DeltaRule, FrictionModel};
use bowknot_geometry::{PairKind, Point, Separation, Vector};
use bowknot_proximity::{CandidateList, Pair, PairList, near_half_spaces, separate_all};
use rayon::prelude::*;

/// Candidate pairs, and what holds for those that are not listed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Listed<'a> {
    pub candidates: &'a CandidateList,
    pub regions: &'a Regions,
    /// By how much distances may be below their bounds [m].
    pub rounding: f64,
}

/// Pairs whose data one task carries over, and vertices that one task looks at.
const CHUNK: usize = 1024;
/// Pairs whose geometry is computed at once.
const BATCH: usize = 32;

/// Upper bound of the rounding of a sum of distances in `f32`, relative.
const LARGER: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Buffers of the selection.
#[derive(Debug, Default)]
pub(super) struct NearPairs {
    /// The previous pairs, from which data are carried over.
    old: ContactSet,
    /// Distance of each vertex from the center of its ball plus its margin [m], rounded up.
    reach: Vec<f32>,
    /// The largest of these among the vertices of each element.
    sides: Sides,
    /// Whether each vertex has moved in the last step.
    moved: Vec<bool>,
    /// Selected pairs by kind and task.
    found: [Vec<Found>; 5],
    /// Pairs of half-spaces by task.
    half_space_pairs: Vec<Vec<Pair>>,
    /// The place of each pair in the previous list, `u32::MAX` if it was not there.
    matches: Vec<u32>,
}

/// The pairs that one task has selected, in order.
#[derive(Debug, Default)]
struct Found {
    pairs: Vec<Pair>,
    separations: Vec<Separation>,
    matches: Vec<u32>,
    /// Pairs whose geometry was that of the step before.
    reused: usize,
}

/// What the tasks of a selection read.
struct Selection<'a> {
    scene: &'a CollisionScene,
    x: &'a [Point],
    moved: &'a [bool],
    old: &'a ContactSet,
    /// Whether pairs out of range are kept.
    complete: bool,
}

impl NearPairs {
    /// Starts a call.
    pub fn begin(&mut self, state: &mut ResolveState) {
        self.old.pairs.clear();
        state.contacts.pairs.clear();
    }

    /// Makes the candidates that are within contact range at x the pairs of `state.contacts`: what the other
    /// stages see does not depend on which pairs are `listed`. `complete`: all candidates.
    pub fn select(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        listed: Listed<'_>,
        complete: bool,
        statistics: &mut Statistics,
    ) {
        let (model, Listed { candidates, regions, .. }) = (scene.model(), listed);
        self.set_reach(scene, state, listed);
        self.keep(&mut state.contacts);
        let x = state.x.as_slice();
        let selection = Selection { scene, x, moved: &self.moved, old: &self.old, complete };
        for kind in PairKind::ALL {
            let Some(list) = candidates.of(kind) else { continue };
            let ([own, other], found) = (self.sides.of(kind), &mut self.found[kind as usize]);
            found.resize_with(range_count(list), Found::default);
            found.par_iter_mut().enumerate().for_each(|(index, found)| {
                let range = range_of(list, index);
                let pairs = range.into_iter().flatten().flat_map(|a| {
                    let partners = list.of(a).iter();
                    let near = partners.filter(move |b| {
                        complete || b.bound <= (own[a] + other[b.element as usize]) * LARGER
                    });
                    near.map(move |b| Pair::of_elements(model.topology(), kind, [a as u32, b.element]))
                });
                found.take(&selection, kind, pairs);
            });
        }
        let bodies = model.vertex_body();
        let margin = |v: usize| scene.spacing().margin(bodies[v]);
        let radius = |v: usize| if complete { regions.radii[v] } else { margin(v) };
        let kind = PairKind::VertexHalfSpace;
        near_half_spaces(model, x, None, radius, &mut self.half_space_pairs);
        let found = &mut self.found[kind as usize];
        found.resize_with(self.half_space_pairs.len(), Found::default);
        let lists = found.par_iter_mut().zip(&self.half_space_pairs);
        lists.for_each(|(found, pairs)| found.take(&selection, kind, pairs.iter().copied()));

        let found = self.found.iter().flatten();
        statistics.skipped.evaluations += found.map(|found| found.reused).sum::<usize>();
        self.gather(&mut state.contacts);
        inherit(scene, state, &self.old, &self.matches, statistics);
    }

    /// Selects the pairs for a caller who knows them: all that are within contact range at x are among `near`.
    pub fn select_among(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        near: &PairList,
        statistics: &mut Statistics,
    ) {
        self.moved.clear();
        self.moved.resize(state.x.len(), true);
        self.keep(&mut state.contacts);
        let selection = Selection { scene, x: &state.x, moved: &self.moved, old: &self.old, complete: false };
        for kind in PairKind::ALL {
            let (pairs, found) = (&near.pairs()[near.range(kind)], &mut self.found[kind as usize]);
            found.resize_with(pairs.len().div_ceil(CHUNK), Found::default);
            let lists = found.par_iter_mut().zip(pairs.par_chunks(CHUNK));
            lists.for_each(|(found, pairs)| found.take(&selection, kind, pairs.iter().copied()));
        }
        self.gather(&mut state.contacts);
        inherit(scene, state, &self.old, &self.matches, statistics);
    }

    /// Keeps the pairs, to carry their data over to those that replace them.
    pub fn keep(&mut self, contacts: &mut ContactSet) {
        std::mem::swap(&mut self.old, contacts);
    }

    /// Notes how far vertices are from the centers of their balls, and which have moved.
    fn set_reach(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        Listed { candidates, regions, rounding }: Listed<'_>,
    ) {
        let (model, count) = (scene.model(), state.x.len());
        self.reach.resize(count, 0.0);
        self.moved.resize(count, false);
        let vertices = self.reach.par_iter_mut().zip(&mut self.moved).enumerate().with_min_len(CHUNK);
        vertices.for_each(|(v, (reach, moved))| {
            let x = &state.x[v];
            let margin = scene.spacing().margin(model.vertex_body()[v]);
            *reach = round_up((x - regions.balls.centers[v]).norm() + margin + rounding);
            *moved = *x != state.previous[v];
        });
        let reach = &self.reach;
        let largest = |side: &[u32]| side.iter().map(|&v| reach[v as usize]).fold(0.0, f32::max);
        self.sides.fill(model.topology(), candidates, largest);
    }

    /// Joins what the tasks have found.
    fn gather(&mut self, contacts: &mut ContactSet) {
        let of_kind = |found: &Vec<Found>| found.iter().map(|found| found.pairs.len()).sum();
        let counts: [usize; 5] = self.found.each_ref().map(of_kind);
        let total = counts.iter().sum();
        contacts.separations.resize(total, BLANK);
        self.matches.resize(total, u32::MAX);
        let mut rest = Lists {
            pairs: contacts.pairs.resize_kinds(counts),
            separations: &mut contacts.separations,
            matches: &mut self.matches,
        };
        for (found, count) in self.found.iter().zip(counts) {
            let (lists, others) = rest.split_at(count);
            lists.copy(found);
            rest = others;
        }
    }
}

impl ResolveState {
    /// Makes these the candidate pairs, with their geometry at x. Those that were candidates before keep what belongs to
    /// them.
    pub fn replace_pairs(
        &mut self,
        scene: &CollisionScene,
        pairs: PairList,
        separations: Vec<Separation>,
        statistics: &mut Statistics,
    ) {
        let old =
            std::mem::replace(&mut self.contacts, ContactSet { pairs, separations, ..ContactSet::default() });
        let mut matches = Vec::new();
        self.contacts.pairs.match_with(&old.pairs, &mut matches);
        inherit(scene, self, &old, &matches, statistics);
    }
}

/// Carries the data of the `old` pairs over to the new list, in which pairs `matches` old ones, and initializes those of new pairs.
fn inherit(
    scene: &CollisionScene,
    state: &mut ResolveState,
    old: &ContactSet,
    matches: &[u32],
    statistics: &mut Statistics,
) {
    let (contacts, starts) = (&mut state.contacts, state.step == 0);
    let growth = state.call.time_step().map_or(f64::INFINITY, |dt| scene.lengths().separation_speed * dt);
    let carried =
        |kind: PairKind, pair: &Pair| starts.then(|| state.call.carried(kind, pair.elements)).flatten();
    let count = contacts.pairs.len();
    contacts.deltas.resize(count, 0.0);
    contacts.min_separations.resize(count, 0.0);
    contacts.multipliers.resize(count, 0.0);
    for kind in PairKind::ALL {
        let range = contacts.pairs.range(kind);
        let pairs = &contacts.pairs.pairs()[range.clone()];
        let places = (
            &mut contacts.deltas[range.clone()],
            &mut contacts.min_separations[range.clone()],
            &mut contacts.multipliers[range.clone()],
            &matches[range.clone()],
            pairs,
            &contacts.separations[range],
        );
        let places = places.into_par_iter().with_min_len(CHUNK);
        let lowered = places.map(|(delta, min_separation, multiplier, &matched, pair, separation)| {
            if let Some(&old_delta) = old.deltas.get(matched as usize) {
                *delta = old_delta;
                *min_separation = old.min_separations[matched as usize];
                *multiplier = old.multipliers[matched as usize];
                return 0;
            }
            let first = first_values(scene, kind, pair, separation, growth, &state.call);
            (*delta, *min_separation) = (first.delta, first.min_separation);
            *multiplier = carried(kind, pair).map_or(0.0, |carried| carried.normal);
            usize::from(first.lowered)
        });
        statistics.lowered_pairs += lowered.sum::<usize>();
    }
    if scene.friction_model() == FrictionModel::Coulomb {
        inherit_friction(scene, contacts, old, matches, carried);
    }
}

fn inherit_friction<'a>(
    scene: &CollisionScene,
    contacts: &mut ContactSet,
    old: &ContactSet,
    matches: &[u32],
    carried: impl Fn(PairKind, &Pair) -> Option<&'a PairMultipliers> + Sync,
) {
    let (count, old) = (contacts.pairs.len(), &old.friction_multipliers);
    contacts.friction_multipliers.resize(count, Vector::zeros());
    contacts.frictions.resize(count, 0.0);
    for kind in PairKind::ALL {
        let range = contacts.pairs.range(kind);
        let places = (
            &mut contacts.friction_multipliers[range.clone()],
            &mut contacts.frictions[range.clone()],
            &matches[range.clone()],
            &contacts.pairs.pairs()[range],
        );
        let places = places.into_par_iter().with_min_len(CHUNK);
        places.for_each(|(multiplier, friction, &matched, pair)| {
            let first = || carried(kind, pair).map_or_else(Vector::zeros, |carried| carried.friction);
            *multiplier = old.get(matched as usize).copied().unwrap_or_else(first);
            *friction = scene.contact().friction_of_pair(scene.model(), kind, pair);
        });
    }
}

impl Found {
    /// Computes the geometry of `pairs` at x, which are in order, and keeps those within contact range. The
    /// geometry of pairs that have not moved is copied.
    fn take(&mut self, selection: &Selection<'_>, kind: PairKind, mut pairs: impl Iterator<Item = Pair>) {
        self.pairs.clear();
        self.separations.clear();
        self.matches.clear();
        self.reused = 0;
        let mut batch = [Pair { elements: [0; 2], vertices: [0; 4] }; BATCH];
        let mut fill = |batch: &mut [Pair; BATCH]| {
            let mut count = 0;
            for (slot, pair) in batch.iter_mut().zip(&mut pairs) {
                *slot = pair;
                count += 1;
            }
            count
        };
        let mut count = fill(&mut batch);
        let mut old = selection.old.pairs.lookup(kind, batch[0].elements);
        while count > 0 {
            let batch_matches = std::array::from_fn(|k| {
                let matched = if k < count { old.find(batch[k].elements) } else { None };
                matched.unwrap_or(u32::MAX)
            });
            self.take_batch(selection, kind, &batch[..count], &batch_matches);
            // A full batch may leave pairs behind.
            count = if count == BATCH { fill(&mut batch) } else { 0 };
        }
    }

    fn take_batch(
        &mut self,
        selection: &Selection<'_>,
        kind: PairKind,
        pairs: &[Pair],
        matches: &[u32; BATCH],
    ) {
        let Selection { scene, x, moved, old, complete } = *selection;
        let (model, spacing) = (scene.model(), scene.spacing());
        let stays = |pair: &Pair| !pair.vertices[..kind.vertex_count()].iter().any(|&v| moved[v as usize]);
        let may_reuse = |k: usize| matches[k] != u32::MAX && stays(&pairs[k]);
        let mut separations = [BLANK; BATCH];
        if (0..pairs.len()).all(may_reuse) {
            for (separation, &matched) in separations.iter_mut().zip(&matches[..pairs.len()]) {
                *separation = old.separations[matched as usize];
            }
            self.reused += pairs.len();
        } else {
            separate_all(model, kind, pairs, x, &mut separations[..pairs.len()]);
        }
        for ((pair, separation), &matched) in pairs.iter().zip(&separations).zip(matches) {
            if complete || separation.distance <= spacing.reach(model, kind, pair) {
                self.pairs.push(*pair);
                self.separations.push(*separation);
                self.matches.push(matched);
            }
        }
    }
}

/// Parts of the lists that [`NearPairs::gather`] writes.
struct Lists<'a> {
    pairs: &'a mut [Pair],
    separations: &'a mut [Separation],
    matches: &'a mut [u32],
}

impl Lists<'_> {
    fn split_at(self, count: usize) -> (Self, Self) {
        let (pairs, other_pairs) = self.pairs.split_at_mut(count);
        let (separations, other_separations) = self.separations.split_at_mut(count);
        let (matches, other_matches) = self.matches.split_at_mut(count);
        let others = Self { pairs: other_pairs, separations: other_separations, matches: other_matches };
        (Self { pairs, separations, matches }, others)
    }

    /// Copies what the tasks have found, one after the other.
    fn copy(self, found: &[Found]) {
        match found {
            [] => {}
            [one] => {
                self.pairs.copy_from_slice(&one.pairs);
                self.separations.copy_from_slice(&one.separations);
                self.matches.copy_from_slice(&one.matches);
            }
            _ => {
                let (first, second) = found.split_at(found.len() / 2);
                let (left, right) = self.split_at(first.iter().map(|found| found.pairs.len()).sum());
                rayon::join(|| left.copy(first), || right.copy(second));
            }
        }
    }
}

/// Distance in the contact distance below which the target knows a contact.
pub const KNOWN: f64 = 1.3;

/// Share of its gap that the row of a contact guards which the target knows.
pub const GUARDED: f64 = 0.7;

/// Smallest distance that such a row asks for, in the way from the minimum separation to the contact
/// distance. At the minimum separation the forward step closes no pair further, and a pair that is held there
/// is stuck.
pub const GUARDED_FLOOR: f64 = 0.35;

/// Data of a pair that is new in this call.
#[derive(Clone, Copy, Debug, Default)]
struct FirstValues {
    delta: f64,
    min_separation: f64,
    lowered: bool,
}

/// Contact distance and minimum separation of a pair that is new in this call. `growth`: by how much its gap
/// may grow in the call [m].
fn first_values(
    scene: &CollisionScene,
    kind: PairKind,
    pair: &Pair,
    separation: &Separation,
    growth: f64,
    call: &CallInput,
) -> FirstValues {
    let (model, rest) = (scene.model(), scene.rest());
    let spacing = scene.spacing().of(model, kind, pair);
    let rule = DeltaRule { delta: spacing.delta, growth };
    let (delta, lowered) = rule.of(model, kind, pair, rest, separation.distance);
    let min_separation = match spacing.min_separation {
        None => scene.lengths().min_separation.min(0.1 * delta),
        Some(guaranteed) => {
            // The rest distance of neighbors bounds their minimum separation. A pair that starts closer has
            // its own gap as minimum separation, which grows from call to call.
            let (unlimited, _) = rule.without_growth_limit(model, kind, pair, rest);
            guaranteed.min(unlimited / MIN_SEPARATION_MARGIN).min(separation.width.max(0.0))
        }
    };
    let is_known = pair.vertices[..kind.vertex_count()].iter().any(|&v| call.is_known(v as usize));
    let (unlimited, _) = rule.without_growth_limit(model, kind, pair, rest);
    if is_known && separation.distance < KNOWN * unlimited {
        let least = min_separation + GUARDED_FLOOR * (unlimited - min_separation);
        let delta = (GUARDED * separation.distance).max(least).min(delta);
        return FirstValues { delta, min_separation, lowered };
    }
    FirstValues { delta, min_separation, lowered }
}

/// Fills lists of separations before they are written.
pub(super) const BLANK: Separation =
    Separation { normal: Vector::new(0.0, 0.0, 0.0), weights: [0.0; 4], distance: 0.0, width: 0.0 };

/// A number of `f32` that is not below `value`.
#[inline]
pub(super) fn round_up(value: f64) -> f32 {
    (value as f32) * (1.0 + f32::EPSILON) + f32::MIN_POSITIVE
}
