//! Springs between sheets, and against obstacles.

use crate::common::{dynamics, sheet, weightless, with_gravity, with_tolerance};
use bowknot_dynamics::{
    Body, ClothMaterial, Dynamics, DynamicsParams, RepulsionSpring, SpringKind, StepError,
};
use bowknot_geometry::{Point, Vector};

/// Gap below which springs push [m]: their reach; the floor is at 0.
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
            kind: SpringKind::Contact,
            vertices: [v + count, v, 0, 0],
            weights: [1.0, -1.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            reach: GAP,
            floor: 0.0,
            start_gap: 0.002,
            stiffness,
            friction: 0.0,
            friction_ratio: Vector::zeros(),
        })
        .collect()
}

/// Makes a time step as callers do: springs know the gaps at its start, and carry friction from the last one.
/// Returns the contact forces at its end.
fn step(
    dynamics: &mut Dynamics,
    springs: &mut [RepulsionSpring],
    (x, v): (&mut Vec<Point>, &mut Vec<Vector>),
    (dt, iterations): (f64, usize),
    (held, keyframes): (&[bool], &[Point]),
) -> Vec<Vector> {
    for s in &mut *springs {
        let sides: Vector = (0..4).map(|k| x[s.vertices[k] as usize].coords * s.weights[k]).sum();
        s.start_gap = s.normal.dot(&sides) - s.offset;
    }
    dynamics.set_repulsion(springs).expect("valid");
    let infos = dynamics.solve_step(x, v, dt, held, keyframes, iterations).expect("solves");
    assert!(infos.iter().all(|info| info.cg.converged), "{infos:?}");
    dynamics.residual(x, held, &vec![true; x.len()]).expect("finite");
    let forces = dynamics.contact_forces();
    for (s, force) in springs.iter_mut().zip(&forces) {
        let push = s.normal.dot(force);
        s.friction_ratio = if push > 0.0 { force / push - s.normal } else { Vector::zeros() };
    }
    forces
}

#[test]
fn two_sheets_pushed_together_come_nearer_by_load_over_stiffness() {
    // The share w of the room at which sheets balance that forces of `load` [N] push together.
    let share = |load: f64, stiffness: f64| {
        let (mut dynamics, rest) = sheets(weightless(with_tolerance(1e-10)));
        let count = rest.len() / 2;
        // Distributed by mass.
        let masses = dynamics.model().masses().to_vec();
        let total: f64 = masses[..count].iter().sum();
        let forces: Vec<Vector> = (0..rest.len())
            .map(|v| Vector::z() * (load * masses[v] / total * if v < count { 1.0 } else { -1.0 }))
            .collect();
        dynamics.set_external_forces(&forces).expect("finite");
        let mut springs = springs(count as u32, stiffness);
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let mut held = vec![false; rest.len()];
        held[2 * count] = true;
        let mut contact_forces = Vec::new();
        for _ in 0..300 {
            contact_forces = step(&mut dynamics, &mut springs, (&mut x, &mut v), (0.01, 3), (&held, &rest));
        }
        // The forces of springs are inner forces, so momentum is conserved.
        assert!(dynamics.momentum(&v).norm() < 1e-12, "{}", dynamics.momentum(&v));
        let pushed: f64 = contact_forces.iter().map(|f| f.z).sum();
        assert!((pushed / load - 1.0).abs() < 1e-3, "{pushed} of {load}");
        (0..count).map(|k| x[k + count].z - x[k].z).sum::<f64>() / count as f64 / GAP
    };
    // The law, and loads over stiffness: a third of the weight, twice that, both by a spring of another
    // stiffness.
    let law = |w: f64| (1.0 - w) / (w * w);
    let [light, heavy, stiff] = [share(0.02, 1.0), share(0.04, 1.0), share(0.02, 10.0)];
    assert!(heavy < light && light < stiff && stiff < 1.0 && heavy > 0.3, "{light} {heavy} {stiff}");
    let (by_load, by_stiffness) = (law(heavy) / law(light), law(light) / law(stiff));
    assert!((by_load - 2.0).abs() < 0.02 && (by_stiffness - 10.0).abs() < 0.1, "{by_load} {by_stiffness}");
}

/// Sheets that a repulsion pushes apart, also from far below the floor, where a contact would be stiffer.
#[test]
fn a_repulsion_pushes_by_its_depth_alone_and_conserves_momentum() {
    let pushed = |start: f64| {
        let (mut dynamics, mut x) = sheets(weightless(with_tolerance(1e-10)));
        let count = x.len() / 2;
        x[count..2 * count].iter_mut().for_each(|p| p.z = start);
        let mut springs = springs(count as u32, 2.0);
        springs.iter_mut().for_each(|spring| spring.kind = SpringKind::Repulsion);
        let (mut v, held) = (vec![Vector::zeros(); x.len()], vec![false; x.len()]);
        let keyframes = x.clone();
        let forces = step(&mut dynamics, &mut springs, (&mut x, &mut v), (0.01, 3), (&held, &keyframes));
        assert!(dynamics.momentum(&v).norm() < 1e-12);
        let depth = |k: usize| GAP - (x[k + count].z - x[k].z);
        (0..count).map(|k| forces[k].z / depth(k)).collect::<Vec<f64>>()
    };
    let [near, deep] = [pushed(0.002), pushed(-0.01)];
    assert!(near.iter().all(|stiffness| *stiffness > 0.0));
    for (near, deep) in near.iter().zip(&deep) {
        assert!((near / deep - 1.0).abs() < 1e-9, "{near} {deep} N/m");
    }
}

