//! The implicit Euler step as a minimization, one Newton iteration at a time.
//!
//! The function is, over the free nodes and with the others at their keyframes,
//!
//! ```text
//! E(x) = sum m/(2 dt^2) |x - x~|^2 + V(x) + D(x; x0),    x~ = x0 + dt v0 + dt^2 (g + f/m)
//! D(x; x0) = a/(2 dt) |x - x0|^2_M + strain-rate damping of every element + drag of the air
//! ```
//!
//! plus the energy of springs ([`RepulsionSpring`]), if there are any.
//!
//! | stage of [`Dynamics::newton_target`] | reads | writes |
//! |---|---|---|
//! | linearize at x | x, x0 | energy, gradient, H (filtered) |
//! | impose keyframes | H, prescribed | right-hand side b = -g - H p_prescribed |
//! | solve H p = b by CG | guesses: inertia, last target | p |
//! | search along p | E | y = x + t p, prescribed vertices at their keyframes |

mod bodies_potential;
mod conservation;
mod info;
mod newton;
pub mod stages;
mod two_level;

pub use bodies_potential::{BodiesPotential, MatrixBlocks, StepTerms};
pub use conservation::{Held, Touching};
pub use info::{NewtonInfo, Residual};
pub use newton::backend::{
    NewtonBackend, NewtonBackendError, NewtonSolve, NewtonStep, NewtonTarget, OutOfBalance, SolveLimits,
    Trial, Watched,
};

use crate::custom::element::CustomElement;
use crate::drag::DragSurfaces;
use crate::elements::filter::Filter;
use crate::error::{ModelError, StepError};
use crate::linear::assembly::ElementModel;
use crate::linear::block::BlockValues;
use crate::linear::solver::LinearSolver;
use crate::model::DynamicsModel;
use crate::nodes::{MIN_NODES, NO_NODE};
use crate::params::{DynamicsParams, Environment, PreconditionerKind};
use crate::repulsion::spring::RepulsionSpring;
use crate::repulsion::springs::Repulsion;
use bodies_potential::matrix_blocks;
use bowknot_errors::{Errors, ParamError, Parameters};
use bowknot_geometry::{Point, Vector};
use conservation::EndOfStep;
use newton::bodies::{Answer, Bodies, BodyEnergies, Lost};
use newton::cpu::CpuBodies;
use newton::device::{Beginning, Device, DeviceTarget, conserve_momentum, on_device};
use newton::momentum::free_groups;
use newton::state::{Course, EvaluationCache, Newton, Step, Workspace};
use rayon::prelude::*;
use std::fmt::Display;
use std::sync::Arc;
use two_level::two_level;

/// Model, parameters and workspace. External forces, wind and springs are kept until they are set again.
/// [`Self::begin_step`] discards everything else that depends on earlier time steps.
#[derive(Debug)]
pub struct Dynamics {
    model: DynamicsModel,
    params: DynamicsParams,
    /// External force by node [N].
    external_forces: Vec<Vector>,
    /// None in a vacuum.
    surfaces: Option<DragSurfaces>,
    repulsion: Repulsion,
    /// See [`Self::set_step_tolerance`] [m].
    step_tolerance: f64,
    /// See [`Self::component_distances`] [m].
    component_distances: Vec<f64>,
    step: Option<Step>,
    course: Course,
    work: Workspace,
    /// What does Newton iterations in place of the CPU.
    device: Option<Device>,
    /// See [`Self::departures`].
    departures: usize,
}

