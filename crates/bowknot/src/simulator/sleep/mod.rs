//! Bodies at rest sleep: what stands in for the scene while they do.
//!
//! While bodies sleep, the collision stage has them as obstacles at rest: no rows, no pairs with each other
//! or with obstacles, trees that are kept. The dynamics has a model of the other bodies alone. Contact forces
//! between bodies asleep are put aside and handed back when these wake, so that a pile need not settle anew.

mod approach;
mod islands;
mod waking;

pub(crate) use approach::Motion;
pub use islands::SleepState;

use super::contact_forces::ContactForce;
use super::custom_elements::moving_elements;
use super::error::SimulationError;
use approach::BodyElements;
use bowknot_dynamics::{Dynamics, DynamicsModel, Energies};
use bowknot_geometry::Point;
use bowknot_scene::SleepParams;
use bowknot_scene::world::World;
use bowknot_twoway::Resolver;
use islands::{Hold, Sleep};

/// Bodies that may sleep, and what is in force while some do.
#[derive(Debug)]
pub(crate) struct SleepingBodies {
    pub sleep: Sleep,
    pub elements: BodyElements,
    /// Distance around each body within which it is in contact, its part [m].
    pub margins: Vec<f64>,
    /// Which bodies sleep, for the collision stage and the dynamics.
    pub asleep: Vec<bool>,
    /// What the bodies that are awake need; none while all are.
    pub awake: Option<Awake>,
    pub hold: Hold,
    /// Where the bodies are predicted to be at the end of a time step [m].
    pub predicted: Vec<Point>,
}

/// What stands in for the whole scene while bodies sleep.
#[derive(Debug)]
pub(crate) struct Awake {
    /// The bodies that are awake.
    pub dynamics: Dynamics,
    /// Contact forces between bodies asleep, and between them and obstacles.
    pub forces: Vec<ContactForce>,
    /// Number of vertices asleep.
    pub vertices: usize,
    /// Elastic and potential energy of the bodies asleep [J].
    pub energies: Energies,
    /// Their largest stretch [1].
    pub stretch: f64,
}

impl SleepingBodies {
    /// Custom elements have `joined` pairs of bodies.
    pub fn new(
        params: &SleepParams,
        world: &World,
        resolver: &Resolver,
        dt: f64,
        joined: Vec<[u32; 2]>,
    ) -> Option<Self> {
        if !params.enabled {
            return None;
        }
        let scene = resolver.scene();
        let bodies = world.bodies.len();
        Some(Self {
            sleep: Sleep::new(params, world, scene.lengths().delta, dt, joined),
            elements: BodyElements::new(world),
            margins: (0..bodies as u32).map(|body| scene.spacing().margin(body)).collect(),
            asleep: vec![false; bodies],
            awake: None,
            hold: Hold::default(),
            predicted: Vec::new(),
        })
    }

    /// Pairs of bodies that custom elements join; both sleep or none.
    pub fn joined(&self) -> &[[u32; 2]] {
        &self.sleep.joined
    }

    /// The dynamics of the bodies that are awake, if some sleep.
    pub fn dynamics(&mut self) -> Option<&mut Dynamics> {
        self.awake.as_mut().map(|awake| &mut awake.dynamics)
    }

    /// As [`Self::dynamics`], to look at.
    pub fn awake_dynamics(&self) -> Option<&Dynamics> {
        self.awake.as_ref().map(|awake| &awake.dynamics)
    }

    /// Whether no deformable body is awake, and there are some.
    pub fn is_all_asleep(&self, world: &World) -> bool {
        self.awake.is_some()
            && world.bodies.iter().zip(&self.asleep).all(|(body, asleep)| body.kind.is_none() || *asleep)
    }

    /// Records which bodies have vertices that are `prescribed`, and whether these move from `start` to where they are
    /// `led` at the ends of stages [m].
    pub fn record_hold(&mut self, world: &World, prescribed: &[bool], start: &[Point], led: &[&[Point]]) {
        let moves = |v: usize| led.iter().any(|x| x[v] != start[v]);
        let Hold { held, moved } = &mut self.hold;
        held.clear();
        moved.clear();
        for body in &world.bodies {
            let vertices = || body.vertices.clone().chain(body.interior.clone()).map(|v| v as usize);
            held.push(vertices().any(|v| prescribed[v]));
            moved.push(vertices().any(|v| prescribed[v] && moves(v)));
        }
    }
}

impl Awake {
    /// The dynamics of the bodies that are not `asleep`, with the parameters and the wind of `all`, and the
    /// measures of those that are.
    pub fn new(
        world: &World,
        asleep: &[bool],
        all: &Dynamics,
        positions: &[Point],
    ) -> Result<Self, SimulationError> {
        let groups = all.model().element_groups();
        let with_elements = |model: DynamicsModel| {
            if groups.is_empty() {
                return Ok(model);
            }
            let moving = moving_elements(model.obstacle(), groups);
            model.with_elements(moving).map_err(SimulationError::elements)
        };
        let awake = with_elements(world.dynamics_model_with_obstacles(|body| asleep[body])?)?;
        let resting = with_elements(world.dynamics_model_with_obstacles(|body| !asleep[body])?)?;
        let gravity = all.params().environment.gravity;
        let weight = |(v, (&mass, x)): (usize, (&f64, &Point))| {
            // Vertices of obstacles have no mass here.
            mass * all.model().gravity(v, gravity).dot(&x.coords)
        };
        Ok(Self {
            dynamics: Dynamics::new(awake, *all.params()).map_err(SimulationError::Dynamics)?,
            forces: Vec::new(),
            vertices: resting.masses().iter().filter(|mass| **mass > 0.0).count(),
            energies: Energies {
                kinetic: 0.0,
                elastic: resting.elastic_energy(positions),
                potential: -resting.masses().iter().zip(positions).enumerate().map(weight).sum::<f64>(),
            },
            stretch: resting.max_stretch(positions),
        })
    }
}
