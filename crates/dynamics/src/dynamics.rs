//! The implicit Euler step as a minimisation, one Newton iteration at a time.
//!
//! Over the free nodes, with the others at their keyframes,
//!
//! ```text
//! E(x) = sum m/(2 dt^2) |x - x~|^2 + V(x) + D(x; x0),    x~ = x0 + dt v0 + dt^2 (g + f/m)
//! D(x; x0) = a/(2 dt) |x - x0|^2_M + strain-rate damping of every element + drag of the air
//! ```
//!
//! plus repulsion ([`RepulsionSpring`]), if there is any.
//!
//! | stage of [`Dynamics::newton_target`] | reads | writes |
//! |---|---|---|
//! | linearise at x | x, x0 | energy, gradient, H (filtered) |
//! | impose keyframes | H, prescribed | right-hand side b = -g - H p_prescribed |
//! | solve H p = b by CG | warm start: inertia, previous target | p |
//! | search along p | E | y = x + t p, prescribed vertices at their keyframes |

use crate::drag::{Drag, DragSurfaces};
use crate::elements::{CHUNK, Filter, Motion, Rows};
use crate::linear::block::BlockValues;
use crate::linear::cg::{self, CgInfo, CgWorkspace, Limits};
use crate::linear::preconditioner::Preconditioner;
use crate::linear::scalar::SplitForm;
use crate::linear::system::System;
use crate::linear::vectors::{add_scaled, dot};
use crate::model::NO_NODE;
use crate::momentum::{Inertia, restore_momentum};
use crate::repulsion::Repulsion;
use crate::{DynamicsModel, DynamicsParams, ParamsError, RepulsionSpring, StepError};
use bowknot_geometry::{Point, Vector};
use nalgebra::Matrix3;
use rayon::prelude::*;
use serde::Serialize;

/// Share of the promised decrease at which a Newton step counts as arrived. The quadratic model then errs by some tenth of
/// the decrease, the next iteration by about its square.
const AGREEMENT: f64 = 0.9;

/// Share of the potential below which a correction's decrease is not worth another.
const VAIN_DECREASE: f64 = 1e-6;

/// Share of the whole displacement below which a correction is the last.
const SMALL_CORRECTION: f64 = 0.1;

/// Share of the contact forces that may be wrong, by springs that pull, are missing, or rub too much or too little.
const SETTLED: f64 = 0.05;

/// Newton iterations made for them at most. In a heap of cloth thousands of contacts come and go; they need not be
/// right, as the collision stage decides.
const SETTLING_ITERATIONS: usize = 2;

/// Share of the potential's terms below which a gain by springs is one of the linear solve's tolerance.
const NO_GAIN: f64 = 1e-6;

/// Energies that differ by less than this share of their terms are equal: what rounding leaves of
/// sums over 10^5 nodes, with room.
const ENERGY_ROUNDING: f64 = 1e-12;

/// Steps shorter than this share of the largest coordinate are rounding: not worth a line search,
/// whose energies would differ by noise.
const NEGLIGIBLE_STEP: f64 = 1e-12;

/// What one Newton iteration did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct NewtonInfo {
    /// The linear solve.
    pub cg: CgInfo,
    /// Newton iterations made: 1, and the correcting ones.
    pub iterations: usize,
    /// Share of the last Newton step that the line search kept, in (0, 1].
    pub step_length: f64,
    /// Ratio of the last step's decrease of the potential to that of the quadratic model, the smaller one over the larger,
    /// or `step_length` if that is less [1].
    pub agreement: f64,
    /// Incremental potential [J] at x, prescribed vertices at their keyframes.
    pub energy_before: f64,
    /// Incremental potential [J] at y.
    pub energy_after: f64,
    /// Largest |y - x| over free vertices [m].
    pub max_displacement: f64,
}

impl NewtonInfo {
    /// Takes in the next iteration of the same target.
    fn add(&mut self, next: &Self) {
        self.cg.iterations += next.cg.iterations;
        self.cg.residual = next.cg.residual;
        self.cg.converged &= next.cg.converged;
        self.iterations += next.iterations;
        self.step_length = next.step_length;
        self.agreement = next.agreement;
        self.energy_after = next.energy_after;
    }
}

