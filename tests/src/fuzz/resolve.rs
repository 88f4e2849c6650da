//! For any meshes and targets, no accepted state of `resolve` intersects, and no path between two accepted
//! states does.

use super::Draw;
use crate::{Case, StepChecker};
use bowknot::check::{Judge, StateOptions};
use bowknot::gpu::{GpuResolveError, TwinEngine, resolve_on};
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{AcceptedState, Observer, Params, ResolveInput, Resolver, Statistics};
use std::ops::ControlFlow;

/// Largest number of bodies.
const BODIES: usize = 4;
/// Largest number of vertices of a body.
const VERTICES: usize = 7;
/// Largest coordinate and rest length up to which nothing may intersect [m]. The search treats coordinates
/// beyond 1e15 m as not finite; beyond this limit the test only requires that nothing panics.
const JUDGED: f64 = 1e14;
/// Largest number of two-way steps.
const STEPS: usize = 8;

/// Draws up to four small bodies of triangles, strands and particles, obstacles among them, and any targets.
/// `resolve` does not panic, every state and path that it accepts is free of intersections, and a refused
/// call does not change the positions.
pub fn resolve(data: &[u8]) -> bool {
    let solve = |problem: &Problem, resolver: &mut Resolver, x: &mut [Point], observer: &mut dyn Observer| {
        resolver.resolve_with(x, &problem.targets, &problem.input(), observer)
    };
    solves(data, solve)
}

/// The same with the twins of the kernels.
pub fn resolve_on_twins(data: &[u8]) -> bool {
    let solve = |problem: &Problem, resolver: &mut Resolver, x: &mut [Point], observer: &mut dyn Observer| {
        let solved = resolve_on(TwinEngine::new(), resolver, x, &problem.targets, &problem.input(), observer);
        solved.inspect_err(|error| assert!(!matches!(error, GpuResolveError::Intersects { .. }), "{error}"))
    };
    solves(data, solve)
}

/// Whether the bytes are a problem that `solve` takes.
fn solves<E>(
    data: &[u8],
    solve: impl FnOnce(&Problem, &mut Resolver, &mut [Point], &mut dyn Observer) -> Result<Statistics, E>,
) -> bool {
    let Some(problem) = Problem::draw(&mut Draw::new(data)) else { return false };
    let Problem { case, params, rest, masses, .. } = &problem;
    let Ok(mut resolver) = Resolver::new(case.model.clone(), rest, masses, params.clone()) else {
        return false;
    };
    let mut x = case.positions.clone();
    let taken = run(&problem, &mut x, |x, observer| solve(&problem, &mut resolver, x, observer)).is_ok();
    assert!(taken || x == problem.case.positions, "a refused call has moved the positions");
    taken
}

/// A small collision problem whose start is free of intersections.
struct Problem {
    case: Case,
    params: Params,
    rest: Vec<Point>,
    masses: Vec<f64>,
    pinned: Vec<bool>,
    time_step: Option<f64>,
    targets: Vec<Point>,
}

impl Problem {
    fn draw(draw: &mut Draw<'_>) -> Option<Self> {
        let presets = [Params::fast, Params::fast, Params::quick, Params::paper];
        let mut params = presets[draw.below(4)]();
        params.solver.stop.max_steps = Some(1 + draw.below(STEPS));
        if draw.below(2) == 0 {
            params.contact.min_separation = draw.pick(&[0.0, 1e-9, 1e-6, 1e-3]);
        }
        let case = case(draw)?;
        let start = &case.positions;
        let judge = Judge::from_model(&case.model);
        let report = judge.check_state(start, &StateOptions { limit: 1, distance: false });
        if !report.is_ok_and(|report| report.is_clear()) {
            return None;
        }
        let targets = targets(draw, start);
        let rest = if draw.below(4) == 0 { targets.clone() } else { start.clone() };
        let masses: Vec<f64> = start.iter().map(|_| mass(draw)).collect();
        let pinned: Vec<bool> = start.iter().map(|_| draw.rarely(40)).collect();
        let time_step = draw.pick(&[None, Some(0.05), Some(1e-4)]).flatten();
        Some(Self { case, params, rest, masses, pinned, time_step, targets })
    }

    fn input(&self) -> ResolveInput<'_> {
        ResolveInput { prescribed: &self.pinned, time_step: self.time_step, ..ResolveInput::default() }
    }
}

