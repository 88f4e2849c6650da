//! Nanoseconds per call of the closest points and the certified separation, each kind.
//!
//! `cargo bench -p bowknot-geometry`. Pairs are drawn as a proximity search meets them: elements of about 1
//! cm, a few millimeters apart, all regions of closest features mixed; throughput over a list.

use bowknot_geometry::{HalfSpace, PairKind, Point, Vector, distance, separation};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fastrand::Rng;
use std::hint::black_box;

const PAIRS: usize = 4096;

/// A vector in the cube [-size, size)^3.
fn vector(random: &mut Rng, size: f64) -> Vector {
    [0; 3].map(|_| size * (2.0 * random.f64() - 1.0)).into()
}

fn pairs(kind: PairKind, parallel: bool) -> Vec<[Point; 4]> {
    let mut random = Rng::with_seed(kind as u64 + 1);
    (0..PAIRS)
        .map(|_| {
            let center = Point::from(vector(&mut random, 1.0));
            let mut points = [0; 4].map(|_| center + vector(&mut random, 0.008));
            if parallel {
                points[3] = points[2] + (points[1] - points[0]);
            }
            points
        })
        .collect()
}

fn distances(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("geometry");
    group.throughput(Throughput::Elements(PAIRS as u64));
    let cases = [
        ("vertex_vertex", PairKind::VertexVertex, false),
        ("vertex_edge", PairKind::VertexEdge, false),
        ("vertex_triangle", PairKind::VertexTriangle, false),
        ("edge_edge", PairKind::EdgeEdge, false),
        ("edge_edge_parallel", PairKind::EdgeEdge, true),
    ];
    for (name, kind, parallel) in cases {
        let pairs = pairs(kind, parallel);
        group.bench_function(format!("closest/{name}"), |bencher| {
            bencher
                .iter(|| pairs.iter().map(|p| distance::closest(kind, black_box(p)).distance).sum::<f64>());
        });
        group.bench_function(format!("separate/{name}"), |bencher| {
            bencher
                .iter(|| pairs.iter().map(|p| separation::separate(kind, black_box(p)).width).sum::<f64>());
        });
    }
    let ground = HalfSpace { normal: Vector::z(), offset: 0.1 };
    let pairs = pairs(PairKind::VertexHalfSpace, false);
    group.bench_function("separate/vertex_half_space", |bencher| {
        bencher.iter(|| {
            pairs
                .iter()
                .map(|p| separation::separate_half_space(black_box(&p[0]), &ground).width)
                .sum::<f64>()
        });
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(1));
    targets = distances
}
criterion_main!(benches);
