use super::support::{momenta, solve_clear};
use crate::common::{Draw, Scene};
use bowknot_baselines::twoway::geometry::{Point, Vector};
use bowknot_baselines::twoway::{Params, ResolveInput};
use bowknot_baselines::zones::RigidZones;
use bowknot_baselines::{Method, Outcome};

fn run(scene: &Scene, target: &[Point], prescribed: &[bool]) -> (Vec<Point>, Outcome) {
    let mut zones = RigidZones::new(scene.collision_scene(Params::fast()));
    let (x, outcome) = solve_clear(&mut zones, scene, target, prescribed);
    assert!(outcome.converged && !outcome.failed);
    (x, outcome)
}

#[test]
fn without_impacts_it_goes_all_the_way() {
    let scene = Scene::two_sheets(4, 0.05);
    let target: Vec<Point> = scene.x.iter().map(|x| x + Vector::new(0.3, 0.2, -0.1)).collect();
    let (x, outcome) = run(&scene, &target, &[]);
    assert_eq!((outcome.steps, outcome.searches), (0, 1));
    assert!(x.iter().zip(&target).all(|(x, y)| (x - y).norm() < 1e-15));
}

#[test]
fn sheets_that_change_places_keep_both_momenta_and_do_not_meet() {
    for cells in [2, 4, 8] {
        let scene = Scene::two_sheets(cells, 0.02);
        let target = scene.swapped();
        let (x, outcome) = run(&scene, &target, &[]);
        assert!(outcome.steps >= 1);
        let (before, after) = (momenta(&scene.x, &target), momenta(&scene.x, &x));
        for (before, after) in before.iter().zip(&after) {
            assert!((before - after).norm() < 1e-12 * x.len() as f64, "{before:?} {after:?}");
        }
    }
}

#[test]
fn a_zone_moves_like_one_body_and_what_it_does_not_reach_goes_on() {
    // Two sheets; the middles of both fly at each other.
    let scene = Scene::two_sheets(8, 0.05);
    let n = scene.x.len() / 2;
    let middle = |v: usize| (scene.x[v] - Point::new(0.4, 0.4, scene.x[v].z)).norm() < 0.15;
    let target: Vec<Point> = (0..2 * n)
        .map(|v| {
            let speed = if middle(v) { 0.04 } else { 0.0 };
            scene.x[v] + Vector::new(0.02, 0.0, if v < n { speed } else { -speed })
        })
        .collect();
    let (x, outcome) = run(&scene, &target, &[]);
    assert!(outcome.steps >= 1);
    let path = |v: usize| x[v] - scene.x[v];
    let held: Vec<usize> = (0..2 * n).filter(|&v| (x[v] - target[v]).norm() > 1e-12).collect();
    assert!(held.iter().any(|&v| v < n) && held.iter().any(|&v| v >= n));
    assert!(held.len() < n, "{} of {} vertices", held.len(), 2 * n);
    // Rigid to first order.
    for &a in &held {
        for &b in &held {
            assert!((scene.x[a] - scene.x[b]).dot(&(path(a) - path(b))).abs() < 1e-14);
        }
    }
}

#[test]
fn what_hits_an_obstacle_stays_with_it() {
    let scene = Scene::vertex_above_triangle(0.5);
    let mut target = scene.x.clone();
    target[3] += Vector::new(0.3, 0.1, -1.0);
    // At rest: locked where it started.
    let (x, _) = run(&scene, &target, &[]);
    assert_eq!(x, scene.x);
    // The obstacle comes up and to the side: the vertex is taken along.
    target[..3].iter_mut().for_each(|y| *y += Vector::new(0.1, 0.0, 0.7));
    let (x, _) = run(&scene, &target, &[]);
    for v in 0..4 {
        assert!((x[v] - scene.x[v] - Vector::new(0.1, 0.0, 0.7)).norm() < 1e-12);
    }
    // It bends: nobody can follow, all wait.
    target[1].z += 0.2;
    let (x, _) = run(&scene, &target, &[]);
    assert_eq!(x, scene.x);
}

#[test]
fn pins_of_a_group_wait_together() {
    // Two corners of the lower sheet are pinned; one would go through the ground, the other to the side.
    let scene = Scene::heap(0.02);
    let count = scene.x.len();
    let (down, aside) = (0, 15);
    let mut target = scene.x.clone();
    target[down].z -= 0.1;
    target[aside].x += 0.01;
    let mut prescribed = vec![false; count];
    let mut groups = vec![ResolveInput::NO_GROUP; count];
    for v in [down, aside] {
        (prescribed[v], groups[v]) = (true, 7);
    }
    for grouped in [true, false] {
        let mut zones = RigidZones::new(scene.collision_scene(Params::fast()));
        let mut x = scene.x.clone();
        let groups = if grouped { &groups[..] } else { &[] };
        let input = ResolveInput {
            prescribed: &prescribed,
            groups,
            time_step: Some(0.01),
            ..ResolveInput::default()
        };
        zones.solve(&mut x, &target, &input).unwrap();
        assert_eq!(x[down], scene.x[down]);
        assert_eq!(x[aside], if grouped { scene.x[aside] } else { target[aside] });
    }
}

#[test]
fn random_heaps_are_never_cut() {
    for seed in 0..20 {
        let scene = Scene::heap(0.02);
        let mut draw = Draw::new(seed);
        let size = 10f64.powf(1.5 * draw.next() - 1.5);
        // The obstacle of three vertices at the end rests.
        let movable = scene.x.len() - 3;
        let target: Vec<Point> = (scene.x.iter().enumerate())
            .map(|(v, x)| if v < movable { x + size * draw.vector() } else { *x })
            .collect();
        run(&scene, &target, &[]);
    }
}
