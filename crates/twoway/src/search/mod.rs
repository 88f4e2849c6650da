//! The default search stage. It keeps a list of candidate pairs, and searches again only for vertices whose
//! paths leave their trust regions.

mod ahead;
mod flight;
mod near;
mod regions;
mod sides;

pub(crate) use regions::longest_path;

use crate::scene::CollisionScene;
use crate::stages::{Coverage, Search};
use crate::state::ResolveState;
use crate::statistics::Statistics;
use ahead::AheadPairs;
pub use ahead::AheadVisitor;
use bowknot_constraints::FrictionModel;
use bowknot_geometry::{Identity, PairKind, Vector};
use bowknot_proximity::{CandidateList, PairList, ProximitySearch};
use bowknot_stepper::{Bound, TrustRegionRule};
use flight::Flight;
pub use near::{GUARDED, GUARDED_FLOOR, KNOWN};
use near::{Listed, NearPairs};
use regions::Regions;
use web_time::Instant;

/// Share of the vertices with new trust regions above which everything is searched.
const MAX_CHANGED: f64 = 0.5;

/// The default [`Search`].
#[derive(Debug)]
pub struct TrustRegionSearch {
    /// Of the scene and its collision model, to which everything below belongs.
    scene: [Identity; 2],
    search: ProximitySearch,
    rule: TrustRegionRule,
    /// Whether all candidates are pairs of the state.
    complete: bool,
    candidates: CandidateList,
    /// What the last swept search has found.
    swept: CandidateList,
    regions: Regions,
    near: NearPairs,
    ahead: AheadPairs,
    flight: Flight,
    /// The paper's D^(l), for the rule `uniform`.
    covered_distance: f64,
    /// Whether the next update searches everything.
    requested: bool,
    /// Whether vertices may have left their trust regions, in a long step.
    left: bool,
    /// Radii of swept searches [m].
    swept_radii: Vec<f64>,
}

impl TrustRegionSearch {
    /// A search over the primitives of the scene. A call for another scene, or after its filters have changed,
    /// begins anew.
    pub fn new(scene: &CollisionScene) -> Self {
        Self {
            scene: identities(scene),
            search: ProximitySearch::new(scene.model()),
            rule: scene.params().solver.forward.trust_region,
            complete: true,
            candidates: CandidateList::default(),
            swept: CandidateList::default(),
            regions: Regions::default(),
            near: NearPairs::default(),
            ahead: AheadPairs::default(),
            flight: Flight::default(),
            covered_distance: 0.0,
            requested: true,
            left: false,
            swept_radii: Vec::new(),
        }
    }

    /// Begins anew if the scene is another one: its trust regions may lack margins, and its list has other
    /// pairs.
    fn follow(&mut self, scene: &CollisionScene) {
        if self.scene != identities(scene) {
            *self = Self::new(scene);
        }
    }

    /// Gives vertices whose paths along `wanted(vertex)` [m] leave their trust regions new ones, and searches
    /// for their pairs. Returns whether there were any.
    fn cover_paths(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        wanted: impl Fn(usize) -> Vector + Sync,
        statistics: &mut Statistics,
    ) -> bool {
        self.left = false;
        let all = std::mem::take(&mut self.requested);
        let renewed = self.regions.cover(scene, state, all, wanted);
        let Self { search, regions, candidates, flight, .. } = self;
        if renewed > 0 {
            let few = !all && renewed as f64 <= MAX_CHANGED * state.x.len() as f64;
            let changed = few.then_some(regions.changed.as_slice());
            search.update(scene.model(), &regions.balls.centers, &regions.radii, changed, candidates);
            if !few {
                flight.settle();
            }
            statistics.searches += 1;
        }
        renewed > 0
    }

    /// Asks for a search if bodies have moved relative to each other since the last one, unless all of them
    /// are apart at x.
    fn search_after_flight(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.requested |= self.flight.drift && !self.flight.is_free(scene, &state.x, |_| Vector::zeros());
    }

    /// Sets the radii of a swept search: the `deviations` from the paths [m], and no margin for contacts that
    /// are still farther, since the next update finds them. But a margin for minimum separations: pairs that
    /// are no candidates must not come closer.
    fn set_swept_radii(&mut self, scene: &CollisionScene, deviations: &[f64]) {
        let bodies = scene.model().vertex_body();
        let margin = |body: &u32| scene.spacing().min_separation_margin(*body);
        self.swept_radii.clear();
        self.swept_radii.extend(deviations.iter().zip(bodies).map(|(d, body)| d + margin(body)));
    }

