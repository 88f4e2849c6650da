//! A target of a crumpled cloth of 10,201 vertices in free flight at dt = 1/20 s.
//!
//! ```text
//! cargo bench -p bowknot-dynamics
//! ```
//!
//! `target/PRECONDITIONER/1` is assembly, preconditioner, one CG iteration and the line search; `/101` has a
//! hundred more iterations, so that a hundredth of the difference is the time of one iteration.

#[path = "../tests/suite/common/cloth.rs"]
mod cloth;
#[path = "../tests/suite/common/sheet.rs"]
mod sheet;

use bowknot_dynamics::{ClothMaterial, Dynamics, DynamicsParams, NewtonParams, PreconditionerKind};
use bowknot_geometry::{Point, Vector};
use cloth::cloth_model;
use criterion::{Criterion, criterion_group, criterion_main};
use sheet::sheet;
use std::hint::black_box;
use std::time::Duration;

fn targets(criterion: &mut Criterion) {
    let (rest, triangles) = sheet(1.0, 1.0, 100, 100);
    let wave = |p: &Point| Vector::new(0.0, 0.0, 0.03 * (25.0 * p.x).sin() * (21.0 * p.y + 5.0 * p.x).cos());
    let x: Vec<Point> = rest.iter().map(|p| p + wave(p)).collect();
    let v: Vec<Vector> =
        rest.iter().map(|p| Vector::new((9.0 * p.y).sin(), (8.0 * p.x).cos(), p.x)).collect();
    let free = vec![false; rest.len()];
    let mut group = criterion.benchmark_group("target");
    group.sample_size(20).measurement_time(Duration::from_secs(4));
    for preconditioner in [PreconditionerKind::BlockJacobi, PreconditionerKind::TwoLevel] {
        for iterations in [1, 101] {
            let model = cloth_model(&rest, triangles.clone(), ClothMaterial::cotton());
            let newton = NewtonParams {
                preconditioner,
                cg_tolerance: 1e-14,
                cg_max_iterations: iterations,
                ..NewtonParams::default()
            };
            let params = DynamicsParams { newton, ..DynamicsParams::default() };
            let mut dynamics = Dynamics::new(model, params).expect("valid");
            let mut y = x.clone();
            group.bench_function(format!("{preconditioner:?}/{iterations}"), |bencher| {
                bencher.iter(|| {
                    dynamics.begin_step(&x, &v, 0.05).expect("finite");
                    let info = dynamics.newton_target(black_box(&x), &free, &x, &mut y).expect("finite");
                    assert_eq!(info.cg.iterations, iterations);
                    info
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, targets);
criterion_main!(benches);