impl Dynamics {
    /// Checks the parameters and allocates the workspace.
    ///
    /// # Errors
    /// Every parameter out of its range.
    pub fn new(model: DynamicsModel, params: DynamicsParams) -> Result<Self, Errors<ParamError>> {
        params.validate()?;
        let nodes = model.node_vertex.len();
        let zero = || vec![Vector::zeros(); nodes];
        let work = Workspace {
            x: zero(),
            trial: zero(),
            free: vec![true; nodes],
            gradient: zero(),
            right_side: zero(),
            imposed: zero(),
            guesses: [zero(), zero()],
            step: zero(),
            values: BlockValues::zeros(&model.pattern),
            solver: match params.newton.preconditioner {
                PreconditionerKind::BlockJacobi => LinearSolver::default(),
                PreconditionerKind::TwoLevel => two_level(&model),
            },
            cache: EvaluationCache::default(),
        };
        let surfaces = (params.environment.air_density > 0.0).then(|| DragSurfaces::new(&model));
        let repulsion = Repulsion::default();
        let course = Course::default();
        Ok(Self {
            external_forces: zero(),
            surfaces,
            repulsion,
            model,
            params,
            step_tolerance: 0.0,
            component_distances: Vec::new(),
            step: None,
            course,
            work,
            device: None,
            departures: 0,
        })
    }

    /// The model.
    pub fn model(&self) -> &DynamicsModel {
        &self.model
    }

    /// The parameters.
    pub fn params(&self) -> &DynamicsParams {
        &self.params
    }

    /// Sets the backend of Newton iterations. Takes effect at the next target; None, the default, is the CPU. Where
    /// single precision gains nothing, the CPU does the rest of a time step. The residuals of time steps are measured by
    /// the preconditioner of the backend.
    ///
    /// # Errors
    /// [`StepError::OnlyOnCpu`] if a body has what the CPU alone computes, [`StepError::CustomElements`] if there are custom
    /// elements: the CPU then computes the dynamics.
    pub fn set_backend(&mut self, backend: Option<Box<dyn NewtonBackend>>) -> Result<(), StepError> {
        (self.device, self.course.on_device) = (None, None);
        self.work.cache.clear();
        let Some(backend) = backend else { return Ok(()) };
        if let Some(error) = self.model.bodies().iter().find_map(StepError::only_on_cpu) {
            return Err(error);
        }
        if let Some(group) = self.model.element_groups().first() {
            return Err(StepError::CustomElements { group: group.name.clone() });
        }
        self.device = Some(Device { backend, has_model: false });
        Ok(())
    }

    /// Takes the backend away: the CPU computes from now on.
    pub fn take_backend(&mut self) -> Option<Box<dyn NewtonBackend>> {
        self.device.take().map(|device| device.backend)
    }

    /// What does Newton iterations; None if it is the CPU.
    pub fn backend(&self) -> Option<&dyn NewtonBackend> {
        self.device.as_ref().map(|device| &*device.backend)
    }

    /// Puts other custom elements in the place of those of a group, such as springs with other rest lengths. Call it between
    /// time steps.
    ///
    /// # Errors
    /// No group of that name, another number of elements, or an element with other vertices or another order of them. The
    /// elements then stay.
    pub fn replace_elements(
        &mut self,
        group: &str,
        elements: Vec<Arc<dyn CustomElement>>,
    ) -> Result<(), ModelError> {
        self.model.replace_elements(group, elements)?;
        self.work.cache.clear();
        Ok(())
    }

    /// Sets the force on each vertex [N], 0 at first. It is kept until it is set again and takes effect at
    /// the next [`Self::begin_step`].
    ///
    /// # Errors
    /// The length is wrong, or an entry is not finite.
    pub fn set_external_forces(&mut self, forces: &[Vector]) -> Result<(), StepError> {
        self.check_length("forces", forces.len())?;
        self.check_finite("force", |vertex| forces[vertex])?;
        self.gather(forces, |f| *f, |dynamics| &mut dynamics.external_forces);
        Ok(())
    }

    /// Sets the gravity of bodies that have none of their own [m/s^2], [`Environment::gravity`] at first. It
    /// takes effect at the next [`Self::begin_step`].
    ///
    /// # Errors
    /// A component is not finite.
    pub fn set_gravity(&mut self, gravity: Vector) -> Result<(), Errors<ParamError>> {
        Environment { gravity, ..self.params.environment }.validate()?;
        self.params.environment.gravity = gravity;
        Ok(())
    }

    /// Sets the wind [m/s], [`Environment::wind`] at first. It takes effect at the next [`Self::begin_step`].
    ///
    /// # Errors
    /// A component is not finite.
    pub fn set_wind(&mut self, wind: Vector) -> Result<(), Errors<ParamError>> {
        Environment { wind, ..self.params.environment }.validate()?;
        self.params.environment.wind = wind;
        Ok(())
    }