/// Solves the problem and judges all states and paths on the way.
fn run<E>(
    problem: &Problem,
    x: &mut [Point],
    solve: impl FnOnce(&mut [Point], &mut dyn Observer) -> Result<Statistics, E>,
) -> Result<(), E> {
    let Problem { case, rest, targets, .. } = problem;
    let mut checker = StepChecker::new(case);
    let is_judged = targets.iter().chain(rest).all(|p| p.coords.amax() < JUDGED);
    let mut last = x.to_vec();
    let mut observer = |state: &AcceptedState<'_>| {
        // A device may round the start.
        let follows = state.step == 0 || state.previous == last;
        assert!(follows, "step {} does not start where the last one ended", state.step);
        last.copy_from_slice(state.positions);
        assert!(state.positions.iter().all(|p| p.iter().all(|c| c.is_finite())), "a position is not finite");
        if !is_judged || checker.check_step(state.previous, state.positions) {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let statistics = solve(x, &mut observer)?;
    assert!(checker.fault.is_none(), "{:?}", checker.fault);
    assert!(x == last, "the result is not the last accepted state");
    assert!(statistics.remaining_m >= 0.0 && statistics.remaining_r >= 0.0, "{statistics:?}");
    Ok(())
}

/// Small bodies on a coarse grid, most of them apart from each other; `None` if the elements are refused.
fn case(draw: &mut Draw<'_>) -> Option<Case> {
    let (scale, origin) = (draw.power(12), draw.pick(&[0.0, 0.0, 1e3, -1e6])?);
    let mut positions = Vec::new();
    let (mut triangles, mut strands, mut particles) = (Vec::new(), Vec::new(), Vec::new());
    let (mut vertex_body, mut bodies) = (Vec::new(), Vec::new());
    for body in 0..1 + draw.below(BODIES) as u32 {
        bodies.push(filter(draw));
        let first = positions.len() as u32;
        let count = 1 + draw.below(VERTICES) as u32;
        // Each body has a height of its own, so bodies usually start apart.
        let height = draw.pick(&[0.0, 0.01, 0.25, 1.0])? * f64::from(body);
        let flatness = draw.pick(&[0.0, 0.05, 1.0])?;
        for _ in 0..count {
            let p = Vector::new(draw.grid(), draw.grid(), height + flatness * draw.grid());
            positions.push(Point::from(scale * p + origin * Vector::x()));
            vertex_body.push(body);
        }
        let shape = draw.below(4);
        let mut vertex = || first + draw.below(count as usize) as u32;
        match shape {
            // Consecutive vertices make a strip. With so few vertices it rarely intersects itself.
            0 | 1 => triangles.extend((2..count).map(|v| [first + v - 2, first + v - 1, first + v])),
            2 => strands.extend((1..count).map(|v| [first + v - 1, first + v])),
            _ => triangles.push([vertex(), vertex(), vertex()]),
        }
        particles.extend((0..count).map(|v| first + v));
    }
    let half_spaces = match draw.below(3) {
        0 => HalfSpace::new(Point::new(0.0, 0.0, -2.5 * scale), Vector::z()).into_iter().collect(),
        1 => {
            let normal = Vector::new(draw.grid(), draw.grid(), draw.grid());
            HalfSpace::new(Point::from(origin * Vector::x() - 4.0 * scale * normal), normal)
                .into_iter()
                .collect()
        }
        _ => Vec::new(),
    };
    let topology = Topology::builder(positions.len())
        .triangles(triangles)
        .strand_edges(strands.iter().copied())
        .particles(particles.iter().copied())
        .build()
        .ok()?;
    let model = CollisionModel::new(topology, vertex_body, bodies, half_spaces).ok()?;
    Some(Case { name: "fuzz".to_owned(), model, positions })
}

fn filter(draw: &mut Draw<'_>) -> BodyFilter {
    match draw.byte() {
        0..160 => BodyFilter::DEFORMABLE,
        160..224 => BodyFilter::OBSTACLE,
        _ => BodyFilter {
            obstacle: draw.below(2) == 0,
            groups: u32::from(draw.byte()),
            mask: u32::from(draw.byte()),
            self_collision: draw.below(2) == 0,
        },
    }
}

fn targets(draw: &mut Draw<'_>, start: &[Point]) -> Vec<Point> {
    let (style, magnitude) = (draw.below(6), draw.power(40));
    let way = Vector::new(draw.grid(), draw.grid(), draw.grid());
    let center = start.iter().map(|p| p.coords).sum::<Vector>() / start.len().max(1) as f64;
    start
        .iter()
        .map(|p| match style {
            0 => p + magnitude * Vector::new(draw.grid(), draw.grid(), draw.grid()),
            1 => Point::from(2.0 * center - p.coords),
            2 => start[draw.below(start.len())],
            3 => p + magnitude * way,
            4 if draw.rarely(2) => Point::new(draw.any(), draw.any(), draw.any()),
            4 => Point::new(p.x, p.y, height(draw)),
            _ => Point::new(p.x, p.y, 0.0),
        })
        .collect()
}

/// Any finite number that is not so small that the exact predicates of the judge underflow.
fn height(draw: &mut Draw<'_>) -> f64 {
    let height = draw.finite();
    if height.abs() < 1e-60 { 0.0 } else { height }
}

/// A mass. A few are extreme or must be refused, but ratios of masses never overflow.
fn mass(draw: &mut Draw<'_>) -> f64 {
    if !draw.rarely(1) {
        return draw.power(20);
    }
    let mass = draw.any();
    if mass > 0.0 && mass.is_finite() { mass.clamp(1e-100, 1e100) } else { mass }
}