    /// Searches within one distance for all vertices if it is due by the paper's rule: D^(l) < D^min.
    fn cover_uniform(&mut self, scene: &CollisionScene, state: &ResolveState, statistics: &mut Statistics) {
        let params = &scene.params().solver.forward;
        let delta = scene.spacing().largest_delta();
        if !self.requested {
            let moved = state.x.iter().zip(&state.previous).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            self.covered_distance -= 2.0 * moved * (1.0 + 1e-12);
            self.requested = self.covered_distance < 2.0 * params.trust_region_min * delta;
        }
        if std::mem::take(&mut self.requested) {
            let radius = params.trust_region_max * delta;
            self.covered_distance = 2.0 * radius;
            let Self { search, regions, candidates, .. } = self;
            regions.set_uniform(state, radius);
            search.update(scene.model(), &regions.balls.centers, &regions.radii, None, candidates);
            statistics.searches += 1;
        }
    }

    /// Selects the pairs of the state.
    fn select(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let timer = Instant::now();
        let Self { near, candidates, regions, flight, complete, .. } = self;
        let listed = Listed { candidates, regions, rounding: flight.rounding };
        near.select(scene, state, listed, *complete, statistics);
        statistics.seconds.evaluate += timer.elapsed().as_secs_f64();
    }
}

fn identities(scene: &CollisionScene) -> [Identity; 2] {
    [scene.identity(), scene.model().identity()]
}

/// What [`CertifiedForward`](crate::CertifiedForward) and [`Resolver::adopt`](crate::Resolver::adopt) ask
/// for.
impl TrustRegionSearch {
    /// As [`Self::update`], for a caller who knows the pairs: all that are within contact range at `state.x`
    /// are among `near`. It need not search then.
    pub fn update_among(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        near: &PairList,
        statistics: &mut Statistics,
    ) {
        if self.complete {
            return self.update(scene, state, statistics);
        }
        // Candidates and trust regions stay as they are: the next update renews those that vertices have
        // left.
        let timer = Instant::now();
        self.near.select_among(scene, state, near, statistics);
        statistics.seconds.evaluate += timer.elapsed().as_secs_f64();
    }

    /// Makes trust regions hold the moves along `displacements` [m] from `state.x`, each at most
    /// `solver.forward.trust_region_max` long, and the candidate pairs valid for them.
    pub fn cover(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        displacements: &[Vector],
        statistics: &mut Statistics,
    ) {
        if self.rule == TrustRegionRule::PerVertex {
            let timer = Instant::now();
            // This step is no free flight.
            self.requested |= self.flight.drift;
            let searched = self.cover_paths(scene, state, |v| displacements[v], statistics);
            statistics.seconds.search += timer.elapsed().as_secs_f64();
            if searched && self.complete {
                self.select(scene, state, statistics);
            }
        }
    }

    /// Calls `visit` with every pair that is not in `state.contacts` and could limit such moves. There is
    /// none if `state.contacts` is complete.
    pub fn visit_ahead(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        displacements: &[Vector],
        visit: &AheadVisitor<'_>,
    ) {
        if !self.complete {
            let Self { ahead, candidates, regions, flight, .. } = self;
            let listed = Listed { candidates, regions, rounding: flight.rounding };
            ahead.visit(scene, state, listed, displacements, visit);
        }
    }

