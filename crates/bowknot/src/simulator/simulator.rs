//! The simulator: one time step after the other.
//!
//! For each Newton iteration the dynamics computes a target y from x. Prescribed vertices (pins, obstacles)
//! have their keyframe at t + dt as target. The two-way method moves x towards y without intersections, and
//! the vertices inside of solids, which it does not know, follow. With [`CollisionEvery::Step`] the
//! iterations run without collisions, and the two-way method resolves once, from the start of the step to the
//! last target.

use super::backend::{BackendError, CollisionBackend, Cpu};
use super::checkpoint::Checkpoint;
use super::contacts::{CarriedContacts, Contacts};
use super::ends::Ends;
use super::error::{SimulationError, describe_intersections};
use super::finished::Finished;
use super::held_apart::HeldApart;
use super::inside;
use super::interior::{self, Interior};
use super::near_starts::{self, NearStart};
use super::observer::{CollisionProblem, Iterated, Relay, SimulationObserver};
use super::overlap;
use super::process::cpu_seconds;
use super::rest::Rest;
use super::sleep::SleepState;
use super::statistics::StepStatistics;
use super::tolerance::Tolerance;
use super::unsolved::Search;
use super::waits::WaitingElements;
use bowknot_check::{Judge, StateOptions, StateReport};
use bowknot_dynamics::{DeviceWork, Dynamics, DynamicsModel, NewtonBackend, Residual};
use bowknot_errors::counted;
use bowknot_geometry::{Point, Vector};
use bowknot_scene::world::{Attachment, World};
use bowknot_scene::{CollisionEvery, Scene};
use bowknot_twoway::{ResolveError, ResolveInput, Resolver};
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;

/// How many intersecting pairs of a refused start are named.
const NAMED_PAIRS: usize = 5;

/// Largest number of two-way steps of a collision stage that is not the last of its time step. On the way to
/// a target that is far from the solution folds lock each other, while the target of the next iteration knows
/// the contacts that were found on the way.
const MAX_INTERMEDIATE_STEPS: usize = 24;

/// Time steps for which a backend keeps the order of what it searches in. To order anew costs as much as a search or two on the
/// host; in as many time steps things move past a few neighbors.
const STEPS_OF_AN_ORDER: usize = 64;

/// Vertices that one thread takes at least, in loops that do little for each.
pub(crate) const MIN_VERTICES: usize = 4096;

/// A running simulation.
#[derive(Debug)]
pub struct Simulator {
    pub(super) world: Arc<World>,
    pub(super) dt: f64,
    newton_iterations: usize,
    step_tolerance: f64,
    collision_every: CollisionEvery,
    pub(super) dynamics: Dynamics,
    pub(super) resolver: Resolver,
    pub(super) backend: Box<dyn CollisionBackend>,
    pub(super) step: usize,
    pub(super) positions: Vec<Point>,
    pub(super) velocities: Vec<Vector>,
    /// See [`Self::present`].
    pub(super) present: Vec<bool>,
    pub(super) anchors: Vec<Vec<Point>>,
    /// Places of pins that follow an obstacle, by pin and vertex; made from the anchors when first needed.
    pub(super) attachments: Vec<Vec<Option<Attachment>>>,
    interior: Interior,
    /// See [`Checkpoint::order`], and whether the backend does not know it yet.
    order: Vec<Point>,
    is_order_new: bool,
    pub(super) contacts: Contacts,
    /// Bodies at rest; none if they never sleep.
    pub(super) rest: Option<Rest>,
    /// Forces that the caller has set, by vertex [N]; empty before.
    pub(super) external_forces: Vec<Vector>,
    /// Bodies on which forces have been changed since the last time step; may be empty.
    pub(super) pushed: Vec<bool>,
    /// See [`Self::set_measured`].
    measured: bool,
    scratch: Scratch,
}

/// Buffers of a time step; nothing in them outlives it.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) start: Vec<Point>,
    x: Vec<Point>,
    y: Vec<Point>,
    pub(super) prescribed: Vec<bool>,
    pub(super) keyframes: Vec<Point>,
    ends: Ends,
    finished: Finished,
    pub(super) groups: Vec<u32>,
}