/// Model, parameters and workspace. Nothing in it outlives a time step: [`Self::begin_step`] forgets
/// all but the external forces, the wind and the repulsion, which are kept until set again.
#[derive(Debug)]
pub struct Dynamics {
    model: DynamicsModel,
    params: DynamicsParams,
    /// By node [N].
    external_forces: Vec<Vector>,
    /// None in a vacuum.
    surfaces: Option<DragSurfaces>,
    repulsion: Repulsion,
    step: Option<Step>,
    work: Workspace,
}

/// The time step under way, by node.
#[derive(Debug, Default)]
struct Step {
    dt: f64,
    start: Vec<Vector>,
    inertial: Vec<Vector>,
    /// The last target, if there was one: the warm start of the next solve.
    last_target: Option<Vec<Vector>>,
    /// Bending plus its damping / dt, as a matrix.
    scalar: SplitForm,
    /// None in a vacuum.
    drag: Option<Drag>,
    /// Whether no Newton iteration has been made yet.
    fresh: bool,
}

/// Buffers; may be dropped at any time.
#[derive(Debug, Default)]
struct Workspace {
    x: Vec<Vector>,
    trial: Vec<Vector>,
    free: Vec<bool>,
    gradient: Vec<Vector>,
    right_side: Vec<Vector>,
    imposed: Vec<Vector>,
    guesses: [Vec<Vector>; 2],
    step: Vec<Vector>,
    values: BlockValues,
    preconditioner: Preconditioner,
    cg: CgWorkspace,
    /// See [`Limits::least_scale`]; 0 but in corrections.
    least_scale: f64,
}

impl Workspace {
    /// Makes the whole Newton step the trial, whatever it does to the potential: the watchdog technique (Chamberlain,
    /// Powell, Lemarechal and Pedersen 1982). A stiff rod that turns stretches along its straight step, a line search would
    /// stop it there for good, and the next step restores its length.
    fn take_full_step(&mut self) {
        self.trial.copy_from_slice(&self.x);
        add_scaled(&mut self.trial, 1.0, &self.imposed);
        add_scaled(&mut self.trial, 1.0, &self.step);
    }

    /// Makes the trial the state that the next iteration starts from; prescribed nodes are at their keyframes there.
    fn start_from_trial(&mut self) {
        self.x.copy_from_slice(&self.trial);
        self.imposed.fill(Vector::zeros());
    }
}

