//! The two-way method with its default stages.

use crate::algorithm::Call;
use crate::backward::LcpBackward;
use crate::bodies::ContactData;
use crate::call::{CallInput, check_min_separation};
use crate::cpu::Cpu;
use crate::error::ResolveError;
use crate::forward::CertifiedForward;
use crate::injection::injected_energy;
use crate::input::ResolveInput;
use crate::lag::lags;
use crate::observer::Observer;
use crate::params::Params;
use crate::scene::CollisionScene;
use crate::search::TrustRegionSearch;
use crate::stages::{BackwardStep, ForwardStep, Search};
use crate::state::{ContactSet, ResolveState};
use crate::statistics::Statistics;
use crate::stretch::max_stretch;
use bowknot_check::{CheckError, Judge, StateOptions, StateReport};
use bowknot_geometry::{BodyFilter, HalfSpace, Point};
use bowknot_proximity::CollisionModel;
use bowknot_stepper::StepReport;

/// From this number of steps on the statistics of a call tell what it waited for.
const SLOW_STEPS: usize = 32;

/// Moves positions toward a target without intersections. It keeps its workspace between calls.
#[derive(Debug)]
pub struct Resolver<S = TrustRegionSearch, B = LcpBackward, F = CertifiedForward> {
    pub(crate) scene: CollisionScene,
    pub(crate) state: ResolveState,
    pub(crate) search: S,
    backward: B,
    forward: F,
}

impl Resolver {
    /// A resolver for vertices with the given rest positions [m] and masses [kg]. Masses of obstacle vertices
    /// are ignored. Rest positions determine default lengths, stretch limits, and the contact distance of
    /// neighbors: they are those of the undeformed bodies, not of a draped start.
    ///
    /// By default no edge gets longer than 1.1 times its rest length.
    /// [`BodyContact::stretch_limit`](crate::BodyContact::stretch_limit) and `params.contact.stretch_limit`
    /// set other limits, infinity switches them off.
    ///
    /// # Errors
    /// Wrong lengths, non-finite numbers, massless vertices, parameters out of range.
    pub fn new(
        model: CollisionModel,
        rest: &[Point],
        masses: &[f64],
        params: Params,
    ) -> Result<Self, ResolveError> {
        Self::with_contact(model, rest, masses, ContactData::default(), params)
    }

    /// A resolver whose bodies and half-spaces have contact data: friction, thickness, contact distance,
    /// stretch limit.
    ///
    /// # Errors
    /// As [`Self::new`]; [`ResolveError::Contact`] with everything that is wrong with `contact`.
    pub fn with_contact(
        model: CollisionModel,
        rest: &[Point],
        masses: &[f64],
        contact: ContactData,
        params: Params,
    ) -> Result<Self, ResolveError> {
        let scene = CollisionScene::new(model, rest, masses, contact, params)?;
        let search = TrustRegionSearch::new(&scene);
        Ok(Self::with_stages(scene, search, LcpBackward::new(), CertifiedForward::default()))
    }

    /// Changes the filters of the bodies, and the half-spaces, from the next call on, one entry per body and
    /// per half-space of the collision model. The next call searches for all pairs.
    ///
    /// **Bodies that rest** may be made obstacles. They then have no rows and no pairs with other obstacles,
    /// and their vertices go to their targets. Lengths, masses and edge lengths of vertices stay those of the
    /// bodies that the resolver was made with. Two obstacles never form a pair: a body that is made an
    /// obstacle is safe from other obstacles only as long as neither moves into the other.
    ///
    /// **Obstacles and half-spaces that come and go** are [absent](BodyFilter::absent) meanwhile
    /// ([half-spaces](HalfSpace::absent)): they meet nothing. Before one comes back the caller makes sure
    /// that it intersects nothing, as with any start ([`Self::detect_intersections`] with the new filters).
    ///
    /// # Errors
    /// A wrong number of entries; a body that would be deformable although its vertices have no mass. The
    /// resolver is then unchanged.
    pub fn set_filters(
        &mut self,
        bodies: &[BodyFilter],
        half_spaces: &[HalfSpace],
    ) -> Result<(), ResolveError> {
        self.scene.set_filters(bodies, half_spaces)?;
        self.search = TrustRegionSearch::new(&self.scene);
        self.state = ResolveState::default();
        Ok(())
    }
}

impl<S: Search, B: BackwardStep, F: ForwardStep<S>> Resolver<S, B, F> {
    /// A resolver with other stages.
    pub fn with_stages(scene: CollisionScene, search: S, backward: B, forward: F) -> Self {
        Self { scene, state: ResolveState::default(), search, backward, forward }
    }

    /// What is fixed for the scene: model, parameters, lengths.
    pub fn scene(&self) -> &CollisionScene {
        &self.scene
    }

    /// The moving state as the last call left it.
    pub fn state(&self) -> &ResolveState {
        &self.state
    }

    /// Refuses positions [m] with coordinates so large that their rounding exceeds the smallest minimum
    /// separation, as a call does with its start and its target.
    ///
    /// # Errors
    /// [`ResolveError::MinSeparationBelowRounding`] with the farthest vertex.
    pub fn check_coordinates(&self, positions: &[Point]) -> Result<(), ResolveError> {
        check_min_separation(&self.scene, positions, positions)
    }

