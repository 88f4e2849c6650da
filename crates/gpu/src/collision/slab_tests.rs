//! The slab that `separate` certifies between the sides of a pair lies there, on the device: by double
//! precision, in which the differences of grid points and their products with a normal are exact to 1e-15.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use super::buffers::words;
use crate::adapter::Adapter;
use crate::engine::{DeviceEngine, Engine};
use crate::kernels;
use crate::layout::{Candidate, Control, Kind, Plane, Separation};
use crate::recording::Recording;

/// Pairs of each kind, and the vertices of one.
const PAIRS: u32 = 20_000;
const VERTICES: u32 = 4;

/// Four points of a pair: two edges, or a point and a triangle, often near each other and nearly parallel.
fn points(random: &mut fastrand::Rng) -> [[i32; 4]; VERTICES as usize] {
    let size = f64::from(1 << random.u32(2..24));
    let origin = [(); 3].map(|()| random.i32(-(1 << 27)..1 << 27));
    let gap = size * 10f64.powf(random.f64() * -7.0);
    let flat = if random.bool() { 1.0 } else { 1e-5 };
    std::array::from_fn(|k| {
        let mut x = [(); 3].map(|()| size * (random.f64() - 0.5));
        x[2] = x[2] * flat + if k % 2 == 0 { gap } else { 0.0 };
        let [x, y, z] = std::array::from_fn(|c| origin[c] + x[c] as i32);
        [x, y, z, 0]
    })
}

#[test]
fn slabs_of_a_device_lie_between_both_sides() {
    let mut random = fastrand::Rng::with_seed(42);
    let (mut positions, mut edges, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    let mut pairs: Vec<(Candidate, [Vec<u32>; 2])> = Vec::new();
    for kind in [Kind::VertexVertex, Kind::VertexEdge, Kind::VertexTriangle, Kind::EdgeEdge] {
        for _ in 0..PAIRS {
            let v = positions.len() as u32;
            positions.extend(points(&mut random));
            edges.extend([[v, v + 2], [v + 1, v + 3]]);
            triangles.push([v + 1, v + 2, v + 3, 0]);
            let (edge, triangle) = (edges.len() as u32 - 1, triangles.len() as u32 - 1);
            let (a, b, sides) = match kind {
                Kind::VertexVertex => (v, v + 1, [vec![v], vec![v + 1]]),
                Kind::VertexEdge => (v, edge, [vec![v], vec![v + 1, v + 3]]),
                Kind::VertexTriangle => (v, triangle, [vec![v], vec![v + 1, v + 2, v + 3]]),
                _ => (edge - 1, edge, [vec![v, v + 2], vec![v + 1, v + 3]]),
            };
            pairs.push((Candidate::new(kind, a, b), sides));
        }
    }
    let candidates: Vec<Candidate> = pairs.iter().map(|(candidate, _)| *candidate).collect();
    let count = candidates.len();
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    let mut engine = DeviceEngine::open(&adapter).unwrap();
    let sizes = [4 * positions.len(), 2 * edges.len(), 4 * triangles.len(), words::<Plane>(1)];
    let [x, e, t, planes] = sizes.map(|size| engine.buffer("input", size).unwrap());
    let [c, s, control] = [words::<Candidate>(count), words::<Separation>(count), words::<Control>(1)]
        .map(|size| engine.buffer("pairs", size).unwrap());
    let mut recording = Recording::default();
    recording.write(x, &positions);
    recording.write(e, &edges);
    recording.write(t, &triangles);
    recording.write(c, &candidates);
    let kept = Control { candidates: count as u32, changed: 1, ..bytemuck::Zeroable::zeroed() };
    recording.write(control, &[kept]);
    let params = kernels::separate::Params { capacity: count as u32, after_search: 0 };
    recording.dispatch(&kernels::SEPARATE, &[x, e, t, planes, c, s, control], params, count);
    let read = engine.run(&recording, &[(s, words::<Separation>(count))]).unwrap();
    let separations: &[Separation] = bytemuck::cast_slice(&read[0]);
    let mut certified = 0;
    for (separation, (candidate, [side_a, side_b])) in separations.iter().zip(&pairs) {
        let n = separation.normal.map(f64::from);
        let length = n.iter().map(|n| n * n).sum::<f64>().sqrt();
        let height = |v: &u32| {
            let x = positions[*v as usize];
            (0..3).map(|k| n[k] * f64::from(x[k])).sum::<f64>() / length
        };
        let above = side_a.iter().map(height).fold(f64::INFINITY, f64::min);
        let below = side_b.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
        let width = f64::from(separation.width);
        if width > 0.0 {
            assert!(width <= above - below + 1e-6, "{candidate:?}: {width} in {}", above - below);
            certified += 1;
        }
    }
    assert!(2 * certified > count, "{certified} of {count}");
}
