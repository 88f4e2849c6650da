//! The default forward stage.

use crate::scene::CollisionScene;
use crate::search::TrustRegionSearch;
use crate::search::longest_path;
use crate::stages::{Coverage, ForwardStep, Search};
use crate::state::ResolveState;
use crate::statistics::Statistics;
use crate::waits::{Wait, waits};
use bowknot_geometry::{PairKind, Separation, Vector};
use bowknot_stepper::{Bound, StepReport, Stepper, TrustRegionRule, Tubes};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Smallest number of vertices in one parallel task.
const CHUNK: usize = 2048;
/// Largest travel of a vertex in a swept step, in local edge lengths.
const MAX_SWEPT_TRAVEL: f64 = 4.0;
/// Radius of the tube around a swept path within which a vertex may deviate, in local edge lengths. It is so
/// small that the tubes of neighbors in the mesh, about a third of an edge apart, do not meet.
const SWEPT_TUBE_RADIUS: f64 = 0.1;
/// Share of that radius that may be used; the rest covers rounding.
const SWEPT_USABLE: f64 = 1.0 - 1e-3;
/// Largest number of searches along one step. After the last one the step is shortened instead.
const MAX_SWEPT_ROUNDS: usize = 3;

/// The default [`ForwardStep`].
#[derive(Debug, Default)]
pub struct CertifiedForward {
    stepper: Stepper,
    /// Step sizes alpha_0 that the swept search assumes.
    assumed: Vec<f64>,
    /// The assumed paths alpha_0 d [m].
    paths: Vec<Vector>,
    /// Radii of the tubes around the paths [m].
    tubes: Vec<f64>,
    /// Whether a pair holds back the vertex in this step. Empty: none is held.
    held: Vec<bool>,
    /// Whether a swept step of this call had to be shortened. In such hard contact swept steps do not pay,
    /// and the call takes no more of them.
    swept_step_failed: bool,
}

impl ForwardStep<TrustRegionSearch> for CertifiedForward {
    fn visits_ahead(&self) -> bool {
        true
    }

    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.stepper.begin(scene.vertex_count());
        self.stepper.set_groups(state.call.groups().of_vertices());
        self.swept_step_failed = false;
    }

    fn advance(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut TrustRegionSearch,
        statistics: &mut Statistics,
    ) -> StepReport {
        self.stepper.set_target(&state.x, &state.y);
        self.held.clear();
        if !self.fly(scene, state, search, statistics) && !self.sweep(scene, state, search, statistics) {
            self.step_within_trust_regions(scene, state, search, statistics);
        }
        self.limit_bodies(scene, state);
        let (unhindered, unhindered_lag) = self.unhindered(state);
        state.previous.par_iter_mut().zip(&state.x).with_min_len(CHUNK).for_each(|(old, x)| *old = *x);
        StepReport { unhindered, unhindered_lag, ..self.stepper.advance(&mut state.x) }
    }

    fn waits(&self, scene: &CollisionScene, state: &ResolveState) -> Vec<Wait> {
        waits(scene, state, &self.stepper, &self.held)
    }
}

impl CertifiedForward {
    /// Limits a step within the trust regions: by the pairs at x, and by those that it could reach.
    fn step_within_trust_regions(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut TrustRegionSearch,
        statistics: &mut Statistics,
    ) {
        let params = &scene.params().solver.forward;
        let damping = params.damping;
        search.cover(scene, state, self.stepper.displacements(), statistics);
        if params.trust_region == TrustRegionRule::PerVertex {
            let groups = state.call.groups().count();
            let longest = |v| longest_path(scene, v);
            self.stepper.cap_travel(scene.model(), scene.obstacle_vertices(), groups, longest);
        }
        let contacts = state.contacts.as_contacts();
        match params.bound {
            Bound::Planes => {
                statistics.frozen_pairs += self.stepper.limit_by_planes(&contacts, damping);
                let (stepper, frozen) = (&self.stepper, AtomicUsize::new(0));
                search.visit_ahead(scene, state, stepper.displacements(), &|kind, vertices, at, least| {
                    if stepper.limit_by_plane(kind, vertices, at, least, damping) {
                        frozen.fetch_add(1, Ordering::Relaxed);
                    }
                });
                statistics.frozen_pairs += frozen.into_inner();
            }
            Bound::Isotropic => {
                statistics.frozen_pairs += self.stepper.limit_by_distances(&contacts, damping);
            }
        }
        self.limit_bodies(scene, state);
        self.note_held(state);
        match search.coverage() {
            Coverage::Distance(distance) => {
                let room = distance - scene.spacing().largest_min_separation();
                self.stepper.limit_by_non_candidates(room, damping);
            }
            Coverage::TrustRegions(trust_regions) => {
                if self.stepper.limit_by_trust_regions(&state.x, trust_regions) {
                    search.request();
                }
            }
        }
    }

