//! Which pairs get a row in a backward step, and the distance that each row asks for.

use crate::blocked::Blocked;
use crate::chunks::Chunks;
use crate::scene::CollisionScene;
use crate::state::ResolveState;
use bowknot_constraints::{ContactForm, Feature, SelectedPair, predicted_gap};
use bowknot_geometry::{PairKind, Separation, Vector};
use std::collections::HashMap;
use std::ops::Range;

/// Sine of the largest angle by which the normals of rows may leave their cones. Rows are rebuilt in each
/// step; a wide cone prevents that they come and go.
const CONE_TOLERANCE: f64 = 0.02;

/// Distance below which a pair has a row whatever its normal, in its contact distance: pressed vertices are
/// held from all sides.
const CLOSE: f64 = 1.001;

/// Share of its distance that the row of such a pair asks for if the pair is no contact.
///
/// With the contact distance instead, the row would block bodies that slide on a mesh, and push them from
/// behind: grains on an irregular mesh gain 17 % of their speed in a second. Without any row, the pair would
/// stop the forward step where the target does not know of it. With a share of a half and no smallest
/// distance, `funnel` at scale 0.2 reaches the limit of steps.
const NON_CONTACT_SHARE: f64 = 0.9;

/// Smallest distance that such a row asks for, in the contact distance of the pair. At the minimum separation
/// the forward step closes no pair further, whatever its row allows. Without this bound, two of three
/// variants of `funnel` reach the limit of steps.
const MIN_NON_CONTACT_DISTANCE: f64 = 0.5;

/// By how much a gap can close at most, in the largest remaining distance of a vertex: both sides by one, and
/// some rounding.
const CLOSING: f64 = 2.0 + 1e-6;

/// The pairs that get a row.
#[derive(Debug, Default)]
pub(crate) struct Selection {
    chunks: Chunks<Found>,
    /// Which pair has the row of a contact that several pairs may have.
    owners: HashMap<[Feature; 2], SelectedPair>,
    /// The pairs that get a row, in the order of the list.
    pub selected: Vec<SelectedPair>,
    /// The pairs with a multiplier, in the order of the list.
    pub pressing: Vec<u32>,
    /// Number of pairs in contact range.
    pub in_range: usize,
}

/// What a chunk of pairs finds.
#[derive(Clone, Copy, Debug)]
enum Found {
    /// With the features that the closest points are on, where other pairs may have the same.
    Selected(SelectedPair, Option<[Feature; 2]>),
    Pressing(u32),
    /// So many of the pairs are in contact range.
    InRange(usize),
}

impl Selection {
    /// Selects pairs for rows that are linearized at `state.x`.
    pub fn select(&mut self, scene: &CollisionScene, state: &ResolveState, blocked: &Blocked) {
        let rule = Rule::new(scene, state, blocked);
        self.chunks.run(state.contacts.pairs.len(), |range, found| rule.find(range, found));
        self.selected.clear();
        self.pressing.clear();
        self.owners.clear();
        self.in_range = 0;
        for found in self.chunks.results() {
            match *found {
                Found::Selected(pair, None) => self.selected.push(pair),
                Found::Selected(pair, Some(contact)) => {
                    self.selected.push(pair);
                    let presses = |pair: SelectedPair| state.contacts.multipliers[pair.pair as usize] > 0.0;
                    let owner = self.owners.entry(contact).or_insert(pair);
                    if presses(pair) && !presses(*owner) {
                        *owner = pair;
                    }
                }
                Found::Pressing(pair) => self.pressing.push(pair),
                Found::InRange(count) => self.in_range += count,
            }
        }
        self.keep_owners();
    }

    /// Takes the rows of pairs away whose contact has the row of another pair, which asks for at least as much.
    /// What has no row does not press.
    fn keep_owners(&mut self) {
        if self.owners.is_empty() {
            return;
        }
        let found = self.chunks.results().filter_map(|found| match found {
            Found::Selected(pair, contact) => Some((pair, contact)),
            _ => None,
        });
        self.selected.clear();
        self.selected.extend(found.filter_map(|(pair, contact)| {
            let owner = contact.map(|contact| self.owners[&contact]);
            owner.is_none_or(|owner| owner.pair == pair.pair || owner.delta < pair.delta).then_some(*pair)
        }));
    }
}

struct Rule<'a> {
    scene: &'a CollisionScene,
    state: &'a ResolveState,
    blocked: &'a Blocked,
    /// By how much any gap can close [m].
    closing: f64,
    only_active: bool,
    /// Whether pairs with the same closest points share a row: in the forms whose rows do not depend on the pair.
    merges: bool,
}

impl<'a> Rule<'a> {
    fn new(scene: &'a CollisionScene, state: &'a ResolveState, blocked: &'a Blocked) -> Self {
        let only_active = scene.params().solver.backward.active_rows;
        let merges = only_active && scene.params().contact.form == ContactForm::Gap;
        Self { scene, state, blocked, closing: CLOSING * state.remaining, only_active, merges }
    }

