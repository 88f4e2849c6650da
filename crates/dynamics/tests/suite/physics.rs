//! Cases with known answers: free fall, conservation, hanging and clamped strips, determinism.

use crate::common::{cloth_model, dynamics, sheet, weightless, with_gravity, with_tolerance};
use bowknot_dynamics::{Body, ClothMaterial, Dynamics, DynamicsParams, HessianFilter, PreconditionerKind};
use bowknot_geometry::{Point, Vector};

/// A sheet of nearly equilateral triangles: every second row is shifted by half a cell.
fn staggered_sheet(width: f64, height: f64, columns: usize, rows: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (mut positions, _) = sheet(width, height, columns, rows);
    let cell = width / columns as f64;
    for j in (1..=rows).step_by(2) {
        // Inner vertices move half a cell; both ends stay, so the outline is the same.
        for i in 1..columns {
            positions[i + j * (columns + 1)].x -= 0.5 * cell;
        }
    }
    let index = |i: usize, j: usize| (i + j * (columns + 1)) as u32;
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let (a, b, c, d) = (index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
            if j % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    (positions, triangles)
}

/// A sheet whose diagonals are parallel.
fn parallel_sheet(width: f64, height: f64, columns: usize, rows: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
    let (positions, _) = sheet(width, height, columns, rows);
    let index = |i: usize, j: usize| (i + j * (columns + 1)) as u32;
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let (a, b, c, d) = (index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1));
        [[a, b, c], [a, c, d]]
    });
    (positions, triangles.collect())
}

/// A wavy sheet with a turbulent velocity, floating.
fn floating(params: DynamicsParams, material: ClothMaterial) -> (Dynamics, Vec<Point>, Vec<Vector>) {
    let (rest, triangles) = sheet(0.5, 0.4, 20, 16);
    let dynamics = Dynamics::new(cloth_model(&rest, triangles, material), params).expect("valid");
    let x = rest.iter().map(|p| p + Vector::new(0.0, 0.0, 0.05 * (20.0 * p.x).sin() * (15.0 * p.y).cos()));
    let v = rest.iter().map(|p| {
        Vector::new(0.3 + (9.0 * p.y).sin(), -0.2 + p.x, (13.0 * p.x).cos())
            + Vector::z().cross(&p.coords) * 5.0
    });
    (dynamics, x.collect(), v.collect())
}

#[test]
fn both_preconditioners_lead_to_the_same_target() {
    let target = |kind: PreconditionerKind| {
        let mut params = with_tolerance(1e-9);
        params.newton.preconditioner = kind;
        let (mut dynamics, x, v) = floating(params, ClothMaterial::cotton());
        dynamics.begin_step(&x, &v, 0.01).expect("valid");
        let (held, mut y) = (vec![false; x.len()], x.clone());
        let info = dynamics.newton_target(&x, &held, &x, &mut y).expect("valid");
        assert!(info.cg.converged, "{info:?}");
        (y, info.cg.iterations)
    };
    let (by_blocks, many) = target(PreconditionerKind::BlockJacobi);
    let (by_levels, few) = target(PreconditionerKind::TwoLevel);
    let apart = by_blocks.iter().zip(&by_levels).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-6, "{apart} m");
    assert!(many > 2 * few, "{many} and {few} iterations");
}

#[test]
fn a_linear_solve_of_one_body_does_not_depend_on_another() {
    // A wavy sheet that hangs from an edge, alone and beside a stiffer one that needs more iterations.
    let (rest, triangles) = sheet(0.5, 0.4, 20, 16);
    let count = rest.len();
    let target = |bodies: usize| {
        let stiffness = [ClothMaterial::cotton(), ClothMaterial::denim()];
        let offset = |body: usize| Vector::new(6.0 * body as f64, 0.0, 0.0);
        let places: Vec<Point> = (0..bodies).flat_map(|b| rest.iter().map(move |p| p + offset(b))).collect();
        let body = |b: usize| {
            let own = triangles.iter().map(|t| t.map(|v| v + (b * count) as u32)).collect();
            Body::cloth(format!("sheet {b}"), own, stiffness[b])
        };
        let mut dynamics = dynamics(&places, (0..bodies).map(body).collect(), DynamicsParams::default());
        let wave = |(k, p): (usize, &Point)| {
            let size = 0.002 * (1.0 + 2.0 * (k / count) as f64);
            p + Vector::new(0.0, 0.0, size * (20.0 * p.x).sin() * (15.0 * p.y).cos())
        };
        let x: Vec<Point> = places.iter().enumerate().map(wave).collect();
        let held: Vec<bool> = (0..x.len()).map(|k| k % count <= 20).collect();
        dynamics.begin_step(&x, &vec![Vector::zeros(); x.len()], 0.01).expect("a time step");
        let mut y = x.clone();
        let info = dynamics.newton_target(&x, &held, &x, &mut y).expect("a target");
        assert_eq!((info.iterations, info.step_length), (1, 1.0));
        (info.cg.iterations, y)
    };
    let ((alone, one), (beside, both)) = (target(1), target(2));
    assert!(beside > alone, "{alone} {beside}");
    assert_eq!(one, both[..count]);
}

