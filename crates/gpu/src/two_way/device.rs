//! The collision stage on a device.

use super::error::GpuResolveError;
use super::judge::SceneJudge;
use super::{flight, pairs, setup};
use crate::{Call, Carried, Collision, ContactRow, End, Engine, Grid, Phase, PhaseSeconds, StepReport, Stop};
use bowknot_dynamics::DeviceWork;
use bowknot_geometry::{BodyFilter, HalfSpace, Identity, Point};
use bowknot_twoway::{
    AcceptedState, Call as RunningCall, CallEnd, CallInput, CollisionScene, Observer, PairMultipliers,
    Processor, Progress, Residuals, ResolveInput, Resolver, Statistics, StopTest, max_stretch,
};
use rayon::prelude::*;
use std::fmt::Debug;
use std::ops::ControlFlow;

/// Vertices that one thread takes at least, in loops that do little for each.
const MIN_VERTICES: usize = 4096;

/// Share of the largest friction from which on a contact slides: single precision.
const SLIDES: f64 = 1.0 - 1e-5;

/// Moves `positions` from an intersection-free state toward `target` on an engine, as
/// [`Resolver::resolve_with`] does on the CPU. The state of the resolver becomes that of the call.
///
/// Statistics that the device does not compute are 0: colors, complementarity, and the seconds by stage if it
/// has no time stamps.
///
/// # Errors
/// [`GpuResolveError`]; `positions` are then unchanged.
pub fn resolve_on<E: Engine + Debug + Send>(
    engine: E,
    resolver: &mut Resolver,
    positions: &mut [Point],
    target: &[Point],
    input: &ResolveInput<'_>,
    observer: &mut dyn Observer,
) -> Result<Statistics, GpuResolveError> {
    let mut device = Device::new(String::new(), engine);
    device.prepare(resolver.scene(), positions)?;
    let mut end = positions.to_vec();
    let statistics = device.solve(resolver, &mut end, target, input, observer)?;
    device.judge.refuse_intersections(resolver.scene(), &end)?;
    positions.copy_from_slice(&end);
    Ok(statistics)
}

/// Resolves collisions on an engine.
#[derive(Debug)]
pub struct Device<E> {
    name: String,
    /// None while a scene has it.
    engine: Option<E>,
    prepared: Option<Prepared<E>>,
    judge: SceneJudge,
    /// Positions that the scene begins with [m]: the grid is made from them, so that a run that is resumed
    /// has the same.
    home: Vec<Point>,
    /// Positions by which the trees are ordered [m].
    order: Vec<Point>,
    /// Most steps that are submitted together.
    steps_per_submission: usize,
    /// Seconds of the device in the last call, if it has time stamps.
    device_seconds: Option<f64>,
}

/// Default of [`Device::set_steps_per_submission`].
const STEPS_PER_SUBMISSION: usize = 8;

/// A scene on the device.
#[derive(Debug)]
struct Prepared<E> {
    collision: Collision<E>,
    constraints: CallConstraints,
    /// The grid around the positions that the scene begins with.
    home_grid: Grid,
}

/// What a call may change of a scene.
#[derive(Debug)]
struct CallConstraints {
    /// The scene itself; what may change follows.
    scene: Identity,
    prescribed: Vec<bool>,
    groups: Vec<u32>,
    filters: Vec<BodyFilter>,
    half_spaces: Vec<HalfSpace>,
    /// Decides the sweeps.
    has_unknown: bool,
}

impl CallConstraints {
    fn new(scene: &CollisionScene, call: &CallInput, input: &ResolveInput<'_>) -> Self {
        Self {
            scene: scene.identity(),
            prescribed: call.prescribed().to_vec(),
            groups: input.groups.to_vec(),
            filters: scene.model().bodies().to_vec(),
            half_spaces: scene.model().half_spaces().to_vec(),
            has_unknown: call.has_unknown(),
        }
    }

    fn are_those_of(&self, scene: &CollisionScene, call: &CallInput, input: &ResolveInput<'_>) -> bool {
        self.scene == scene.identity()
            && self.prescribed == call.prescribed()
            && self.groups == input.groups
            && self.has_unknown == call.has_unknown()
            && self.filters == scene.model().bodies()
            && self.half_spaces == scene.model().half_spaces()
    }
}

impl<E: Engine + Debug + Send> Device<E> {
    /// Resolves on that engine, whose name goes to `summary.json`.
    pub fn new(name: String, engine: E) -> Self {
        Self {
            name,
            engine: Some(engine),
            prepared: None,
            judge: SceneJudge::default(),
            home: Vec::new(),
            order: Vec::new(),
            steps_per_submission: STEPS_PER_SUBMISSION,
            device_seconds: None,
        }
    }