impl Simulator {
    /// Loads the scene's meshes and prepares the first time step.
    ///
    /// # Errors
    /// Whatever is wrong with the scene or its meshes; a start that already intersects, with the first
    /// pairs.
    pub fn new(scene: &Scene) -> Result<Self, SimulationError> {
        let mut simulator = Self::without_start_check(scene)?;
        simulator.apply_filters()?;
        let options = StateOptions { limit: NAMED_PAIRS, distance: false };
        let count = simulator.world.collision_vertices();
        let report = simulator.judge().check_state(&simulator.positions[..count], &options)?;
        if report.is_clear() {
            let enclosed = inside::enclosed_bodies(&simulator.world, &simulator.present);
            enclosed.iter().for_each(|body| tracing::warn!("{body}"));
            simulator.find_contacts(CarriedContacts::default())?;
            return Ok(simulator);
        }
        let lines = describe_intersections(&simulator.world, &report.intersections);
        let all = StateOptions { limit: usize::MAX, distance: false };
        let all = simulator.judge().check_state(&simulator.positions[..count], &all)?;
        let advice = overlap::advice(&simulator.world, &all.intersections);
        Err(SimulationError::StartIntersects { lines, count: report.intersection_count, advice })
    }

    /// The scene's world and all intersections of its start, for a dump.
    ///
    /// # Errors
    /// Whatever is wrong with the scene or its meshes.
    pub fn start_intersections(scene: &Scene) -> Result<(World, StateReport), SimulationError> {
        let world = World::new(scene)?;
        let options = StateOptions { limit: usize::MAX, distance: false };
        let positions = &world.positions[..world.collision_vertices()];
        let model = world.collision_of(&world.present(0.0, scene.simulation.dt));
        let report = Judge::from_model(&model).check_state(positions, &options)?;
        Ok((world, report))
    }

    /// Pairs that are nearer than their contact distance before the first time step, by bodies, most first. Neighbors along the
    /// surface do not count, nor does anything after the first time step.
    pub fn near_starts(&self) -> Vec<NearStart> {
        if self.step == 0 { near_starts::near_starts(&self.world, &self.resolver) } else { Vec::new() }
    }

    fn without_start_check(scene: &Scene) -> Result<Self, SimulationError> {
        let world = World::new(scene)?;
        let model = world.dynamics_model()?;
        let count = world.collision_vertices();
        let (rest, masses) = (&model.rest_positions()[..count], &model.masses()[..count]);
        let contact = world.contact.clone();
        let resolver = Resolver::new(world.collision.clone(), rest, masses, scene.twoway())
            .and_then(|resolver| resolver.with_bodies(contact.bodies))
            .and_then(|resolver| resolver.with_half_spaces(contact.half_spaces))
            .and_then(|resolver| resolver.with_pair_friction(&contact.pairs))
            .map_err(|source| resolve_error(&world, 0, source))?;
        let contacts = Contacts::new(&scene.solver.repulsion, &world, &model, &resolver);
        let dynamics = Dynamics::new(model, scene.dynamics()).map_err(SimulationError::Dynamics)?;
        let anchors = vec![Vec::new(); world.pins.len()];
        let rest = Rest::new(&scene.solver.sleep, &world, &resolver, scene.simulation.dt);
        Ok(Self {
            dt: scene.simulation.dt,
            newton_iterations: scene.simulation.newton_iterations,
            step_tolerance: scene.solver.newton.step_tolerance,
            collision_every: scene.simulation.collision_every,
            dynamics,
            resolver,
            backend: Box::new(Cpu),
            step: 0,
            positions: world.positions.clone(),
            velocities: world.velocities.clone(),
            present: world.present(0.0, scene.simulation.dt),
            attachments: vec![Vec::new(); anchors.len()],
            anchors,
            interior: Interior::new(&world, scene.simulation.interior),
            order: Vec::new(),
            is_order_new: false,
            contacts,
            rest,
            external_forces: Vec::new(),
            pushed: Vec::new(),
            measured: true,
            scratch: Scratch::default(),
            world: Arc::new(world),
        })
    }

