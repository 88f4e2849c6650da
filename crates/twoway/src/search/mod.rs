//! The default search stage. It keeps a list of candidate pairs, and searches again only for vertices whose
//! paths leave their trust regions.

mod ahead;
mod near;
mod regions;
mod sides;

pub(crate) use regions::longest_path;

use crate::scene::CollisionScene;
use crate::stages::{AheadVisitor, Coverage, Search};
use crate::state::ResolveState;
use crate::statistics::Statistics;
use ahead::AheadPairs;
use bowknot_constraints::FrictionModel;
use bowknot_geometry::Vector;
use bowknot_proximity::{CandidateList, ProximitySearch};
use bowknot_stepper::{Bound, TrustRegionRule};
use near::NearPairs;
use regions::Regions;
use std::time::Instant;

/// Share of the vertices with new trust regions above which everything is searched.
const MAX_CHANGED: f64 = 0.5;

/// The default [`Search`].
#[derive(Debug)]
pub struct TrustRegionSearch {
    search: ProximitySearch,
    rule: TrustRegionRule,
    /// Whether all candidates are pairs of the state.
    complete: bool,
    candidates: CandidateList,
    regions: Regions,
    near: NearPairs,
    ahead: AheadPairs,
    /// The paper's D^(l), for the rule `uniform`.
    covered_distance: f64,
    /// Whether the next update searches everything.
    requested: bool,
    /// Radii of swept searches [m].
    swept_radii: Vec<f64>,
}

impl TrustRegionSearch {
    /// A search over the primitives of the scene.
    pub fn new(scene: &CollisionScene) -> Self {
        Self {
            search: ProximitySearch::new(scene.model()),
            rule: scene.params().solver.forward.trust_region,
            complete: true,
            candidates: CandidateList::default(),
            regions: Regions::default(),
            near: NearPairs::default(),
            ahead: AheadPairs::default(),
            covered_distance: 0.0,
            requested: true,
            swept_radii: Vec::new(),
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
        let all = std::mem::take(&mut self.requested);
        let renewed = self.regions.cover(scene, state, all, wanted);
        let Self { search, regions, candidates, .. } = self;
        if renewed > 0 {
            let few = !all && renewed as f64 <= MAX_CHANGED * state.x.len() as f64;
            let changed = few.then_some(regions.changed.as_slice());
            search.update(scene.model(), &regions.balls.centers, &regions.radii, changed, candidates);
            statistics.searches += 1;
        }
        renewed > 0
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
        let Self { near, candidates, regions, complete, .. } = self;
        near.select(scene, state, candidates, regions, *complete, statistics);
        statistics.seconds.evaluate += timer.elapsed().as_secs_f64();
    }
}

impl Search for TrustRegionSearch {
    fn begin(&mut self, scene: &CollisionScene, state: &mut ResolveState, complete: bool) {
        let forward = &scene.params().solver.forward;
        // The velocity filter looks at pairs that are still far, and so do isotropic bounds.
        let sees_all = scene.friction_model() == FrictionModel::Filter || forward.bound == Bound::Isotropic;
        self.complete = complete || sees_all || self.rule == TrustRegionRule::Uniform;
        self.requested |= self.complete;
        self.near.begin(state);
    }

    fn update(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        let timer = Instant::now();
        match self.rule {
            TrustRegionRule::Uniform => self.cover_uniform(scene, state, statistics),
            TrustRegionRule::PerVertex if self.requested => {
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

    fn cover(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        displacements: &[Vector],
        statistics: &mut Statistics,
    ) {
        if self.rule == TrustRegionRule::PerVertex {
            let timer = Instant::now();
            let searched = self.cover_paths(scene, state, |v| displacements[v], statistics);
            statistics.seconds.search += timer.elapsed().as_secs_f64();
            if searched && self.complete {
                self.select(scene, state, statistics);
            }
        }
    }

    fn visit_ahead(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        displacements: &[Vector],
        visit: &AheadVisitor<'_>,
    ) {
        if !self.complete {
            self.ahead.visit(scene, state, &self.candidates, &self.regions, displacements, visit);
        }
    }

    fn update_swept(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        displacements: &[Vector],
        deviations: &[f64],
        statistics: &mut Statistics,
    ) {
        let timer = Instant::now();
        // No margin for contacts that are still farther: the next update searches again and finds them. But a
        // margin for minimum separations: pairs that are no candidates must not come closer.
        let bodies = scene.model().vertex_body();
        let margin = |body: &u32| scene.spacing().min_separation_margin(*body);
        self.swept_radii.clear();
        self.swept_radii.extend(deviations.iter().zip(bodies).map(|(d, body)| d + margin(body)));
        let contacts = &mut state.contacts;
        self.near.keep(contacts);
        self.search.search_swept(
            scene.model(),
            &state.x,
            displacements,
            &self.swept_radii,
            &mut contacts.pairs,
            &mut contacts.separations,
        );
        self.near.replace(scene, state, statistics);
        self.requested = true;
        statistics.searches += 1;
        statistics.seconds.search += timer.elapsed().as_secs_f64();
    }

    fn finish(&mut self, scene: &CollisionScene, state: &mut ResolveState, statistics: &mut Statistics) {
        // After a long step, the list knows the pairs along the path, but not all in range of its end.
        if self.requested && self.rule == TrustRegionRule::PerVertex {
            let timer = Instant::now();
            self.cover_paths(scene, state, |_| Vector::zeros(), statistics);
            statistics.seconds.search += timer.elapsed().as_secs_f64();
        }
        self.select(scene, state, statistics);
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

    fn candidate_count(&self) -> usize {
        self.candidates.len()
    }
}
