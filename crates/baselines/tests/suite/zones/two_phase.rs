use super::support::{crumpled, nearing, solve_clear};
use crate::common::{Scene, assert_clear};
use bowknot_baselines::barrier::{BarrierParams, by_descent};
use bowknot_baselines::twoway::geometry::Point;
use bowknot_baselines::twoway::{Params, ResolveInput};
use bowknot_baselines::zones::{ImpactZones, RigidZones, TwoPhase, ZoneParams};
use bowknot_baselines::{Composed, Method};

#[test]
fn easy_calls_need_the_soft_phase_only_and_end_where_it_does() {
    let scene = Scene::two_sheets(4, 0.05);
    let target = nearing(&scene);
    let collision = || scene.collision_scene(Params::fast());
    let mut two = TwoPhase::new(collision(), 100, RigidZones::new(collision())).unwrap();
    let (x, outcome) = solve_clear(&mut two, &scene, &target, &[]);
    assert!(outcome.converged && outcome.steps <= 100);
    let mut alone = ImpactZones::new(collision(), ZoneParams::default()).unwrap();
    assert_eq!(solve_clear(&mut alone, &scene, &target, &[]).0, x);
}

#[test]
fn what_the_soft_phase_leaves_the_hard_phase_brings_on_its_way() {
    let scene = Scene::two_sheets(6, 0.02);
    let target = crumpled(&scene, 0.2, 100);
    let mut params = Params::fast();
    params.solver.stop.max_steps = Some(100);
    let collision = || scene.collision_scene(params.clone());
    let hard = Composed::new("log barrier", by_descent(collision(), BarrierParams::default()).unwrap());
    let mut two = TwoPhase::new(collision(), 2, hard).unwrap();
    assert_eq!(two.name(), "two phases, hard: log barrier");
    let mut x = scene.x.clone();
    let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
    let outcome = two.solve(&mut x, &target, &input).unwrap();
    assert!(!outcome.failed && outcome.steps > 2 && outcome.searches > 3, "{outcome:?}");
    assert_clear(&scene.model, &x, "end");
    let distance = |x: &[Point]| x.iter().zip(&target).map(|(x, y)| (x - y).norm_squared()).sum::<f64>();
    assert!(distance(&x) < 0.9 * distance(&scene.x), "{} {}", distance(&x), distance(&scene.x));
}
