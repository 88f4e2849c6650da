//! One forward step of folded cloth, about 10,000 vertices in layers 1.5 mm apart that are asked to lie on
//! one another: set the target, limit by the candidate pairs and by the trust regions, advance. The time does
//! not include the search.

// The scene of the search's own bench.
#[path = "../../proximity/tests/suite/scenes/folded.rs"]
mod folded;

use bowknot_geometry::{Point, Topology};
use bowknot_proximity::{CollisionModel, PairList, ProximitySearch};
use bowknot_stepper::{Bound, Contacts, Stepper, TrustRegions};
use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

/// Minimum separation [m].
const MIN_SEPARATION: f64 = 1e-4;
/// Radius of each trust region [m].
const RADIUS: f64 = 1e-3;
/// Share of a gap that one step may use.
const DAMPING: f64 = 0.9;

fn forward_step(criterion: &mut Criterion) {
    let (start, triangles) = folded::folded_cloth(10_000, 0.0015);
    let target: Vec<Point> = start.iter().map(|p| Point::new(p.x, p.y, 0.5 * p.z)).collect();
    let Ok(topology) = Topology::builder(start.len()).triangles(triangles).build() else { return };
    let model = CollisionModel::single_body(topology);
    let radii = vec![RADIUS + 0.5 * MIN_SEPARATION; start.len()];
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    ProximitySearch::new(&model).search(&model, &start, &radii, &mut pairs, &mut separations);
    let min_separations = vec![MIN_SEPARATION; pairs.len()];
    let contacts = Contacts { pairs: &pairs, separations: &separations, min_separations: &min_separations };
    let trust_regions = TrustRegions { centers: start.clone(), radii: vec![RADIUS; start.len()] };

    let mut group = criterion.benchmark_group("folded cloth");
    group.throughput(Throughput::Elements(pairs.len() as u64));
    for (name, bound) in [("planes", Bound::Planes), ("isotropic", Bound::Isotropic)] {
        // Every iteration makes the first step of a call: later steps start from smaller gaps.
        let first_step = || {
            let mut stepper = Stepper::default();
            stepper.begin(start.len());
            stepper.set_target(&start, &target); // allocates the buffer outside of the measured time
            (stepper, start.clone())
        };
        group.bench_function(BenchmarkId::new(name, start.len()), |bencher| {
            bencher.iter_batched_ref(
                first_step,
                |(stepper, positions)| {
                    stepper.set_target(positions, &target);
                    match bound {
                        Bound::Planes => stepper.limit_by_planes(&contacts, DAMPING),
                        Bound::Isotropic => stepper.limit_by_distances(&contacts, DAMPING),
                    };
                    stepper.limit_by_trust_regions(positions, &trust_regions);
                    stepper.advance(positions)
                },
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, forward_step);
criterion_main!(benches);
