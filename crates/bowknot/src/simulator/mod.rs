//! The simulator: one time step after the other.
//!
//! [`Simulator`] holds the scene and its state. `time_step.rs` makes a time step, `newton_iterations.rs`
//! solves it. The folders:
//!
//! - `contact_forces`, `stretch_limits`: what the dynamics knows of contacts, and of edges at their limits;
//! - `sleep`: bodies at rest;
//! - `prescribed`: obstacles and pins;
//! - `drive`: what a program changes between time steps;
//! - `start`: what is checked before the first time step;
//! - `report`: statistics and observers.

mod backend;
mod checkpoint;
mod contact_forces;
mod custom_elements;
mod drive;
mod error;
mod finished;
mod interior;
mod newton_iterations;
mod prescribed;
mod report;
mod restore;
mod restore_error;
mod search_order;
mod sleep;
mod start;
mod stretch_limits;
mod time_step;
mod tolerance;

pub use backend::{BackendError, CollisionBackend, Cpu};
pub use checkpoint::Checkpoint;
pub use contact_forces::{CarriedContacts, ContactForce, ContactMean};
pub use drive::{DriveError, Driven, ObstacleDrive};
pub use error::{SimulationError, describe_intersections};
pub use report::{
    AcceptedStep, CollisionProblem, Contact, Energy, Iterated, SimulationObserver, StepSeconds,
    StepStatistics, Unsolved, WaitingElements, Wrench, cpu_seconds, peak_memory_bytes,
};
pub use restore_error::RestoreError;
pub use sleep::SleepState;
pub use start::NearStart;
pub use stretch_limits::{HeldApart, HeldPair};

use bowknot_check::{CheckError, Judge, StateOptions, StateReport};
use bowknot_dynamics::{DeviceWork, Dynamics, DynamicsModel, ElementGroup, NewtonBackend};
use bowknot_geometry::{Point, Vector};
use bowknot_scene::world::{Attachment, World};
use bowknot_scene::{CollisionEvery, Scene};
use bowknot_twoway::{ResolveInput, Resolver};
use contact_forces::Contacts;
use custom_elements::{joined_bodies, vertices_of_elements};
use finished::Finished;
use interior::Interior;
use prescribed::Ends;
use search_order::SearchOrder;
use sleep::SleepingBodies;
use std::sync::Arc;

/// How many intersecting pairs of a refused start are named.
const NAMED_PAIRS: usize = 5;

/// Vertices that one thread takes at least, in loops that do little for each.
pub(crate) const MIN_VERTICES: usize = 4096;

/// A running simulation.
#[derive(Debug)]
pub struct Simulator {
    world: Arc<World>,
    dt: f64,
    newton_iterations: usize,
    step_tolerance: f64,
    collision_every: CollisionEvery,
    dynamics: Dynamics,
    resolver: Resolver,
    backend: Box<dyn CollisionBackend>,
    step: usize,
    positions: Vec<Point>,
    velocities: Vec<Vector>,
    /// See [`Self::present`].
    present: Vec<bool>,
    anchors: Vec<Vec<Point>>,
    /// Places of pins that follow an obstacle, by pin and vertex; made from the anchors when first needed.
    attachments: Vec<Vec<Option<Attachment>>>,
    interior: Interior,
    search_order: SearchOrder,
    contacts: Contacts,
    /// Bodies at rest; none if they never sleep.
    sleeping: Option<SleepingBodies>,
    /// See [`Self::pin_forces`].
    pin_forces: Vec<Vec<Vector>>,
    /// What a program has changed.
    driven: Driven,
    home: Home,
    /// The world without the pins and motions that a program has changed.
    undriven: Arc<World>,
    /// See [`Self::set_measured`].
    measured: bool,
    scratch: Scratch,
}

/// What the simulation began with.
#[derive(Clone, Debug)]
pub(crate) struct Home {
    scene: Arc<Scene>,
    world: Arc<World>,
}

/// Buffers of a time step; nothing in them outlives it.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    start: Vec<Point>,
    x: Vec<Point>,
    y: Vec<Point>,
    prescribed: Vec<bool>,
    keyframes: Vec<Point>,
    /// The keyframes at the ends of the stages of the time step but the last, while bodies may sleep.
    inner: Vec<Vec<Point>>,
    ends: Ends,
    finished: Finished,
    groups: Vec<u32>,
}

impl Simulator {
    /// Loads the scene's meshes and prepares the first time step.
    ///
    /// # Errors
    /// Whatever is wrong with the scene or its meshes; a start that already intersects, with the first
    /// pairs.
    pub fn new(scene: &Scene) -> Result<Self, SimulationError> {
        Self::of_world(World::new(scene)?, scene)
    }

    /// As [`Self::new`], with the `world` of the scene as the caller has made or changed it: other positions,
    /// which are also the rest shapes, other velocities, other pins.
    ///
    /// # Errors
    /// As [`Self::new`]; a world of other bodies than the scene, or whose lists differ in length.
    pub fn from_world(world: World, scene: &Scene) -> Result<Self, SimulationError> {
        scene.validate()?;
        start::check_world(&world, scene)?;
        Self::of_world(world, scene)
    }

