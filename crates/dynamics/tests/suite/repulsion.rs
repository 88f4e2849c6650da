//! Springs between sheets, and against obstacles.

use crate::common::{dynamics, sheet, weightless, with_gravity, with_tolerance};
use bowknot_dynamics::{Body, ClothMaterial, Dynamics, DynamicsParams, RepulsionSpring, StepError};
use bowknot_geometry::{Point, Vector};

/// Gap below which springs push [m].
const GAP: f64 = 0.004;

/// Two sheets, one above the other at a gap of 2 mm, and a floor of one vertex.
fn sheets(params: DynamicsParams) -> (Dynamics, Vec<Point>) {
    let (lower, triangles) = sheet(0.2, 0.2, 6, 6);
    let count = lower.len() as u32;
    let mut rest = lower.clone();
    rest.extend(lower.iter().map(|p| p + Vector::z() * 0.002));
    rest.push(Point::new(0.0, 0.0, -0.01));
    let upper = triangles.iter().map(|t| t.map(|v| v + count)).collect();
    let bodies = vec![
        Body::cloth("lower", triangles, ClothMaterial::cotton()),
        Body::cloth("upper", upper, ClothMaterial::cotton()),
        Body::obstacle("floor", vec![2 * count]),
    ];
    (dynamics(&rest, bodies, params), rest)
}

/// Springs between corresponding vertices of the sheets.
fn springs(count: u32, stiffness: f64) -> Vec<RepulsionSpring> {
    (0..count)
        .map(|v| RepulsionSpring {
            vertices: [v + count, v, 0, 0],
            weights: [1.0, -1.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            desired: GAP,
            stiffness,
            friction: 0.0,
            force: Vector::zeros(),
        })
        .collect()
}

#[test]
fn two_sheets_pushed_together_balance_by_a_depth_that_stiffness_divides() {
    let depth = |stiffness: f64| {
        let (mut dynamics, rest) = sheets(weightless(with_tolerance(1e-10)));
        let count = rest.len() / 2;
        // A force of 0.02 N on each sheet, a third of its weight, towards the other sheet; it is distributed
        // by mass.
        let masses = dynamics.model().masses().to_vec();
        let total: f64 = masses[..count].iter().sum();
        let forces: Vec<Vector> = (0..rest.len())
            .map(|v| Vector::z() * (0.02 * masses[v] / total * if v < count { 1.0 } else { -1.0 }))
            .collect();
        dynamics.set_external_forces(&forces).expect("finite");
        dynamics.set_repulsion(&springs(count as u32, stiffness)).expect("valid");
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let mut held = vec![false; rest.len()];
        held[2 * count] = true;
        for _ in 0..300 {
            let infos = dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 3).expect("solves");
            assert!(infos[2].cg.converged, "{infos:?}");
        }
        // The forces of springs are inner forces, so momentum is conserved.
        assert!(dynamics.momentum(&v).norm() < 1e-12, "{}", dynamics.momentum(&v));
        let gap: f64 = (0..count).map(|k| x[k + count].z - x[k].z).sum::<f64>() / count as f64;
        GAP - gap
    };
    let (soft, stiff) = (depth(100.0), depth(1000.0));
    assert!(stiff > 0.0 && stiff < 0.1 * GAP, "{stiff}");
    assert!((soft / stiff - 10.0).abs() < 0.01, "{soft} {stiff}");
}

#[test]
fn sheets_fly_together_with_their_momentum_at_any_tolerance() {
    let (mut dynamics, rest) = sheets(weightless(with_tolerance(1e-2)));
    let count = rest.len() / 2;
    dynamics.set_repulsion(&springs(count as u32, 10.0)).expect("valid");
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    (0..count).for_each(|k| v[k] = Vector::new(0.1, 0.0, 1.0));
    let held: Vec<bool> = (0..rest.len()).map(|k| k == 2 * count).collect();
    let before = dynamics.momentum(&v);
    for _ in 0..10 {
        dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 2).expect("solves");
    }
    assert!((dynamics.momentum(&v) - before).norm() < 1e-12 * before.norm());
    let mean = |range: std::ops::Range<usize>| range.map(|k| v[k].z).sum::<f64>() / count as f64;
    assert!(mean(count..2 * count) > 0.1, "the lower sheet pushed the upper: {}", mean(count..2 * count));
}

