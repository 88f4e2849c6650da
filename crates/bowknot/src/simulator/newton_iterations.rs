//! The Newton iterations of a time step, in one stage or several, see [`bowknot_dynamics::dynamics::stages`].
//!
//! For each Newton iteration the dynamics computes a target y from x. Prescribed vertices (pins, obstacles)
//! have their keyframe at the end of the stage as target. The two-way method moves x towards y without intersections, and
//! the vertices inside of solids, which it does not know, follow. With [`CollisionEvery::Step`] the
//! iterations run without collisions, and the two-way method resolves once, from the start of the step to the
//! last target.

use super::backend::CollisionBackend;
use super::contact_forces::Contacts;
use super::error::SimulationError;
use super::interior::Interior;
use super::report::{
    CollisionProblem, Iterated, Relay, Search, SimulationObserver, StepStatistics, WaitingElements,
};
use super::sleep::SleepingBodies;
use super::stretch_limits::HeldApart;
use super::tolerance::Tolerance;
use super::{MIN_VERTICES, Scratch, Simulator};
use bowknot_dynamics::{Dynamics, Residual, StepError};
use bowknot_geometry::{Point, Vector};
use bowknot_scene::CollisionEvery;
use bowknot_scene::world::World;
use bowknot_twoway::{ResolveInput, Resolver, Statistics};
use rayon::prelude::*;
use web_time::Instant;

/// Largest number of two-way steps of a collision stage that is not the last of its time step. On the way to
/// a target that is far from the solution folds lock each other, while the target of the next iteration knows
/// the contacts that were found on the way.
const MAX_INTERMEDIATE_STEPS: usize = 24;

/// A stage of a time step: from where to where, as shares of the time step.
#[derive(Clone, Copy, Debug)]
struct Stage {
    begin: f64,
    end: f64,
    tolerance: Tolerance,
}

impl Stage {
    /// Whether it is the whole time step.
    fn is_whole(self) -> bool {
        self.end - self.begin == 1.0
    }
}

/// What the Newton iterations of a stage read and write.
struct NewtonIterations<'a> {
    step: usize,
    /// The time step [s].
    dt: f64,
    /// By how much implicit Euler goes on in the stage [s].
    length: f64,
    stage: Stage,
    /// See [`Simulator::set_measured`].
    measured: bool,
    world: &'a World,
    dynamics: &'a mut Dynamics,
    resolver: &'a mut Resolver,
    backend: &'a mut dyn CollisionBackend,
    contacts: &'a mut Contacts,
    interior: &'a mut Interior,
    scratch: &'a mut Scratch,
    statistics: &'a mut StepStatistics,
    /// After the last iteration.
    residual: Residual,
    /// The body with the largest remaining distance, if the last collision problem did not converge.
    slowest_body: Option<u32>,
}

impl Simulator {
    /// Solves the time step that ends the `statistics`, stage by stage; moves the positions.
    pub(super) fn iterate(
        &mut self,
        tolerance: Tolerance,
        scratch: &mut Scratch,
        observer: &mut dyn SimulationObserver,
        statistics: &mut StepStatistics,
    ) -> Result<(), SimulationError> {
        let ends = self.dynamics.params().integrator.stage_ends();
        // A stage that has ended changes what contacts remember, which an abandoned time step must not.
        let carried = (ends.len() > 1).then(|| self.contacts.carried().clone());
        let mut begin = 0.0;
        for &end in ends {
            let stage = Stage { begin, end, tolerance };
            if let Err(error) = self.iterate_stage(stage, scratch, observer, statistics) {
                carried.into_iter().for_each(|carried| self.contacts.resume(carried));
                return Err(error);
            }
            begin = end;
        }
        self.positions.clone_from(&scratch.x);
        Ok(())
    }

    fn iterate_stage(
        &mut self,
        stage: Stage,
        scratch: &mut Scratch,
        observer: &mut dyn SimulationObserver,
        statistics: &mut StepStatistics,
    ) -> Result<(), SimulationError> {
        let (step, count, every) = (statistics.step, self.newton_iterations, self.collision_every);
        if !stage.is_whole() {
            self.lead_to(statistics.time, stage.end, scratch);
        }
        let target_error = |source| SimulationError::target(step, source);
        let done = statistics.newton_iterations;
        let (velocities, mut iterations) = self.newton_iterations(stage, scratch, statistics);
        iterations.predict(velocities).map_err(target_error)?;
        for iteration in 0..count {
            let is_last = iteration + 1 == count;
            let iteration = done + iteration;
            iterations.newton_target(iteration).map_err(target_error)?;
            if every == CollisionEvery::Step {
                iterations.restart(is_last);
                if !is_last {
                    continue;
                }
            }
            let is_cut = iterations.resolve_collisions(iteration, is_last, observer)?;
            iterations.apply_contact_forces().map_err(target_error)?;
            let residual = iterations.residual;
            tracing::debug!(step, iteration, residual.force, residual.distance, "time step");
            observer.iterated(&Iterated { step, iteration, residual });
            if stage.tolerance.ends(residual.distance) && !is_cut {
                break;
            }
            iterations.finish_groups(is_cut);
        }
        iterations.end()
    }

