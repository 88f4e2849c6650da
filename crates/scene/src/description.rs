//! A scene: what a TOML file holds, with every default filled in.

use crate::body::{BodySpec, ObstacleSpec, PinSpec};
use crate::friction::FrictionPair;
use crate::params::{OutputParams, Preset, RepulsionParams, SimulationParams};
use bowknot_dynamics::DynamicsParams;
use std::path::PathBuf;

/// A scene: parameters, bodies, obstacles, pins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// Time and the order of work.
    pub simulation: SimulationParams,
    /// Gravity, drag, Newton's method, the linear solve.
    pub dynamics: DynamicsParams,
    /// Which preset the defaults of `twoway` came from.
    pub preset: Preset,
    /// Contact, backward step, forward step, stopping rule.
    pub twoway: bowknot_twoway::Params,
    /// Friction of pairs of bodies.
    pub friction_pairs: Vec<FrictionPair>,
    /// Repulsion of near surfaces by the dynamics.
    pub repulsion: RepulsionParams,
    /// What a run writes.
    pub output: OutputParams,
    /// Deformable bodies.
    pub bodies: Vec<BodySpec>,
    /// Obstacles.
    pub obstacles: Vec<ObstacleSpec>,
    /// Held or led vertices.
    pub pins: Vec<PinSpec>,
    /// Folder that mesh paths are relative to.
    pub folder: PathBuf,
}

impl Scene {
    /// Name in reports.
    pub fn name(&self) -> &str {
        &self.simulation.name
    }
}