    /// Takes the whole step in free flight, if no pair limits it. Returns whether it did; if not, nothing is
    /// limited yet.
    ///
    /// In free flight no two bodies come near each other as long as all vertices go all the way. Within a
    /// body, the slab of each pair moves along with the body: the pair cannot meet if its sides together
    /// close less than the slab, see [`Stepper::limit_by_moving_planes`]. One pair that could meet ends the
    /// flight.
    fn fly(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        search: &mut TrustRegionSearch,
        statistics: &mut Statistics,
    ) -> bool {
        let params = &scene.params().solver.forward;
        let usable = params.bound == Bound::Planes && matches!(search.coverage(), Coverage::TrustRegions(_));
        if !usable || state.contacts.any_presses() {
            return false;
        }
        let (stepper, damping) = (&self.stepper, params.damping);
        let displacements = stepper.displacements();
        let tubes = Tubes { paths: displacements, radii: &[] };
        let stays_open = |kind, vertices: &[u32; 4], at: &Separation, least: f64| {
            stepper.stays_open(kind, vertices, at, least, &tubes, damping)
        };
        let contacts = &state.contacts;
        for kind in PairKind::ALL {
            let all_open = contacts.pairs.range(kind).into_par_iter().with_min_len(CHUNK).all(|p| {
                let (pair, at) = (&contacts.pairs.pairs()[p], &contacts.separations[p]);
                stays_open(kind, &pair.vertices, at, contacts.min_separations[p])
            });
            if !all_open {
                return false;
            }
        }
        let closes = AtomicBool::new(false);
        let is_flight = search.visit_flight(
            scene,
            state,
            displacements,
            &|kind, vertices, at, least| {
                if !stays_open(kind, vertices, at, least) {
                    closes.store(true, Ordering::Relaxed);
                }
            },
            statistics,
        );
        let takes = is_flight && !closes.into_inner();
        if takes {
            search.take_flight(scene, state, displacements, stepper.largest_coordinate());
        }
        takes
    }

    /// Takes a long step where one pays and no contact presses: limits it by every pair that could meet along
    /// it, with all vertices at the same path time. Returns whether it did; if not, nothing is limited yet.
    ///
    /// All vertices are assumed to move along u = alpha_0 d. The search finds every pair whose boxes, moved
    /// along u and inflated by the tubes, meet at the same path time. There are three kinds of pairs:
    /// - pairs that are no candidates: they cannot meet while every vertex stays in its tube;
    /// - candidates whose slab stays open while it moves along: they are as safe;
    /// - the other candidates: their planes lower alpha.
    ///
    /// If (alpha_0 - alpha) |d| is within the tube for all vertices, pairs of the first two kinds cannot meet
    /// at any path time. Otherwise alpha_0 is lowered to alpha and the search is repeated. After the last
    /// search the whole step is scaled instead: with tau = min over the vertices of tube / ((alpha_0 - alpha)
    /// |d|) and alpha <- min(alpha, tau alpha_0), the vertices follow the assumed paths at the path time tau
    /// t. They deviate by at most tau (alpha_0 - alpha) |d| <= tube, since min(alpha, tau alpha_0) >= tau
    /// alpha.
    fn sweep(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut TrustRegionSearch,
        statistics: &mut Statistics,
    ) -> bool {
        let params = &scene.params().solver.forward;
        let min_travel = params.swept_travel * scene.lengths().edge;
        let longest = |stepper: &Stepper| {
            let displacements = stepper.displacements().par_iter().with_min_len(CHUNK).enumerate();
            displacements.map(|(v, d)| stepper.alpha(v) * d.norm()).reduce(|| 0.0, f64::max)
        };
        let usable = params.bound == Bound::Planes && matches!(search.coverage(), Coverage::TrustRegions(_));
        // Where contacts press, free vertices that move far ahead of held ones only make the rows between
        // them harder: long steps then cost searches and steps.
        let is_off = !usable || self.swept_step_failed || !min_travel.is_finite();
        if is_off || state.contacts.any_presses() || longest(&self.stepper) <= min_travel {
            return false;
        }
        let count = state.x.len();
        let damping = params.damping;
        self.tubes.clear();
        for v in 0..count {
            let (length, h) = (self.stepper.displacements()[v].norm(), scene.local_edge(v));
            self.tubes.push(if length == 0.0 { 0.0 } else { SWEPT_TUBE_RADIUS * h });
            self.stepper.limit_travel(v, MAX_SWEPT_TRAVEL * h);
        }
        // The present candidates tell whether any vertex can go far, before a search is made.
        self.assume_step_sizes();
        self.limit_by_moving_planes(scene, state, damping, statistics);
        if longest(&self.stepper) <= min_travel {
            self.stepper.set_target(&state.x, &state.y);
            return false;
        }
        for round in 1..=MAX_SWEPT_ROUNDS {
            self.assume_step_sizes();
            let Self { stepper, paths, tubes: radii, .. } = &*self;
            let (tubes, frozen) = (Tubes { paths, radii }, AtomicUsize::new(0));
            search.visit_swept(
                scene,
                state,
                paths,
                radii,
                &|kind, vertices, at, least| {
                    if stepper.limit_by_moving_plane(kind, vertices, at, least, &tubes, damping) {
                        frozen.fetch_add(1, Ordering::Relaxed);
                    }
                },
                statistics,
            );
            statistics.frozen_pairs += frozen.into_inner();
            self.limit_by_moving_planes(scene, state, damping, statistics);
            let worst = (0..count)
                .filter(|&v| self.tubes[v] > 0.0)
                .map(|v| {
                    let deviation =
                        (self.assumed[v] - self.stepper.alpha(v)) * self.stepper.displacements()[v].norm();
                    deviation / (SWEPT_USABLE * self.tubes[v])
                })
                .fold(0.0, f64::max);
            if worst <= 1.0 {
                break;
            }
            if round == MAX_SWEPT_ROUNDS {
                self.swept_step_failed = true;
                for v in 0..count {
                    self.stepper.limit(v, self.assumed[v] / worst);
                }
            }
        }
        true
    }