    /// The velocities at the start of a time step, and what its iterations use.
    fn newton_iterations<'a>(
        &'a mut self,
        stage: Stage,
        scratch: &'a mut Scratch,
        statistics: &'a mut StepStatistics,
    ) -> (&'a [Vector], NewtonIterations<'a>) {
        let dynamics =
            self.sleeping.as_mut().and_then(SleepingBodies::dynamics).unwrap_or(&mut self.dynamics);
        let length = self.dt * dynamics.params().integrator.stage_length();
        let iterations = NewtonIterations {
            step: statistics.step,
            dt: self.dt,
            length,
            stage,
            measured: self.measured,
            world: &self.world,
            dynamics,
            resolver: &mut self.resolver,
            backend: &mut *self.backend,
            contacts: &mut self.contacts,
            interior: &mut self.interior,
            scratch,
            statistics,
            residual: Residual::default(),
            slowest_body: None,
        };
        (&self.velocities, iterations)
    }
}

impl NewtonIterations<'_> {
    /// Begins the stage: the inertial prediction, and the contacts at its start.
    fn predict(&mut self, velocities: &[Vector]) -> Result<(), StepError> {
        let timer = Instant::now();
        let Scratch { start, x, y, prescribed, keyframes, ends, finished, .. } = &mut *self.scratch;
        self.dynamics.set_step_tolerance(self.stage.tolerance.meters());
        let held_way = self.dynamics.params().integrator.held_way() * self.dt * self.dt;
        if self.stage.begin == 0.0 {
            self.dynamics.begin_step(start, velocities, self.dt)?;
            self.contacts.begin_step(self.resolver, prescribed, start, held_way);
        } else {
            start.clone_from(x);
            self.dynamics.next_stage(start, prescribed);
            self.contacts.begin_stage(self.resolver, prescribed, start, held_way);
        }
        self.contacts.apply(self.dynamics)?;
        self.statistics.repulsion_springs = self.contacts.springs().len();
        y.clone_from(start);
        x.clone_from(start);
        ends.begin(keyframes);
        finished.begin(prescribed);
        self.statistics.seconds.dynamics += timer.elapsed().as_secs_f64();
        Ok(())
    }

    /// Computes the target y from x.
    fn newton_target(&mut self, iteration: usize) -> Result<(), StepError> {
        let timer = Instant::now();
        let Scratch { x, y, ends, finished, .. } = &mut *self.scratch;
        finished.lead(x, &ends.places);
        let info = self.dynamics.newton_target(x, finished.held(), finished.places(), y)?;
        self.statistics.add_newton(&info, timer.elapsed().as_secs_f64());
        if !info.cg.converged {
            let (step, residual) = (self.step, info.cg.residual);
            tracing::debug!(step, iteration, residual, "the linear solve did not converge");
        }
        Ok(())
    }

    /// Without collisions x goes to the target, and after the last target back to the start of the time step.
    fn restart(&mut self, is_last: bool) {
        let Scratch { start, x, y, .. } = &mut *self.scratch;
        x.clone_from(if is_last { start } else { y });
    }

    /// Moves x toward y without intersections. Returns whether the collision problem was cut short.
    fn resolve_collisions(
        &mut self,
        iteration: usize,
        is_last: bool,
        observer: &mut dyn SimulationObserver,
    ) -> Result<bool, SimulationError> {
        let Self { step, dt, stage, world, resolver, backend, contacts, .. } = self;
        let Scratch { start, x, y, prescribed, groups, ends, .. } = &mut *self.scratch;
        let count = world.collision_vertices();
        let (x, y) = (&mut x[..count], &y[..count]);
        let input = ResolveInput {
            prescribed: &prescribed[..count],
            time_step: Some(*dt * (stage.end - stage.begin)),
            start: Some(&start[..count]),
            groups,
            known: contacts.known(count),
            carried: contacts.row_multipliers(),
            yielding: contacts.yielding(),
            max_steps: (!is_last).then_some(MAX_INTERMEDIATE_STEPS),
        };
        if observer.problem(&CollisionProblem::new([*step, iteration], x, y, &input)).is_break() {
            return Err(SimulationError::Interrupted);
        }
        ends.record_ways(world, prescribed, x);
        let mut relay = Relay { observer, world, step: *step, iteration, stopped: false };
        let resolved = backend.resolve(resolver, x, y, &input, &mut relay);
        if relay.stopped {
            return Err(SimulationError::Interrupted);
        }
        let resolved = resolved.map_err(|source| SimulationError::backend(world, *step, source))?;
        let delta = resolver.scene().lengths().delta;
        ends.hold_back(world, prescribed, [start, x], delta, resolved.converged);
        self.record_collisions(&resolved);
        Ok(!is_last && !resolved.converged && resolved.steps >= MAX_INTERMEDIATE_STEPS)
    }

    /// Adds a collision problem to the statistics.
    fn record_collisions(&mut self, resolved: &Statistics) {
        let Self { world, statistics, .. } = self;
        if let Some(seconds) = self.backend.device_seconds() {
            *statistics.seconds.device.get_or_insert_default() += seconds;
        }
        self.slowest_body = resolved.slowest_body.filter(|_| !resolved.converged);
        statistics.add_collision(resolved, |body| world.name_of(body).to_owned());
        if !resolved.waits.is_empty() {
            statistics.waits = resolved.waits.iter().map(|wait| WaitingElements::new(world, wait)).collect();
        }
    }

    /// Finds the contacts at x, where vertices inside of solids have followed, and the residual of the time
    /// step with their forces.
    fn apply_contact_forces(&mut self) -> Result<(), StepError> {
        let timer = Instant::now();
        let Self { dynamics, resolver, contacts, statistics, .. } = self;
        let Scratch { start, x, y, prescribed, .. } = &mut *self.scratch;
        let count = self.world.collision_vertices();
        contacts.update_limits(resolver, x);
        contacts.record_pairs_in_range(resolver);
        contacts.record_rows(resolver);
        contacts.find(resolver, start);
        x[count..].copy_from_slice(&y[count..]);
        let resolution = self.backend.resolution();
        if differ(&x[..count], &y[..count], resolution) {
            statistics.interior_solves += self.interior.follow(dynamics, prescribed, y, x)?;
            if self.measured {
                let change = dynamics.energy_change(dynamics.stage_start(), y, x, self.length, resolution);
                statistics.collision_energy_j += change.max(0.0);
            }
        }
        contacts.apply(dynamics)?;
        self.residual = dynamics.residual(x, prescribed, contacts.counted())?;
        statistics.seconds.dynamics += timer.elapsed().as_secs_f64();
        Ok(())
    }

    /// Lets the groups of bodies whose time step is solved stay where they are, unless the collision problem
    /// was cut short.
    fn finish_groups(&mut self, is_cut: bool) {
        let Self { dynamics, contacts, world, stage, .. } = self;
        let Scratch { x, prescribed, ends, finished, .. } = &mut *self.scratch;
        let delta = self.resolver.scene().lengths().delta;
        // A device sets up its matrices anew where other vertices are free.
        let may_finish = !is_cut && dynamics.backend().is_none();
        if may_finish && ends.are_reached(world, prescribed, &x[..world.collision_vertices()], delta) {
            let (distances, springs) = (dynamics.component_distances(), contacts.springs());
            finished.update(dynamics.model(), distances, contacts.counted(), springs, stage.tolerance);
        } else {
            finished.release();
        }
    }

    /// Ends the stage at x: whether it is solved, a judgment of what a device has computed, and what
    /// contacts remember.
    fn end(&mut self) -> Result<(), SimulationError> {
        let Self { step, world, resolver, backend, contacts, .. } = self;
        let Scratch { start, x, .. } = &*self.scratch;
        let forces = self.dynamics.contact_forces();
        let search = Search { world, contacts, forces: &forces, positions: x };
        let is_balanced = self.stage.tolerance.solves(self.residual.distance);
        self.statistics.end_iterations(&search, &self.residual, is_balanced, self.slowest_body);
        self.statistics.held_apart = contacts.over(x).and_then(|over| HeldApart::new(world, &over));
        let judged = backend.judge(resolver.scene(), &x[..world.collision_vertices()]);
        judged.map_err(|source| SimulationError::backend(world, *step, source))?;
        contacts.end_step(&forces, resolver, start);
        self.statistics.pressing_contacts = contacts.pressing();
        Ok(())
    }
}

/// Whether any of the positions differ by more than the `resolution` [m].
fn differ(x: &[Point], y: &[Point], resolution: f64) -> bool {
    // Positions that are not numbers differ.
    let vertices = x.par_iter().zip(y).with_min_len(MIN_VERTICES);
    !vertices.all(|(x, y)| (x - y).amax() <= resolution)
}
