//! A sweep over a cloth-like grid: distance limits on its edges in 12 colors, random contact rows in
//! about 40.
//!
//! `cargo bench -p bowknot-lcp --bench sweep`

use bowknot_lcp::*;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

#[path = "../tests/suite/common/mod.rs"]
mod common;
use common::{Case, cloth};

fn problem(case: &Case) -> LcpProblem<'_> {
    LcpProblem::new(
        &case.weights,
        ConstraintSet::new(&case.rows, Schedule::colored(&case.row_starts)),
        ConstraintSet::new(&case.limits, Schedule::colored(&case.limit_starts)),
        ConstraintSet::default(),
    )
    .expect("the case is valid")
}

fn sweeps(criterion: &mut Criterion) {
    let case = cloth(100, 20_000, 1);
    let (rows, limits) = (case.rows.len(), case.limits.len());
    let mut group = criterion.benchmark_group("8 sweeps");
    group.throughput(Throughput::Elements(8 * (rows + limits) as u64));
    group.sample_size(30);
    let params = LcpParams { max_sweeps: 8, ..LcpParams::default() };
    let problem = problem(&case);
    for threads in [0, 1, 2] {
        let name = if threads == 0 { "serial".to_owned() } else { format!("colored, {threads} threads") };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.max(1)).build().expect("a pool");
        group.bench_function(BenchmarkId::new(name, format!("{limits}+{rows}")), |bench| {
            let (mut y, mut lambda, mut limit_multipliers) = case.start();
            bench.iter(|| {
                y.copy_from_slice(&case.y_free);
                lambda.fill(0.0);
                limit_multipliers.fill(Vector::zeros());
                let mut state = LcpState {
                    y: &mut y,
                    lambda: &mut lambda,
                    limit_multipliers: &mut limit_multipliers,
                    friction: &mut [],
                };
                let info = if threads == 0 {
                    solve_serial(&problem, &mut state, &params)
                } else {
                    pool.install(|| solve_colored(&problem, &mut state, &params))
                };
                black_box(info.expect("no tolerance, no error"))
            });
        });
    }
    group.finish();
}

criterion_group!(benches, sweeps);
criterion_main!(benches);
