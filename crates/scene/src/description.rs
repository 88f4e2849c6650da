//! A scene: what a TOML file holds, with every default filled in.

use crate::body::BodySpec;
use crate::friction::FrictionPair;
use crate::obstacle::ObstacleSpec;
use crate::origin::Origins;
use crate::params::{
    OutputParams, Preset, RepulsionParams, SceneSolverParams, SimulationParams, SleepParams,
};
use crate::pin::PinSpec;
use bowknot_dynamics::{DynamicsParams, Environment, NewtonParams};
use bowknot_twoway::ContactParams;
use std::path::PathBuf;

/// A scene: parameters, bodies, obstacles, pins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Time and the order of work; with `environment` the table `[simulation]`.
    pub simulation: SimulationParams,
    /// Gravity and air.
    pub environment: Environment,
    /// Which set of defaults `contact` and `solver` started from, the key `contact.preset`.
    pub preset: Preset,
    /// Contacts and edge-length limits, the table `[contact]`.
    pub contact: ContactParams,
    /// Friction of pairs of bodies, the tables `[[contact.friction_pairs]]`.
    pub friction_pairs: Vec<FrictionPair>,
    /// How a time step is solved, the table `[solver]`.
    pub solver: SceneSolverParams,
    /// What a run writes, the table `[output]`.
    pub output: OutputParams,
    /// Deformable bodies.
    pub bodies: Vec<BodySpec>,
    /// Obstacles.
    pub obstacles: Vec<ObstacleSpec>,
    /// Held or led vertices.
    pub pins: Vec<PinSpec>,
    /// Folder that mesh paths are relative to.
    pub folder: PathBuf,
    /// Where the keys stand, for messages.
    pub origins: Origins,
}

impl Scene {
    /// An empty scene whose contacts and solver are those of a preset.
    pub fn with_preset(preset: Preset) -> Self {
        let bowknot_twoway::Params { contact, solver } = preset.params();
        let bowknot_twoway::SolverParams { backward, forward, stop } = solver;
        // The paper's method knows no sleep.
        let sleep = SleepParams { enabled: preset != Preset::Paper, ..SleepParams::default() };
        let mut newton = NewtonParams::default();
        if preset == Preset::Quick {
            // Most time steps then end after one iteration.
            newton.step_tolerance = 0.3;
        }
        let repulsion = match preset {
            Preset::Paper => RepulsionParams::paper(),
            Preset::Fast | Preset::Quick => RepulsionParams::default(),
        };
        let solver = SceneSolverParams { backward, forward, stop, newton, repulsion, sleep };
        Self { preset, contact, solver, ..Self::default() }
    }

    /// The parameters of the collision stage.
    pub fn twoway(&self) -> bowknot_twoway::Params {
        let SceneSolverParams { backward, forward, stop, .. } = self.solver.clone();
        let solver = bowknot_twoway::SolverParams { backward, forward, stop };
        bowknot_twoway::Params { contact: self.contact.clone(), solver }
    }

    /// The parameters of the dynamics.
    pub fn dynamics(&self) -> DynamicsParams {
        let integrator = self.simulation.integrator;
        DynamicsParams { integrator, environment: self.environment, newton: self.solver.newton }
    }

    /// Name in reports.
    pub fn name(&self) -> &str {
        &self.simulation.name
    }
}
