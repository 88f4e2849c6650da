//! The bodies on a device: a backend with what the host knows of the time step.

use super::backend::{NewtonBackend, NewtonTarget, SolveLimits, Trial};
use super::bodies::{Answer, Bodies, BodyEnergies, Imbalance, LinearSolve, Lost, Promise};
use super::cpu::NEGLIGIBLE_STEP;
use super::momentum::{Inertia, nodes_of, translation};
use super::state::{Course, DeviceStep, Step};
use crate::dynamics::bodies_potential::StepTerms;
use crate::elements::filter::Filter;
use crate::groups::Group;
use crate::linear::accuracy::Limits;
use crate::linear::assembly::AssemblySprings;
use crate::linear::parts::Parts;
use crate::linear::springs::LinearSprings;
use crate::model::DynamicsModel;
use crate::nodes::CHUNK;
use crate::params::{DynamicsParams, PreconditionerKind};
use crate::repulsion::springs::Repulsion;
use bowknot_geometry::Vector;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// A backend that does Newton iterations.
#[derive(Debug)]
pub struct Device {
    pub backend: Box<dyn NewtonBackend>,
    /// Whether it has taken over the model.
    pub has_model: bool,
}

/// Begins the time step on the backend, which takes over the model before the first one.
fn begin_step(
    model: &DynamicsModel,
    params: &DynamicsParams,
    step: &Step,
    Device { backend, has_model }: &mut Device,
) -> Answer<DeviceStep> {
    if !*has_model {
        let patches = match params.newton.preconditioner {
            PreconditionerKind::BlockJacobi => Vec::new(),
            PreconditionerKind::TwoLevel => model.leaves.clone(),
        };
        backend.set_model(&model.describe(patches))?;
        *has_model = true;
    }
    let terms = StepTerms::new(model, params, step);
    let as_step = terms.as_step();
    let component_sums = model
        .components
        .iter()
        .map(|component| as_step.row_sums[component.start as usize..component.end as usize].iter().sum());
    backend.begin_step(&as_step)?;
    let kinetic = |n: usize| {
        let inertia = 0.5 * model.node_masses[n] * as_step.rate * as_step.rate;
        inertia * (step.start[n] - step.inertial[n]).norm_squared()
    };
    let nodes = step.start.len();
    let chunks = (0..nodes.div_ceil(CHUNK)).into_par_iter();
    let of_chunk = |chunk: usize| {
        let nodes = chunk * CHUNK..((chunk + 1) * CHUNK).min(nodes);
        nodes.map(kinetic).sum::<f64>() + model.bending.chunk_energy(chunk, &step.start)
    };
    // Partial sums in order: the same bits for any number of threads.
    let potential: Vec<f64> = chunks.map(of_chunk).collect();
    Ok(DeviceStep { component_sums: component_sums.collect(), potential_at_start: potential.iter().sum() })
}

/// Where a target begins, by node, and the nodes that springs act on.
#[derive(Clone, Copy)]
pub struct Beginning<'a> {
    pub iterate: &'a [Vector],
    pub free: &'a [bool],
    pub imposed: &'a [Vector],
    pub watched: &'a [u32],
}

/// The bodies of a target on a device.
pub struct DeviceBodies<'a> {
    model: &'a DynamicsModel,
    step: &'a Step,
    on_device: &'a DeviceStep,
    backend: &'a mut dyn NewtonBackend,
    beginning: Beginning<'a>,
    /// Watched nodes at the iterate, and there with those that are not free at their ends.
    iterate: [Vec<Vector>; 2],
    /// The last trial, and watched nodes of the kept one.
    trial: Trial,
    kept: Vec<Vector>,
    /// The trial at full length, where a search has begun and not asked for it yet.
    full: Option<Trial>,
    /// Largest coordinate of the iterate that the target began with [m].
    largest: f64,
}