#[test]
fn sheets_fly_together_with_their_momentum_at_any_tolerance() {
    let (mut dynamics, rest) = sheets(weightless(with_tolerance(1e-2)));
    let count = rest.len() / 2;
    let mut springs = springs(count as u32, 10.0);
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    (0..count).for_each(|k| v[k] = Vector::new(0.1, 0.0, 1.0));
    let held: Vec<bool> = (0..rest.len()).map(|k| k == 2 * count).collect();
    let before = dynamics.momentum(&v);
    for _ in 0..10 {
        step(&mut dynamics, &mut springs, (&mut x, &mut v), (0.01, 2), (&held, &rest));
    }
    assert!((dynamics.momentum(&v) - before).norm() < 1e-12 * before.norm());
    let mean = |range: std::ops::Range<usize>| range.map(|k| v[k].z).sum::<f64>() / count as f64;
    assert!(mean(count..2 * count) > 0.1, "the lower sheet pushed the upper: {}", mean(count..2 * count));
}

/// A sheet on another that falls on a smooth plane of any slope and slides: gravity acts along the normal.
#[test]
fn sheets_keep_their_momentum_along_a_smooth_plane_at_any_tolerance() {
    for normal in [Vector::z(), Vector::new(0.3, -0.2, 0.9).normalize()] {
        let (mut dynamics, rest) = sheets(with_gravity(with_tolerance(1e-2), normal * -9.81));
        let count = rest.len() / 2;
        let mut springs = springs(count as u32, 10.0);
        let below = |s: &RepulsionSpring| {
            let weights = [0.0, 1.0, 0.0, 0.0];
            // Of different stiffness, so that the sheet is pushed unevenly.
            let stiffness = 5.0 + f64::from(s.vertices[1] % 7);
            RepulsionSpring { weights, normal, offset: -0.02, stiffness, ..*s }
        };
        springs.extend(springs.clone().iter().map(below));
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        (0..2 * count).for_each(|k| v[k] = Vector::new(0.1, 0.2, 0.0));
        let held: Vec<bool> = (0..rest.len()).map(|k| k == 2 * count).collect();
        let before = dynamics.momentum(&v);
        for _ in 0..20 {
            step(&mut dynamics, &mut springs, (&mut x, &mut v), (0.01, 2), (&held, &rest));
        }
        let change = dynamics.momentum(&v) - before;
        let across = change - normal * normal.dot(&change);
        assert!(across.norm() < 1e-12 * before.norm(), "{}", across.norm() / before.norm());
    }
}

#[test]
fn targets_end_with_an_accurate_solve_and_a_residual_between_them_changes_no_bit() {
    let targets = |measured: bool| {
        let (mut dynamics, rest) = sheets(DynamicsParams::default());
        let tolerance = dynamics.params().newton.cg_tolerance;
        let count = rest.len() / 2;
        let held: Vec<bool> = (0..rest.len()).map(|k| k == 2 * count).collect();
        let speed = |k: usize| Vector::new(0.0, (k as f64).cos(), if k < count { 1.0 } else { -1.0 });
        let v: Vec<Vector> = (0..rest.len()).map(speed).collect();
        dynamics.begin_step(&rest, &v, 0.01).expect("finite");
        let (mut x, mut y, mut targets) = (rest.clone(), rest.clone(), Vec::new());
        let mut solves = 0;
        for _ in 0..3 {
            // Contacts are found anew at each iterate.
            dynamics.set_repulsion(&springs(count as u32, 10.0)).expect("valid");
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
        let mut all = springs(count, 100.0);
        all.extend((0..count).map(|v| RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: [v, 2 * count, 0, 0],
            weights: [1.0, if obstacle { -1.0 } else { 0.0 }, 0.0, 0.0],
            normal: Vector::z(),
            offset: if obstacle { 0.0 } else { -0.005 },
            reach: GAP,
            floor: 0.0,
            start_gap: 0.0,
            stiffness: 100.0,
            friction: 0.0,
            friction_ratio: Vector::zeros(),
        }));
        let mut keyframes = rest.clone();
        keyframes[2 * count as usize].z = -0.005;
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let held = vec![false; rest.len()];
        let mut forces = Vec::new();
        for _ in 0..200 {
            forces = step(&mut dynamics, &mut all, (&mut x, &mut v), (0.05, 2), (&held, &keyframes));
        }
        let mean =
            |first: u32| (first..first + count).map(|k| x[k as usize].z).sum::<f64>() / f64::from(count);
        let (below, between) = (mean(0) + 0.005, mean(count) - mean(0));
        assert!([below, between].iter().all(|gap| *gap > 0.8 * GAP && *gap < GAP), "{below} {between}");
        // The sheets' contacts carry one sheet, those of the lower one both.
        let pushed = |range: std::ops::Range<u32>| range.map(|k| forces[k as usize].z).sum::<f64>();
        let weight = 9.81 * dynamics.model().masses()[..count as usize].iter().sum::<f64>();
        let carried = [pushed(0..count) / weight, pushed(count..2 * count) / weight];
        assert!((carried[0] - 1.0).abs() < 1e-3 && (carried[1] - 2.0).abs() < 2e-3, "{carried:?}");
        let speed = v[..2 * count as usize].iter().map(Vector::norm).fold(0.0, f64::max);
        assert!(speed < 1e-6, "{speed}");
    }
}