    /// Whether time steps measure what they report but do not need: energies, momentum, center of mass, largest
    /// stretch and speed, inverted tetrahedra, and the residual of a last iteration. True at first. Otherwise
    /// these are 0 in [`StepStatistics`], and a time step takes some hundredths less. Results do not change.
    pub fn set_measured(&mut self, measured: bool) {
        self.measured = measured;
    }

    /// Lets a backend resolve the collisions from the next time step on, in place of the CPU.
    ///
    /// # Errors
    /// [`SimulationError::Backend`] if it does not have what the scene needs.
    pub fn set_backend(&mut self, mut backend: Box<dyn CollisionBackend>) -> Result<(), SimulationError> {
        let home = &self.world.positions[..self.world.collision_vertices()];
        let prepared = backend.prepare(self.resolver.scene(), home);
        prepared.map_err(|source| backend_error(&self.world, self.step, source))?;
        self.backend = backend;
        self.is_order_new = !self.order.is_empty();
        Ok(())
    }

    /// Every so many time steps, orders what the backend searches in by the present positions: grains mix.
    fn order_search(&mut self) -> Result<(), SimulationError> {
        if !self.backend.is_ordered() {
            return Ok(());
        }
        let count = self.world.collision_vertices();
        if self.step > 0 && self.step.is_multiple_of(STEPS_OF_AN_ORDER) {
            self.order.clear();
            self.order.extend_from_slice(&self.positions[..count]);
            self.is_order_new = true;
        }
        if self.is_order_new {
            let order = if self.order.is_empty() { &self.world.positions[..count] } else { &self.order };
            let ordered = self.backend.order(self.resolver.scene(), order);
            ordered.map_err(|source| backend_error(&self.world, self.step, source))?;
            self.is_order_new = false;
        }
        Ok(())
    }

    /// What resolves the collisions.
    pub fn backend(&self) -> &dyn CollisionBackend {
        &*self.backend
    }

    /// Lets a backend compute the dynamics from the next time step on, in place of the CPU; None for the CPU.
    ///
    /// # Errors
    /// [`SimulationError::Backend`] if a body has quadratic elements: the CPU then computes the dynamics.
    pub fn set_dynamics_backend(
        &mut self,
        backend: Option<Box<dyn NewtonBackend>>,
    ) -> Result<(), SimulationError> {
        // That of all bodies refuses for those that are asleep, too.
        let set = self.dynamics.set_backend(backend).and_then(|()| {
            let backend = self.dynamics.take_backend();
            self.active_dynamics().set_backend(backend)
        });
        set.map_err(|source| SimulationError::target(self.step, source))
    }

    /// What computes the dynamics; None if it is the CPU.
    pub fn dynamics_backend(&mut self) -> Option<&dyn NewtonBackend> {
        self.active_dynamics().backend()
    }

    /// The dynamics of all bodies that are awake.
    fn active_dynamics(&mut self) -> &mut Dynamics {
        self.rest.as_mut().and_then(Rest::dynamics).unwrap_or(&mut self.dynamics)
    }

    /// Finds the contacts at the present state, and refuses coordinates too large for the minimum separation.
    pub(super) fn find_contacts(&mut self, carried: CarriedContacts) -> Result<(), SimulationError> {
        let Self { world, resolver, contacts, positions, step, dt, .. } = self;
        let input = ResolveInput { time_step: Some(*dt), ..ResolveInput::default() };
        resolver
            .detect_contacts(&positions[..world.collision_vertices()], &input)
            .map_err(|source| resolve_error(world, *step, source))?;
        contacts.resume(carried);
        Ok(())
    }

    /// Makes one time step, on a thread of the pool.
    ///
    /// # Errors
    /// A target that is not finite, with its body; coordinates too large for the minimum separation. The
    /// simulator is then as it was before the step.
    pub fn step(&mut self) -> Result<StepStatistics, SimulationError> {
        // From outside of the thread pool each of the parallel loops would put this thread to sleep and wake it again.
        rayon::scope(|_| self.step_observed(&mut ()))
    }