    /// Sets the [`Residual::distance`] at which a time step counts as solved [m], 0 at first: none. It takes
    /// effect at the next [`Self::begin_step`]. Linear solves that correct a step are then accurate enough
    /// for it, however far bodies move in the step and however much they differ in mass.
    pub fn set_step_tolerance(&mut self, distance: f64) {
        self.step_tolerance = distance;
    }

    /// Sets the springs of contacts; there are none at first. They are kept until they are set again and take
    /// effect at the next [`Self::newton_target`]. Without springs the result has the same bits as if they
    /// had never been set.
    ///
    /// # Errors
    /// The first invalid spring and the reason; the previous springs then stay.
    pub fn set_repulsion(&mut self, springs: &[RepulsionSpring]) -> Result<(), StepError> {
        self.repulsion =
            if springs.is_empty() { Repulsion::default() } else { Repulsion::new(&self.model, springs)? };
        if let Some(step) = &self.step {
            self.course.unprepared = true;
            self.repulsion.anchor(&step.positions);
        }
        Ok(())
    }

    /// Forces of the springs on the side that their normal points to, where the last [`Self::residual`] was
    /// measured [N]; one entry per spring.
    pub fn contact_forces(&self) -> Vec<Vector> {
        let trial = self.repulsion.watched().iter().map(|&node| self.work.x[node as usize]);
        self.repulsion.forces(&trial.collect::<Vec<_>>())
    }

    /// Force that something must exert on a vertex to lead it as it was led, at the last [`Self::residual`] [N]:
    /// what is missing to the balance of inertia, gravity, elements and springs. On free vertices it is the
    /// residual. None for obstacles, and where a backend computes.
    pub fn holding_force(&self, vertex: u32) -> Option<Vector> {
        let node = *self.model.vertex_node.get(vertex as usize)?;
        self.work.gradient.get(node as usize).copied().filter(|_| self.device.is_none())
    }

    /// Positions from which inertia leads in the stage of the step, with velocities that implicit Euler then gives as (x -
    /// these) / length of the stage [m]; one entry per vertex, none without a step that was begun.
    pub fn stage_start(&self) -> &[Point] {
        self.step.as_ref().map_or(&[], Step::from)
    }

    /// The residual of the time step at `x` [m]. Contact forces are those of the springs at `x`. Only forces
    /// on vertices that are free and `counted` enter; leave out vertices on which unknown forces act. All
    /// slices have one entry per vertex. If there are springs, the next target begins as if they had just
    /// been set.
    ///
    /// # Errors
    /// A length is wrong, an entry is not finite, no step was begun, a custom element or the backend has failed.
    pub fn residual(
        &mut self,
        x: &[Point],
        prescribed: &[bool],
        counted: &[bool],
    ) -> Result<Residual, StepError> {
        for (array, given) in [("x", x.len()), ("prescribed", prescribed.len()), ("counted", counted.len())] {
            self.check_length(array, given)?;
        }
        self.check_finite("x", |vertex| x[vertex].coords)?;
        let counted: Vec<bool> = self.model.node_vertex.iter().map(|&v| counted[v as usize]).collect();
        let Some(step) = self.step.take() else { return Err(StepError::NotBegun) };
        self.start_from(x, prescribed);
        self.work.imposed.fill(Vector::zeros());
        self.repulsion.place_obstacles(x);
        let residual = self.with_bodies(&step, false, |newton| newton.residual(&counted));
        self.step = Some(step);
        let (residual, distances) = residual?;
        self.component_distances = distances;
        Ok(residual)
    }

    /// How many time steps the CPU has finished because single precision was not enough on a device.
    pub fn departures(&self) -> usize {
        self.departures
    }

    /// The [`Residual::distance`] of each connected component in the last call of [`Self::residual`], in the order of
    /// [`DynamicsModel::components_of_vertices`] [m].
    pub fn component_distances(&self) -> &[f64] {
        &self.component_distances
    }