#[test]
fn free_fall_is_exact() {
    let (rest, triangles) = parallel_sheet(0.5, 0.4, 20, 16);
    let model = cloth_model(&rest, triangles, ClothMaterial::cotton());
    let mut dynamics = Dynamics::new(model, DynamicsParams::default()).expect("valid");
    let velocity = Vector::new(1.0, 2.0, 3.0);
    let (mut x, mut v) = (rest.clone(), vec![velocity; rest.len()]);
    let none = vec![false; rest.len()];
    let (dt, steps) = (0.05, 20);
    for _ in 0..steps {
        let infos = dynamics.solve_step(&mut x, &mut v, dt, &none, &rest, 1).expect("solves");
        // The guess, where inertia leads, is the solution.
        assert_eq!(infos[0].cg.iterations, 0);
    }
    // Implicit Euler: v_n = v_0 + n dt g, x_n = x_0 + n dt v_0 + n (n + 1)/2 dt^2 g.
    let (n, g) = (steps as f64, dynamics.params().environment.gravity);
    for k in 0..rest.len() {
        let expected = rest[k] + velocity * (n * dt) + g * (0.5 * n * (n + 1.0) * dt * dt);
        // Each step rounds positions to 1e-15; v = (x1 - x0) / dt accumulates these errors to about 1e-11.
        assert!((x[k] - expected).norm() < 1e-10, "vertex {k}: {} {expected}", x[k]);
        assert!((v[k] - (velocity + g * (n * dt))).norm() < 1e-10 / dt);
    }
}

#[test]
fn linear_momentum_is_conserved_at_any_tolerance() {
    for cg_tolerance in [1e-2, 1e-8] {
        let material = ClothMaterial { stretch_damping: 0.01, bend_damping: 0.1, ..ClothMaterial::cotton() };
        let (mut dynamics, mut x, mut v) = floating(weightless(with_tolerance(cg_tolerance)), material);
        let none = vec![false; x.len()];
        let before = dynamics.momentum(&v);
        let center = dynamics.center_of_mass(&x);
        for _ in 0..20 {
            let keyframes = x.clone();
            dynamics.solve_step(&mut x, &mut v, 0.01, &none, &keyframes, 2).expect("solves");
        }
        let after = dynamics.momentum(&v);
        assert!((after - before).norm() < 1e-10 * before.norm(), "{before} became {after}");
        let drift = dynamics.center_of_mass(&x) - center - before / dynamics.model().total_mass() * 0.2;
        assert!(drift.norm() < 1e-10);
    }
}

#[test]
fn angular_momentum_stays_where_implicit_euler_would_lose_it() {
    // Strain-rate damping is included; bending damping depends on rotations and is left out.
    let material = ClothMaterial { stretch_damping: 0.01, ..ClothMaterial::cotton() };
    let mut params = weightless(with_tolerance(1e-12));
    // Over many iterations this filter converges faster.
    params.newton.hessian_filter = HessianFilter::Clamp;
    let (mut dynamics, mut x, mut v) = floating(params, material);
    let none = vec![false; x.len()];
    let dt = 0.002;
    for _ in 0..3 {
        let (x0, v0) = (x.clone(), v.clone());
        let infos = dynamics.solve_step(&mut x, &mut v, dt, &none, &x0, 40).expect("solves");
        assert!(infos[39].max_displacement < 1e-10, "{:?}", infos[39]);
        let before = dynamics.angular_momentum(&x0, &v0);
        let after = dynamics.angular_momentum(&x, &v);
        let difference = (after - before).norm();
        assert!(difference < 1e-9 * before.norm(), "off by {difference:e} of {}", before.norm());
    }
}