    /// Makes one time step with an observer, on this thread. Scenes of a few thousand vertices take less time from inside
    /// of the thread pool, as by `rayon::scope(|_| ...)`.
    ///
    /// # Errors
    /// As [`Self::step`]; [`SimulationError::Interrupted`] if the observer stopped it. The simulator is
    /// then as it was before the step.
    pub fn step_observed(
        &mut self,
        observer: &mut dyn SimulationObserver,
    ) -> Result<StepStatistics, SimulationError> {
        let (timer, cpu_start) = (Instant::now(), cpu_seconds());
        let work_start = self.device_work();
        let step = self.step + 1;
        let time = time_of(step, self.dt);
        let tolerance = Tolerance::new(self.step_tolerance * self.resolver.scene().lengths().edge, self.dt);
        let tolerance_m = tolerance.meters();
        let mut statistics = StepStatistics {
            step,
            time,
            tolerance_m,
            converged: true,
            solved: true,
            ..StepStatistics::default()
        };

        self.order_search()?;
        self.place_absent(time);
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.start.clone_from(&self.positions);
        let anchors = self.anchors.clone();
        self.prescribe(time, &mut scratch);
        // Bodies that wake here stay awake if the time step is abandoned: it would wake them again.
        if let Err(error) = self.wake_for_step(time, &mut scratch) {
            (self.anchors, self.scratch) = (anchors, scratch);
            self.place_absent(self.time());
            return Err(error);
        }
        if self.has_nothing_to_do() {
            self.scratch = scratch;
            self.step = step;
            self.velocities.fill(Vector::zeros());
            self.update_presence(&mut statistics)?;
            self.close(timer, cpu_start, &mut statistics);
            return Ok(statistics);
        }
        let result = self.iterate(step, tolerance, &mut scratch, observer, &mut statistics);
        if let Err(error) = result {
            self.positions.clone_from(&scratch.start);
            self.place_absent(self.time());
            self.anchors = anchors;
            self.attachments.iter_mut().for_each(Vec::clear);
            self.scratch = scratch;
            // The resolver still has the pairs of the abandoned step. What contacts remember changes at its end alone.
            let carried = self.contacts.carried().clone();
            self.find_contacts(carried)?;
            return Err(error);
        }

        let Self { dynamics, positions, contacts, velocities, rest, .. } = self;
        let dynamics = rest.as_mut().and_then(Rest::dynamics).unwrap_or(dynamics);
        dynamics.end_velocities(positions, &scratch.prescribed, contacts.touching(), velocities);
        statistics.waiting = self.waiting(time, &scratch);
        statistics.prescribed_lag_m = statistics.waiting.values().copied().fold(0.0, f64::max);
        self.scratch = scratch;
        self.step = step;
        self.fall_asleep()?;
        self.update_presence(&mut statistics)?;
        self.close(timer, cpu_start, &mut statistics);
        statistics.set_device_work(&(self.device_work() - work_start));
        if let Some(body) = &statistics.slowest_body {
            tracing::debug!(step, %body, remaining_m = statistics.remaining_m, "collisions did not converge");
        }
        Ok(statistics)
    }

    /// What devices were asked for since they were opened.
    fn device_work(&self) -> DeviceWork {
        let awake = self.rest.as_ref().and_then(Rest::awake_dynamics);
        let dynamics = awake.unwrap_or(&self.dynamics);
        let of_dynamics = dynamics.backend().map(NewtonBackend::work);
        let departures = dynamics.departures();
        self.backend.work() + DeviceWork { departures, ..of_dynamics.unwrap_or_default() }
    }

    /// Closes the statistics of a time step that began at `timer` and `cpu_start` [s].
    fn close(&self, timer: Instant, cpu_start: f64, statistics: &mut StepStatistics) {
        statistics.asleep_vertices = self.asleep_vertices();
        if self.measured {
            self.measure_state(statistics);
        }
        statistics.close(timer.elapsed().as_secs_f64(), cpu_seconds() - cpu_start);
    }

