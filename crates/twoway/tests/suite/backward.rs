//! The backward step keeps to the edges that act. Its result is that of sweeps over all edges.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::{Draw, sheet};
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::lcp::{LcpError, LcpState};
use bowknot_twoway::{
    CertifiedForward, CollisionScene, ColoredSweeps, ContactData, LcpBackward, Params, Resolver, RowSolver,
    RowSystem, TrustRegionSearch,
};

/// The default solver over all edges.
#[derive(Default)]
struct AllEdges(ColoredSweeps);

impl RowSolver for AllEdges {
    fn begin(&mut self) {
        self.0.begin();
    }

    fn solve(&mut self, rows: &RowSystem<'_>, state: &mut LcpState<'_>) -> Result<(), LcpError> {
        self.0.solve(rows, state)
    }
}

/// What one call leaves: y^(l), the largest ratio of an edge at y to 1.1 times its rest length, and the rows
/// with a multiplier.
struct Outcome {
    y: Vec<Point>,
    stretch: f64,
    active_rows: usize,
}

fn call<K: RowSolver + Default>(
    model: &CollisionModel,
    x: &[Point],
    target: &[Point],
    params: &Params,
) -> Outcome {
    let scene =
        CollisionScene::new(model.clone(), x, &vec![1.0; x.len()], ContactData::default(), params.clone())
            .unwrap();
    let search = TrustRegionSearch::new(&scene);
    let backward = LcpBackward::with_solver(K::default());
    let mut resolver = Resolver::with_stages(scene, search, backward, CertifiedForward::default());
    let report = resolver.resolve(&mut x.to_vec(), target).unwrap();
    let y = resolver.state().y.clone();
    let ratio = |&[a, b]: &[u32; 2]| {
        let length = |x: &[Point]| (x[a as usize] - x[b as usize]).norm();
        length(&y) / (1.1 * length(x))
    };
    let stretch = model.topology().edges.iter().map(ratio).fold(0.0, f64::max);
    Outcome { y, stretch, active_rows: report.active_rows }
}

/// The outcome of the default step, and of one over all edges.
fn both(model: &CollisionModel, x: &[Point], target: &[Point], steps: usize, sweeps: usize) -> [Outcome; 2] {
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(steps);
    params.solver.backward.sweeps = sweeps;
    params.solver.backward.polish_sweeps = sweeps;
    [call::<ColoredSweeps>(model, x, target, &params), call::<AllEdges>(model, x, target, &params)]
}

fn distance(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// A chain along x of which only the last vertex wants to move: at the target one edge is too long, and pulls
/// the others after it one by one.
fn chain() -> (CollisionModel, Vec<Point>, Vec<Point>) {
    let x: Vec<Point> = (0..40).map(|i| Point::new(0.1 * f64::from(i), 0.0, 0.0)).collect();
    let topology = Topology::builder(40).strand_edges((0..39).map(|i| [i, i + 1])).build().unwrap();
    let mut target = x.clone();
    target[39].x += 2.0;
    (CollisionModel::single_body(topology), x, target)
}

/// A sheet above the ground. One corner is pulled away, and all of it down into the ground.
fn pulled_sheet() -> (CollisionModel, Vec<Point>, Vec<Point>) {
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(12, 0.1, 0.02, &mut x, &mut triangles);
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
    let filters = vec![BodyFilter::DEFORMABLE];
    let model = CollisionModel::new(topology, vec![0; x.len()], filters, vec![ground]).unwrap();
    let mut draw = Draw::new(3);
    let mut target: Vec<Point> =
        x.iter().map(|x| x + Vector::new(0.0, 0.0, -0.05) + 0.002 * draw.vector()).collect();
    target[0] += Vector::new(-0.4, -0.3, 0.0);
    (model, x, target)
}

#[test]
fn edges_that_act_only_later_are_found() {
    for (name, (model, x, target)) in [("chain", chain()), ("sheet", pulled_sheet())] {
        // So many sweeps find the projection onto the rows at x.
        let [live, all] = both(&model, &x, &target, 1, 20_000);
        assert!(all.active_rows > 10, "{name}: {} rows act", all.active_rows);
        assert_eq!(live.active_rows, all.active_rows, "{name}");
        let apart = distance(&live.y, &all.y);
        assert!(apart < 1e-7, "{name}: {apart} m apart");
        assert!(live.stretch < 1.0 + 1e-6, "{name}: an edge is {} times its limit", live.stretch);
    }
}

#[test]
fn few_sweeps_leave_edges_no_longer_than_sweeps_over_all_do() {
    for (name, (model, x, target)) in [("chain", chain()), ("sheet", pulled_sheet())] {
        for steps in 1..4 {
            let [live, all] = both(&model, &x, &target, steps, 8);
            let [live, all] = [live.stretch - 1.0, all.stretch - 1.0];
            assert!(live < 1.3 * all + 1e-3, "{name}, step {steps}: {live} beyond the limits, all {all}");
        }
    }
}