#[test]
fn energy_never_grows_without_external_work() {
    let params = weightless(DynamicsParams::default());
    let (mut dynamics, mut x, mut v) = floating(params, ClothMaterial::cotton());
    let none = vec![false; x.len()];
    let mut energy = dynamics.energies(&x, &v).total();
    let first = energy;
    for step in 0..60 {
        let keyframes = x.clone();
        dynamics.solve_step(&mut x, &mut v, 0.01, &none, &keyframes, 4).expect("solves");
        let now = dynamics.energies(&x, &v).total();
        assert!(now <= energy * (1.0 + 1e-9), "step {step}: {energy} J became {now} J");
        energy = now;
    }
    assert!(energy < first);
}

#[test]
fn damping_from_rest_is_added_stiffness() {
    // Starting at rest shape, K dx + damping K dx / dt = (1 + damping / dt) K dx for small dx.
    let dt = 0.01;
    let stiff = ClothMaterial { bend_stiffness: 1e-3, ..ClothMaterial::cotton() };
    let step = |material: ClothMaterial| {
        let (mut dynamics, _, v) = floating(weightless(with_tolerance(1e-12)), material);
        let mut x = dynamics.model().rest_positions().to_vec();
        let mut v: Vec<Vector> = v.iter().map(|v| v * 1e-5).collect();
        let keyframes = x.clone();
        dynamics
            .solve_step(&mut x, &mut v, dt, &vec![false; keyframes.len()], &keyframes, 3)
            .expect("solves");
        v
    };
    let largest = |v: &[Vector]| v.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let difference = |a: &[Vector], b: &[Vector]| {
        a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) / largest(b)
    };
    let undamped = step(stiff);
    let factor = 3.0;
    for (name, damped, stiffer) in [
        (
            "stretch",
            ClothMaterial { stretch_damping: (factor - 1.0) * dt, ..stiff },
            ClothMaterial { stretch_stiffness: factor * stiff.stretch_stiffness, ..stiff },
        ),
        (
            "bend",
            ClothMaterial { bend_damping: (factor - 1.0) * dt, ..stiff },
            ClothMaterial { bend_stiffness: factor * stiff.bend_stiffness, ..stiff },
        ),
    ] {
        let (damped, stiffer) = (step(damped), step(stiffer));
        // The amplitude is 1e-7 m in cells of 25 mm; this is the error of the linearization.
        assert!(difference(&damped, &stiffer) < 1e-4, "{name}: {}", difference(&damped, &stiffer));
        assert!(difference(&damped, &undamped) > 1e-2, "{name}: no effect");
    }
}

#[test]
fn air_drag_decays_velocity() {
    let (rest, triangles) = parallel_sheet(0.5, 0.4, 4, 4);
    let mut params = weightless(DynamicsParams::default());
    params.environment.air_drag = 2.0;
    let mut dynamics =
        Dynamics::new(cloth_model(&rest, triangles, ClothMaterial::cotton()), params).expect("valid");
    let (mut x, mut v) = (rest.clone(), vec![Vector::x(); rest.len()]);
    let none = vec![false; rest.len()];
    dynamics.solve_step(&mut x, &mut v, 0.05, &none, &rest, 1).expect("solves");
    // Implicit Euler of v' = -a v.
    assert!(v.iter().all(|v| (v - Vector::x() / 1.1).norm() < 1e-9), "{}", v[0]);
}

/// Static equilibrium: steps so long that inertia has no effect.
fn settle(dynamics: &mut Dynamics, x: &mut [Point], prescribed: &[bool], steps: usize) {
    let keyframes = x.to_vec();
    for _ in 0..steps {
        let mut v = vec![Vector::zeros(); x.len()];
        let infos = dynamics.solve_step(x, &mut v, 100.0, prescribed, &keyframes, 4).expect("solves");
        assert!(infos.iter().all(|i| i.cg.converged), "{infos:?}");
    }
}

