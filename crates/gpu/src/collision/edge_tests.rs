//! Sweeps over clusters of edges on a device, beside their twin: with as many edges as threads keep, and with
//! more.

use super::*;
use crate::adapter::Adapter;
use crate::engine::{ComparingEngine, DeviceEngine};
use crate::layout::EdgeLimit;

const SWEEPS: u32 = 3;

/// All edges between `count` vertices.
fn all_pairs(count: u32) -> Vec<[u32; 2]> {
    (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).collect()
}

/// Sweeps twice over the edges, of which some are too long, and applies the multipliers once. Vertices whose
/// number is a multiple of seven do not move.
fn sweep(edges: &[[u32; 2]], vertices: u32) {
    let mut random = fastrand::Rng::with_seed(7);
    let points: Vec<Point> = (0..vertices)
        .map(|v| {
            Point::new(f64::from(v % 16), f64::from(v / 16), random.f64())
                + 0.3 * Vector::repeat(random.f64())
        })
        .collect();
    let lengths: Vec<f64> = edges
        .iter()
        .map(|&[a, b]| (points[a as usize] - points[b as usize]).norm() * (0.7 + 0.5 * random.f64()))
        .collect();
    let moves = |v: u32| !v.is_multiple_of(7);
    let divided = Edges::new(edges, &lengths, &points, moves);
    let grid = Grid::around(&points, 20.0, 1e-3).expect("a grid");
    let limits = divided.limits(&grid, &[]);
    let positions = snapped(&grid, &points).expect("on the grid");
    let weights: Vec<[f32; 4]> =
        (0..vertices).map(|v| [0.0, 0.0, 0.0, if moves(v) { 0.5 + random.f32() } else { 0.0 }]).collect();

    let device = DeviceEngine::open(&Adapter::choose(None).expect("a device")).expect("opens");
    let mut engine = ComparingEngine::new(device);
    let mut recording = Recording::default();
    let mut buffer = |words: usize| engine.buffer("edges", words).expect("memory");
    let b = [
        buffer(4 * positions.len()),
        buffer(words::<crate::layout::EdgeCluster>(divided.clusters.len())),
        buffer(divided.vertices.len()),
        buffer(divided.color_ends.len()),
        buffer(words::<EdgeLimit>(limits.len())),
        buffer(4 * weights.len()),
    ];
    recording.write(b[0], &padded(&positions));
    recording.write(b[1], &divided.clusters);
    recording.write(b[2], &divided.vertices);
    recording.write(b[3], &divided.color_ends);
    recording.write(b[4], &limits);
    recording.write(b[5], &weights);
    for only_apply in [0, 0, 1] {
        for round in divided.rounds() {
            let params = kernels::sweep_edges::Params {
                first: round.start as u32,
                end: round.end as u32,
                only_apply,
                sweeps: if only_apply == 1 { 1 } else { SWEEPS },
            };
            recording.dispatch(
                &kernels::SWEEP_EDGES,
                &b,
                params,
                kernels::SWEEP_EDGES.workgroup * round.len(),
            );
        }
    }
    let read = engine.run(&recording, &[(b[4], words::<EdgeLimit>(limits.len()))]).expect("runs");
    assert!(engine.differences().is_empty(), "{:?}", &engine.differences()[..1]);
    let pulling = bytemuck::cast_slice::<u32, EdgeLimit>(&read[0])
        .iter()
        .filter(|edge| edge.multiplier != [0.0; 3])
        .count();
    assert!(pulling > limits.len() / 10 && pulling < limits.len(), "{pulling} of {}", limits.len());
}

#[test]
fn edges_that_a_workgroup_keeps_and_more_are_swept_as_by_the_twin() {
    // 256 threads keep four edges each: 765, 1014, 1060 and 1734 edges have an end that moves.
    for vertices in [40, 46, 47, 60] {
        sweep(&all_pairs(vertices), vertices);
    }
}

#[test]
fn edges_of_a_sheet_are_swept_as_by_the_twin() {
    let n = 40;
    let mut edges = Vec::new();
    for k in (0..n * (n - 1)).filter(|k| k % n != n - 1) {
        edges.extend([[k, k + 1], [k, k + n], [k, k + n + 1]]);
    }
    sweep(&edges, n * n);
}