    /// Submits at most `most` two-way steps together, 8 if this is not called. States are the same bits for
    /// any number. With an observer that sees each state it is 1.
    pub fn set_steps_per_submission(&mut self, most: usize) {
        self.steps_per_submission = most.max(1);
    }

    /// What runs the stages; none before a scene is prepared.
    pub fn engine(&self) -> Option<&E> {
        self.prepared.as_ref().map(|prepared| prepared.collision.engine())
    }

    /// Prepares for a scene that begins at `home` [m]; results depend on these positions.
    ///
    /// # Errors
    /// Settings of the scene that the kernels do not have.
    pub fn prepare(&mut self, scene: &CollisionScene, home: &[Point]) -> Result<(), GpuResolveError> {
        setup::refuse_unsupported(scene)?;
        self.home = home.to_vec();
        self.order = home.to_vec();
        self.judge = SceneJudge::default();
        self.release();
        Ok(())
    }

    /// Takes the engine back from a scene.
    fn release(&mut self) {
        if let Some(prepared) = self.prepared.take() {
            self.engine = Some(prepared.collision.into_engine());
        }
    }

    /// Prepares the scene with the constraints of a call, and room from `positions` to `ends` [m].
    fn prepare_call(
        &mut self,
        scene: &CollisionScene,
        call: &CallInput,
        input: &ResolveInput<'_>,
        positions: &[Point],
        ends: &[Point],
    ) -> Result<(), GpuResolveError> {
        let fits = |prepared: &Prepared<E>| {
            let grid = || prepared.home_grid.for_motion(positions, ends, scene.lengths().min_separation);
            prepared.constraints.are_those_of(scene, call, input)
                && grid().as_ref() == Some(prepared.collision.grid())
        };
        if !self.prepared.as_ref().is_some_and(fits) {
            self.release();
            let engine = self.engine.take().ok_or(GpuResolveError::NoEngine)?;
            let (collision, home_grid) =
                setup::collision(engine, scene, [&self.home, &self.order, positions, ends], call, input)?;
            let constraints = CallConstraints::new(scene, call, input);
            self.prepared = Some(Prepared { collision, constraints, home_grid });
        }
        Ok(())
    }

    fn solve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, GpuResolveError> {
        let mut running = RunningCall::new(resolver.scene(), input);
        let steps_per_submission = self.steps_per_submission;
        let scene = resolver.scene();
        let call = CallInput::new(scene, positions, target, input)?;
        let stop = running.stop();
        let ends =
            farthest_ends(scene, positions, target, stop.max_steps() as f64 * setup::longest_travel(scene));
        self.prepare_call(scene, &call, input, positions, &ends)?;
        let Self { prepared, judge, .. } = self;
        let collision = &mut prepared.as_mut().ok_or(GpuResolveError::NoEngine)?.collision;
        // Those of a call that failed.
        collision.take_phase_seconds();
        let start = place(collision, scene, positions, judge)?;
        let mut statistics = Statistics::default();
        let flown = fly(collision, scene, &call, [&start, target]).filter(|_| stop.max_steps() > 1);
        let speed = scene.lengths().separation_speed;
        let growth = input.time_step.map_or(f64::INFINITY, |dt| speed * dt);
        let slip_start = if call.slip_start().is_empty() { &start } else { call.slip_start() };
        // As on the CPU, pairs that meet after a flight carry nothing.
        let starts = if flown.is_none() { call.all_carried() } else { &[] };
        let carried: Vec<Carried> = starts.iter().filter_map(pairs::carried).collect();
        let (known, stop_rule) = (call.known(), rule(stop));
        let yielding: Vec<([u32; 2], f64)> =
            call.yielding().iter().map(|edge| (edge.vertices, edge.limit)).collect();
        let (carried, yielding) = (&carried[..], &yielding[..]);
        let previous = match &flown {
            Some(flown) => collision.place(flown)?,
            None => start.clone(),
        };
        collision.begin(&Call { target, growth, slip_start, known, carried, yielding, stop: stop_rule })?;
        let mut steps = Steps { collision, steps_per_submission, previous, reports: Vec::new() };
        let observed = flown.map_or(ControlFlow::Continue(()), |flown| {
            debug_assert_eq!(steps.previous, flown, "translations are multiples of the quantum");
            statistics.steps = 1;
            if observer.sees_each_state() {
                observer.accepted(&AcceptedState { step: 0, previous: &start, positions: &flown, target })
            } else {
                observer.advanced(1)
            }
        });
        if observed.is_continue() {
            running.run(&mut steps, observer, &mut statistics)?;
        }
        let collision = steps.collision;
        let End { positions: end, aims, rows, near } = collision.end()?;
        let phases = collision.take_phase_seconds();
        let quantum = collision.grid().quantum();
        note_friction(&mut statistics, &rows);
        [statistics.max_step_stretch, statistics.max_stretch] =
            max_stretch(scene, [&start, scene.rest()], &end);
        let pressing = rows.iter().filter(|row| row.multiplier > 0.0);
        let contacts: Vec<PairMultipliers> = pressing.filter_map(pairs::multipliers).collect();
        let near = near.and_then(|near| {
            let list = pairs::list(scene, &near);
            if list.is_none() {
                tracing::warn!("the device lists pairs that do not exist: the CPU searches in its place");
            }
            list
        });
        let call_end = CallEnd {
            start: &start,
            positions: &end,
            target,
            aims: &aims,
            contacts: &contacts,
            near: near.as_ref(),
        };
        resolver.adopt(&call_end, call, &mut statistics)?;
        if statistics.prescribed_lag_m <= quantum {
            // On the nearest point of the grid.
            statistics.prescribed_lag_m = 0.0;
        }
        positions.copy_from_slice(&end);
        if let Some(phases) = phases {
            statistics.seconds.search = phases.of(Phase::Search);
            statistics.seconds.evaluate = phases.of(Phase::Evaluate);
            statistics.seconds.backward = phases.of(Phase::Backward);
            statistics.seconds.forward = phases.of(Phase::Forward);
        }
        self.device_seconds = phases.as_ref().map(PhaseSeconds::total);
        statistics.seconds.total = running.seconds();
        Ok(statistics)
    }
}