    /// Lets Newton's method work from the iterate in the workspace, on a device if there is one for the
    /// model. What a device cannot finish in single precision begins again on the CPU, as does the rest of
    /// the time step. With `sets_trial` the trial in the workspace is the result.
    fn with_bodies<T: Send>(
        &mut self,
        step: &Step,
        sets_trial: bool,
        run: impl Fn(&mut Newton<'_>) -> Answer<T> + Sync,
    ) -> Result<T, StepError> {
        // What reports have found is not about this time step.
        self.custom_fault();
        // Thousands of parallel loops follow. From inside of the thread pool each is a push on a local queue;
        // from outside each would put this thread to sleep and wake it again (20 times the CPU time on a busy
        // machine, at 1,700 nodes).
        let done = rayon::scope(|_| self.with_bodies_in_pool(step, sets_trial, &run))?;
        let Some(fault) = self.custom_fault() else { return Ok(done) };
        // The cache lacks what was not finite.
        self.work.cache.clear();
        Err(fault)
    }

    /// The first custom element that has computed something that is not finite since the last call.
    fn custom_fault(&self) -> Option<StepError> {
        let ([group, index], quantity) = self.model.custom.as_ref()?.take_fault()?;
        let group = self.model.element_groups().get(group)?.name.clone();
        Some(StepError::CustomElement { group, index, quantity: quantity.name() })
    }

    fn with_bodies_in_pool<T>(
        &mut self,
        step: &Step,
        sets_trial: bool,
        run: &impl Fn(&mut Newton<'_>) -> Answer<T>,
    ) -> Result<T, StepError> {
        let Self { model, params, repulsion, course, work, device, departures, .. } = self;
        let (dt, is_first) = (step.dt, step.last_target.is_none());
        let (watched, free) = (repulsion.watched().to_vec(), work.free.clone());
        let mut over = |bodies: &mut dyn Bodies, course: &mut Course| {
            let energies = BodyEnergies::default();
            let mut newton =
                Newton { model, params, bodies, repulsion, free: &free, dt, is_first, course, energies };
            run(&mut newton)
        };
        let failed = |error: &dyn Display| StepError::Backend { message: error.to_string() };
        let Workspace { x, imposed, trial, solver, .. } = &mut *work;
        if let Some(device) = device.as_mut().filter(|_| !course.leaves_device) {
            let beginning = Beginning { iterate: x, free: &free, imposed, watched: &watched };
            let target = DeviceTarget {
                device: &mut *device,
                beginning,
                trial: sets_trial.then_some(trial.as_mut_slice()),
            };
            match on_device(model, params, step, course, target, &mut over) {
                Ok(done) => {
                    if sets_trial {
                        let groups = free_groups(model, repulsion, &free);
                        conserve_momentum(model, params, step, &groups, trial);
                    }
                    return Ok(done);
                }
                Err(lost) => {
                    course.leaves_device = true;
                    solver.leave_single_precision();
                    if let Lost::Failed(error) = lost {
                        // It may not have got what was on its way.
                        device.has_model = false;
                        return Err(failed(&error));
                    }
                    if *departures == 0 {
                        tracing::warn!(
                            "the CPU finishes a time step whose linear solves need more than single precision; \
                             `device.departures` in stats.jsonl counts them"
                        );
                    }
                    *departures += 1;
                    course.unprepared = true;
                }
            }
        }
        over(&mut CpuBodies::new(model, params, step, work, &watched), course).map_err(|lost| failed(&lost))
    }

    /// Starts a time step of `dt` [s] from positions `x0` [m] and velocities `v0` [m/s].
    ///
    /// Velocities of vertices that will be prescribed have an effect on the drag of air only, but must be
    /// finite.
    ///
    /// # Errors
    /// A length is wrong, an entry is not finite, or the time step is not positive and finite.
    pub fn begin_step(&mut self, x0: &[Point], v0: &[Vector], dt: f64) -> Result<(), StepError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(StepError::TimeStep { dt });
        }
        self.check_length("x0", x0.len())?;
        self.check_length("v0", v0.len())?;
        self.check_finite("x0", |vertex| x0[vertex].coords)?;
        self.check_finite("v0", |vertex| v0[vertex])?;
        let mut step = self.step.take().unwrap_or_default();
        (step.earlier, step.whole) = (None, dt);
        step.pressed.clear();
        step.positions.clear();
        step.positions.extend_from_slice(x0);
        self.enter(step, x0, v0);
        Ok(())
    }