#[test]
fn targets_end_with_an_accurate_solve_and_a_residual_between_them_changes_no_bit() {
    let targets = |measured: bool| {
        let (mut dynamics, rest) = sheets(DynamicsParams::default());
        let tolerance = dynamics.params().newton.cg_tolerance;
        let count = rest.len() / 2;
        dynamics.set_repulsion(&springs(count as u32, 10.0)).expect("valid");
        let held: Vec<bool> = (0..rest.len()).map(|k| k == 2 * count).collect();
        let speed = |k: usize| Vector::new(0.0, (k as f64).cos(), if k < count { 1.0 } else { -1.0 });
        let v: Vec<Vector> = (0..rest.len()).map(speed).collect();
        dynamics.begin_step(&rest, &v, 0.01).expect("finite");
        let (mut x, mut y, mut targets) = (rest.clone(), rest.clone(), Vec::new());
        let mut solves = 0;
        for _ in 0..3 {
            let info = dynamics.newton_target(&x, &held, &rest, &mut y).expect("finite");
            assert!(info.cg.converged && info.cg.residual <= tolerance, "{info:?}");
            solves += info.iterations;
            x.copy_from_slice(&y);
            // The next target reuses the linearization of the residual.
            if measured {
                dynamics.residual(&x, &held, &vec![true; rest.len()]).expect("finite");
            }
            targets.push(y.clone());
        }
        assert!(solves > 3, "no target took more than one solve");
        targets
    };
    assert_eq!(targets(false), targets(true));
}

#[test]
fn obstacles_and_half_spaces_hold_a_sheet_up() {
    // Every vertex of the lower sheet has a spring against the half-space z < -5 mm (by an offset) or against
    // an obstacle's vertex (by its keyframe).
    for obstacle in [false, true] {
        let mut params = with_tolerance(1e-10);
        params.environment.air_drag = 5.0;
        let (mut dynamics, rest) = sheets(params);
        let count = (rest.len() / 2) as u32;
        let mut all = springs(count, 1000.0);
        all.extend((0..count).map(|v| RepulsionSpring {
            vertices: [v, 2 * count, 0, 0],
            weights: [1.0, if obstacle { -1.0 } else { 0.0 }, 0.0, 0.0],
            normal: Vector::z(),
            offset: if obstacle { 0.0 } else { -0.005 },
            desired: GAP,
            stiffness: 1000.0,
            friction: 0.0,
            force: Vector::zeros(),
        }));
        dynamics.set_repulsion(&all).expect("valid");
        let mut keyframes = rest.clone();
        keyframes[2 * count as usize].z = -0.005;
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let held = vec![false; rest.len()];
        for _ in 0..200 {
            dynamics.solve_step(&mut x, &mut v, 0.05, &held, &keyframes, 2).expect("solves");
        }
        let mean =
            |first: u32| (first..first + count).map(|k| x[k as usize].z).sum::<f64>() / f64::from(count);
        let (below, between) = (GAP - 0.005 - mean(0), GAP - (mean(count) - mean(0)));
        assert!(below > 0.0 && below < 0.2 * GAP && between > 0.0 && between < below, "{below} {between}");
        let speed = v[..2 * count as usize].iter().map(Vector::norm).fold(0.0, f64::max);
        assert!(speed < 1e-6, "{speed}");
    }
}

