use crate::common::{Scene, assert_same_on_any_number_of_threads, resolve_watched};
use bowknot_baselines::rows::{
    AugmentedLagrangian, InterStepChebyshev, LinearSystem, ProjectedJacobi, preserving_volume, two_way_with,
    two_way_with_stage,
};
use bowknot_baselines::twoway::geometry::{Point, Vector};
use bowknot_baselines::twoway::{
    BackwardStep, CertifiedForward, ColoredSweeps, LcpBackward, Params, Resolver, RowSolver, Statistics,
    TrustRegionSearch,
};
use bowknot_baselines::{Composed, Method};

/// The paper's parameters without edge limits, with at most `steps` steps.
fn params(steps: usize) -> Params {
    let mut params = Params::paper();
    params.contact.edges = false;
    params.solver.stop.max_steps = Some(steps);
    params
}

fn run<B: BackwardStep>(
    scene: &Scene,
    mut resolver: Resolver<TrustRegionSearch, B, CertifiedForward>,
    target: &[Point],
) -> (Vec<Point>, Statistics) {
    resolve_watched(&mut resolver, scene, target, std::any::type_name::<B>())
}

fn solve<K: RowSolver + Default>(
    scene: &Scene,
    solver: K,
    steps: usize,
    target: &[Point],
) -> (Vec<Point>, Statistics) {
    run(scene, two_way_with(scene.collision_scene(params(steps)), solver), target)
}

/// Pinned, because a step more or less is a change of the method.
#[test]
fn sheets_that_change_places_stay_apart_whatever_solves_the_rows() {
    let scene = Scene::two_sheets(4, 0.02);
    let target = scene.swapped();
    let count = |(_, statistics): (Vec<Point>, Statistics)| {
        assert!(statistics.converged);
        (statistics.steps, statistics.searches)
    };
    let steps = 400;
    let chebyshev = InterStepChebyshev::new(LcpBackward::with_solver(ProjectedJacobi::new(1, 0.0)), 0.9, 10);
    let counts = [
        ("Gauss-Seidel", count(solve(&scene, ColoredSweeps::default(), steps, &target))),
        ("linear system", count(solve(&scene, LinearSystem::default(), steps, &target))),
        ("projected", count(solve(&scene, LinearSystem::projected(), steps, &target))),
        ("augmented, 20", count(solve(&scene, AugmentedLagrangian::new(20), steps, &target))),
        ("augmented, 100", count(solve(&scene, AugmentedLagrangian::new(100), steps, &target))),
        ("Jacobi, 1", count(solve(&scene, ProjectedJacobi::new(1, 0.0), steps, &target))),
        ("Jacobi, 50", count(solve(&scene, ProjectedJacobi::new(50, 0.0), steps, &target))),
        ("Chebyshev, 50", count(solve(&scene, ProjectedJacobi::new(50, 0.95), steps, &target))),
        ("Chebyshev between steps", {
            count(run(&scene, two_way_with_stage(scene.collision_scene(params(steps)), chebyshev), &target))
        }),
    ];
    let expected = [
        ("Gauss-Seidel", (7, 3)),
        ("linear system", (5, 2)),
        ("projected", (7, 3)),
        ("augmented, 20", (4, 3)),
        ("augmented, 100", (5, 3)),
        ("Jacobi, 1", (133, 34)),
        ("Jacobi, 50", (8, 3)),
        ("Chebyshev, 50", (7, 3)),
        ("Chebyshev between steps", (130, 23)),
    ];
    assert_eq!(counts, expected);
}

#[test]
fn sheets_with_separating_targets_stick_with_the_linear_system_only() {
    let scene = Scene::two_sheets(4, 0.015);
    let n = scene.x.len() / 2;
    let target: Vec<Point> =
        scene.x.iter().enumerate().map(|(v, x)| if v < n { *x } else { x + 0.1 * Vector::z() }).collect();
    let left = |(x, _): (Vec<Point>, Statistics)| {
        x.iter().zip(&target).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max)
    };
    assert!(left(solve(&scene, ColoredSweeps::default(), 200, &target)) < 1e-4);
    assert!(left(solve(&scene, LinearSystem::projected(), 200, &target)) < 1e-4);
    assert!(left(solve(&scene, AugmentedLagrangian::new(20), 200, &target)) < 1e-4);
    assert!(left(solve(&scene, LinearSystem::default(), 200, &target)) > 0.04);
}

#[test]
fn the_default_with_gauss_seidel_named_is_the_default() {
    let scene = Scene::two_sheets(4, 0.02);
    let target = scene.swapped();
    let mut plain =
        Resolver::new(scene.model.clone(), &scene.x, &vec![0.01; scene.x.len()], Params::fast()).unwrap();
    let (x, _) = resolve_watched(&mut plain, &scene, &target, "plain");
    let (same, _) =
        run(&scene, two_way_with(scene.collision_scene(Params::fast()), ColoredSweeps::default()), &target);
    assert_eq!(x, same);
}

#[test]
fn results_have_the_same_bits_on_any_number_of_threads() {
    // Large enough for loops to be shared out.
    let scene = Scene::two_sheets(24, 0.02);
    let target = scene.swapped();
    assert_same_on_any_number_of_threads(|| {
        let collision = || scene.collision_scene(params(6));
        let chebyshev = InterStepChebyshev::new(LcpBackward::new(), 0.9, 2);
        let methods: [Box<dyn Method>; 4] = [
            Box::new(Composed::new("Harmon", two_way_with(collision(), LinearSystem::default()))),
            Box::new(Composed::new("Tang", two_way_with(collision(), AugmentedLagrangian::new(20)))),
            Box::new(Composed::new("Jacobi", two_way_with(collision(), ProjectedJacobi::new(20, 0.9)))),
            Box::new(Composed::new("Chebyshev", two_way_with_stage(collision(), chebyshev))),
        ];
        methods.map(|mut method| {
            let mut x = scene.x.clone();
            method.solve(&mut x, &target, &Default::default()).unwrap();
            x
        })
    });
}

#[test]
fn contacts_that_keep_their_volume_stay_as_near_as_they_start_and_others_open() {
    // Half of the contact distance apart, pressed onto each other.
    let scene = Scene::two_sheets(4, 0.005);
    let n = scene.x.len() / 2;
    let target: Vec<Point> = (scene.x.iter().enumerate())
        .map(|(v, x)| x + Vector::z() * if v < n { 0.01 } else { -0.01 })
        .collect();
    let gaps = |params: Params| {
        let collision = scene.collision_scene(params);
        assert!((collision.lengths().delta - 0.0112).abs() < 1e-4);
        let (x, statistics) = run(&scene, two_way_with(collision, ColoredSweeps::default()), &target);
        assert!(statistics.converged);
        // Both sheets have one and the same warp.
        let gaps = (0..n).map(|v| x[v + n].z - x[v].z);
        (gaps.clone().fold(f64::INFINITY, f64::min), gaps.fold(0.0, f64::max))
    };
    let (low, high) = gaps(preserving_volume(params(200)));
    assert!(low > 0.0045 && high < 0.0055, "{low} {high}");
    let mut slowly = params(200);
    slowly.contact.separation_speed = Some(0.224);
    let (low, high) = gaps(slowly);
    // 20 delta a second, for 1/100 s.
    assert!(low > 0.0065 && high < 0.008, "{low} {high}");
    // At once, to the whole contact distance.
    let (low, high) = gaps(params(200));
    assert!(low > 0.0111 && high < 0.012, "{low} {high}");
}