    /// Begins a stage of the time step, in which inertia leads from positions `from` with velocities `v`; the bodies
    /// are at the positions of the step.
    fn enter(&mut self, mut step: Step, from: &[Point], v: &[Vector]) {
        let dt = self.params.integrator.stage_length() * step.whole;
        let model = &self.model;
        let nodes = || model.node_vertex.par_iter().with_min_len(MIN_NODES);
        nodes().map(|&vertex| from[vertex as usize].coords).collect_into_vec(&mut step.start);
        nodes().map(|&vertex| v[vertex as usize]).collect_into_vec(&mut step.velocities);
        let inertial = nodes().enumerate().map(|(node, &vertex)| {
            let vertex = vertex as usize;
            let gravity = model.gravity(vertex, self.params.environment.gravity);
            let acceleration = gravity + self.external_forces[node] / model.node_masses[node];
            from[vertex].coords + v[vertex] * dt + acceleration * (dt * dt)
        });
        inertial.collect_into_vec(&mut step.inertial);
        if step.dt != dt {
            let mut scalar = model.bending.split(&model.pattern);
            if let Some(damping) = &model.bending_damping {
                scalar.add_scaled(1.0 / dt, &damping.split(&model.pattern));
            }
            step.scalar = Arc::new(scalar);
        }
        if let Some(surfaces) = &self.surfaces {
            let drag = step.drag.get_or_insert_default();
            surfaces.fill(&self.params.environment, &step.start, &step.velocities, drag);
        }
        step.dt = dt;
        step.last_target = None;
        step.wanted.clear();
        if self.params.integrator.stage_ends().len() > 1 {
            step.wanted
                .extend(model.node_vertex.iter().map(|&vertex| step.positions[vertex as usize].coords));
        }
        let step_tolerance = self.step_tolerance;
        self.course = Course { unprepared: true, step_tolerance, ..Course::default() };
        self.work.solver.begin_step();
        self.work.cache.clear();
        self.repulsion.anchor(&step.positions);
        self.step = Some(step);
    }

    /// Computes the target `y` [m] from the current iterate `x` [m] by a Newton iteration and the ones that
    /// correct it.
    ///
    /// Vertices that are `prescribed` end the step at their `keyframes` [m], which are read for them only;
    /// vertices of obstacles always do. Their entries of `y` are exactly the keyframes, whatever the line
    /// search does. `x` may be any state, such as the result of contact resolution, and may differ from one
    /// call to the next. All slices have one entry per vertex.
    ///
    /// If contact moves the surface of a solid elsewhere than to `y`, its inside can follow: call this once
    /// or twice more in the same step, with the surface prescribed and its positions as keyframes. The inside
    /// then solves the time step, inertia included, with the surface held.
    ///
    /// # Errors
    /// A length is wrong, an entry is not finite, no step was begun, a custom element or the backend has failed.
    pub fn newton_target(
        &mut self,
        x: &[Point],
        prescribed: &[bool],
        keyframes: &[Point],
        y: &mut [Point],
    ) -> Result<NewtonInfo, StepError> {
        for (array, given) in
            [("x", x.len()), ("prescribed", prescribed.len()), ("keyframes", keyframes.len()), ("y", y.len())]
        {
            self.check_length(array, given)?;
        }
        self.check_finite("x", |vertex| x[vertex].coords)?;
        let fixed = |vertex: usize| prescribed[vertex] || self.model.obstacle()[vertex];
        self.check_finite("keyframe", |v| if fixed(v) { keyframes[v].coords } else { Vector::zeros() })?;
        let Some(mut step) = self.step.take() else { return Err(StepError::NotBegun) };

        self.start_from(x, prescribed);
        let imposed = self.work.imposed.par_iter_mut().zip(&self.model.node_vertex).with_min_len(MIN_NODES);
        imposed.for_each(|(imposed, &vertex)| {
            let vertex = vertex as usize;
            *imposed = if prescribed[vertex] { keyframes[vertex] - x[vertex] } else { Vector::zeros() };
        });
        self.record_pressure(&mut step, x, prescribed);
        self.repulsion.place_obstacles(keyframes);
        let solved = self.with_bodies(&step, true, |newton| newton.solve());
        let mut info = match solved {
            Ok(info) => info,
            Err(error) => {
                self.step = Some(step);
                return Err(error);
            }
        };
        // `trial` is the target by node.
        let (Workspace { trial, free, .. }, vertex_node) = (&self.work, &self.model.vertex_node);
        info.max_displacement = displacement(&self.model, trial, free, x);
        let vertices = y.par_iter_mut().zip(vertex_node).zip(keyframes).with_min_len(MIN_NODES);
        vertices.for_each(|((y, &node), keyframe)| {
            let is_free = node != NO_NODE && free[node as usize];
            *y = if is_free { Point::from(trial[node as usize]) } else { *keyframe };
        });
        for ((wanted, target), _) in step.wanted.iter_mut().zip(trial).zip(free).filter(|(_, free)| **free) {
            *wanted = *target;
        }
        step.last_target.get_or_insert_default().clone_from(trial);
        self.step = Some(step);
        self.check_finite("target", |vertex| y[vertex].coords)?;
        tracing::debug!(
            iterations = info.cg.iterations,
            residual = info.cg.residual,
            step_length = info.step_length,
            "newton target"
        );
        Ok(info)
    }