#[test]
fn springs_stick_below_the_angle_of_friction_and_slide_above_by_coulombs_law() {
    // A sheet on a plane, gravity tilted by 21.8 degrees: tan = 0.4.
    let (sine, cosine) = (0.4f64.atan().sin(), 0.4f64.atan().cos());
    let slid = |friction: f64, steps: usize| {
        let gravity = Vector::new(sine, 0.0, -cosine) * 9.81;
        let (mut dynamics, rest) = sheets(with_gravity(with_tolerance(1e-10), gravity));
        let count = (rest.len() / 2) as u32;
        let on_plane = |v: u32| RepulsionSpring {
            vertices: [v, 0, 0, 0],
            weights: [1.0, 0.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            desired: rest[v as usize].z,
            stiffness: 1e4,
            friction,
            force: Vector::zeros(),
        };
        dynamics.set_repulsion(&(0..2 * count).map(on_plane).collect::<Vec<_>>()).expect("valid");
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let held = vec![false; rest.len()];
        for _ in 0..steps {
            dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 2).expect("solves");
        }
        let moved = |k: usize| x[k].x - rest[k].x;
        (0..2 * count as usize).map(moved).sum::<f64>() / f64::from(2 * count)
    };
    assert!(slid(0.42, 50).abs() < 1e-5, "{}", slid(0.42, 50));
    for friction in [0.38, 0.2, 0.0] {
        // Implicit Euler: a dt^2 n (n + 1) / 2.
        let expected = 9.81 * (sine - friction * cosine) * 1e-4 * 50.0 * 51.0 / 2.0;
        let found = slid(friction, 50);
        assert!((found - expected).abs() < 0.03 * expected, "{friction}: {found} {expected}");
    }
}

#[test]
fn removed_springs_change_no_bit_and_bad_ones_are_refused() {
    let run = |clear: bool| {
        let (mut dynamics, rest) = sheets(DynamicsParams::default());
        if clear {
            dynamics.set_repulsion(&springs(49, 10.0)).expect("valid");
            dynamics.set_repulsion(&[]).expect("valid");
        }
        let (mut x, mut v) = (rest.clone(), vec![Vector::new(0.3, 0.1, 0.2); rest.len()]);
        v[3].z = 4.0;
        let held = vec![false; rest.len()];
        for _ in 0..3 {
            dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 2).expect("solves");
        }
        x
    };
    assert_eq!(run(false), run(true));

    let (mut dynamics, _) = sheets(DynamicsParams::default());
    let good = springs(2, 10.0);
    let refuse =
        |dynamics: &mut Dynamics, spring: RepulsionSpring| match dynamics.set_repulsion(&[good[0], spring]) {
            Err(StepError::Repulsion { spring, problem }) => (spring, problem.to_owned()),
            other => panic!("{other:?}"),
        };
    let (index, problem) = refuse(&mut dynamics, RepulsionSpring { vertices: [999, 0, 0, 0], ..good[0] });
    assert_eq!((index, problem.as_str()), (1, "it names a vertex that does not exist"));
    let (_, problem) = refuse(&mut dynamics, RepulsionSpring { stiffness: -1.0, ..good[0] });
    assert!(problem.starts_with("its stiffness"), "{problem}");
    let (_, problem) = refuse(&mut dynamics, RepulsionSpring { normal: Vector::repeat(f64::NAN), ..good[0] });
    assert!(problem.starts_with("its weights"), "{problem}");
}

/// A contact near a held vertex that is nearer than desired, on one that is free: to keep the gap the free vertex would
/// have to rise by a hundred gaps. It is asked for no more than the gap in its own place.
#[test]
fn springs_do_not_throw_what_hangs_on_held_vertices() {
    let rest = vec![
        Point::origin(),
        Point::new(0.1, 0.0, 0.0),
        Point::new(0.0, 0.1, 0.0),
        Point::new(0.0, 0.0, -0.001),
    ];
    let bodies = vec![
        Body::cloth("sheet", vec![[0, 1, 2]], ClothMaterial::cotton()),
        Body::obstacle("point", vec![3]),
    ];
    let mut dynamics = dynamics(&rest, bodies, weightless(with_tolerance(1e-8)));
    let spring = RepulsionSpring {
        vertices: [0, 1, 2, 3],
        weights: [0.98, 0.01, 0.01, -1.0],
        normal: Vector::z(),
        offset: 0.0,
        desired: GAP,
        stiffness: 10.0,
        friction: 0.0,
        force: Vector::zeros(),
    };
    dynamics.set_repulsion(&[spring]).expect("valid");
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); 4]);
    let held = [true, false, false, true];
    dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 4).expect("solves");
    let risen = x[1].z.max(x[2].z);
    assert!(risen > 0.5 * GAP && risen < 1.1 * GAP, "{risen}");
}