impl Dynamics {
    /// Checks the parameters and allocates the workspace.
    ///
    /// # Errors
    /// Everything that is wrong with the parameters.
    pub fn new(model: DynamicsModel, params: DynamicsParams) -> Result<Self, Vec<ParamsError>> {
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
            preconditioner: match params.preconditioner {
                crate::Preconditioner::BlockJacobi => Preconditioner::default(),
                crate::Preconditioner::TwoLevel => model.two_level(),
            },
            cg: CgWorkspace::default(),
            least_scale: 0.0,
        };
        let surfaces = (params.air_density > 0.0).then(|| DragSurfaces::new(&model));
        let repulsion = Repulsion::default();
        Ok(Self { external_forces: zero(), surfaces, repulsion, model, params, step: None, work })
    }

    /// What is fixed.
    pub fn model(&self) -> &DynamicsModel {
        &self.model
    }

    /// The parameters.
    pub fn params(&self) -> &DynamicsParams {
        &self.params
    }

    /// Sets the force on each vertex [N], kept until set again; 0 to begin with. It enters at the
    /// next [`Self::begin_step`].
    ///
    /// # Errors
    /// Wrong length, or an entry that is not finite.
    pub fn set_external_forces(&mut self, forces: &[Vector]) -> Result<(), StepError> {
        self.check_length("forces", forces.len())?;
        self.check_finite("force", |vertex| forces[vertex])?;
        self.gather(forces, |f| *f, |dynamics| &mut dynamics.external_forces);
        Ok(())
    }

    /// Sets the wind [m/s], [`DynamicsParams::wind`] until then. It enters at the next [`Self::begin_step`].
    ///
    /// # Errors
    /// A component that is not finite.
    pub fn set_wind(&mut self, wind: Vector) -> Result<(), Vec<ParamsError>> {
        DynamicsParams { wind, ..self.params }.validate()?;
        self.params.wind = wind;
        Ok(())
    }

    /// Sets the springs that push close pairs apart, kept until set again; none to begin with. They enter at the
    /// next [`Self::newton_target`]; none costs nothing and changes no bit.
    ///
    /// # Errors
    /// The first spring that is wrong, and why; the springs set before then stay.
    pub fn set_repulsion(&mut self, springs: &[RepulsionSpring]) -> Result<(), StepError> {
        self.repulsion =
            if springs.is_empty() { Repulsion::default() } else { Repulsion::new(&self.model, springs)? };
        Ok(())
    }

    /// Starts a time step of `dt` [s] from positions `x0` [m] and velocities `v0` [m/s].
    ///
    /// Velocities of vertices that will be prescribed matter for the drag of air alone, but must be finite.
    ///
    /// # Errors
    /// Wrong lengths, entries that are not finite, a time step that is not positive.
    pub fn begin_step(&mut self, x0: &[Point], v0: &[Vector], dt: f64) -> Result<(), StepError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(StepError::TimeStep { dt });
        }
        self.check_length("x0", x0.len())?;
        self.check_length("v0", v0.len())?;
        self.check_finite("x0", |vertex| x0[vertex].coords)?;
        self.check_finite("v0", |vertex| v0[vertex])?;
        let mut step = self.step.take().unwrap_or_default();
        let model = &self.model;
        step.start.clear();
        step.start.extend(model.node_vertex.iter().map(|&v| x0[v as usize].coords));
        step.inertial.clear();
        step.inertial.extend(model.node_vertex.iter().enumerate().map(|(node, &v)| {
            let gravity = model.gravity(v as usize, self.params.gravity);
            let acceleration = gravity + self.external_forces[node] / model.node_masses[node];
            x0[v as usize].coords + v0[v as usize] * dt + acceleration * (dt * dt)
        }));
        if step.dt != dt {
            step.scalar = model.bending.split(&model.pattern);
            if let Some(damping) = &model.bending_damping {
                step.scalar.add_scaled(1.0 / dt, &damping.split(&model.pattern));
            }
        }
        if let Some(surfaces) = &self.surfaces {
            let v: Vec<Vector> = model.node_vertex.iter().map(|&v| v0[v as usize]).collect();
            surfaces.fill(&self.params, &step.start, &v, step.drag.get_or_insert_default());
        }
        step.dt = dt;
        step.last_target = None;
        step.fresh = true;
        self.repulsion.begin_step(x0);
        self.step = Some(step);
        Ok(())
    }

    /// One Newton iteration of the step from the current iterate `x` [m] to the target `y` [m].
    ///
    /// `prescribed` says which vertices end the step at their `keyframes` [m] (read only there);
    /// vertices of obstacles always do. `y` of a prescribed vertex is its keyframe exactly, whatever
    /// the line search does. `x` may be anything that contact resolution left, and may differ from
    /// one call to the next. All slices have one entry a vertex.
    ///
    /// To bring the inside of solids along with a surface that contact moved elsewhere than to `y`, call it once
    /// or twice more in the same step, with the surface prescribed and its place as keyframe: the inside then
    /// solves the step with the surface held, inertia included.
    ///
    /// # Errors
    /// Wrong lengths, entries that are not finite, no step begun.
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

        let work = &mut self.work;
        for (node, &vertex) in self.model.node_vertex.iter().enumerate() {
            let vertex = vertex as usize;
            work.x[node] = x[vertex].coords;
            work.free[node] = !prescribed[vertex];
            work.imposed[node] =
                if prescribed[vertex] { keyframes[vertex] - x[vertex] } else { Vector::zeros() };
        }
        // From inside of the thread pool a parallel loop is a push on a local queue; from outside every
        // one of the thousands to come would put this thread to sleep and wake it (20 times the CPU
        // time on a busy machine, at 1,700 nodes).
        self.repulsion.place_obstacles(keyframes);
        let repulsion = &mut self.repulsion;
        let mut info = rayon::scope(|_| {
            if repulsion.is_empty() {
                approach(&self.model, &self.params, repulsion, &mut step, work)
            } else {
                approach_contacts(&self.model, &self.params, repulsion, &mut step, work)
            }
        });

        info.max_displacement = displacement(&self.model, &work.trial, &work.free, x);
        // `trial` holds the target by node.
        for (vertex, y) in y.iter_mut().enumerate() {
            let node = self.model.vertex_node[vertex];
            let free = node != NO_NODE && work.free[node as usize];
            *y = if free { Point::from(work.trial[node as usize]) } else { keyframes[vertex] };
        }
        step.last_target = Some(work.trial.clone());
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

    /// A whole step without contact: `newton_iterations` targets, each accepted as it is; `x` and
    /// `v` move on by `dt`. Prescribed vertices end at their `keyframes` and move at the velocity
    /// that takes them there.
    ///
    /// # Errors
    /// As [`Self::begin_step`] and [`Self::newton_target`]; `x` and `v` are then unchanged.
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
        for _ in 0..newton_iterations {
            infos.push(self.newton_target(&iterate, prescribed, keyframes, &mut target)?);
            iterate.copy_from_slice(&target);
        }
        for ((x, v), end) in x.iter_mut().zip(v).zip(&iterate) {
            *v = (end - *x) / dt;
            *x = *end;
        }
        Ok(infos)
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

    fn check_finite(&self, array: &'static str, entry: impl Fn(usize) -> Vector) -> Result<(), StepError> {
        let wrong = (0..self.model.vertex_count()).find(|&v| !entry(v).iter().all(|c| c.is_finite()));
        match wrong {
            None => Ok(()),
            Some(vertex) => {
                Err(StepError::NonFinite { array, vertex, body: self.model.body_name(vertex).to_owned() })
            }
        }
    }
}