impl<'a> DeviceBodies<'a> {
    /// Begins a target.
    pub fn new(
        model: &'a DynamicsModel,
        step: &'a Step,
        on_device: &'a DeviceStep,
        backend: &'a mut dyn NewtonBackend,
        beginning: Beginning<'a>,
    ) -> Answer<Self> {
        let watched = backend.begin_target(&NewtonTarget {
            iterate: beginning.iterate,
            free: beginning.free,
            imposed: beginning.imposed,
            watched: beginning.watched,
        })?;
        let largest = beginning.iterate.iter().map(Vector::amax).fold(0.0, f64::max);
        let (trial, kept) = (Trial::default(), Vec::new());
        let iterate = beginning.with_ends(watched);
        Ok(Self { model, step, on_device, backend, beginning, iterate, trial, kept, full: None, largest })
    }
}

impl Beginning<'_> {
    /// Watched nodes at the iterate, and there with those that are not free at their ends.
    fn with_ends(&self, iterate: Vec<Vector>) -> [Vec<Vector>; 2] {
        let ends =
            self.watched.iter().zip(&iterate).map(|(&node, x)| x + self.imposed[node as usize]).collect();
        [iterate, ends]
    }
}

impl DeviceBodies<'_> {
    fn energies(&self) -> BodyEnergies {
        BodyEnergies {
            kinetic: self.on_device.potential_at_start,
            internal: self.trial.reference + self.trial.change,
            rounding: self.trial.rounding,
        }
    }
}

impl Bodies for DeviceBodies<'_> {
    fn linearize(&mut self, filter: Filter) -> Answer<()> {
        Ok(self.backend.linearize(filter == Filter::Absolute)?)
    }

    fn iterate(&self) -> Vec<Vector> {
        self.iterate[0].clone()
    }

    fn iterate_at_ends(&self) -> Vec<Vector> {
        self.iterate[1].clone()
    }

    fn inertial_at_ends(&self) -> Vec<Vector> {
        let position = |(&node, end): (&u32, &Vector)| {
            let node = node as usize;
            if self.beginning.free[node] { self.step.inertial[node] } else { *end }
        };
        self.beginning.watched.iter().zip(&self.iterate[1]).map(position).collect()
    }

    fn solve(
        &mut self,
        springs: &LinearSprings,
        parts: &Parts,
        limits: &Limits,
        groups: &[Group],
    ) -> Answer<LinearSolve> {
        let limits = SolveLimits {
            tolerance: limits.tolerance,
            own_tolerance: limits.own_tolerance,
            min_scale: limits.min_scale_of_whole(),
            max_iterations: limits.max_iterations,
            searches: groups.is_empty(),
        };
        let solved = self.backend.solve(&for_device(springs), &limits)?;
        if solved.stalled {
            return Err(Lost::Stalled);
        }
        let solve = LinearSolve { info: solved.info, scales: vec![solved.scale; parts.count()] };
        if groups.is_empty() {
            return Ok(solve);
        }
        let mut residuals = Vec::new();
        self.backend.component_residuals(&mut residuals)?;
        let mut translations = vec![Vector::zeros(); self.model.components.len()];
        for group in groups {
            let residual: Vector = group.members.iter().map(|&c| residuals[c]).sum();
            let total: Matrix3<f64> = group.members.iter().map(|&c| self.on_device.component_sums[c]).sum();
            let shift = translation(group, &total, &residual);
            group.members.iter().for_each(|&c| translations[c] = shift);
        }
        self.backend.translate(&translations)?;
        Ok(solve)
    }

    fn begin_search(&mut self) -> Answer<BodyEnergies> {
        let (watched, full) = self.backend.begin_search()?;
        self.trial = Trial {
            reference: full.reference,
            predicted: full.predicted,
            largest_step: full.largest_step,
            watched,
            ..Trial::default()
        };
        self.full = Some(full);
        Ok(self.energies())
    }

    fn place(&mut self, length: f64) -> Answer<BodyEnergies> {
        self.trial = match self.full.take() {
            Some(full) if length == 1.0 => full,
            _ => self.backend.place(length)?,
        };
        Ok(self.energies())
    }

    fn promise(&mut self) -> Promise {
        Promise {
            predicted: self.trial.predicted,
            is_negligible: self.trial.largest_step <= NEGLIGIBLE_STEP * self.largest,
        }
    }

    fn trial(&self) -> Vec<Vector> {
        self.trial.watched.clone()
    }

    fn distance_from_iterate(&self) -> f64 {
        self.trial.from_iterate
    }

    fn distance_from_start(&self) -> f64 {
        self.trial.from_start
    }

    fn start_from_trial(&mut self) -> Answer<()> {
        self.backend.start_from_trial()?;
        self.iterate = [self.trial.watched.clone(), self.trial.watched.clone()];
        Ok(())
    }

    fn keep_trial(&mut self) -> Answer<()> {
        self.kept.clone_from(&self.trial.watched);
        Ok(self.backend.keep_trial()?)
    }

    fn start_from_kept_trial(&mut self) -> Answer<()> {
        self.backend.start_from_kept_trial()?;
        self.iterate = [self.kept.clone(), self.kept.clone()];
        Ok(())
    }

    fn out_of_balance(
        &mut self,
        repulsion: &Repulsion,
        counted: &[bool],
        filter: Filter,
    ) -> Answer<Imbalance> {
        let known = repulsion.forces_on_nodes(&self.iterate());
        let springs = for_device(repulsion.linear());
        let found = self.backend.out_of_balance(&springs, &known, counted, filter == Filter::Absolute)?;
        Ok(Imbalance { squared_force: found.squared_force, products: found.products })
    }
}

