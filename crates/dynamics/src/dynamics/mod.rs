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

mod conservation;
mod newton;

pub use conservation::Touching;

use crate::drag::DragSurfaces;
use crate::linear::block::BlockValues;
use crate::linear::cg::{CgInfo, CgWorkspace};
use crate::linear::preconditioner::Preconditioner;
use crate::model::NO_NODE;
use crate::repulsion::Repulsion;
use crate::{DynamicsModel, DynamicsParams, ParamsError, RepulsionSpring, StepError};
use bowknot_geometry::{Point, Vector};
use newton::{Known, Newton, Step, Workspace};
use serde::Serialize;

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

    /// By how much the potential fell [J].
    fn decrease(&self) -> f64 {
        self.energy_before - self.energy_after
    }
}

/// How far a state is from solving the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Residual {
    /// Root of the sum of squares of the forces on free nodes that do not balance [N].
    pub force: f64,
    /// The distance that this is worth [m]: the largest sqrt(dt^2 r . P r / M) of a connected component, with r the forces, P the
    /// preconditioner of the Newton system without contacts and M the mass. As H is at least M / dt^2, this bounds the root
    /// mean square distance, weighted by mass, to where the forces would balance, up to the quality of P.
    pub distance: f64,
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
            known: Known::default(),
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
        if let Some(step) = &mut self.step {
            step.fresh = true;
            self.repulsion.anchor(&step.positions);
        }
        Ok(())
    }

    /// Forces of the springs at the last target, on the side that the normal points to [N]; one entry per spring.
    pub fn contact_forces(&self) -> Vec<Vector> {
        self.repulsion.forces(&self.work.trial)
    }

    /// Where inertia alone leads from the start of the step, by vertex [m]; obstacles stay.
    pub fn inertial_positions(&self) -> Vec<Point> {
        let Some(step) = &self.step else { return Vec::new() };
        let mut positions = step.positions.clone();
        for (node, &vertex) in self.model.node_vertex.iter().enumerate() {
            positions[vertex as usize] = Point::from(step.inertial[node]);
        }
        positions
    }

    /// What is missing to a solution of the step at `x` [m], with the springs' carried forces for contact forces.
    /// Prescribed vertices and obstacles are where they are. Only forces on vertices that are `counted` matter: what holds
    /// others may be unknown here. All slices have one entry per vertex.
    ///
    /// # Errors
    /// Wrong lengths, entries that are not finite, no step begun.
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
        let Some(mut step) = self.step.take() else { return Err(StepError::NotBegun) };
        self.start_from(x, prescribed);
        let work = &mut self.work;
        let (model, params, repulsion) = (&self.model, &self.params, &mut self.repulsion);
        let residual =
            rayon::scope(|_| Newton { model, params, repulsion, step: &mut step, work }.residual(&counted));
        self.step = Some(step);
        Ok(residual)
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
        step.velocities.clear();
        step.velocities.extend(model.node_vertex.iter().map(|&v| v0[v as usize]));
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
            surfaces.fill(&self.params, &step.start, &step.velocities, step.drag.get_or_insert_default());
        }
        step.dt = dt;
        step.last_target = None;
        self.work.least_scale = 0.0;
        self.work.known.clear();
        step.most = None;
        step.fresh = true;
        step.positions.clear();
        step.positions.extend_from_slice(x0);
        self.repulsion.anchor(x0);
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

        self.start_from(x, prescribed);
        let work = &mut self.work;
        for (node, &vertex) in self.model.node_vertex.iter().enumerate() {
            let vertex = vertex as usize;
            work.imposed[node] =
                if prescribed[vertex] { keyframes[vertex] - x[vertex] } else { Vector::zeros() };
        }
        // From inside of the thread pool a parallel loop is a push on a local queue; from outside every
        // one of the thousands to come would put this thread to sleep and wake it (20 times the CPU
        // time on a busy machine, at 1,700 nodes).
        self.repulsion.place_obstacles(keyframes);
        let repulsion = &mut self.repulsion;
        let mut info = rayon::scope(|_| {
            Newton { model: &self.model, params: &self.params, repulsion, step: &mut step, work }.reach()
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
    /// `v` move on by `dt`, see [`Self::end_velocities`]. Prescribed vertices end at their `keyframes` and move at the
    /// velocity that takes them there.
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
        self.end_velocities(&iterate, prescribed, &Touching::default(), v);
        x.copy_from_slice(&iterate);
        Ok(infos)
    }

    /// Takes the state that an iteration starts from, by node.
    fn start_from(&mut self, x: &[Point], prescribed: &[bool]) {
        let work = &mut self.work;
        for (node, &vertex) in self.model.node_vertex.iter().enumerate() {
            work.x[node] = x[vertex as usize].coords;
            let free = !prescribed[vertex as usize];
            if std::mem::replace(&mut work.free[node], free) != free {
                work.known.clear();
            }
        }
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

/// Largest |y - x| over free nodes, x by vertex [m].
fn displacement(model: &DynamicsModel, y: &[Vector], free: &[bool], x: &[Point]) -> f64 {
    let distance = |node: usize| (y[node] - x[model.node_vertex[node] as usize].coords).norm();
    (0..y.len()).filter(|&node| free[node]).map(distance).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