#[test]
fn a_hanging_strip_meets_its_analytic_stretch() {
    // With free sides and nu = 0 it lengthens by rho g L^2 / (2 Et), exactly so for linear elements.
    let (length, material) = (2.0, ClothMaterial { poisson_ratio: 0.0, ..ClothMaterial::cotton() });
    let sheets =
        [("alternating", sheet(0.1, length, 4, 80)), ("parallel", parallel_sheet(0.1, length, 4, 80))];
    for (diagonals, (flat, triangles)) in sheets {
        let rest: Vec<Point> = flat.iter().map(|p| Point::new(p.x, 0.0, -p.y)).collect();
        let mut dynamics =
            Dynamics::new(cloth_model(&rest, triangles, material), with_tolerance(1e-9)).expect("valid");
        let prescribed: Vec<bool> = rest.iter().map(|p| p.z == 0.0).collect();
        let mut x = rest.clone();
        settle(&mut dynamics, &mut x, &prescribed, 3);
        let lowest = x.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        let expected = material.density * 9.81 * length * length / (2.0 * material.stretch_stiffness);
        let found = -lowest - length;
        // Single triangles at the corners share the load unevenly across the width: 0.1 %.
        assert!((found / expected - 1.0).abs() < 2e-3, "{diagonals}: {found} m, analytic {expected} m");
    }
}

#[test]
fn a_clamped_strip_meets_its_sag() {
    // w = q L^4 / (8 D), small against L. The first two rows are held, so the strip is clamped half a cell
    // beyond the first row: the hinge at the second row represents half a cell on either side.
    let (columns, length) = (50, 0.25);
    let cell = length / columns as f64;
    let material =
        ClothMaterial { bend_stiffness: 0.2, stretch_stiffness: 1000.0, ..ClothMaterial::cotton() };
    let meshes = [
        ("parallel", parallel_sheet(length, 0.05, columns, 10)),
        ("alternating", sheet(length, 0.05, columns, 10)),
        ("staggered", staggered_sheet(length, 0.05, columns, 10)),
    ];
    for (name, (rest, triangles)) in meshes {
        let mut dynamics =
            Dynamics::new(cloth_model(&rest, triangles, material), with_tolerance(1e-10)).expect("valid");
        let prescribed: Vec<bool> = rest.iter().map(|p| p.x < 1.1 * cell).collect();
        let mut x = rest.clone();
        settle(&mut dynamics, &mut x, &prescribed, 3);
        let tips: Vec<f64> = x.iter().zip(&rest).filter(|(_, r)| r.x == length).map(|(p, _)| -p.z).collect();
        let found = tips.iter().sum::<f64>() / tips.len() as f64;
        let free = length - 0.5 * cell;
        let expected = material.density * 9.81 * free.powi(4) / (8.0 * material.bend_stiffness);
        println!("{name}: sag {found:.6} m, analytic {expected:.6} m, ratio {:.4}", found / expected);
        assert!(expected < 0.02 * length);
        assert!((found / expected - 1.0).abs() < 0.03, "{name}: {found} m, analytic {expected} m");
    }
}

#[test]
fn prescribed_vertices_follow_their_keyframes_and_drag_the_rest() {
    let (rest, triangles) = sheet(0.2, 0.2, 8, 8);
    let mut all = rest.clone();
    all.push(Point::new(9.0, 9.0, 9.0));
    let bodies = vec![
        Body::cloth("sheet", triangles, ClothMaterial::cotton()),
        Body::obstacle("marker", vec![rest.len() as u32]),
    ];
    let mut dynamics = dynamics(&all, bodies, weightless(DynamicsParams::default()));
    let prescribed: Vec<bool> = (0..all.len()).map(|k| k <= 8).collect();
    let (mut x, mut v) = (all.clone(), vec![Vector::zeros(); all.len()]);
    let speed = Vector::new(0.0, 0.0, 1.0);
    let dt = 0.02;
    for step in 1..=50 {
        let keyframes: Vec<Point> = all.iter().map(|p| p + speed * (step as f64 * dt)).collect();
        dynamics.solve_step(&mut x, &mut v, dt, &prescribed, &keyframes, 3).expect("solves");
        for k in (0..=8).chain([all.len() - 1]) {
            // Obstacles are always prescribed.
            assert_eq!(x[k], keyframes[k]);
        }
    }
    // After a second the sheet has followed for most of the way.
    assert!(x[..all.len() - 1].iter().all(|p| p.z > 0.7), "some vertex stayed behind");
    assert!(dynamics.max_stretch(&x) < 1.1);
}