impl<E: Engine + Debug + Send> Device<E> {
    /// What it is called where runs are described.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What its device was asked for since it was opened.
    pub fn work(&self) -> DeviceWork {
        let prepared = || self.prepared.as_ref().map(|prepared| prepared.collision.engine().work());
        self.engine.as_ref().map(Engine::work).or_else(prepared).unwrap_or_default()
    }

    /// Orders the trees of the search by these positions [m], until it is told others.
    ///
    /// # Errors
    /// The device has failed.
    pub fn order(&mut self, positions: &[Point]) -> Result<(), GpuResolveError> {
        if self.order == positions {
            return Ok(());
        }
        self.order = positions.to_vec();
        let ordered = match &mut self.prepared {
            Some(prepared) => prepared.collision.reorder(positions),
            None => Ok(()),
        };
        if ordered.is_err() {
            self.release();
        }
        Ok(ordered?)
    }

    /// Seconds of the device in the last call, if it has time stamps.
    pub fn device_seconds(&self) -> Option<f64> {
        self.device_seconds
    }

    /// How far positions may be off because they lie on a grid [m].
    pub fn resolution(&self) -> f64 {
        self.prepared.as_ref().map_or(0.0, |prepared| prepared.collision.grid().quantum())
    }

    /// As [`Resolver::resolve_with`], whose state becomes that of the call. Nobody may rely on the positions
    /// before they have been [judged](Self::judge).
    ///
    /// # Errors
    /// [`GpuResolveError`]; `positions` are then unchanged.
    pub fn resolve(
        &mut self,
        resolver: &mut Resolver,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, GpuResolveError> {
        let resolved = self.solve(resolver, positions, target, input, observer);
        if resolved.is_err() {
            // Some buffers may be gone, of which a larger one could not be had.
            self.release();
        }
        resolved
    }

    /// Judges positions [m] that calls have led to, by exact tests on the CPU.
    ///
    /// # Errors
    /// They intersect, or cannot be judged.
    pub fn judge(&mut self, scene: &CollisionScene, positions: &[Point]) -> Result<(), GpuResolveError> {
        self.judge.refuse_intersections(scene, positions)
    }
}

/// How far toward the target vertices can come [m] if they travel by `most` local edge lengths.
fn farthest_ends(scene: &CollisionScene, positions: &[Point], target: &[Point], most: f64) -> Vec<Point> {
    let end = |(v, (x, y)): (usize, (&Point, &Point))| -> Point {
        let (way, reach) = (y - x, most * scene.local_edge(v));
        let length = way.norm();
        if length > reach { x + way * (reach / length) } else { *y }
    };
    positions.par_iter().zip(target).enumerate().with_min_len(MIN_VERTICES).map(end).collect()
}

/// Puts the vertices on the grid and returns where they are [m]. Nothing may pass through on the way there:
/// each vertex moves by less than 0.87 quanta, so that gaps of two quanta stay open.
fn place<E: Engine>(
    collision: &mut Collision<E>,
    scene: &CollisionScene,
    positions: &[Point],
    judge: &mut SceneJudge,
) -> Result<Vec<Point>, GpuResolveError> {
    let start = collision.place(positions)?;
    if start != positions {
        let quantum = collision.grid().quantum();
        if !judge.is_open(scene, positions, 2.0 * quantum)? {
            return Err(GpuResolveError::TooTight { quantum });
        }
    }
    Ok(start)
}

/// Where the vertices are after a [flight](flight::fly) on the grid of the call.
fn fly<E: Engine>(
    collision: &Collision<E>,
    scene: &CollisionScene,
    call: &CallInput,
    course: [&[Point]; 2],
) -> Option<Vec<Point>> {
    let grid = collision.grid();
    let flown = flight::fly(scene, call, course, grid.quantum(), setup::longest_travel(scene));
    flown.filter(|flown| grid.has_room(flown))
}

/// The rule as the device decides by it.
fn rule(stop: &StopTest) -> Stop {
    stop.travel_limits().map_or(Stop::NEVER, |limits| Stop {
        distance: limits.remaining,
        unhindered: limits.unhindered,
        net_residual: limits.net_residual,
        mean_residual: limits.mean_residual,
        stretch_to_limit: limits.stretch_to_limit,
        finishing_steps: limits.finishing_steps,
    })
}

/// Steps of a device, several of them per submission.
struct Steps<'a, E> {
    collision: &'a mut Collision<E>,
    steps_per_submission: usize,
    /// Positions before the next step [m], for observers that see each state.
    previous: Vec<Point>,
    /// Of the last submission.
    reports: Vec<StepReport>,
}