    /// Notes which vertices the pairs hold back: those with a limit before trust regions add theirs.
    fn note_held(&mut self, state: &ResolveState) {
        let Self { held, stepper, .. } = self;
        held.resize(state.x.len(), false);
        let vertices = held.par_iter_mut().enumerate().with_min_len(CHUNK);
        vertices.for_each(|(v, held)| *held = stepper.alpha(v) < stepper.cap(v));
    }

    /// Largest distance that a vertex has left after this step although no pair holds it back, and the
    /// largest of a prescribed vertex [m].
    fn unhindered(&self, state: &ResolveState) -> (f64, f64) {
        let left = |v: usize| {
            let is_held = self.held.get(v).is_some_and(|held| *held);
            let share = if is_held { 0.0 } else { 1.0 - self.stepper.alpha(v) };
            if share == 0.0 { 0.0 } else { share * self.stepper.displacements()[v].norm() }
        };
        let of_vertex = |v: usize| {
            let left = left(v);
            (left, if state.call.is_prescribed(v) { left } else { 0.0 })
        };
        let vertices = (0..state.x.len()).into_par_iter().with_min_len(CHUNK);
        vertices.map(of_vertex).reduce(|| (0.0, 0.0), |a, b| (a.0.max(b.0), a.1.max(b.1)))
    }

    /// Assumes that the vertices take the present step sizes.
    fn assume_step_sizes(&mut self) {
        let displacements = self.stepper.displacements();
        self.assumed.clear();
        self.assumed.extend((0..displacements.len()).map(|v| self.stepper.alpha(v)));
        self.paths.clear();
        self.paths.extend(displacements.iter().zip(&self.assumed).map(|(d, a)| *a * *d));
    }

    /// Limits the step by the candidate pairs whose slabs do not stay open along the assumed paths.
    fn limit_by_moving_planes(
        &mut self,
        scene: &CollisionScene,
        state: &ResolveState,
        damping: f64,
        statistics: &mut Statistics,
    ) {
        let contacts = state.contacts.as_contacts();
        let tubes = Tubes { paths: &self.paths, radii: &self.tubes };
        statistics.frozen_pairs += self.stepper.limit_by_moving_planes(&contacts, &tubes, damping);
        self.limit_bodies(scene, state);
    }

    /// Makes each obstacle and each group of pinned vertices move together.
    fn limit_bodies(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.stepper.limit_by_bodies(scene.model(), scene.obstacle_vertices());
        self.stepper.limit_by_groups(state.call.groups().count());
    }
}
