//! Runs a case under the judge, and says which goals it missed.

use super::case::{Case, Start};
use crate::files::write;
use anyhow::{Result, bail};
use bowknot::geometry::{Point, Vector};
use bowknot::run::Checker;
use bowknot::simulator::AcceptedStep;
use bowknot::{SimulationError, SimulationObserver, Simulator, StepStatistics};
use serde::{Deserialize, Serialize};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Largest growth of energy that counts as none, in the case's energy scale: separation to the contact
/// distance and rows that push bodies apart may add a little.
const GROWTH: f64 = 0.05;

/// Largest excess of a stretch over its limit: twice the tolerance of the stopping rule,
/// `solver.stop.stretch_tolerance`.
const STRETCH_EXCESS: f64 = 1.04;

/// Smallest share of time steps whose last collision problem must have ended by its stopping rule.
const CONVERGED: f64 = 0.95;

/// What became of a case.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Why the scene was refused, if it was: a message for the user, no failure.
    pub refused: Option<String>,
    /// Why the run ended early, if it did.
    pub error: Option<String>,
    pub vertices: usize,
    pub time_steps: usize,
    /// States and paths judged.
    pub states: usize,
    pub paths: usize,
    /// Intersections in states and on paths.
    pub intersections: usize,
    /// Coordinates and velocities that are not finite, over all time steps.
    pub not_finite: usize,
    /// Time steps whose last collision problem ended by its stopping rule.
    pub converged: usize,
    /// Largest rise of the energy over an earlier one, in the energy scale.
    pub growth: f64,
    pub max_stretch: f64,
    /// Two-way steps of all time steps, and of the one with the most.
    pub steps: usize,
    pub most_steps: usize,
    /// Tetrahedra without a positive volume at the end.
    pub inverted: usize,
    /// Largest speed at the end [m/s].
    pub last_speed: f64,
}

impl Outcome {
    /// The goals of a case that the outcome misses, in words; none: it is as it should be.
    pub fn missed(&self, case: &Case) -> Vec<String> {
        let mut missed = Vec::new();
        let mut goal = |holds: bool, text: String| {
            if !holds {
                missed.push(text);
            }
        };
        if self.refused.is_some() {
            return missed;
        }
        goal(self.error.is_none(), self.error.clone().unwrap_or_default());
        goal(self.intersections == 0, format!("{} intersections", self.intersections));
        goal(self.not_finite == 0, format!("{} numbers not finite", self.not_finite));
        let converged = self.converged as f64 >= CONVERGED * self.time_steps as f64;
        goal(!case.can_converge || converged, "not converged".to_owned());
        goal(self.growth <= GROWTH, "energy".to_owned());
        goal(self.max_stretch <= case.stretch_limit * STRETCH_EXCESS, "stretch".to_owned());
        goal(!case.can_recover || self.inverted == 0, format!("{} tets inverted", self.inverted));
        missed
    }
}

/// Judges every two-way step.
struct Judged {
    checker: Checker,
    world: Arc<bowknot::World>,
    error: Option<String>,
}

impl SimulationObserver for Judged {
    fn accepted(&mut self, accepted: &AcceptedStep<'_>) -> ControlFlow<()> {
        match self.checker.judge(accepted, &self.world) {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.error = Some(error.to_string());
                ControlFlow::Break(())
            }
        }
    }
}

