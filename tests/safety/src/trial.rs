//! Runs a problem and judges every accepted step by `bowknot-check`, which shares no code with the stepper.
//!
//! A step is at fault if
//! - its path or its end intersects, or has a coordinate that is not finite;
//! - it does not start where the last one ended;
//! - bodies with a thickness come nearer than that, or than half of the gap that they started the call with;
//! - an obstacle or a group of pins that is only translated changes its shape;
//! - it goes toward other targets of prescribed vertices than those given.
//!
//! A call that is refused must leave the positions as they are.

use crate::{Case, Scenario, StepChecker};
use bowknot_check::{Judge, StateOptions};
use bowknot_geometry::{CollisionModel, Point};
use bowknot_proximity::BodyFilter;
use bowknot_twoway::{
    AcceptedState, BackwardStep, CertifiedForward, CollisionScene, ContactData, ForwardStep, LcpBackward,
    ResolveError, ResolveInput, Resolver, Search, TrustRegionSearch,
};
use std::ops::ControlFlow;

/// What became of one problem, or of many.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Problems.
    pub cases: usize,
    /// Problems whose start intersects, so that nothing can be said.
    pub unusable: usize,
    /// Problems that were refused, in part at least: with coordinates too large for the minimum separation.
    pub refused: usize,
    /// Problems in which a vertex moved.
    pub moved: usize,
    /// Accepted steps that were judged.
    pub steps: usize,
}

impl Tally {
    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            cases: self.cases + other.cases,
            unusable: self.unusable + other.unusable,
            refused: self.refused + other.refused,
            moved: self.moved + other.moved,
            steps: self.steps + other.steps,
        }
    }
}

/// What of a run is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judged {
    /// That nothing intersects.
    Safety,
    /// The other promises of the default stages as well.
    Promises,
}

/// Runs a problem by the whole method.
///
/// # Errors
/// The first fault of a step.
pub fn check(scenario: &Scenario) -> Result<Tally, String> {
    check_with(scenario, Judged::Promises, |scene| {
        let search = TrustRegionSearch::new(&scene);
        let backward = LcpBackward::new();
        Ok(Resolver::with_stages(scene, search, backward, CertifiedForward::default()))
    })
}

/// Runs a problem by other stages.
///
/// # Errors
/// The first fault of a step.
pub fn check_with<S: Search, B: BackwardStep, F: ForwardStep<S>>(
    scenario: &Scenario,
    judged: Judged,
    stages: impl Fn(CollisionScene) -> Result<Resolver<S, B, F>, ResolveError>,
) -> Result<Tally, String> {
    let mut tally = Tally { cases: 1, ..Tally::default() };
    let Some(case) = scenario.case() else {
        return Ok(Tally { unusable: 1, ..tally });
    };
    let scale = scenario.scale();
    let rest: Vec<Point> = case.positions.iter().map(|p| p * scenario.rest).collect();
    let masses = scenario.masses(rest.len());
    // No target of any call is farther away.
    let ways = scenario.calls.iter().map(|call| 2.0 * call.magnitude.max(call.way));
    let largest = ways
        .fold(4.0 * case.positions.iter().map(|p| p.coords.amax()).fold(0.0, f64::max) / scale, |a, b| a + b);
    let setup = scenario.setup.raised(largest);
    let params = setup.params(scale);
    let contact = ContactData {
        bodies: vec![setup.body(scale); case.model.bodies().len()],
        half_spaces: vec![setup.half_space(scale); case.model.half_spaces().len()],
        ..ContactData::default()
    };
    let resolver = CollisionScene::new(case.model.clone(), &rest, &masses, contact, params).and_then(&stages);
    let mut resolver = resolver.map_err(|error| format!("refused: {error}"))?;

    let (pinned, groups) = scenario.pins(&case);
    let entities = entities(&case, &groups);
    let prescribed: Vec<bool> =
        (0..pinned.len()).map(|v| pinned[v] || case.model.is_obstacle(v as u32)).collect();
    let mut checker = StepChecker::new(&case);
    let promises = judged == Judged::Promises;
    let apart =
        setup.thickness.filter(|_| promises).map(|thickness| Apart::new(&case.model, thickness * scale));
    let mut x = case.positions.clone();
    for (call, motion) in scenario.calls.iter().enumerate() {
        let targets = motion.targets(&case, &x, &prescribed, scale);
        let input = ResolveInput {
            prescribed: &pinned,
            groups: &groups,
            time_step: motion.time_step,
            ..ResolveInput::default()
        };
        let start = x.clone();
        let floor = apart.as_ref().map(|apart| apart.floor(&x));
        let mut last = x.clone();
        let mut fault = None;
        let mut observer = |state: &AcceptedState<'_>| {
            let led = if promises { prescribed.as_slice() } else { &[] };
            fault = step_fault(state, &last, led, &targets).or_else(|| {
                checker.check_step(state.previous, state.positions);
                checker.fault.clone()
            });
            if let (None, Some(apart), Some(floor)) = (&fault, &apart, floor) {
                fault = apart.fault(state.positions, floor);
            }
            if fault.is_none() && promises && motion.is_translation() {
                fault = shape_fault(&entities, state, &targets);
            }
            last.copy_from_slice(state.positions);
            if fault.is_none() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let solved = resolver.resolve_with(&mut x, &targets, &input, &mut observer);
        if let Some(fault) = fault {
            return Err(format!("call {call}: {fault}"));
        }
        match solved {
            Ok(_) if x == last => {}
            Ok(_) => return Err(format!("call {call}: the result is not the last accepted state")),
            Err(_) if x != start => {
                return Err(format!("call {call}: a refused call has moved the positions"));
            }
            Err(ResolveError::MinSeparationBelowRounding { .. }) => tally.refused = 1,
            Err(error) => return Err(format!("call {call} is refused: {error}")),
        }
    }
    tally.steps = checker.steps;
    tally.moved = usize::from(checker.largest_move > 0.0);
    Ok(tally)
}