    /// Finds the candidate pairs at intersection-free positions, with their contact geometry, as the first
    /// step of a call would find them: every pair that is closer than its contact range is among them.
    ///
    /// # Errors
    /// As [`Self::resolve`].
    pub fn detect_contacts(
        &mut self,
        positions: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<&ContactSet, ResolveError> {
        self.begin(positions, positions, input)?;
        self.search.update(&self.scene, &mut self.state, &mut Statistics::default());
        self.state.check_pairs(&self.scene)?;
        Ok(&self.state.contacts)
    }

    /// The pairs that intersect at `positions` [m], by the exact predicates of [`bowknot_check`]. Lists up to
    /// `limit` of them and counts all; does not look for the nearest pair, as `Judge::check_state` can. Takes
    /// about as long as a two-way step.
    ///
    /// # Errors
    /// A wrong number of positions; coordinates that are not finite or above 1e60.
    pub fn detect_intersections(&self, positions: &[Point], limit: usize) -> Result<StateReport, CheckError> {
        Judge::from_model(self.scene.model()).check_state(positions, &StateOptions { limit, distance: false })
    }

    /// Moves `positions` from an intersection-free state toward `target`. Every accepted state and the
    /// straight path to it are free of intersections, however far the target.
    ///
    /// **The start must be free of intersections.** That holds for what an earlier call returned; check any
    /// other start with [`Self::detect_intersections`]. Debug builds check each start and refuse those that
    /// intersect. Release builds do not look: surfaces that pass through each other then stay so, or worse,
    /// and the statistics do not tell.
    ///
    /// # Errors
    /// Wrong lengths, non-finite numbers and coordinates too large for the minimum separation; more pairs
    /// than can be numbered; in debug builds a start that intersects. The call is then refused, and
    /// `positions` are unchanged.
    pub fn resolve(&mut self, positions: &mut [Point], target: &[Point]) -> Result<Statistics, ResolveError> {
        self.resolve_with(positions, target, &ResolveInput::default(), &mut ())
    }

    /// As [`Self::resolve`], with further input and an observer. It is always valid to stop early.
    ///
    /// # Errors
    /// As [`Self::resolve`].
    pub fn resolve_with(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, ResolveError> {
        let mut call = Call::new(&self.scene, input);
        self.begin(positions, target, input)?;
        if cfg!(debug_assertions) {
            self.refuse_intersections(positions)?;
        }
        let mut statistics = Statistics::default();
        let Self { scene, state, search, backward, forward } = self;
        let mut cpu = Cpu { scene, state, search, backward, forward, report: StepReport::default() };
        call.run(&mut cpu, observer, &mut statistics)?;

        // A step limit set by the caller does not make a call slow.
        let is_cut = input.max_steps.is_some_and(|most| statistics.steps >= most);
        if statistics.steps >= SLOW_STEPS || (!statistics.converged && !is_cut && statistics.steps > 0) {
            statistics.waits = self.forward.waits(&self.scene, &self.state);
        }
        self.finish(&mut statistics);
        self.state.check_pairs(&self.scene)?;
        [statistics.max_step_stretch, statistics.max_stretch] =
            max_stretch(&self.scene, [positions, self.scene.rest()], &self.state.x);
        positions.copy_from_slice(&self.state.x);
        statistics.seconds.total = call.seconds();
        Ok(statistics)
    }

    /// Refuses a start that intersects.
    fn refuse_intersections(&self, positions: &[Point]) -> Result<(), ResolveError> {
        let mut report = self.detect_intersections(positions, 1).map_err(ResolveError::Unjudged)?;
        match report.intersections.pop() {
            Some(first) => Err(ResolveError::StartIntersects {
                count: report.intersection_count,
                first: Box::new(first),
            }),
            None => Ok(()),
        }
    }

    /// Starts a call: x^(0) = x^[k], y^(0) = y^[k+1], no candidates, r = 1.
    pub(crate) fn begin(
        &mut self,
        positions: &[Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<(), ResolveError> {
        let call = CallInput::new(&self.scene, positions, target, input)?;
        self.begin_search(positions, target, call);
        let Self { scene, state, backward, forward, .. } = self;
        backward.begin(scene, state);
        forward.begin(scene, state);
        Ok(())
    }

    /// The part of it that a call without steps needs.
    pub(crate) fn begin_search(&mut self, positions: &[Point], target: &[Point], call: CallInput) {
        let Self { scene, state, search, forward, .. } = self;
        state.begin(positions, target, call);
        search.begin(scene, state, !forward.visits_ahead());
    }

    /// Adds what is known only at the end of a call to the statistics.
    fn finish(&mut self, statistics: &mut Statistics) {
        let Self { scene, state, search, backward, .. } = self;
        search.finish(scene, state, statistics);
        backward.finish(scene, state, statistics);
        self.describe_end(statistics);
    }

    /// What can be told of the state at the end of a call.
    pub(crate) fn describe_end(&self, statistics: &mut Statistics) {
        let Self { scene, state, .. } = self;
        statistics.min_gap_m = state.contacts.separations.iter().map(|s| s.distance).reduce(f64::min);
        let (mut sum, mut free) = (0.0, 0usize);
        for v in 0..state.x.len() {
            if state.is_movable(v) {
                statistics.remaining_m = statistics.remaining_m.max((state.y[v] - state.x[v]).norm());
                sum += (state.x[v] - state.target[v]).norm_squared();
                free += 1;
            } else {
                let lag = (state.target[v] - state.x[v]).norm();
                statistics.prescribed_lag_m = statistics.prescribed_lag_m.max(lag);
            }
        }
        statistics.lags = lags(scene, state);
        statistics.injected_j = injected_energy(scene, state);
        statistics.distance_to_target_m = (sum / free.max(1) as f64).sqrt();
        if statistics.converged {
            statistics.slowest_body = None;
        }
    }
}
