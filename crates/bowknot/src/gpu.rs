//! Collision problems on a GPU: scenes as the CPU knows them, solved by `bowknot-gpu`.
//!
//! The device takes the same two-way steps and stops by the same rule. Its sweeps make no coarse corrections, so that it may
//! take other steps than the CPU. Positions lie on a grid, see [`bowknot_gpu::Grid`].

use bowknot_check::{CheckError, Intersection, Judge, StateOptions, StateReport};
use bowknot_constraints::{ContactForm, EdgeForm, EdgeReference, FrictionModel};
use bowknot_errors::counted;
use bowknot_geometry::Point;
use bowknot_gpu::{Call, Collision, CollisionError, Constraints, Engine, Lengths, Settings};
use bowknot_stepper::{Bound, StepReport, TrustRegionRule};
use bowknot_twoway::{
    CallInput, CollisionScene, Residuals, ResolveError, ResolveInput, Statistics, StopRule, StopTest,
    max_stretch,
};
use std::time::Instant;

pub use bowknot_gpu::{Adapter, ComparingEngine, DeviceEngine, GpuError, TwinEngine};

/// Why a collision problem was not solved on a device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GpuResolveError {
    /// A setting that the device does not have.
    #[error("{what} is not available on a GPU: use --backend cpu{}", remedy(.instead))]
    Unsupported {
        /// The key and its value.
        what: String,
        /// What the device has in its place, if anything.
        instead: Option<&'static str>,
    },
    /// The input is refused, as on the CPU.
    #[error(transparent)]
    Input(#[from] ResolveError),
    /// The device failed, or has no room for the scene.
    #[error(transparent)]
    Collision(#[from] CollisionError),
    /// The start cannot be judged.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// On the grid of the device the start intersects.
    #[error(
        "the start intersects on the grid of the device, of {quantum:e} m: gaps are smaller than that. Use --backend cpu"
    )]
    TooTight {
        /// The distance of neighboring points of the grid [m].
        quantum: f64,
    },
    /// The device computed a state that intersects: its driver does not compute what it should.
    #[error(
        "{} in the state that the device computed, which was thrown away: {first}. Its driver does not compute what it \
         should. Use --backend cpu, and report this with the output of `bowknot info --gpus`",
        counted(*count, "pair intersects", "pairs intersect")
    )]
    Intersects {
        /// Pairs that intersect.
        count: usize,
        /// The first of them.
        first: Box<Intersection>,
    },
}

fn remedy(instead: &Option<&'static str>) -> String {
    instead.map_or_else(String::new, |instead| format!(" or {instead}"))
}

/// Moves `positions` from an intersection-free state toward `target` on an engine, as
/// [`bowknot_twoway::Resolver::resolve_with`] does on the CPU. `go_on` is asked after each step.
///
/// Statistics that the device does not compute are 0: colors, slip, stages.
///
/// # Errors
/// [`GpuResolveError`]; `positions` are then unchanged.
pub fn resolve_on<E: Engine>(
    engine: E,
    scene: &CollisionScene,
    positions: &mut [Point],
    target: &[Point],
    input: &ResolveInput<'_>,
    go_on: &mut dyn FnMut() -> bool,
) -> Result<Statistics, GpuResolveError> {
    let timer = Instant::now();
    refuse_unsupported(scene)?;
    let call = CallInput::new(scene, positions, target, input)?;
    let mut collision = collision(engine, scene, positions, &call, input)?;
    let judge = Judge::from_model(scene.model());
    let on_grid = collision.positions()?;
    if !judge.check_state(&on_grid, &StateOptions { limit: 0, distance: false })?.is_clear() {
        return Err(GpuResolveError::TooTight { quantum: collision.grid().quantum() });
    }
    let speed = scene.lengths().separation_speed;
    let growth = input.time_step.map_or(f64::INFINITY, |dt| speed * dt);
    collision.begin(&Call { target, growth, slip_start: call.slip_start() })?;

    let edge = scene.lengths().edge;
    let mut stop = StopTest::new(&scene.params().solver.stop, edge, input.time_step, input.max_steps);
    let mut statistics = Statistics::default();
    while stop.allows_step(statistics.steps) {
        let report = collision.step()?;
        note(&mut statistics, &report);
        let as_step = StepReport {
            remaining: report.remaining,
            largest_move: report.largest_move,
            unhindered: report.unhindered,
            unhindered_lag: report.unhindered_lag,
            ..StepReport::default()
        };
        statistics.converged = stop.is_met(&as_step, || Residuals {
            net_residual: report.net_residual,
            mean_residual: report.mean_residual,
            stretch_to_limit: report.stretch_to_limit,
        });
        if statistics.converged
            && stop.takes_finishing_step(&as_step, statistics.steps, || report.pressing == 0)
        {
            statistics.converged = false;
        }
        if statistics.converged || stop.is_out_of_time(timer.elapsed().as_secs_f64()) || !go_on() {
            break;
        }
    }
    let end = collision.positions()?;
    let mut state = judge.check_state(&end, &StateOptions { limit: 1, distance: true })?;
    if let Some(first) = state.intersections.pop() {
        return Err(GpuResolveError::Intersects { count: state.intersection_count, first: Box::new(first) });
    }
    finish(&mut statistics, scene, &call, [positions, &end, target], &state, collision.grid().quantum());
    positions.copy_from_slice(&end);
    statistics.seconds.total = timer.elapsed().as_secs_f64();
    Ok(statistics)
}