/// Linearized springs as a device gets them.
fn for_device(springs: &LinearSprings) -> AssemblySprings<'_> {
    if springs.is_empty() {
        return AssemblySprings::default();
    }
    AssemblySprings { springs: springs.all(), starts: springs.starts(), entries: springs.all_entries() }
}

/// Translates each of the `groups` of components at the trial so that its linear momentum at the end of the
/// time step is that of the forces on it in its free directions, in double precision: inertia and the forces
/// of air balance where the translation minimizes them, and forces within a group have no sum. On the device
/// positions and sums are rounded to single precision.
pub fn conserve_momentum(
    model: &DynamicsModel,
    params: &DynamicsParams,
    step: &Step,
    groups: &[Group],
    trial: &mut [Vector],
) {
    let inertia = Inertia::new(params, step);
    for group in groups {
        let nodes = || nodes_of(model, group);
        let force = |n: usize| inertia.gradient(model, step, n, &trial[n]);
        let sum: Vector = nodes().map(force).sum();
        let shift = translation(group, &inertia.of_nodes(model, nodes()), &sum);
        nodes().for_each(|n| trial[n] -= shift);
    }
}

/// A target that a device computes.
pub struct DeviceTarget<'a> {
    pub device: &'a mut Device,
    pub beginning: Beginning<'a>,
    /// Becomes the last trial, by node, which then is the last target.
    pub trial: Option<&'a mut [Vector]>,
}

/// Lets `run` work on the bodies on a device, from a beginning.
pub fn on_device<T>(
    model: &DynamicsModel,
    params: &DynamicsParams,
    step: &Step,
    course: &mut Course,
    DeviceTarget { device, beginning, trial }: DeviceTarget<'_>,
    run: &mut dyn FnMut(&mut dyn Bodies, &mut Course) -> Answer<T>,
) -> Answer<T> {
    let on_device = match course.on_device.take() {
        Some(on_device) => on_device,
        None => begin_step(model, params, step, device)?,
    };
    let mut bodies = DeviceBodies::new(model, step, &on_device, &mut *device.backend, beginning)?;
    let done = run(&mut bodies, course)?;
    if let Some(trial) = trial {
        bodies.backend.target(trial)?;
    }
    course.on_device = Some(on_device);
    Ok(done)
}