    /// Makes a whole step without contact resolution: `newton_iterations` targets in each stage, each of which
    /// is the next iterate. `x` and `v` advance by `dt`, see [`Self::end_velocities`]. Prescribed vertices end at their
    /// `keyframes` and have the velocity that takes them there.
    ///
    /// # Errors
    /// Those of [`Self::begin_step`] and [`Self::newton_target`]; `x` and `v` are then unchanged.
    pub fn solve_step(
        &mut self,
        x: &mut [Point],
        v: &mut [Vector],
        dt: f64,
        prescribed: &[bool],
        keyframes: &[Point],
        newton_iterations: usize,
    ) -> Result<Vec<NewtonInfo>, StepError> {
        self.begin_step(x, v, dt)?;
        let mut iterate = x.to_vec();
        let mut target = x.to_vec();
        let mut infos = Vec::with_capacity(newton_iterations);
        for (stage, &end) in self.params.integrator.stage_ends().iter().enumerate() {
            if stage > 0 {
                self.next_stage(&iterate, prescribed);
            }
            let at = |(from, to): (&Point, &Point)| if end < 1.0 { from + (to - from) * end } else { *to };
            let keyframes: Vec<Point> = x.iter().zip(keyframes).map(at).collect();
            for _ in 0..newton_iterations {
                infos.push(self.newton_target(&iterate, prescribed, &keyframes, &mut target)?);
                iterate.copy_from_slice(&target);
            }
        }
        self.end_velocities(&iterate, prescribed, &Touching::default(), v);
        x.copy_from_slice(&iterate);
        Ok(infos)
    }

    /// Velocities at the end of the step, at positions `x` [m], in `v` [m/s]. They conserve linear and
    /// angular momentum. Bodies with a vertex that is `prescribed`, obstacles and single grains move at the
    /// mean velocities of the step. All slices have one entry per vertex. Without a step that was begun `v`
    /// stays unchanged.
    pub fn end_velocities(&self, x: &[Point], prescribed: &[bool], touching: &Touching, v: &mut [Vector]) {
        let Some(step) = &self.step else { return };
        self.stage_velocities(step, x, prescribed, v);
        self.end_of(step).conserve(x, prescribed, touching, v);
    }

    fn end_of<'a>(&'a self, step: &'a Step) -> EndOfStep<'a> {
        let Self { model, params, external_forces, repulsion, .. } = self;
        EndOfStep { model, environment: &params.environment, external_forces, repulsion, step }
    }

