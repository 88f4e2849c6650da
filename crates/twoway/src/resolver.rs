//! Algorithm 1: the two-way loop, and its default composition.

use crate::backward::LcpBackward;
use crate::filter::filter_slip;
use crate::forward::CertifiedForward;
use crate::injection::injected_energy;
use crate::search::BudgetedSearch;
use crate::waiting::{Patience, behind};
use crate::{
    AcceptedState, BackwardStep, BodyContact, ContactSet, ForwardStep, HalfSpaceContact, Observer,
    PairFriction, Params, Problem, ResolveError, Search, State, Statistics, StopRule,
};
use bowknot_constraints::FrictionModel;
use bowknot_geometry::Point;
use bowknot_proximity::CollisionModel;
use std::time::Instant;

/// Steps past [`StopRule::Travel`] at most, while no contact pushes: the target is then reached to the bit, and momentum with it.
const FINISHING_STEPS: usize = 2;

/// Default of [`crate::StopParams::drag`].
const DEFAULT_DRAG: f64 = 1e-4;

/// What changes from call to call.
#[derive(Clone, Copy, Debug, Default)]
pub struct Call<'a> {
    /// Which vertices are prescribed: they go to their target and yield to nothing, but wait where they
    /// would cut through. Obstacle vertices always are. Empty: none but those.
    pub prescribed: &'a [bool],
    /// Time step that the call stands for [s]; scales the separation speed and the default step limit.
    pub time_step: Option<f64>,
    /// Positions at the start of the time step [m]: what friction measures slip from, where a time step makes
    /// several calls. None: the positions that the call starts from.
    pub start: Option<&'a [Point]>,
    /// Group of each vertex: prescribed vertices of one group go and wait as one, by one fraction of their way.
    /// [`Self::NO_GROUP`] is none. Every obstacle is a group of its own anyway. Empty: no groups.
    pub groups: &'a [u32],
    /// Two-way steps at most, if fewer than those of the parameters: for a caller that goes on from wherever the call ends.
    pub max_steps: Option<usize>,
}

impl Call<'_> {
    /// The entry of [`Self::groups`] for vertices in no group.
    pub const NO_GROUP: u32 = u32::MAX;
}

/// Resolves collisions between a state and a target; keeps its workspace between calls.
#[derive(Debug)]
pub struct Resolver<S = BudgetedSearch, B = LcpBackward, F = CertifiedForward> {
    problem: Problem,
    state: State,
    search: S,
    backward: B,
    forward: F,
}

impl Resolver {
    /// A resolver for vertices with the given rest positions [m] and masses [kg]. Masses of obstacle
    /// vertices are ignored. Rest positions set default lengths, stretch limits, and the desired distance of
    /// neighbours.
    ///
    /// # Errors
    /// Wrong lengths, non-finite numbers, massless vertices, parameters out of range.
    pub fn new(
        model: CollisionModel,
        rest: &[Point],
        masses: &[f64],
        params: Params,
    ) -> Result<Self, ResolveError> {
        let problem = Problem::new(model, rest, masses, params)?;
        let search = BudgetedSearch::new(&problem);
        Ok(Self::with_stages(problem, search, LcpBackward::default(), CertifiedForward::default()))
    }
}

impl<S: Search, B: BackwardStep, F: ForwardStep> Resolver<S, B, F> {
    /// A resolver made of other stages.
    pub fn with_stages(problem: Problem, search: S, backward: B, forward: F) -> Self {
        Self { problem, state: State::default(), search, backward, forward }
    }

    /// Says what each body brings into its contacts; one entry a body of the collision model, obstacles included.
    ///
    /// # Errors
    /// [`ResolveError::Contact`] with every entry out of its range, or a wrong number of entries.
    pub fn with_bodies(mut self, bodies: Vec<BodyContact>) -> Result<Self, ResolveError> {
        self.problem.contact.set_bodies(bodies)?;
        self.problem.contact_changed();
        Ok(self)
    }

    /// Says what each half-space of the collision model brings into its contacts.
    ///
    /// # Errors
    /// As [`Self::with_bodies`].
    pub fn with_half_spaces(mut self, half_spaces: Vec<HalfSpaceContact>) -> Result<Self, ResolveError> {
        self.problem.contact.set_half_spaces(half_spaces)?;
        self.problem.contact_changed();
        Ok(self)
    }

    /// Gives pairs of bodies coefficients of friction of their own, in place of the means of both sides'.
    ///
    /// # Errors
    /// As [`Self::with_bodies`]; a side that does not exist, a pair that is named twice.
    pub fn with_pair_friction(mut self, pairs: &[PairFriction]) -> Result<Self, ResolveError> {
        self.problem.contact.set_pairs(pairs)?;
        Ok(self)
    }

    /// The scene, its parameters, and the lengths in force.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The moving state as the last call left it.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Lists the pairs near each other at intersection-free positions, with their contact geometry, as the first step of
    /// a call would find them: every pair that is nearer than its contact range is among them.
    ///
    /// # Errors
    /// As [`Self::resolve`].
    pub fn survey(&mut self, positions: &[Point], call: &Call<'_>) -> Result<&ContactSet, ResolveError> {
        self.begin(positions, positions, call)?;
        self.search.update(&self.problem, &mut self.state, &mut Statistics::default());
        Ok(&self.state.contacts)
    }

