//! What a call says that it waits for.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::sheet;
use bowknot_geometry::{PairKind, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{AcceptedState, Observer, Params, ResolveInput, Resolver, Statistics, Wait, WaitReason};
use std::ops::ControlFlow;

/// Two sheets 3 mm apart: the lower one is body 0, the upper one body 1. `steps` is the limit of steps.
fn two_sheets(obstacle: [bool; 2], steps: usize) -> (Vec<Point>, Resolver) {
    let (mut x, mut triangles, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
    for body in 0..2 {
        sheet(4, 0.05, 0.003 * f64::from(body), &mut x, &mut triangles);
        bodies.resize(x.len(), body);
    }
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let filter = |obstacle| if obstacle { BodyFilter::OBSTACLE } else { BodyFilter::DEFORMABLE };
    let model = CollisionModel::new(topology, bodies, obstacle.map(filter).to_vec(), Vec::new()).unwrap();
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(steps);
    let resolver = Resolver::new(model, &x, &vec![1e-3; x.len()], params).unwrap();
    (x, resolver)
}

/// Lowers the upper sheet by 1 m.
fn lower(
    resolver: &mut Resolver,
    x: &[Point],
    prescribed: &[bool],
    observer: &mut dyn Observer,
) -> Statistics {
    let bodies = resolver.scene().model().vertex_body().to_vec();
    let fall = |(p, body): (&Point, &u32)| p - Vector::z() * f64::from(*body);
    let target: Vec<Point> = x.iter().zip(&bodies).map(fall).collect();
    let input = ResolveInput { prescribed, ..ResolveInput::default() };
    resolver.resolve_with(&mut x.to_vec(), &target, &input, observer).unwrap()
}

/// Asserts that the pair is one of both sheets.
#[track_caller]
fn is_between(wait: &Wait, gap: std::ops::Range<f64>) {
    let pair = wait.pair.expect("a pair");
    assert!(gap.contains(&pair.gap_m), "{wait:?}");
    assert!(matches!(pair.kind, PairKind::VertexTriangle | PairKind::EdgeEdge));
    let side = |vertices: &[u32]| vertices.iter().map(|v| v / 25).collect::<Vec<_>>();
    let (a, b) = pair.vertices.split_at(pair.kind.side_a());
    let (a, b) = (side(a), side(b));
    assert!(a.iter().all(|s| *s == a[0]) && b.iter().all(|s| *s == b[0]) && a[0] != b[0], "{wait:?}");
}

#[test]
fn a_pinned_sheet_waits_for_the_one_below_it() {
    let (x, mut resolver) = two_sheets([false; 2], 1);
    let prescribed: Vec<bool> = (0..x.len()).map(|v| v >= 25).collect();
    let statistics = lower(&mut resolver, &x, &prescribed, &mut ());
    assert!(!statistics.converged);
    let wait = &statistics.waits[0];
    assert_eq!((wait.body, wait.reason), (1, WaitReason::Planes), "{:?}", statistics.waits);
    assert!(wait.vertex >= 25 && wait.remaining_m > 1e-6, "{wait:?}");
    // The place is where the vertex was before the last step, within the gap at the start.
    assert!((0.0..=0.003).contains(&wait.place[2]), "{wait:?}");
    is_between(wait, 1e-6..0.0031);
}

#[test]
fn an_obstacle_waits_as_one_for_the_vertex_that_is_stopped() {
    // One vertex of the pinned sheet is higher than the rest.
    let (mut x, mut resolver) = two_sheets([false, true], 3);
    x[12].z = 0.002;
    let prescribed: Vec<bool> = (0..x.len()).map(|v| v < 25).collect();
    let statistics = lower(&mut resolver, &x, &prescribed, &mut ());
    let [wait] = &statistics.waits[..] else { panic!("one for both bodies: {:?}", statistics.waits) };
    assert_eq!((wait.body, wait.reason), (1, WaitReason::Group), "{wait:?}");
    let pair = wait.pair.expect("a pair");
    assert!(pair.vertices.contains(&12) && !pair.vertices.contains(&wait.vertex), "{pair:?}");
    is_between(wait, 1e-6..0.0011);
}

#[test]
fn a_vertex_in_free_space_waits_for_its_trust_region() {
    let (x, mut resolver) = two_sheets([false; 2], 1);
    let bodies = resolver.scene().model().vertex_body().to_vec();
    // The sheets part, but not as wholes: it is no free flight.
    let rise =
        |(v, p): (usize, &Point)| p + Vector::z() * (f64::from(bodies[v]) * (1.0 + 0.4 * (v % 5) as f64));
    let target: Vec<Point> = x.iter().enumerate().map(rise).collect();
    let statistics = resolver.resolve(&mut x.clone(), &target).unwrap();
    assert!(!statistics.waits.is_empty());
    for wait in &statistics.waits {
        assert!(wait.body == 1 && wait.remaining_m > 0.01, "{wait:?}");
        assert!(wait.pair.is_none() || wait.reason == WaitReason::Planes, "{wait:?}");
    }
}

#[test]
fn a_call_that_converges_says_nothing() {
    let (x, mut resolver) = two_sheets([false; 2], 500);
    let target: Vec<Point> = x.iter().map(|p| p - Vector::z() * 0.001).collect();
    let statistics = resolver.resolve(&mut x.clone(), &target).unwrap();
    assert!(statistics.converged && statistics.waits.is_empty(), "{statistics:?}");
}

/// Asks after every step.
struct Asking(Vec<Vec<Wait>>);

impl Observer for Asking {
    fn accepted(&mut self, _: &AcceptedState<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn waiting(&mut self, tell: &dyn Fn() -> Vec<Wait>) {
        self.0.push(tell());
    }
}

#[test]
fn an_observer_may_ask_after_each_step_and_changes_nothing() {
    let prescribed: Vec<bool> = (0..50).map(|v| v >= 25).collect();
    let (x, mut resolver) = two_sheets([false; 2], 4);
    let mut asking = Asking(Vec::new());
    let statistics = lower(&mut resolver, &x, &prescribed, &mut asking);
    assert_eq!(asking.0.len(), statistics.steps);
    assert_eq!(asking.0.last(), Some(&statistics.waits));
    assert!(!statistics.converged && !statistics.waits.is_empty());
    let (_, mut other) = two_sheets([false; 2], 4);
    lower(&mut other, &x, &prescribed, &mut ());
    assert_eq!(resolver.state().x, other.state().x);
}