#[test]
fn external_forces_accelerate() {
    let (rest, triangles) = sheet(0.2, 0.2, 8, 8);
    let model = cloth_model(&rest, triangles, ClothMaterial::cotton());
    let mut dynamics = Dynamics::new(model, DynamicsParams::default()).expect("valid");
    // The opposite of the weight: the sheet stays where it is.
    let gravity = dynamics.params().environment.gravity;
    let lift: Vec<Vector> = dynamics.model().masses().iter().map(|&m| -gravity * m).collect();
    dynamics.set_external_forces(&lift).expect("valid");
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    dynamics.solve_step(&mut x, &mut v, 0.1, &vec![false; rest.len()], &rest, 1).expect("solves");
    assert!(x.iter().zip(&rest).all(|(a, b)| (a - b).norm() < 1e-14));
}

#[test]
fn scaled_problems_have_scaled_answers() {
    // With lengths and times multiplied by k, the same density and Et, D k^2 and gravity / k, all terms scale
    // alike.
    let run = |k: f64| {
        let (rest, triangles) = sheet(0.3 * k, 0.3 * k, 10, 10);
        let cotton = ClothMaterial::cotton();
        let material = ClothMaterial { bend_stiffness: cotton.bend_stiffness * k * k, ..cotton };
        let params = with_gravity(with_tolerance(1e-11), Vector::new(0.0, 0.0, -9.81 / k));
        let mut dynamics = Dynamics::new(cloth_model(&rest, triangles, material), params).expect("valid");
        let prescribed: Vec<bool> = (0..rest.len()).map(|v| v == 0).collect();
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        for _ in 0..5 {
            dynamics.solve_step(&mut x, &mut v, 0.01 * k, &prescribed, &rest, 2).expect("solves");
        }
        x.into_iter().map(|p| p.coords / k).collect::<Vec<_>>()
    };
    // For a power of two rounding is the same as well.
    assert_eq!(run(1.0), run(64.0));
}

#[test]
fn the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            // Several chunks of nodes.
            let (rest, triangles) = sheet(0.5, 0.5, 50, 50);
            let model = cloth_model(&rest, triangles, ClothMaterial::cotton());
            let mut dynamics = Dynamics::new(model, DynamicsParams::default()).expect("valid");
            let prescribed: Vec<bool> = (0..rest.len()).map(|v| v == 0).collect();
            let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
            let mut iterations = 0;
            for _ in 0..5 {
                let infos = dynamics.solve_step(&mut x, &mut v, 0.02, &prescribed, &rest, 2).expect("solves");
                iterations += infos.iter().map(|i| i.cg.iterations).sum::<usize>();
            }
            let energies = dynamics.energies(&x, &v);
            let stretch = dynamics.max_stretch(&x);
            (x, v, energies, stretch, iterations)
        })
    };
    let one = run(1);
    assert!(one.4 > 100, "the solver had something to do");
    for threads in [2, 3, 7] {
        assert_eq!(run(threads), one, "{threads} threads");
    }
}

#[test]
fn a_step_does_not_depend_on_the_steps_before() {
    // A resumed run needs this: positions and velocities are the whole state.
    let (mut warm, mut x, mut v) = floating(DynamicsParams::default(), ClothMaterial::cotton());
    let none = vec![false; x.len()];
    for _ in 0..3 {
        let keyframes = x.clone();
        warm.solve_step(&mut x, &mut v, 0.01, &none, &keyframes, 2).expect("solves");
    }
    let (mut cold, _, _) = floating(DynamicsParams::default(), ClothMaterial::cotton());
    let (mut x_cold, mut v_cold) = (x.clone(), v.clone());
    let keyframes = x.clone();
    cold.solve_step(&mut x_cold, &mut v_cold, 0.01, &none, &keyframes, 2).expect("solves");
    warm.solve_step(&mut x, &mut v, 0.01, &none, &keyframes, 2).expect("solves");
    assert_eq!((x, v), (x_cold, v_cold));
}