    /// Moves `positions` from an intersection-free state toward `target`. Every accepted state and the straight
    /// path to it is free of intersections, however far the target; stopping early is always valid.
    ///
    /// # Errors
    /// The call is refused, and `positions` left as they were, on wrong lengths, non-finite numbers and
    /// coordinates too large for the floor.
    pub fn resolve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        call: &Call<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, ResolveError> {
        let clock = Instant::now();
        self.begin(positions, target, call)?;
        let Self { problem, state, search, backward, forward, .. } = self;
        let mut statistics = Statistics::default();
        let limits = &problem.params.stop;
        let max_steps = limits.max_steps.unwrap_or_else(|| default_max_steps(call.time_step));
        let max_steps = call.max_steps.map_or(max_steps, |most| most.min(max_steps));
        let mut waiting = Patience::default();
        let mut unrest = f64::INFINITY;
        let mut finishing = 0;
        let drag = limits.drag.unwrap_or(DEFAULT_DRAG);

        while state.step < max_steps {
            // In the pool from here on: parallel loops that are called from outside it pay for each crossing.
            let report = rayon::scope(|_| {
                search.update(problem, state, &mut statistics);
                if state.step == 0 && problem.friction_model() == FrictionModel::Filter {
                    filter_slip(problem, state);
                }
                let projecting = Instant::now();
                backward.project(problem, state, &mut statistics);
                statistics.seconds.backward += projecting.elapsed().as_secs_f64();
                let (advancing, before) = (Instant::now(), statistics.seconds.of_search());
                let report = forward.advance(problem, state, search, &mut statistics);
                let searched = statistics.seconds.of_search() - before;
                statistics.seconds.forward += advancing.elapsed().as_secs_f64() - searched;
                report
            });

            let accepted = AcceptedState {
                step: state.step,
                previous: &state.previous,
                positions: &state.x,
                target: &state.y,
            };
            let go_on = observer.accepted(&accepted);
            state.step += 1;
            state.remaining = report.remaining;
            statistics.remaining_r = report.remaining_r;
            statistics.slowest_body = report.slowest.map(|v| problem.model.vertex_body()[v as usize]);
            let settled = backward.settled(problem, state);
            statistics.converged = match limits.rule {
                _ if settled.is_some() => settled == Some(true),
                StopRule::Clock => report.remaining_r < limits.clock,
                StopRule::Travel => {
                    let edge = problem.lengths.edge;
                    report.remaining < limits.distance * edge
                        && backward.imbalance(problem, state) < limits.imbalance * edge
                        && backward.stretch_to_limit(state) <= 1.0 + limits.stretch_tolerance
                        && {
                            let before = std::mem::replace(&mut unrest, backward.unrest(problem, state));
                            unrest < drag * edge || unrest > 0.5 * before
                        }
                }
            };
            let out_of_time = limits.max_seconds.is_some_and(|s| clock.elapsed().as_secs_f64() > s);
            let stuck = waiting.update(problem, state);
            let finishes = limits.rule == StopRule::Travel
                && report.remaining > 0.0
                && finishing < FINISHING_STEPS
                && state.step < max_steps;
            let free = || state.contacts.multipliers.iter().all(|&multiplier| multiplier == 0.0);
            if statistics.converged && finishes && free() {
                finishing += 1;
                statistics.converged = false;
            }
            if statistics.converged || go_on.is_break() || out_of_time || stuck {
                break;
            }
        }

        self.finish(&mut statistics);
        positions.copy_from_slice(&self.state.x);
        statistics.seconds.total = clock.elapsed().as_secs_f64();
        Ok(statistics)
    }

    fn begin(&mut self, positions: &[Point], target: &[Point], call: &Call<'_>) -> Result<(), ResolveError> {
        let Self { problem, state, search, backward, forward } = self;
        problem.begin(positions, target, call)?;
        state.begin(positions, target, call.time_step);
        state.slip_start.clear();
        if problem.friction_model() != FrictionModel::None {
            state.slip_start.extend_from_slice(call.start.unwrap_or(positions));
        }
        search.begin(problem, state);
        backward.begin(problem, state);
        forward.begin(problem, state);
        Ok(())
    }

    /// Fills in what is known only at the end.
    fn finish(&mut self, statistics: &mut Statistics) {
        let Self { problem, state, search, backward, .. } = self;
        // Contact geometry at the final x, for the smallest gap.
        search.refresh(problem, state, statistics);
        backward.finish(problem, state, statistics);
        statistics.steps = state.step;
        statistics.pairs = state.contacts.pairs.len();
        statistics.min_gap_m = state.contacts.separations.iter().map(|s| s.distance).reduce(f64::min);
        let (mut sum, mut free) = (0.0, 0usize);
        for v in 0..state.x.len() {
            if problem.movable(v) {
                statistics.remaining_m = statistics.remaining_m.max((state.y[v] - state.x[v]).norm());
                sum += (state.x[v] - state.target[v]).norm_squared();
                free += 1;
            } else {
                let behind = (state.target[v] - state.x[v]).norm();
                statistics.prescribed_behind_m = statistics.prescribed_behind_m.max(behind);
            }
        }
        statistics.behind = behind(problem, state);
        statistics.injected_j = injected_energy(problem, state);
        statistics.distance_to_target_m = (sum / free.max(1) as f64).sqrt();
        if statistics.converged {
            statistics.slowest_body = None;
        }
    }
}

/// The paper's step limits: 512 up to dt = 1/100, 2048 from 1/20, in proportion between.
fn default_max_steps(time_step: Option<f64>) -> usize {
    let share = time_step.map_or(0.0, |dt| ((dt - 0.01) / 0.04).clamp(0.0, 1.0));
    512 + (share * 1536.0).round() as usize
}