/// Runs a case; its scene and its meshes are written to `folder`.
///
/// # Errors
/// If a mesh cannot be written, or the case's scene is not sound: a mistake in this program.
pub fn run(case: &Case, folder: &Path) -> Result<Outcome> {
    for (name, text) in &case.meshes {
        write(&folder.join(name), text)?;
    }
    // `bowknot run` reproduces what the table says of a case that starts as its scene is.
    write(&folder.join(format!("{}.toml", case.file_name())), &case.scene)?;
    let scene = match case.open(folder) {
        Ok(scene) => scene,
        Err(error) => bail!("{}: {error}", case.name()),
    };
    let mut outcome = Outcome::default();
    let mut simulator = match Simulator::new(&scene) {
        Ok(simulator) => simulator,
        Err(error @ (SimulationError::StartIntersects { .. } | SimulationError::Scene(_))) => {
            bail!("{}: {error}", case.name())
        }
        Err(error) => {
            outcome.refused = Some(error.to_string());
            return Ok(outcome);
        }
    };
    if let Some(state) = case.start(&simulator)
        && let Err(error) = simulator.restore(&state)
    {
        bail!("{}: {error}", case.name());
    }
    let world = simulator.world().clone();
    let mut judged = Judged { checker: Checker::new(&simulator), world: world.clone(), error: None };
    outcome.vertices = simulator.positions().len();
    let mut energies = Energies::new(&simulator, case);
    for _ in 0..case.time_steps {
        let done = match simulator.step_observed(&mut judged) {
            Ok(done) => done,
            Err(error) => {
                outcome.error = Some(judged.error.take().unwrap_or_else(|| error.to_string()));
                break;
            }
        };
        outcome.add(&done);
        outcome.not_finite += not_finite(simulator.positions(), simulator.velocities());
        energies.add(&done);
        let ends = &simulator.positions()[..world.collision_vertices()];
        if let Err(error) = judged.checker.judge_end(done.step, ends, &world) {
            outcome.error = Some(error.to_string());
            break;
        }
    }
    outcome.growth = energies.growth();
    (outcome.states, outcome.paths) = (judged.checker.states(), judged.checker.paths());
    outcome.intersections = judged.checker.intersections();
    Ok(outcome)
}

impl Outcome {
    fn add(&mut self, done: &StepStatistics) {
        self.time_steps += 1;
        self.converged += usize::from(done.converged);
        self.max_stretch = self.max_stretch.max(done.max_stretch);
        self.steps += done.two_way_steps;
        self.most_steps = self.most_steps.max(done.two_way_steps);
        self.inverted = done.inverted_tets;
        self.last_speed = done.max_speed;
    }
}

fn not_finite(positions: &[Point], velocities: &[Vector]) -> usize {
    let finite = |v: &Vector| v.iter().all(|c| c.is_finite());
    positions.iter().filter(|p| !finite(&p.coords)).count() + velocities.iter().filter(|v| !finite(v)).count()
}

/// The energy of a run: kinetic, elastic and potential.
struct Energies {
    /// What a rise is compared with [J]: the energy of the start, kinetic and elastic, and what gravity can
    /// give the bodies on the length of the scene.
    scale: f64,
    driven_until: f64,
    /// Whether the bodies are strained at the start; their elastic energy then counts as energy of the start.
    is_strained: bool,
    lowest: f64,
    rise: f64,
}

impl Energies {
    fn new(simulator: &Simulator, case: &Case) -> Self {
        let is_strained = case.start != Start::Scene;
        let model = simulator.dynamics_model();
        let x = simulator.positions();
        let velocities = simulator.velocities();
        let kinetic: f64 =
            model.masses().iter().zip(velocities).map(|(m, v)| 0.5 * m * v.norm_squared()).sum();
        let (low, high) = x.iter().fold((x[0], x[0]), |(low, high), p| (low.inf(p), high.sup(p)));
        let deformable = simulator.world().deformable_vertices;
        let inside = simulator.world().collision_vertices()..x.len();
        let mass: f64 = (0..deformable).chain(inside).map(|v| model.masses()[v]).sum();
        let scale = kinetic + mass * 9.81 * (high - low).norm();
        Self { scale, driven_until: case.driven_until, is_strained, lowest: f64::INFINITY, rise: 0.0 }
    }

    fn add(&mut self, done: &StepStatistics) {
        if done.time <= self.driven_until {
            return;
        }
        if done.step == 1 && self.is_strained {
            self.scale += done.energy.elastic;
        }
        let energy = done.energy.kinetic + done.energy.elastic + done.energy.potential;
        self.lowest = self.lowest.min(energy);
        self.rise = self.rise.max(energy - self.lowest);
    }

    fn growth(&self) -> f64 {
        self.rise / self.scale
    }
}