/// Whether a step starts elsewhere, ends nowhere, or goes toward other targets of prescribed vertices.
fn step_fault(
    state: &AcceptedState<'_>,
    last: &[Point],
    prescribed: &[bool],
    targets: &[Point],
) -> Option<String> {
    let step = state.step;
    if state.previous != last {
        return Some(format!("step {step} does not start where the last one ended"));
    }
    if let Some(v) = state.positions.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
        return Some(format!("step {step}: vertex {v} is at {:?}", state.positions[v]));
    }
    let other = |v: &usize| prescribed[*v] && state.target[*v] != targets[*v];
    (0..prescribed.len())
        .find(other)
        .map(|v| format!("step {step}: the target of the prescribed vertex {v} has changed"))
}

/// The vertices of each obstacle and of each group of pins.
fn entities(case: &Case, groups: &[u32]) -> Vec<Vec<usize>> {
    let of_body = |body: u32| {
        let vertices = 0..case.positions.len();
        vertices.filter(move |&v| case.model.is_obstacle(v as u32) && case.model.vertex_body()[v] == body)
    };
    let of_group = |group: u32| (0..groups.len()).filter(move |&v| groups[v] == group);
    let bodies = (0..case.model.bodies().len() as u32).map(|body| of_body(body).collect());
    let largest = groups.iter().copied().filter(|&g| g != ResolveInput::NO_GROUP).max();
    let groups = largest.into_iter().flat_map(|largest| 0..=largest).map(|group| of_group(group).collect());
    bodies.chain(groups).filter(|vertices: &Vec<usize>| vertices.len() > 1).collect()
}

/// Whether an entity whose targets are translated has moved otherwise than as a whole.
fn shape_fault(entities: &[Vec<usize>], state: &AcceptedState<'_>, targets: &[Point]) -> Option<String> {
    let largest = targets.iter().chain(state.previous).map(|p| p.coords.amax()).fold(0.0, f64::max);
    for vertices in entities {
        let moved = |v: usize| state.positions[v] - state.previous[v];
        let first = moved(vertices[0]);
        // By rounding of the displacements and of the positions before and after.
        let slack = 32.0 * f64::EPSILON * largest + 1e-9 * first.norm();
        if let Some(&v) = vertices.iter().find(|&&v| (moved(v) - first).norm() > slack) {
            let (a, b) = (first, moved(v));
            return Some(format!(
                "step {}: vertices {} and {v} move as one, but by {a:?} and {b:?}",
                state.step, vertices[0]
            ));
        }
    }
    None
}

/// The guaranteed thickness between bodies.
struct Apart {
    /// A judge of pairs of different bodies.
    judge: Judge,
    thickness: f64,
}

impl Apart {
    fn new(model: &CollisionModel, thickness: f64) -> Self {
        let bodies: Vec<BodyFilter> =
            model.bodies().iter().map(|body| BodyFilter { self_collision: false, ..*body }).collect();
        let parts = (model.topology().clone(), model.vertex_body().to_vec(), model.half_spaces().to_vec());
        // The same parts made a model before, so that the default is never taken.
        let judge = CollisionModel::new(parts.0, parts.1, bodies, parts.2).map(|m| Judge::from_model(&m));
        Self { judge: judge.unwrap_or_default(), thickness }
    }

    /// The smallest distance between bodies [m]; infinite if there is none.
    fn distance(&self, x: &[Point]) -> (f64, String) {
        let report = self.judge.check_state(x, &StateOptions { limit: 1, distance: true });
        let nearest = report.ok().and_then(|report| report.nearest);
        nearest.map_or((f64::INFINITY, String::new()), |nearest| (nearest.distance, nearest.to_string()))
    }

    /// The distance that a call that starts at `x` keeps [m]: the thickness, or where bodies start closer
    /// the certified width of their gap, which is more than half of it.
    fn floor(&self, x: &[Point]) -> f64 {
        self.thickness.min(0.5 * self.distance(x).0)
    }

    fn fault(&self, x: &[Point], floor: f64) -> Option<String> {
        let (distance, nearest) = self.distance(x);
        // By the rounding of the distance that the judge computes.
        let largest = x.iter().map(|p| p.coords.amax()).fold(0.0, f64::max);
        let slack = 8.0 * f64::EPSILON * largest + 1e-12 * floor;
        (distance < floor - slack).then(|| format!("{nearest}, but must keep {floor:e} m"))
    }
}