/// A Newton iteration from `work.x` to `work.trial`, and as many to correct it as it takes.
///
/// Where the quadratic model is poor, its minimum is far from that of the potential: left there, stiff bodies
/// that turn lose most of their motion. A good step after a poor one may only have restored lengths.
/// What a straw gains by turning is little beside the stretch that a step restores, so that the promise says
/// nothing about it: strands look at the next step.
fn approach(
    model: &DynamicsModel,
    params: &DynamicsParams,
    repulsion: &mut Repulsion,
    step: &mut Step,
    work: &mut Workspace,
) -> NewtonInfo {
    let mut info = iterate(model, params, repulsion, step, work);
    let mut arrived = info.agreement >= AGREEMENT && !model.has_strands();
    let start = if arrived { Vec::new() } else { work.x.clone() };
    while !arrived && info.iterations <= params.correcting_iterations {
        let shortened = (info.step_length < 1.0).then(|| (work.trial.clone(), info));
        if shortened.is_some() {
            work.take_full_step();
        }
        work.start_from_trial();
        let mut next = iterate(model, params, repulsion, step, work);
        match shortened {
            Some((trial, before)) if next.energy_after >= before.energy_after => {
                work.trial.copy_from_slice(&trial);
                work.start_from_trial();
                info.add(&next);
                next = iterate(model, params, repulsion, step, work);
            }
            _ => {}
        }
        info.add(&next);
        let moved = largest_distance(&work.trial, &start, &work.free);
        let small = next.max_displacement <= SMALL_CORRECTION * moved;
        let vain = next.energy_before - next.energy_after <= VAIN_DECREASE * next.energy_before.abs();
        arrived = info.agreement >= AGREEMENT && small || vain;
    }
    info
}

