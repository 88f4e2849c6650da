//! What a Newton iteration works on, by node.

use super::bodies::{Bodies, BodyEnergies};
use crate::drag::Drag;
use crate::elements::filter::Filter;
use crate::linear::block::BlockValues;
use crate::linear::scalar::SplitForm;
use crate::linear::solver::LinearSolver;
use crate::linear::vectors::add_scaled;
use crate::model::DynamicsModel;
use crate::params::DynamicsParams;
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use std::sync::Arc;

/// The current time step, or a stage of it.
#[derive(Debug, Default)]
pub struct Step {
    /// Its length h, by which implicit Euler goes on from `start` with `velocities` [s].
    pub dt: f64,
    /// Positions from which inertia leads.
    pub start: Vec<Vector>,
    /// Velocities there.
    pub velocities: Vec<Vector>,
    /// Positions at which the bodies are at the start, by vertex.
    pub positions: Vec<Point>,
    /// What the stages before leave to this one; None in the first.
    pub earlier: Option<Box<Earlier>>,
    /// Length of the time step [s].
    pub whole: f64,
    /// Sum of the normal forces of contacts on each node before the stage [N]; empty if not yet known, or if
    /// there is but one stage.
    pub pressed: Vec<f64>,
    /// Positions x~ where inertia leads.
    pub inertial: Vec<Vector>,
    /// Where each node was to go by the last target in which it was free; only if there are several stages.
    pub wanted: Vec<Vector>,
    /// The last target, if there is one: the next solve starts from it.
    pub last_target: Option<Vec<Vector>>,
    /// Bending plus its damping / dt, as a matrix.
    pub scalar: Arc<SplitForm>,
    /// None in a vacuum.
    pub drag: Option<Drag>,
}

/// What the first stage of a time step leaves to the second.
#[derive(Debug, Default)]
pub struct Earlier {
    /// Positions at the start of the time step, by node.
    pub start: Vec<Vector>,
    /// Velocities there.
    pub velocities: Vec<Vector>,
    /// Positions from which inertia leads, by vertex.
    pub from: Vec<Point>,
    /// Gravity, external forces and those of the air in the first stage, by node [N].
    pub forces: Vec<Vector>,
}

impl Step {
    /// Positions from which inertia leads, by vertex.
    pub fn from(&self) -> &[Point] {
        self.earlier.as_ref().map_or(&self.positions, |earlier| &earlier.from)
    }
}

/// What the host keeps of a time step on a device.
#[derive(Debug, Default)]
pub struct DeviceStep {
    /// Inertia and drag of each component: the sum of the rows of H without springs [N/m].
    pub component_sums: Vec<Matrix3<f64>>,
    /// Potential of inertia and flat bending at the start [J].
    pub potential_at_start: f64,
}

/// What the iterations of a time step have found out.
#[derive(Debug, Default)]
pub struct Course {
    /// Whether springs must be prepared: they have been set since the last Newton iteration, or the step has
    /// just begun.
    pub unprepared: bool,
    /// By component, see [`crate::linear::accuracy::Limits::min_scales`]: that of the first solve of the time
    /// step, unless that is too large for the tolerance of the time step; 0 before.
    pub scales: Vec<f64>,
    /// See [`crate::Dynamics::set_step_tolerance`] [m].
    pub step_tolerance: f64,
    /// Whether the CPU does the rest of the time step.
    pub leaves_device: bool,
    /// The time step on the device, once it has begun there.
    pub on_device: Option<DeviceStep>,
}

/// Buffers; they may be dropped at any time.
#[derive(Debug, Default)]
pub struct Workspace {
    /// The iterate.
    pub x: Vec<Vector>,
    /// The trial of the line search, and the target in the end.
    pub trial: Vec<Vector>,
    pub free: Vec<bool>,
    pub gradient: Vec<Vector>,
    pub right_side: Vec<Vector>,
    /// Displacements from the iterate to the keyframes; zero for free nodes.
    pub imposed: Vec<Vector>,
    pub guesses: [Vec<Vector>; 2],
    /// The Newton step.
    pub step: Vec<Vector>,
    pub values: BlockValues,
    pub solver: LinearSolver,
    pub cache: EvaluationCache,
}

/// Energies and gradients that were computed in this time step, so that they are not computed twice.
#[derive(Debug, Default)]
pub struct EvaluationCache {
    /// Where `energies` were computed last [m]; empty if nowhere in this time step.
    pub energies_at: Vec<Vector>,
    pub energies: [f64; 2],
    /// Where the bodies were linearized last [m], with which filter, and their gradient [N].
    pub linearized_at: Vec<Vector>,
    pub filter: Option<Filter>,
    pub gradient: Vec<Vector>,
}

impl EvaluationCache {
    /// Drops all values.
    pub fn clear(&mut self) {
        self.energies_at.clear();
        self.linearized_at.clear();
    }
}

impl Workspace {
    /// Sets the trial to the iterate plus `length` times the Newton step, with prescribed nodes at their
    /// keyframes.
    pub fn place(&mut self, length: f64) {
        self.trial.copy_from_slice(&self.x);
        add_scaled(&mut self.trial, 1.0, &self.imposed);
        if length != 0.0 {
            add_scaled(&mut self.trial, length, &self.step);
        }
    }

    /// Makes the trial the next iterate. Prescribed nodes are at their keyframes there.
    pub fn start_from_trial(&mut self) {
        self.x.copy_from_slice(&self.trial);
        self.imposed.fill(Vector::zeros());
    }
}

/// Makes the right-hand side b = -(g + H p) over free nodes of H p and the gradient g.
pub fn negate_forces(b: &mut [Vector], gradient: &[Vector], free: &[bool]) {
    for ((b, g), &free) in b.iter_mut().zip(gradient).zip(free) {
        *b = if free { -(*b + g) } else { Vector::zeros() };
    }
}

/// Newton's method over bodies, to a trial that is the target in the end.
pub struct Newton<'a> {
    pub model: &'a DynamicsModel,
    pub params: &'a DynamicsParams,
    pub bodies: &'a mut dyn Bodies,
    pub repulsion: &'a mut Repulsion,
    /// Which nodes are free.
    pub free: &'a [bool],
    pub dt: f64,
    /// Whether this is the first target of the time step.
    pub is_first: bool,
    pub course: &'a mut Course,
    /// The potential of the bodies at the last trial.
    pub energies: BodyEnergies,
}