    /// Calls `visit` with the pairs within bodies that are not in `state.contacts` and could limit a step in
    /// free flight along `displacements` [m] from x: one in which no body comes near another or a half-space,
    /// and the vertices of each body move almost alike. Returns whether the step is one. It must be a
    /// function of x and the displacements.
    pub fn visit_flight(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        displacements: &[Vector],
        visit: &AheadVisitor<'_>,
        statistics: &mut Statistics,
    ) -> bool {
        if self.complete || self.rule != TrustRegionRule::PerVertex {
            return false;
        }
        if !self.flight.plan(scene, state, displacements) {
            return false;
        }
        let timer = Instant::now();
        let relative = std::mem::take(&mut self.flight.relative);
        let smallest = self.regions.smallest_radius(scene);
        self.requested |= self.flight.is_spent(smallest);
        self.cover_paths(scene, state, |v| relative[v], statistics);
        statistics.seconds.search += timer.elapsed().as_secs_f64();
        let Self { ahead, candidates, regions, flight, .. } = self;
        let bodies = scene.model().vertex_body();
        if !candidates.is_empty() {
            // Pairs of different bodies may be listed with wrong bounds; they do not matter.
            let listed = Listed { candidates, regions, rounding: flight.rounding };
            ahead.visit(scene, state, listed, &relative, &|kind, vertices, at, least| {
                let body = |side: usize| bodies[vertices[side] as usize];
                if kind != PairKind::VertexHalfSpace && body(0) == body(kind.side_a()) {
                    visit(kind, vertices, at, least);
                }
            });
        }
        flight.relative = relative;
        true
    }

    /// Notes that all vertices will take this step from x, all the way. `largest_coordinate` is that of the
    /// step [m].
    pub fn take_flight(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        displacements: &[Vector],
        largest_coordinate: f64,
    ) {
        self.flight.take(scene, state, displacements, largest_coordinate, &mut self.regions);
        self.search.note_moved();
    }

    /// Calls `visit` with every pair that is not in `state.contacts` and could meet while the vertices move
    /// from x along `displacements`, all at the same path time, and deviate from there by at most
    /// `deviations` [m].
    pub fn visit_swept(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        displacements: &[Vector],
        deviations: &[f64],
        visit: &AheadVisitor<'_>,
        statistics: &mut Statistics,
    ) {
        let timer = Instant::now();
        self.set_swept_radii(scene, deviations);
        let Self { search, ahead, swept, swept_radii, .. } = self;
        search.list_swept(scene.model(), &state.x, displacements, swept_radii, swept);
        statistics.seconds.search += timer.elapsed().as_secs_f64();
        let radius = |v: usize| swept_radii[v];
        ahead.visit_swept(scene, state, swept, displacements, radius, visit);
        self.left = true;
        self.requested |= self.flight.drift;
        statistics.searches += 1;
    }
}

impl Search for TrustRegionSearch {
    fn begin(&mut self, scene: &CollisionScene, state: &mut ResolveState, complete: bool) {
        self.follow(scene);
        let forward = &scene.params().solver.forward;
        // The velocity filter looks at pairs that are still far, and so do isotropic bounds.
        let sees_all = scene.friction_model() == FrictionModel::Filter || forward.bound == Bound::Isotropic;
        self.complete = complete || sees_all || self.rule == TrustRegionRule::Uniform;
        self.requested |= self.complete;
        self.near.begin(state);
    }

    fn update(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        self.follow(scene);
        let timer = Instant::now();
        if state.step == 0 {
            self.search_after_flight(scene, state);
        }
        match self.rule {
            TrustRegionRule::Uniform => self.cover_uniform(scene, state, statistics),
            TrustRegionRule::PerVertex if self.requested || self.left => {
                self.cover_paths(scene, state, |v| state.y[v] - state.x[v], statistics);
            }
            // A list of an earlier call holds as long as the vertices are in their trust regions.
            TrustRegionRule::PerVertex if state.step == 0 => {
                self.cover_paths(scene, state, |_| Vector::zeros(), statistics);
            }
            TrustRegionRule::PerVertex => {}
        }
        statistics.seconds.search += timer.elapsed().as_secs_f64();
        self.select(scene, state, statistics);
    }

    fn finish(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        if state.step == 0 {
            self.search_after_flight(scene, state);
        }
        // After a long step, vertices may have left their trust regions.
        if (self.requested || self.left) && self.rule == TrustRegionRule::PerVertex {
            let timer = Instant::now();
            self.cover_paths(scene, state, |_| Vector::zeros(), statistics);
            statistics.seconds.search += timer.elapsed().as_secs_f64();
        }
        self.select(scene, state, statistics);
        statistics.pairs = self.candidates.len();
    }

    fn request(&mut self) {
        self.requested = true;
    }

    fn coverage(&self) -> Coverage<'_> {
        match self.rule {
            TrustRegionRule::PerVertex => Coverage::TrustRegions(&self.regions.balls),
            TrustRegionRule::Uniform => Coverage::Distance(self.covered_distance),
        }
    }
}