/// The same with springs: contacts are guessed, and the guess is improved by what it led to.
///
/// A spring that pulls, wrongly, can only do so within this bound: the potential without springs must not be above where it
/// started, but by what pressed springs had stored, so that no energy comes from them (a target of implicit Euler keeps V + kinetic energy below those before).
/// Where it is, the target is made without them.
fn approach_contacts(
    model: &DynamicsModel,
    params: &DynamicsParams,
    repulsion: &mut Repulsion,
    step: &mut Step,
    work: &mut Workspace,
) -> NewtonInfo {
    let (start, imposed) = (work.x.clone(), work.imposed.clone());
    let without = |step: &Step, free: &[bool], x: &[Vector]| {
        potential(model, params, &Repulsion::default(), step, free, x)
    };
    let mut placed = start.clone();
    add_scaled(&mut placed, 1.0, &imposed);
    let (before, scale) = without(step, &work.free, &placed);

    let mut info = approach(model, params, repulsion, step, work);
    work.least_scale = work.cg.scale();
    for _ in 0..SETTLING_ITERATIONS {
        if repulsion.settle(&work.trial) <= SETTLED {
            break;
        }
        work.start_from_trial();
        info.add(&iterate(model, params, repulsion, step, work));
    }
    work.least_scale = 0.0;
    let after = without(step, &work.free, &work.trial).0;
    let gains_nothing = after <= before + repulsion.stored_energy(&placed) + NO_GAIN * scale;
    if !gains_nothing {
        work.x.copy_from_slice(&start);
        work.imposed.copy_from_slice(&imposed);
        repulsion.let_go();
        info.add(&approach(model, params, repulsion, step, work));
    }
    info
}

/// The Newton iteration by node: from `work.x` to `work.trial`.
fn iterate(
    model: &DynamicsModel,
    params: &DynamicsParams,
    repulsion: &mut Repulsion,
    step: &mut Step,
    work: &mut Workspace,
) -> NewtonInfo {
    linearise(model, params, step, work);
    if !repulsion.is_empty() {
        if std::mem::take(&mut step.fresh) {
            let end = |n: usize| if work.free[n] { step.inertial[n] } else { work.x[n] + work.imposed[n] };
            let predicted: Vec<Vector> = (0..work.x.len()).map(end).collect();
            repulsion.stiffen(&work.values.diagonal, &work.free, &predicted);
        }
        repulsion.linearise(&work.x);
        let gradient = work.gradient.par_iter_mut().enumerate().with_min_len(CHUNK);
        gradient.for_each(|(node, gradient)| *gradient += repulsion.gradient(node));
    }
    let repulsion = &*repulsion;

    // b = -(g + H p) over free nodes, p the imposed displacement of the prescribed ones.
    let system = System {
        pattern: &model.pattern,
        values: &work.values,
        scalar: &step.scalar,
        repulsion: (!repulsion.is_empty()).then_some(repulsion),
        free: &work.free,
    };
    system.multiply(&work.imposed, &mut work.right_side);
    for ((b, g), &free) in work.right_side.iter_mut().zip(&work.gradient).zip(&work.free) {
        *b = if free { -(*b + g) } else { Vector::zeros() };
    }

    // Guesses: to where inertia leads, and to where the last target was. Near the solution of a step
    // the second is all but exact; in free flight the first is.
    let mut guess_count = 1;
    for node in 0..work.x.len() {
        let to =
            |target: &[Vector]| if work.free[node] { target[node] - work.x[node] } else { Vector::zeros() };
        work.guesses[0][node] = to(&step.inertial);
        if let Some(last) = &step.last_target {
            work.guesses[1][node] = to(last);
            guess_count = 2;
        }
    }
    let [inertia, last] = &work.guesses;
    let guesses: &[&[Vector]] = &[last.as_slice(), inertia.as_slice()][2 - guess_count..];
    work.preconditioner.build(&system, &work.x);
    let limits = Limits {
        tolerance: params.cg_tolerance,
        least_scale: work.least_scale,
        max_iterations: params.cg_max_iterations,
    };
    let mut info = NewtonInfo {
        iterations: 1,
        cg: cg::solve(
            &system,
            &mut work.preconditioner,
            &work.right_side,
            guesses,
            limits,
            &mut work.step,
            &mut work.cg,
        ),
        ..NewtonInfo::default()
    };
    let inertia = Inertia {
        per_mass: 1.0 / (step.dt * step.dt) + params.air_drag / step.dt,
        drag: step.drag.as_ref(),
        rate: 1.0 / step.dt,
    };
    restore_momentum(model, repulsion, &inertia, &work.free, work.cg.residual(), &mut work.step);
    search_line(model, params, repulsion, step, work, &mut info);
    info.max_displacement = largest_distance(&work.trial, &work.x, &work.free);
    info
}

