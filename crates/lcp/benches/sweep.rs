//! A sweep over a cloth-like grid: ball rows on its edges in 12 colours, random contact rows in about 40.
//!
//! `cargo bench -p bowknot-lcp --bench sweep`

use bowknot_lcp::*;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

#[path = "../tests/suite/common/mod.rs"]
mod common;
use common::{Case, cloth};

fn problem(case: &Case) -> Problem<'_> {
    Problem::new(
        &case.weights,
        Family::new(&case.rows, Schedule::coloured(&case.row_starts)),
        Family::new(&case.balls, Schedule::coloured(&case.ball_starts)),
        Family::default(),
    )
    .expect("the case is valid")
}

fn sweeps(criterion: &mut Criterion) {
    let case = cloth(100, 20_000, 1);
    let (rows, balls) = (case.rows.len(), case.balls.len());
    let mut group = criterion.benchmark_group("8 sweeps");
    group.throughput(Throughput::Elements(8 * (rows + balls) as u64));
    group.sample_size(30);
    let params = Params { max_sweeps: 8, ..Params::default() };
    let problem = problem(&case);
    for threads in [0, 1, 2] {
        let name = if threads == 0 { "serial".to_owned() } else { format!("coloured, {threads} threads") };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.max(1)).build().expect("a pool");
        group.bench_function(BenchmarkId::new(name, format!("{balls}+{rows}")), |bench| {
            let (mut y, mut lambda, mut forces) = case.start();
            bench.iter(|| {
                y.copy_from_slice(&case.y_free);
                lambda.fill(0.0);
                forces.fill(Vector::zeros());
                let mut state =
                    State { y: &mut y, lambda: &mut lambda, forces: &mut forces, friction: &mut [] };
                let info = if threads == 0 {
                    solve_serial(&problem, &mut state, &params)
                } else {
                    pool.install(|| solve_coloured(&problem, &mut state, &params))
                };
                black_box(info.expect("no tolerance, no error"))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, sweeps);
criterion_main!(benches);