#[test]
fn springs_stick_below_the_angle_of_friction_and_slide_above_by_coulombs_law() {
    // A sheet on a plane, gravity tilted by 21.8 degrees: tan = 0.4.
    let (sine, cosine) = (0.4f64.atan().sin(), 0.4f64.atan().cos());
    // How far it has slid after each of 50 time steps.
    let slid = |friction: f64, stiffness: f64| -> Vec<f64> {
        let gravity = Vector::new(sine, 0.0, -cosine) * 9.81;
        let (mut dynamics, rest) = sheets(with_gravity(with_tolerance(1e-10), gravity));
        let count = (rest.len() / 2) as u32;
        let on_plane = |v: u32| RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: [v, 0, 0, 0],
            weights: [1.0, 0.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            reach: rest[v as usize].z,
            floor: rest[v as usize].z - GAP,
            start_gap: 0.0,
            stiffness,
            friction,
            friction_ratio: Vector::zeros(),
        };
        let mut springs: Vec<RepulsionSpring> = (0..2 * count).map(on_plane).collect();
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let held = vec![false; rest.len()];
        let mean = |x: &[Point]| {
            let moved = |k: usize| x[k].x - rest[k].x;
            (0..2 * count as usize).map(moved).sum::<f64>() / f64::from(2 * count)
        };
        let advance = |_| {
            step(&mut dynamics, &mut springs, (&mut x, &mut v), (0.01, 2), (&held, &rest));
            mean(&x)
        };
        (0..50).map(advance).collect()
    };
    // Contacts give way a little until friction holds, and creep no further.
    let stiff = slid(0.42, 1e4);
    assert!(stiff[49].abs() < 1e-5, "{stiff:?}");
    let soft = slid(0.42, 10.0);
    assert!(soft[49] < 0.25 * GAP && (soft[49] - soft[30]).abs() < 1e-6, "{soft:?}");
    for friction in [0.38, 0.2, 0.0] {
        // Implicit Euler: a dt^2 n (n + 1) / 2.
        let expected = 9.81 * (sine - friction * cosine) * 1e-4 * 50.0 * 51.0 / 2.0;
        let found = slid(friction, 1e4)[49];
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
    for floor in [GAP, 2.0 * GAP] {
        let (_, problem) = refuse(&mut dynamics, RepulsionSpring { floor, ..good[0] });
        assert_eq!(problem, "its floor must be below its reach");
    }
    for kind in [SpringKind::Limit, SpringKind::Repulsion] {
        let rough = RepulsionSpring { kind, friction: 0.1, ..good[0] };
        assert_eq!(refuse(&mut dynamics, rough).1, "only a contact has friction");
    }
    let (_, problem) = refuse(&mut dynamics, RepulsionSpring { stiffness: -1.0, ..good[0] });
    assert!(problem.starts_with("its stiffness"), "{problem}");
    let (_, problem) = refuse(&mut dynamics, RepulsionSpring { normal: Vector::repeat(f64::NAN), ..good[0] });
    assert!(problem.starts_with("its weights"), "{problem}");
}

/// A contact near a held vertex that is nearer than the reach, on one that is free: to keep the gap the free
/// vertex would have to rise by a hundred gaps. It is asked for no more than the gap in its own place.
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
        kind: SpringKind::Contact,
        vertices: [0, 1, 2, 3],
        weights: [0.98, 0.01, 0.01, -1.0],
        normal: Vector::z(),
        offset: 0.0,
        reach: GAP,
        floor: 0.0,
        start_gap: 0.001,
        stiffness: 10.0,
        friction: 0.0,
        friction_ratio: Vector::zeros(),
    };
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); 4]);
    let held = [true, false, false, true];
    // The drag lets it rise over several time steps.
    for _ in 0..4 {
        step(&mut dynamics, &mut [spring], (&mut x, &mut v), (0.01, 4), (&held, &rest));
    }
    let risen = x[1].z.max(x[2].z);
    assert!(risen > 0.5 * GAP && risen < 1.1 * GAP, "{risen}");
}