/// Largest |y - x| over free nodes [m].
fn largest_distance(y: &[Vector], x: &[Vector], free: &[bool]) -> f64 {
    let distance = |((y, x), _): ((&Vector, &Vector), &bool)| (y - x).norm();
    y.iter().zip(x).zip(free).filter(|(_, free)| **free).map(distance).fold(0.0, f64::max)
}

/// Largest |y - x| over free nodes, x by vertex [m].
fn displacement(model: &DynamicsModel, y: &[Vector], free: &[bool], x: &[Point]) -> f64 {
    let distance = |node: usize| (y[node] - x[model.node_vertex[node] as usize].coords).norm();
    (0..y.len()).filter(|&node| free[node]).map(distance).fold(0.0, f64::max)
}

/// Fills gradient and H at `work.x`, but for repulsion.
fn linearise(model: &DynamicsModel, params: &DynamicsParams, step: &Step, work: &mut Workspace) {
    let motion = Motion { x: &work.x, start: &step.start, rate: 1.0 / step.dt };
    let filter = Filter::from(params.hessian_filter);
    let inertia = 1.0 / (step.dt * step.dt);
    let drag = params.air_drag / step.dt;

    // Every chunk gets the blocks of its own rows.
    let mut blocks = work.values.blocks.as_mut_slice();
    let mut rows = Vec::new();
    let chunks = work.gradient.chunks_mut(CHUNK).zip(work.values.diagonal.chunks_mut(CHUNK));
    for (chunk, (gradient, diagonal)) in chunks.enumerate() {
        let nodes = chunk * CHUNK..chunk * CHUNK + gradient.len();
        let first_block = model.pattern.starts[nodes.start] as usize;
        let end_block = model.pattern.starts[nodes.end] as usize;
        let (mine, rest) = blocks.split_at_mut(end_block - first_block);
        blocks = rest;
        rows.push(Rows { nodes, gradient, diagonal, blocks: mine, first_block });
    }
    rows.into_par_iter().enumerate().for_each(|(chunk, mut rows)| {
        let near = &step.scalar.near[rows.first_block..];
        for (block, &value) in rows.blocks.iter_mut().zip(near) {
            *block = Matrix3::from_diagonal_element(value);
        }
        for (row, node) in rows.nodes.clone().enumerate() {
            let mass = model.node_masses[node];
            let (x, start) = (motion.x[node], motion.start[node]);
            rows.diagonal[row] =
                Matrix3::from_diagonal_element(mass * (inertia + drag) + step.scalar.diagonal[node]);
            rows.gradient[row] = (x - step.inertial[node]) * (mass * inertia)
                + (x - start) * (mass * drag)
                + model.bending.product(node, motion.x);
            if let Some(damping) = &model.bending_damping {
                rows.gradient[row] +=
                    (damping.product(node, motion.x) - damping.product(node, motion.start)) * motion.rate;
            }
            if let Some(drag) = &step.drag {
                rows.diagonal[row] += drag.matrix[node] * motion.rate;
                rows.gradient[row] += drag.matrix[node] * (x - start) * motion.rate - drag.push[node];
            }
        }
        for family in &model.families {
            family.linearise(chunk, motion, filter, &mut rows);
        }
    });
}