    fn measure_state(&self, statistics: &mut StepStatistics) {
        let model = self.dynamics.model();
        statistics.inverted_tets = interior::inverted(&self.world, &self.positions);
        let (energies, max_stretch) = self.measures();
        statistics.max_stretch = max_stretch;
        let (collide, inside) = self.velocities.split_at(self.world.collision_vertices());
        let deformable = collide[..self.world.deformable_vertices].iter().chain(inside);
        statistics.max_speed = deformable.map(Vector::norm).fold(0.0, f64::max);
        let (momentum, center) = (model.momentum(&self.velocities), model.center_of_mass(&self.positions));
        statistics.finish(&energies, &momentum, &center);
    }

    /// The Newton iterations of a time step, with their collision problems; moves `self.positions`.
    fn iterate(
        &mut self,
        step: usize,
        tolerance: Tolerance,
        scratch: &mut Scratch,
        observer: &mut dyn SimulationObserver,
        statistics: &mut StepStatistics,
    ) -> Result<(), SimulationError> {
        let Self {
            world,
            dynamics,
            resolver,
            backend,
            positions,
            velocities,
            dt,
            interior,
            contacts,
            rest,
            measured,
            ..
        } = self;
        let dynamics = rest.as_mut().and_then(Rest::dynamics).unwrap_or(dynamics);
        let Scratch { start, x, y, prescribed, keyframes, ends, finished, groups } = scratch;
        let target_error = |source| SimulationError::target(step, source);
        let count = world.collision_vertices();

        let timer = Instant::now();
        dynamics.set_step_tolerance(tolerance.meters());
        dynamics.begin_step(start, velocities, *dt).map_err(target_error)?;
        contacts.begin_step(resolver, prescribed, start, *dt);
        contacts.apply(dynamics).map_err(target_error)?;
        statistics.repulsion_springs = contacts.springs().len();
        statistics.seconds.dynamics += timer.elapsed().as_secs_f64();
        y.clone_from(start);
        x.clone_from(start);
        ends.begin(keyframes);
        finished.begin(prescribed);
        let mut slowest_body = None;
        let mut imbalance = Residual::default();
        for iteration in 0..self.newton_iterations {
            let last = iteration + 1 == self.newton_iterations;
            let timer = Instant::now();
            finished.lead(x, &ends.places);
            let info =
                dynamics.newton_target(x, finished.held(), finished.places(), y).map_err(target_error)?;
            statistics.add_newton(&info, timer.elapsed().as_secs_f64());
            if !info.cg.converged {
                tracing::debug!(
                    step,
                    iteration,
                    residual = info.cg.residual,
                    "the linear solve did not converge"
                );
            }
            match self.collision_every {
                CollisionEvery::Step if !last => {
                    x.clone_from(y);
                    continue;
                }
                CollisionEvery::Step => x.clone_from(start),
                CollisionEvery::Newton => {}
            }

            let problem = CollisionProblem {
                step,
                iteration,
                positions: &x[..count],
                target: &y[..count],
                prescribed: &prescribed[..count],
                time_step: *dt,
                start: &start[..count],
                groups,
                known: contacts.known(count),
                carried: contacts.row_multipliers(),
                yielding: contacts.yielding(),
            };
            if observer.problem(&problem).is_break() {
                return Err(SimulationError::Interrupted);
            }
            let mut relay = Relay { observer: &mut *observer, world, step, iteration, stopped: false };
            let input = ResolveInput {
                prescribed: &prescribed[..count],
                time_step: Some(*dt),
                start: Some(&start[..count]),
                groups,
                known: contacts.known(count),
                carried: contacts.row_multipliers(),
                yielding: contacts.yielding(),
                max_steps: (!last).then_some(MAX_INTERMEDIATE_STEPS),
            };
            ends.note(world, prescribed, &x[..count]);
            let resolved = backend.resolve(resolver, &mut x[..count], &y[..count], &input, &mut relay);
            if relay.stopped {
                return Err(SimulationError::Interrupted);
            }
            let resolved = resolved.map_err(|source| backend_error(world, step, source))?;
            if let Some(seconds) = backend.device_seconds() {
                *statistics.seconds.device.get_or_insert_default() += seconds;
            }
            let cut = !last && !resolved.converged && resolved.steps >= MAX_INTERMEDIATE_STEPS;
            slowest_body = resolved.slowest_body.filter(|_| !resolved.converged);
            statistics.add_collision(&resolved, |body| world.name_of(body).to_owned());
            if !resolved.waits.is_empty() {
                statistics.waits =
                    resolved.waits.iter().map(|wait| WaitingElements::new(world, wait)).collect();
            }

            let timer = Instant::now();
            let delta = resolver.scene().lengths().delta;
            ends.hold_back(world, prescribed, [start, &x[..count]], delta, resolved.converged);
            contacts.note_held(resolver, x);
            contacts.note_touching(resolver);
            contacts.note_rows(resolver);
            contacts.find(resolver, start);
            x[count..].copy_from_slice(&y[count..]);
            if differ(&x[..count], &y[..count], backend.resolution()) {
                statistics.interior_solves +=
                    interior.follow(dynamics, prescribed, y, x).map_err(target_error)?;
                if *measured {
                    let change = dynamics.energy_change(start, y, x, *dt, backend.resolution());
                    statistics.collision_energy_j += change.max(0.0);
                }
            }
            contacts.apply(dynamics).map_err(target_error)?;
            let residual = dynamics.residual(x, prescribed, contacts.counted()).map_err(target_error)?;
            statistics.seconds.dynamics += timer.elapsed().as_secs_f64();
            imbalance = residual;
            tracing::debug!(step, iteration, residual.force, residual.distance, "time step");
            observer.iterated(&Iterated { step, iteration, residual });
            if tolerance.ends(residual.distance) && !cut {
                break;
            }
            // A device sets up its matrices anew where other vertices are free.
            let may_finish = !cut && dynamics.backend().is_none();
            if may_finish && ends.are_reached(world, prescribed, &x[..count], delta) {
                let (distances, springs) = (dynamics.component_distances(), contacts.springs());
                finished.note(dynamics.model(), distances, contacts.counted(), springs, tolerance);
            } else {
                finished.release();
            }
        }
        (statistics.residual_n, statistics.residual_m) = (imbalance.force, imbalance.distance);
        let forces = dynamics.contact_forces();
        let is_balanced = tolerance.solves(imbalance.distance);
        statistics.solved = statistics.converged && is_balanced;
        if !statistics.solved {
            let search = Search { world, contacts, forces: &forces, positions: x };
            let of_forces = || imbalance.vertex.map(|vertex| search.of_forces(vertex));
            let of_collisions = || search.of_collisions(&statistics.waits, slowest_body);
            // Where forces balance, what stopped the collision stage is the cause.
            statistics.unsolved = match is_balanced {
                true => of_collisions().or_else(of_forces),
                false => of_forces().or_else(of_collisions),
            };
        }
        statistics.held_apart = contacts.over(x).and_then(|over| HeldApart::new(world, &over));
        let judged = backend.judge(resolver.scene(), &x[..count]);
        judged.map_err(|source| backend_error(world, step, source))?;
        contacts.end_step(&forces, resolver, start);
        statistics.pressing_contacts = contacts.pressing();
        positions.clone_from(x);
        Ok(())
    }