impl<E: Engine> Processor for Steps<'_, E> {
    type Error = GpuResolveError;

    fn steps(
        &mut self,
        most: usize,
        observer: &mut dyn Observer,
        statistics: &mut Statistics,
    ) -> Result<(usize, ControlFlow<()>), GpuResolveError> {
        let sees_each_state = observer.sees_each_state();
        let most = most.min(if sees_each_state { 1 } else { self.steps_per_submission });
        self.reports = self.collision.steps(most)?;
        self.reports.iter().for_each(|report| note(statistics, report));
        let observed = if sees_each_state {
            let (positions, aims) = self.collision.positions_and_aims()?;
            let previous = std::mem::replace(&mut self.previous, positions);
            let (step, positions) = (statistics.steps, &self.previous);
            observer.accepted(&AcceptedState { step, previous: &previous, positions, target: &aims })
        } else {
            observer.advanced(self.reports.len())
        };
        Ok((self.reports.len(), observed))
    }

    fn report(&self, k: usize) -> bowknot_twoway::stepper::StepReport {
        let StepReport { remaining, largest_move, unhindered, unhindered_lag, .. } = self.reports[k];
        let others = bowknot_twoway::stepper::StepReport::default();
        bowknot_twoway::stepper::StepReport { remaining, largest_move, unhindered, unhindered_lag, ..others }
    }

    fn residuals(&mut self, k: usize) -> Residuals {
        let StepReport { net_residual, mean_residual, stretch_to_limit, .. } = self.reports[k];
        Residuals { net_residual, mean_residual, stretch_to_limit }
    }

    fn is_free(&self, k: usize) -> bool {
        self.reports[k].pressing == 0
    }

    fn progress(&self, k: usize, of: Progress) -> f64 {
        let report = &self.reports[k];
        match of {
            Progress::Lag => report.lag,
            Progress::Remaining => report.free_remaining,
            Progress::Move => report.free_move,
        }
    }
}

fn note(statistics: &mut Statistics, report: &StepReport) {
    statistics.searches += usize::from(report.searched);
    statistics.skipped.searches += usize::from(!report.searched);
    statistics.pairs = report.candidates;
    statistics.contact_rows = report.contact_rows;
    statistics.active_rows = report.pressing;
    statistics.frozen_pairs += report.frozen;
    statistics.net_residual_m = report.net_residual;
}

/// Which contacts stick and slide. Slip is that before the last step.
fn note_friction(statistics: &mut Statistics, rows: &[ContactRow]) {
    for row in rows.iter().filter(|row| row.coefficient > 0.0) {
        statistics.friction_rows += 1;
        let largest = row.coefficient * row.multiplier;
        if largest > 0.0 && row.friction.norm() >= SLIDES * largest {
            statistics.sliding_contacts += 1;
        } else if largest > 0.0 {
            statistics.sticking_contacts += 1;
            statistics.sticking_slip_m = statistics.sticking_slip_m.max(row.slip.norm());
        }
    }
}