/// Incremental potential at `x`, and the size of its largest term: what rounding is relative to.
fn potential(
    model: &DynamicsModel,
    params: &DynamicsParams,
    repulsion: &Repulsion,
    step: &Step,
    free: &[bool],
    x: &[Vector],
) -> (f64, f64) {
    let motion = Motion { x, start: &step.start, rate: 1.0 / step.dt };
    let inertia = 0.5 / (step.dt * step.dt);
    let drag = 0.5 * params.air_drag / step.dt;
    let chunks = x.len().div_ceil(CHUNK);
    let partial: Vec<[f64; 2]> = (0..chunks)
        .into_par_iter()
        .map(|chunk| {
            let mut kinetic = 0.0;
            for node in chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()) {
                if free[node] {
                    let share = inertia * (x[node] - step.inertial[node]).norm_squared()
                        + drag * (x[node] - step.start[node]).norm_squared();
                    kinetic += model.node_masses[node] * share;
                    if let Some(drag) = &step.drag {
                        let moved = x[node] - step.start[node];
                        kinetic +=
                            moved.dot(&(drag.matrix[node] * moved * (0.5 * motion.rate) - drag.push[node]));
                    }
                }
            }
            let elements: f64 = model.families.iter().map(|family| family.energy(chunk, motion)).sum();
            [kinetic, elements + model.bending.chunk_energy(chunk, x)]
        })
        .collect();
    let (mut kinetic, mut internal) = (0.0, 0.0);
    for [k, i] in partial {
        kinetic += k;
        internal += i;
    }
    if let Some(damping) = &model.bending_damping {
        let moved: Vec<Vector> = x.iter().zip(&step.start).map(|(x, x0)| x - x0).collect();
        internal += damping.energy(&moved) / step.dt;
    }
    internal += repulsion.energy(x);
    (kinetic + internal, kinetic.abs() + internal.abs())
}

/// Backtracking from the full Newton step; leaves the target in `work.trial`.
///
/// Prescribed nodes are at their keyframes from the first trial on: the line runs over free nodes
/// only, from the state with free nodes at x. The predicted decrease is that of the quadratic model
/// from there, p.b. Should no trial pass (the keyframes jump far, so that the model is poor), the
/// lowest is taken.
fn search_line(
    model: &DynamicsModel,
    params: &DynamicsParams,
    repulsion: &Repulsion,
    step: &Step,
    work: &mut Workspace,
    info: &mut NewtonInfo,
) {
    let place = |work: &mut Workspace, length: f64| {
        work.trial.copy_from_slice(&work.x);
        add_scaled(&mut work.trial, 1.0, &work.imposed);
        add_scaled(&mut work.trial, length, &work.step);
    };
    place(work, 0.0);
    let (before, scale) = potential(model, params, repulsion, step, &work.free, &work.trial);
    info.energy_before = before;
    let predicted = dot(&work.step, &work.right_side);
    // Maxima are the same in any order.
    let largest = |values: &[Vector]| values.iter().map(|v| v.amax()).fold(0.0, f64::max);
    let accept =
        params.line_search_halvings == 0 || largest(&work.step) <= NEGLIGIBLE_STEP * largest(&work.x);
    let mut best = (f64::INFINITY, 1.0);
    let mut length = 1.0;
    for halving in 0..=params.line_search_halvings {
        place(work, length);
        let (energy, terms) = potential(model, params, repulsion, step, &work.free, &work.trial);
        if energy < best.0 {
            best = (energy, length);
        }
        let slack = ENERGY_ROUNDING * scale.max(terms);
        let passes = energy <= before - params.line_search_decrease * length * predicted + slack;
        if passes || accept {
            (info.energy_after, info.step_length) = (energy, length);
            let model = predicted * length * (1.0 - 0.5 * length);
            let kept = (before - energy) / model;
            info.agreement = if accept || model <= slack { 1.0 } else { length.min(kept).min(1.0 / kept) };
            return;
        }
        if halving < params.line_search_halvings {
            length *= 0.5;
        }
    }
    (info.energy_after, info.step_length) = best;
    place(work, best.1);
    tracing::debug!(step_length = best.1, "no trial of the line search decreased the energy enough");
}

#[cfg(test)]
#[path = "dynamics_tests.rs"]
mod tests;