    /// Positions of all vertices, in the order of the [world](crate::world) [m].
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Velocities of all vertices [m/s].
    pub fn velocities(&self) -> &[Vector] {
        &self.velocities
    }

    /// Time of the state [s].
    pub fn time(&self) -> f64 {
        time_of(self.step, self.dt)
    }

    /// Time steps made.
    pub fn step_index(&self) -> usize {
        self.step
    }

    /// Bodies, topology, pins: what is fixed.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// Masses, elements, and what can be measured of a state.
    pub fn dynamics_model(&self) -> &DynamicsModel {
        self.dynamics.model()
    }

    /// The collision stage: its parameters and the lengths in force.
    pub fn resolver(&self) -> &Resolver {
        &self.resolver
    }

    /// A judge of the simulation's states and paths in the next time step.
    pub fn judge(&self) -> Judge {
        Judge::from_model(&self.collision_model())
    }

    /// The state, in full.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            step: self.step,
            positions: self.positions.clone(),
            velocities: self.velocities.clone(),
            anchors: self.anchors.clone(),
            present: self.present.clone(),
            contacts: self.carried(),
            sleep: self.sleep_state(),
            order: self.order.clone(),
        }
    }

    /// Goes on from a state of the same scene.
    ///
    /// # Errors
    /// What does not fit, in words; the simulator is then as it was.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), String> {
        let vertices = self.positions.len();
        for (what, given) in
            [("positions", checkpoint.positions.len()), ("velocities", checkpoint.velocities.len())]
        {
            if given != vertices {
                let vertices = counted(vertices, "vertex", "vertices");
                return Err(format!("its {what} are {given}, but the scene has {vertices}"));
            }
        }
        let fits = checkpoint.anchors.len() == self.world.pins.len()
            && checkpoint
                .anchors
                .iter()
                .zip(&self.world.pins)
                .all(|(a, p)| a.is_empty() || a.len() == p.vertices.len());
        if !fits {
            return Err("its pins are not those of the scene".to_owned());
        }
        if checkpoint.present.len() != self.present.len() {
            return Err("its obstacles are not those of the scene".to_owned());
        }
        let (bodies, sleep) = (self.world.bodies.len(), &checkpoint.sleep);
        let is_island = |island: &u32| *island == SleepState::AWAKE || (*island as usize) < bodies;
        let fits = sleep.origins.is_empty()
            || (sleep.origins.len() == vertices
                && sleep.calm_steps.len() == bodies
                && sleep.islands.len() == bodies
                && sleep.islands.iter().all(is_island));
        if !fits {
            return Err("its bodies asleep are not those of the scene".to_owned());
        }
        if ![0, self.world.collision_vertices()].contains(&checkpoint.order.len()) {
            return Err("its order of a search is not one of the scene".to_owned());
        }
        let before = self.checkpoint();
        self.adopt(checkpoint);
        self.take_out(checkpoint.contacts.clone()).map_err(|error| {
            self.adopt(&before);
            // The state before was a sound one.
            let _ = self.take_out(before.contacts);
            error.to_string()
        })
    }

    fn adopt(&mut self, checkpoint: &Checkpoint) {
        self.step = checkpoint.step;
        self.positions.clone_from(&checkpoint.positions);
        self.velocities.clone_from(&checkpoint.velocities);
        self.anchors.clone_from(&checkpoint.anchors);
        self.present.clone_from(&checkpoint.present);
        self.order.clone_from(&checkpoint.order);
        self.is_order_new = true;
        self.attachments.iter_mut().for_each(Vec::clear);
        self.adopt_sleep_state(&checkpoint.sleep);
    }
}

/// Whether any of the positions differ by more than the `resolution` [m].
fn differ(x: &[Point], y: &[Point], resolution: f64) -> bool {
    // Positions that are not numbers differ.
    let vertices = x.par_iter().zip(y).with_min_len(MIN_VERTICES);
    !vertices.all(|(x, y)| (x - y).amax() <= resolution)
}

pub(super) fn resolve_error(world: &World, step: usize, source: ResolveError) -> SimulationError {
    let body = match &source {
        ResolveError::NonFinite { body, .. } | ResolveError::Mass { body, .. } => world.name_of(*body),
        ResolveError::MinSeparationBelowRounding { vertex, .. } => world.body_name(*vertex),
        _ => "",
    };
    SimulationError::Resolve { step, body: body.to_owned(), source }
}

fn backend_error(world: &World, step: usize, source: BackendError) -> SimulationError {
    match source {
        BackendError::Refused(source) => resolve_error(world, step, source),
        BackendError::Failed(source) => SimulationError::Backend { step, source },
    }
}

/// Time after a number of time steps [s].
pub(super) fn time_of(step: usize, dt: f64) -> f64 {
    step as f64 * dt
}