    fn find(&self, range: Range<usize>, found: &mut Vec<Found>) {
        let contacts = &self.state.contacts;
        let mut in_range = 0;
        for kind in PairKind::ALL {
            let of_kind = contacts.pairs.range(kind);
            for p in range.start.max(of_kind.start)..range.end.min(of_kind.end) {
                if contacts.multipliers[p] != 0.0 {
                    found.push(Found::Pressing(p as u32));
                }
                if self.is_in_range(kind, p) {
                    in_range += 1;
                    let delta = self.row_delta(kind, p);
                    found.extend(delta.map(|delta| {
                        Found::Selected(SelectedPair { pair: p as u32, delta }, self.shared_contact(kind, p))
                    }));
                }
            }
        }
        found.push(Found::InRange(in_range));
    }

    fn is_in_range(&self, kind: PairKind, p: usize) -> bool {
        let (scene, contacts) = (self.scene, &self.state.contacts);
        let range = if scene.spacing().is_uniform() {
            scene.lengths().contact_range
        } else {
            scene.spacing().contact_range(scene.model(), kind, &contacts.pairs.pairs()[p])
        };
        contacts.separations[p].distance <= range
    }

    /// The features that the closest points of a pair are on, in order, if other pairs may have the same. A vertex
    /// near a vertex of a mesh is near all triangles and edges around it: one row is enough for all of them.
    fn shared_contact(&self, kind: PairKind, p: usize) -> Option<[Feature; 2]> {
        let is_alone = matches!(kind, PairKind::VertexVertex | PairKind::VertexHalfSpace);
        if is_alone || !self.merges {
            return None;
        }
        let contacts = &self.state.contacts;
        let mut features = self.scene.features(kind, &contacts.pairs.pairs()[p], &contacts.separations[p]);
        features.sort_unstable();
        // Vertices come before edges, edges before triangles.
        matches!(features, [Feature::Vertex(_), Feature::Vertex(_) | Feature::Edge(_)]).then_some(features)
    }

    /// The distance that the row of a pair in range asks for [m], if it gets one.
    fn row_delta(&self, kind: PairKind, p: usize) -> Option<f64> {
        let (scene, state, contacts) = (self.scene, self.state, &self.state.contacts);
        let params = &scene.params().contact;
        let (separation, delta) = (&contacts.separations[p], contacts.deltas[p]);
        let presses = contacts.multipliers[p] > 0.0;
        let pair = &contacts.pairs.pairs()[p];
        let mut gap = f64::NEG_INFINITY;
        if self.only_active && !presses {
            // No row asks for more than the contact distance. Most pairs are out already: tests from the
            // cheapest on.
            let open = separation.distance.min(separation.width.max(0.0)) - self.closing;
            if open >= params.active * delta {
                return None;
            }
            gap = predicted_gap(kind, &pair.vertices, separation, &state.x, &state.y);
            if gap >= params.active * delta || gap.is_nan() {
                return None;
            }
        }
        let is_contact = !params.contacts_only || {
            let features = scene.features(kind, pair, separation);
            scene.is_contact(features, &separation.normal, &state.x, CONE_TOLERANCE)
        };
        if is_contact {
            return Some(self.attainable_distance(kind, &pair.vertices, separation, delta));
        }
        let is_close = separation.distance < CLOSE * delta || presses;
        let row_delta =
            (NON_CONTACT_SHARE * separation.distance).clamp(MIN_NON_CONTACT_DISTANCE * delta, delta);
        let row_delta = (is_close && gap < params.active * row_delta).then_some(row_delta);
        row_delta.map(|row_delta| self.attainable_distance(kind, &pair.vertices, separation, row_delta))
    }

    /// A contact distance `delta` [m] without the deficit of prescribed vertices.
    ///
    /// Where prescribed vertices end nearer than that, the other vertices of their side would have to make up
    /// for it. With a closest point near a prescribed vertex they have a short lever, and would have to go
    /// far. So the deficit of the prescribed vertices is subtracted.
    fn attainable_distance(
        &self,
        kind: PairKind,
        vertices: &[u32; 4],
        separation: &Separation,
        delta: f64,
    ) -> f64 {
        let state = self.state;
        let sides = [0..kind.side_a(), kind.side_a()..kind.vertex_count()];
        let is_prescribed = |k: usize| state.call.is_prescribed(vertices[k] as usize);
        let place = |k: usize| match is_prescribed(k) {
            true => self.blocked.aim(state, vertices[k]).coords,
            false => state.x[vertices[k] as usize].coords,
        };
        let mut lacking = 0.0;
        for (side, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            let mut prescribed = sides[side].clone().filter(|&k| is_prescribed(k)).peekable();
            if prescribed.peek().is_none() || sides[side].clone().all(is_prescribed) {
                continue;
            }
            let opposite: Vector = sides[other].clone().map(|k| separation.weights[k] * place(k)).sum();
            let gap = |k: usize| sign * separation.normal.dot(&(place(k) - opposite));
            lacking += prescribed.map(|k| separation.weights[k] * (delta - gap(k)).max(0.0)).sum::<f64>();
        }
        delta - lacking
    }
}
