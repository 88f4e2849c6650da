//! Running a method, and judging its path.

use crate::common::{Draw, Scene, assert_clear};
use bowknot_baselines::twoway::ResolveInput;
use bowknot_baselines::twoway::geometry::{Point, Vector};
use bowknot_baselines::{Method, Outcome};

/// Runs a method from the scene's positions, and asserts that no state on the straight path to where it ends intersects.
#[track_caller]
pub fn solve_clear(
    method: &mut dyn Method,
    scene: &Scene,
    target: &[Point],
    prescribed: &[bool],
) -> (Vec<Point>, Outcome) {
    let mut x = scene.x.clone();
    let input = ResolveInput { time_step: Some(0.01), prescribed, ..ResolveInput::default() };
    let outcome = method.solve(&mut x, target, &input).unwrap();
    for k in 0..=64 {
        let t = f64::from(k) / 64.0;
        let between: Vec<Point> = scene.x.iter().zip(&x).map(|(a, b)| a + t * (b - a)).collect();
        assert_clear(&scene.model, &between, &format!("{}, {t}", method.name()));
    }
    (x, outcome)
}

/// Linear momentum of unit masses [kg m], and angular about the origin at where they start.
pub fn momenta(start: &[Point], end: &[Point]) -> [Vector; 2] {
    let paths = || start.iter().zip(end).map(|(x, y)| (x, y - x));
    [paths().map(|(_, d)| d).sum(), paths().map(|(x, d)| x.coords.cross(&d)).sum()]
}

/// Where two sheets want to be that come toward each other, through each other by a little, with some noise [m].
pub fn nearing(scene: &Scene) -> Vec<Point> {
    let n = scene.x.len() / 2;
    let mut draw = Draw::new(3);
    let way = |v: usize| if v < n { 0.03 } else { -0.03 };
    (0..2 * n).map(|v| scene.x[v] + Vector::z() * way(v) + 2e-3 * draw.vector()).collect()
}

/// Where two sheets want to be that change places, with so much noise [m].
pub fn crumpled(scene: &Scene, noise: f64, seed: u64) -> Vec<Point> {
    let n = scene.x.len() / 2;
    let mut draw = Draw::new(seed);
    (0..2 * n)
        .map(|v| {
            let other = scene.x[(v + n) % (2 * n)];
            scene.x[v] + 1.5 * (other.z - scene.x[v].z) * Vector::z() + noise * draw.vector()
        })
        .collect()
}
