//! A search on folded cloth: every vertex-triangle and edge-edge pair nearer than 2 mm, with its contact
//! geometry, of layers 1.5 mm apart.

#[path = "../tests/suite/scenes/folded.rs"]
mod folded;

use bowknot_geometry::{Topology, Vector};
use bowknot_proximity::{CollisionModel, PairList, ProximitySearch};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

fn search(criterion: &mut Criterion) {
    for vertices in [10_000, 50_000] {
        let (positions, triangles) = folded::folded_cloth(vertices, 0.0015);
        let Ok(topology) = Topology::builder(positions.len()).triangles(triangles).build() else { continue };
        let model = CollisionModel::single_body(topology);
        let radii = vec![0.001; positions.len()];
        let displacements = vec![Vector::new(0.0, 0.0, 0.001); positions.len()];
        let mut search = ProximitySearch::new(&model);
        let (mut pairs, mut separations) = (PairList::default(), Vec::new());

        let mut group = criterion.benchmark_group("folded cloth");
        group.sample_size(20).throughput(Throughput::Elements(positions.len() as u64));
        group.bench_function(BenchmarkId::new("search", vertices), |bencher| {
            bencher.iter(|| search.search(&model, &positions, &radii, &mut pairs, &mut separations));
        });
        group.bench_function(BenchmarkId::new("search_swept", vertices), |bencher| {
            bencher.iter(|| {
                search.search_swept(&model, &positions, &displacements, &radii, &mut pairs, &mut separations);
            });
        });
        let old = pairs.clone();
        group.bench_function(BenchmarkId::new("match_with", vertices), |bencher| {
            let mut matches = Vec::new();
            bencher.iter(|| pairs.match_with(&old, &mut matches));
        });
        group.finish();
    }
}

criterion_group!(benches, search);
criterion_main!(benches);