/// The scene on the engine, at `positions`.
fn collision<E: Engine>(
    engine: E,
    scene: &CollisionScene,
    positions: &[Point],
    call: &CallInput,
    input: &ResolveInput<'_>,
) -> Result<Collision<E>, CollisionError> {
    let (model, params) = (scene.model(), scene.params());
    let vertices = 0..scene.vertex_count();
    let body = |v: usize| model.vertex_body()[v];
    let contact = |v: usize| &scene.contact().bodies()[body(v) as usize];
    let limit = |[a, b]: &[u32; 2]| {
        let rest = (scene.rest()[*a as usize] - scene.rest()[*b as usize]).norm();
        let limits = params.contact.edges;
        if limits { scene.stretch_limit(body(*a as usize)) * rest } else { f64::INFINITY }
    };
    let has_friction = scene.friction_model() != FrictionModel::None;
    let of_vertices = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { vertices.clone().map(value).collect() };
    let frictions = if has_friction { of_vertices(&|v| contact(v).friction) } else { Vec::new() };
    let half_space_frictions: Vec<f64> = scene.contact().half_spaces().iter().map(|h| h.friction).collect();
    let lengths = Lengths {
        edges: &of_vertices(&|v| scene.local_edge(v)),
        margins: &of_vertices(&|v| scene.spacing().margin(body(v))),
        deltas: &of_vertices(&|v| scene.spacing().delta(body(v))),
        thicknesses: &of_vertices(&|v| contact(v).thickness.unwrap_or(f64::NAN)),
        min_separation: scene.lengths().min_separation,
        edge_limits: &model.topology().edges.iter().map(limit).collect::<Vec<f64>>(),
    };
    let constraints = Constraints {
        prescribed: call.prescribed(),
        groups: input.groups,
        masses: &of_vertices(&|v| scene.relative_mass(v)),
        frictions: &frictions,
        half_space_frictions: &half_space_frictions,
    };
    let backward = &params.solver.backward;
    let settings = Settings {
        sweeps: backward.sweeps,
        polish_sweeps: backward.polish_sweeps,
        polish_distance: backward.polish_distance * scene.lengths().edge,
        polish_stretch: 1.0 + 0.5 * params.solver.stop.stretch_tolerance,
        edge_proximal: backward.edge_proximal,
        contact_proximal: backward.contact_proximal,
        proximal_growth: backward.proximal_growth,
        range: params.contact.range,
        active: params.contact.active,
        contacts_only: params.contact.contacts_only,
        damping: params.solver.forward.damping,
    };
    Collision::new(engine, model, positions, scene.rest(), &lengths, &constraints, &settings)
}

/// Refuses what the kernels do not have.
fn refuse_unsupported(scene: &CollisionScene) -> Result<(), GpuResolveError> {
    const FAST: Option<&str> = Some("--preset fast");
    let params = scene.params();
    let (contact, solver) = (&params.contact, &params.solver);
    let filter = scene.friction_model() == FrictionModel::Filter;
    let thick_half_space = scene.contact().half_spaces().iter().any(|h| h.thickness.is_some());
    let refused = [
        (contact.form != ContactForm::Gap, "contact.form other than \"gap\"", FAST),
        (filter, "contact.friction_model = \"filter\"", FAST),
        (contact.edge_form != EdgeForm::Ball, "contact.edge_form other than \"ball\"", FAST),
        (contact.edge_reference != EdgeReference::Rest, "contact.edge_reference other than \"rest\"", FAST),
        (!solver.backward.active_rows, "solver.backward.active_rows = false", FAST),
        (solver.forward.bound != Bound::Planes, "solver.forward.bound other than \"planes\"", FAST),
        (
            solver.forward.trust_region != TrustRegionRule::PerVertex,
            "solver.forward.trust_region other than \"per-vertex\"",
            FAST,
        ),
        (!matches!(solver.stop.rule, StopRule::Travel { .. }), "solver.stop.rule = \"clock\"", FAST),
        (scene.contact().has_pair_friction(), "friction of a pair of bodies", None),
        (thick_half_space, "the thickness of a half-space", None),
        (scene.lengths().min_separation == 0.0, "contact.min_separation = 0", None),
    ];
    match refused.into_iter().find(|(refused, ..)| *refused) {
        Some((_, what, instead)) => Err(GpuResolveError::Unsupported { what: what.to_owned(), instead }),
        None => Ok(()),
    }
}

fn note(statistics: &mut Statistics, report: &bowknot_gpu::StepReport) {
    statistics.steps += 1;
    statistics.searches += usize::from(report.searched);
    statistics.skipped.searches += usize::from(!report.searched);
    statistics.pairs = report.candidates;
    statistics.contact_rows = report.contact_rows;
    statistics.active_rows = report.pressing;
    statistics.frozen_pairs += report.frozen;
    statistics.remaining_m = report.remaining;
    statistics.net_residual_m = report.net_residual;
}

/// What is known at the end. A prescribed vertex is at its target if it is on the nearest point of the grid.
fn finish(
    statistics: &mut Statistics,
    scene: &CollisionScene,
    call: &CallInput,
    [start, end, target]: [&[Point]; 3],
    state: &StateReport,
    quantum: f64,
) {
    let (mut sum, mut free) = (0.0, 0usize);
    for v in 0..end.len() {
        let distance = (end[v] - target[v]).norm();
        if call.is_movable(v) {
            sum += distance * distance;
            free += 1;
        } else if distance > quantum {
            statistics.prescribed_lag_m = statistics.prescribed_lag_m.max(distance);
        }
    }
    statistics.distance_to_target_m = (sum / free.max(1) as f64).sqrt();
    statistics.min_gap_m = state.nearest.as_ref().map(|nearest| nearest.distance);
    [statistics.max_step_stretch, statistics.max_stretch] = max_stretch(scene, [start, scene.rest()], end);
}