    fn of_world(world: World, scene: &Scene) -> Result<Self, SimulationError> {
        let world = Arc::new(world);
        let home = Home { scene: Arc::new(scene.clone()), world: Arc::clone(&world) };
        let mut simulator = Self::at_start(world, home, None, Vec::new())?;
        simulator.apply_filters()?;
        if let Some((lines, count)) = simulator.intersections()? {
            let positions = &simulator.positions[..simulator.world.collision_vertices()];
            let all = StateOptions { limit: usize::MAX, distance: false };
            let all = simulator.judge().check_state(positions, &all)?;
            let advice = start::advice(&simulator.world, &all.intersections);
            return Err(SimulationError::StartIntersects { lines, count, advice });
        }
        simulator.warn_of_enclosed();
        simulator.find_contacts(CarriedContacts::default())?;
        Ok(simulator)
    }

    /// Warns of bodies that cannot leave what they are inside of, where they start or are put.
    fn warn_of_enclosed(&self) {
        let enclosed = start::enclosed_bodies(&self.world, &self.positions, &self.present);
        enclosed.iter().for_each(|body| tracing::warn!("{body}"));
    }

    /// The first pairs that intersect in the present state, in words, and how many do in all; none if none
    /// does.
    fn intersections(&self) -> Result<Option<(Vec<String>, usize)>, CheckError> {
        let options = StateOptions { limit: NAMED_PAIRS, distance: false };
        let positions = &self.positions[..self.world.collision_vertices()];
        let report = self.judge().check_state(positions, &options)?;
        let lines = || describe_intersections(&self.world, &report.intersections);
        Ok((!report.is_clear()).then(|| (lines(), report.intersection_count)))
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

    /// Pairs that are nearer than their contact distance before the first time step, by bodies, most first.
    /// Neighbors along the surface do not count, nor does anything after the first time step.
    pub fn near_starts(&self) -> Vec<NearStart> {
        if self.step == 0 { start::near_starts(&self.world, &self.resolver) } else { Vec::new() }
    }

    /// A simulator at the start of its world, whatever intersects there, with custom elements. `changed` is the
    /// scene of the world if that is not the one that the simulation began with.
    fn at_start(
        world: Arc<World>,
        home: Home,
        changed: Option<Box<Scene>>,
        groups: Vec<ElementGroup>,
    ) -> Result<Self, SimulationError> {
        let scene = changed.as_deref().unwrap_or(&home.scene);
        let elements = vertices_of_elements(&groups);
        let joined = joined_bodies(&world, &groups);
        let mut model = world.dynamics_model()?;
        if !groups.is_empty() {
            model = model.with_elements(groups).map_err(SimulationError::elements)?;
        }
        let count = world.collision_vertices();
        let (rest_positions, masses) = (&model.rest_positions()[..count], &model.masses()[..count]);
        let contact = world.contact.clone();
        let resolver =
            Resolver::with_contact(world.collision.clone(), rest_positions, masses, contact, scene.twoway())
                .map_err(|source| SimulationError::resolve(&world, 0, source))?;
        let contacts = Contacts::new(&scene.solver.repulsion, &world, &model, &resolver);
        let dynamics = Dynamics::new(model, scene.dynamics()).map_err(SimulationError::Dynamics)?;
        let anchors = vec![Vec::new(); world.pins.len()];
        let sleeping =
            SleepingBodies::new(&scene.solver.sleep, &world, &resolver, scene.simulation.dt, joined);
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
            search_order: SearchOrder::default(),
            contacts,
            sleeping,
            measured: true,
            scratch: Scratch::default(),
            pin_forces: Vec::new(),
            undriven: Arc::clone(&world),
            world,
            driven: Driven { scene: changed, elements, ..Driven::default() },
            home,
        })
    }

    /// Whether time steps measure what they report but do not need: energies, momentum, center of mass,
    /// largest stretch and speed, inverted tetrahedra, and the residual of a last iteration. True at first.
    /// Otherwise these are 0 in [`StepStatistics`], and a time step takes some hundredths less. Results do
    /// not change.
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
        prepared.map_err(|source| SimulationError::backend(&self.world, self.step, source))?;
        self.backend = backend;
        self.search_order.tell_again();
        Ok(())
    }

    /// What resolves the collisions.
    pub fn backend(&self) -> &dyn CollisionBackend {
        &*self.backend
    }

    /// Lets a backend compute the dynamics from the next time step on, in place of the CPU; None for the CPU.
    ///
    /// # Errors
    /// [`SimulationError::Backend`] if a body has quadratic elements, or there are custom ones: the CPU then
    /// computes the dynamics.
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
        self.sleeping.as_mut().and_then(SleepingBodies::dynamics).unwrap_or(&mut self.dynamics)
    }

    /// What devices were asked for since they were opened.
    fn device_work(&self) -> DeviceWork {
        let awake = self.sleeping.as_ref().and_then(SleepingBodies::awake_dynamics);
        let dynamics = awake.unwrap_or(&self.dynamics);
        let of_dynamics = dynamics.backend().map(NewtonBackend::work).unwrap_or_default();
        self.backend.work() + DeviceWork { departures: dynamics.departures(), ..of_dynamics }
    }

    /// Finds the contacts at the present state, and refuses coordinates too large for the minimum separation.
    fn find_contacts(&mut self, carried: CarriedContacts) -> Result<(), SimulationError> {
        let Self { world, resolver, contacts, positions, step, dt, .. } = self;
        let input = ResolveInput { time_step: Some(*dt), ..ResolveInput::default() };
        resolver
            .detect_contacts(&positions[..world.collision_vertices()], &input)
            .map_err(|source| SimulationError::resolve(world, *step, source))?;
        contacts.resume(carried);
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
}

/// Time after a number of time steps [s].
fn time_of(step: usize, dt: f64) -> f64 {
    step as f64 * dt
}