    /// Copies the iterate, by node.
    fn start_from(&mut self, x: &[Point], prescribed: &[bool]) {
        let Workspace { x: iterate, free, cache, .. } = &mut self.work;
        let nodes = iterate.par_iter_mut().zip(&mut *free).zip(&self.model.node_vertex);
        let place = |((iterate, free), &vertex): ((&mut Vector, &mut bool), &u32)| {
            *iterate = x[vertex as usize].coords;
            let is_free = !prescribed[vertex as usize];
            std::mem::replace(free, is_free) != is_free
        };
        if nodes.with_min_len(MIN_NODES).map(place).reduce(|| false, |a, b| a | b) {
            // Energies of inertia are those of free nodes; gradients and matrices are of all.
            cache.energies_at.clear();
        }
    }

    /// The elements as backends get them, without patches and without quadratic elements.
    pub fn element_model(&self) -> ElementModel {
        self.model.describe(Vec::new())
    }

    /// The terms of the potential in the time step that was begun.
    ///
    /// # Errors
    /// No step was begun.
    pub fn step_terms(&self) -> Result<StepTerms, StepError> {
        let Some(step) = &self.step else { return Err(StepError::NotBegun) };
        Ok(StepTerms::new(&self.model, &self.params, step))
    }

    /// The potential of the bodies at positions `x` of nodes [m] in the time step that was begun. One thread
    /// computes it.
    ///
    /// # Errors
    /// No step was begun, or the length is wrong.
    pub fn bodies_potential(&self, x: &[Vector]) -> Result<BodiesPotential, StepError> {
        let terms = self.step_terms()?;
        self.check_nodes(x)?;
        Ok(BodiesPotential::at(&self.model, &terms, x))
    }

    /// The matrix of the bodies at positions `x` of nodes [m] in the time step that was begun, without springs and as if all
    /// nodes were free. `absolute` is that of [`NewtonBackend::linearize`].
    ///
    /// # Errors
    /// No step was begun, or the length is wrong.
    pub fn bodies_matrix(&mut self, x: &[Vector], absolute: bool) -> Result<MatrixBlocks, StepError> {
        self.check_nodes(x)?;
        let Some(step) = &self.step else { return Err(StepError::NotBegun) };
        let filter = if absolute { Filter::Absolute } else { Filter::Clamp };
        Ok(matrix_blocks(&self.model, &self.params, step, &mut self.work, x, filter))
    }

    fn check_nodes(&self, x: &[Vector]) -> Result<(), StepError> {
        let nodes = self.model.node_vertex.len();
        if x.len() == nodes {
            return Ok(());
        }
        Err(StepError::Length { array: "x", given: x.len(), vertices: nodes })
    }

    fn gather<T>(
        &mut self,
        from: &[T],
        map: impl Fn(&T) -> Vector,
        into: impl Fn(&mut Self) -> &mut Vec<Vector>,
    ) {
        let gathered = self.model.node_vertex.iter().map(|&v| map(&from[v as usize])).collect();
        *into(self) = gathered;
    }

    fn check_length(&self, array: &'static str, given: usize) -> Result<(), StepError> {
        let vertices = self.model.vertex_count();
        if given == vertices { Ok(()) } else { Err(StepError::Length { array, given, vertices }) }
    }

    fn check_finite(
        &self,
        array: &'static str,
        entry: impl Fn(usize) -> Vector + Sync,
    ) -> Result<(), StepError> {
        let vertices = (0..self.model.vertex_count()).into_par_iter().with_min_len(MIN_NODES);
        match vertices.find_first(|&v| !entry(v).iter().all(|c| c.is_finite())) {
            None => Ok(()),
            Some(vertex) => {
                Err(StepError::NonFinite { array, vertex, body: self.model.body_name(vertex).to_owned() })
            }
        }
    }
}

/// Largest |y - x| over free nodes [m]; `x` has one entry per vertex.
fn displacement(model: &DynamicsModel, y: &[Vector], free: &[bool], x: &[Point]) -> f64 {
    let distance = |node: usize| (y[node] - x[model.node_vertex[node] as usize].coords).norm();
    let nodes = (0..y.len()).into_par_iter().with_min_len(MIN_NODES);
    nodes.filter(|&node| free[node]).map(distance).reduce(|| 0.0, f64::max)
}

#[cfg(test)]
mod tests;
