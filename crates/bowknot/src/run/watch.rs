//! What is kept of a run to show its failure again.

use crate::recording::{Failure, Limits, Recorder, Reduction, States};
use crate::simulator::{CollisionProblem, SimulationError, Simulator};
use bowknot_geometry::Point;
use bowknot_scene::Scene;
use bowknot_scene::world::World;
use bowknot_twoway::Params;
use std::sync::{Arc, Mutex, PoisonError};

/// Keeps the states by which a run fails; copies share what they keep. Given to a run in
/// [`super::RunOptions::watch`], it knows after its end, however that came.
#[derive(Clone, Debug, Default)]
pub struct FailureWatch(Arc<Mutex<Watched>>);

#[derive(Debug, Default)]
struct Watched {
    recorder: Option<Recorder>,
    /// The collision problem that was given to the two-way method last.
    last: Option<States>,
    /// The problem in which the judge first found an intersection, and where the step ended that has it.
    unsafe_step: Option<(States, Vec<Point>)>,
    /// The first problem at the end of a time step that did not converge.
    unreached: Option<States>,
}

/// The smallest state that shows a failure.
#[derive(Clone, Debug)]
pub struct SmallestState {
    /// What it shows by itself; none if the collision stage alone does not fail.
    pub failure: Option<Failure>,
    /// The state, and how it was found. Whole if it shows nothing.
    pub reduction: Reduction,
}

impl FailureWatch {
    /// Begins, or goes on after an obstacle has appeared or vanished.
    pub(super) fn begin(&self, simulator: &Simulator) {
        self.with(|watched| watched.recorder = Some(Recorder::new(simulator)));
    }

    pub(super) fn problem(&self, problem: &CollisionProblem<'_>) {
        self.with(|watched| watched.last = watched.recorder.as_ref().map(|r| r.states(problem)));
    }

    /// The judge has found an intersection in a step that ended at `x`, or on the way there.
    pub(super) fn found_intersection(&self, x: &[Point]) {
        self.with(|watched| {
            if watched.unsafe_step.is_none() {
                watched.unsafe_step = watched.last.clone().map(|last| (last, x.to_vec()));
            }
        });
    }

    /// A time step has ended with a collision problem that did not converge.
    pub(super) fn not_converged(&self) {
        self.with(|watched| {
            if watched.unreached.is_none() {
                watched.unreached.clone_from(&watched.last);
            }
        });
    }

    fn with<T>(&self, act: impl FnOnce(&mut Watched) -> T) -> T {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The smallest state that shows what the run of the scene failed of: `error` if it ended with one, else
    /// an intersection that the judge found, else the first time step that did not converge. None if it did
    /// not fail, or of something that is no state, such as a file.
    pub fn smallest(
        &self,
        scene: &Scene,
        error: Option<&SimulationError>,
        limits: Limits<'_>,
    ) -> Option<SmallestState> {
        let params = scene.twoway();
        if let Some(error) = error {
            return of_error(scene, self.with(|watched| watched.last.clone()), &params, error, limits);
        }
        if let Some((problem, end)) = self.with(|watched| watched.unsafe_step.clone()) {
            let at_end = States { y: end.clone(), x: end, ..problem.clone() };
            let reduced = smallest(&problem, &params, Failure::Unsafe, limits)
                .or_else(|| smallest(&at_end, &params, Failure::Intersects, limits));
            return Some(reduced.unwrap_or_else(|| whole(problem)));
        }
        let problem = self.with(|watched| watched.unreached.clone())?;
        Some(smallest(&problem, &params, Failure::NotConverged, limits).unwrap_or_else(|| whole(problem)))
    }
}

fn of_error(
    scene: &Scene,
    last: Option<States>,
    params: &Params,
    error: &SimulationError,
    limits: Limits<'_>,
) -> Option<SmallestState> {
    let (problem, failure) = match error {
        SimulationError::StartIntersects { .. } => (start(scene)?, Failure::Intersects),
        SimulationError::Resolve { step, source, .. } => {
            // The call that was refused may be one that looked for contacts alone, before the first problem.
            let problem = last.filter(|_| *step > 0).or_else(|| start(scene))?;
            (problem, Failure::Refused(std::mem::discriminant(source)))
        }
        SimulationError::Internal { .. } => (last?, Failure::Panics),
        SimulationError::Target { .. } | SimulationError::Backend { .. } => return Some(whole(last?)),
        _ => return None,
    };
    Some(smallest(&problem, params, failure, limits).unwrap_or_else(|| whole(problem)))
}

/// The start of a scene, as a problem that moves nothing.
fn start(scene: &Scene) -> Option<States> {
    let world = World::new(scene).ok()?;
    let masses = world.dynamics_model().ok()?.masses().to_vec();
    let home = &world.positions[..world.collision_vertices()];
    let present = world.present(0.0, scene.simulation.dt);
    Some(Recorder::of_world(&world, &present, &masses).at_rest(home))
}

fn smallest(
    problem: &States,
    params: &Params,
    failure: Failure,
    limits: Limits<'_>,
) -> Option<SmallestState> {
    let reduction = problem.reduce(params, failure, limits)?;
    Some(SmallestState { failure: Some(failure), reduction })
}

fn whole(states: States) -> SmallestState {
    let of = states.element_count();
    SmallestState { failure: None, reduction: Reduction { states, of, tries: 0, minimal: false } }
}
