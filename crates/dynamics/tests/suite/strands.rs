//! Strands and particles with known answers: threads, beams, curls, falls, conservation, mixed scenes.

use crate::common::{block, dynamics, equilibrium, sheet, strands, weightless, with_tolerance};
use bowknot_dynamics::{
    Body, ClothMaterial, Dynamics, DynamicsParams, NewtonParams, ParticleMaterial, RestShape, SolidMaterial,
    StrandMaterial,
};
use bowknot_geometry::{Point, Vector};

/// See [`equilibrium`].
fn settle(dynamics: &mut Dynamics, x: &mut [Point], held: &[bool], iterations: usize) {
    let keyframes = x.to_vec();
    equilibrium(dynamics, x, held, &keyframes, (1e3, iterations, 1e-7));
}

#[test]
fn a_hanging_thread_stretches_by_rho_g_l2_over_2ea() {
    let (length, nodes) = (0.5, 26);
    let (rest, edges) = strands(1, nodes, length, 0.1);
    let material = StrandMaterial { density: 0.01, stretch_stiffness: 10.0, ..StrandMaterial::yarn() };
    let mut dynamics =
        dynamics(&rest, vec![Body::strands("thread", edges, material)], DynamicsParams::default());
    let held: Vec<bool> = (0..nodes).map(|k| k == 0).collect();
    let mut x = rest.clone();
    settle(&mut dynamics, &mut x, &held, 5);
    // With half the mass of each edge at either end the sum is exact.
    let expected = 0.01 * 9.81 * length * length / (2.0 * 10.0);
    let stretch = rest[nodes - 1].z - x[nodes - 1].z;
    assert!((stretch - expected).abs() < 1e-9, "{stretch} {expected}");
}

#[test]
fn a_clamped_strand_meets_beam_theory() {
    // The tip of a beam under its own weight sags by q L^4 / (8 EI). Held by its first two vertices, the beam
    // is clamped in the middle of the edge between them: the bending spring at the second vertex represents
    // half a cell on either side.
    let (cells, length) = (40, 0.2f64);
    let rest: Vec<Point> =
        (0..=cells + 1).map(|k| Point::new(length * (k as f64 - 1.0) / cells as f64, 0.0, 0.0)).collect();
    let edges: Vec<[u32; 2]> = (0..=cells as u32).map(|k| [k, k + 1]).collect();
    let material = StrandMaterial::straw();
    let mut dynamics =
        dynamics(&rest, vec![Body::strands("beam", edges, material)], DynamicsParams::default());
    let held: Vec<bool> = (0..rest.len()).map(|k| k < 2).collect();
    let mut x = rest.clone();
    settle(&mut dynamics, &mut x, &held, 8);
    let free = length * (1.0 + 0.5 / cells as f64);
    let expected = material.density * 9.81 * free.powi(4) / (8.0 * material.bend_stiffness);
    let tip = -x[rest.len() - 1].z;
    assert!((tip / expected - 1.0).abs() < 0.005, "{tip} {expected}");
}

#[test]
fn curls_rest_and_straight_rest_shapes_uncurl() {
    // A helix with the rest shape `initial` keeps its shape; with `flat` it opens.
    let rest: Vec<Point> = (0..60)
        .map(|k| {
            let angle = 0.3 * f64::from(k);
            Point::new(0.01 * angle.cos(), 0.01 * angle.sin(), -0.001 * f64::from(k))
        })
        .collect();
    let edges: Vec<[u32; 2]> = (0..59).map(|k| [k, k + 1]).collect();
    let span = |x: &[Point]| (x[59] - x[0]).norm();
    for (rest_shape, opens) in [(RestShape::Initial, false), (RestShape::Flat, true)] {
        let material = StrandMaterial { rest_shape, ..StrandMaterial::hair() };
        let body = Body::strands("curl", edges.clone(), material);
        let mut dynamics = dynamics(&rest, vec![body], weightless(DynamicsParams::default()));
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); 60]);
        for _ in 0..40 {
            let keyframes = x.clone();
            dynamics.solve_step(&mut x, &mut v, 0.01, &[false; 60], &keyframes, 2).expect("solves");
        }
        let moved = x.iter().zip(&rest).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        if opens {
            assert!(span(&x) > 1.5 * span(&rest), "{} {}", span(&x), span(&rest));
        } else {
            assert!(moved < 1e-10, "{moved:e}");
        }
    }
}

#[test]
fn momenta_of_flying_strands_are_conserved() {
    let (rest, edges) = strands(3, 20, 0.2, 0.03);
    let material = StrandMaterial { stretch_damping: 0.001, ..StrandMaterial::hair() };
    // A yarn joins the strands, which therefore branch.
    let bodies = vec![
        Body::strands("hair", edges, material),
        Body::strands("tie", vec![[5, 25], [25, 45]], StrandMaterial::yarn()),
    ];
    let mut dynamics = dynamics(&rest, bodies, weightless(with_tolerance(1e-12)));
    let mut x = rest.clone();
    let mut v: Vec<Vector> = (0..rest.len())
        .map(|k| {
            Vector::new((k as f64).sin(), 0.2, (0.7 * k as f64).cos()) * 0.05
                + Vector::x().cross(&rest[k].coords) * 5.0
        })
        .collect();
    let none = vec![false; x.len()];
    let dt = 0.001;
    for _ in 0..5 {
        let (x0, v0) = (x.clone(), v.clone());
        let infos = dynamics.solve_step(&mut x, &mut v, dt, &none, &x0, 60).expect("solves");
        assert!(infos[59].max_displacement < 1e-11, "{:?}", infos[59]);
        assert!(
            (dynamics.momentum(&v) - dynamics.momentum(&v0)).norm() < 1e-12 * dynamics.momentum(&v0).norm()
        );
        let before = dynamics.angular_momentum(&x0, &v0);
        let difference = (dynamics.angular_momentum(&x, &v) - before).norm();
        assert!(difference < 1e-8 * before.norm(), "off by {difference:e} of {}", before.norm());
    }
}

#[test]
fn hair_is_solved_in_a_few_iterations_however_stiff() {
    // 100 hairs of 40 nodes that move sideways: EA / L is 10^7 times inertia.
    let (rest, edges) = strands(100, 40, 0.3, 0.005);
    let mut dynamics = dynamics(
        &rest,
        vec![Body::strands("hair", edges, StrandMaterial::hair())],
        DynamicsParams::default(),
    );
    let held: Vec<bool> = (0..rest.len()).map(|k| k % 40 < 2).collect();
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    v.iter_mut().zip(&rest).for_each(|(v, p)| v.x = -2.0 * p.z);
    for _ in 0..10 {
        for info in dynamics.solve_step(&mut x, &mut v, 0.01, &held, &rest, 2).expect("solves") {
            assert!(info.cg.converged && info.cg.iterations <= 3 * info.iterations, "{info:?}");
        }
    }
    assert!(dynamics.max_stretch(&x) < 1.01, "{}", dynamics.max_stretch(&x));
}

/// Angle below the horizontal of a straw that is hinged at one end and falls for 0.2 s from the horizontal
/// [rad].
fn fallen(correcting_iterations: usize) -> f64 {
    let (length, nodes) = (0.3, 13);
    let rest: Vec<Point> =
        (0..nodes).map(|k| Point::new(length * k as f64 / (nodes - 1) as f64, 0.0, 0.0)).collect();
    let edges = (1..nodes as u32).map(|k| [k - 1, k]).collect();
    let params = DynamicsParams {
        newton: NewtonParams { correcting_iterations, ..NewtonParams::default() },
        ..DynamicsParams::default()
    };
    let mut dynamics = dynamics(&rest, vec![Body::strands("straw", edges, StrandMaterial::straw())], params);
    let held: Vec<bool> = (0..nodes).map(|k| k == 0).collect();
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); nodes]);
    for _ in 0..40 {
        dynamics.solve_step(&mut x, &mut v, 0.005, &held, &rest, 1).expect("solves");
    }
    (-x[nodes - 1].z).atan2(x[nodes - 1].x)
}

#[test]
fn a_stiff_straw_falls_as_a_rigid_rod_does() {
    // theta'' = (3 g / 2 L) cos theta, integrated with small explicit steps.
    let (mut angle, mut rate, dt) = (0.0f64, 0.0f64, 1e-5);
    for _ in 0..20_000 {
        rate += dt * 1.5 * 9.81 / 0.3 * angle.cos();
        angle += dt * rate;
    }
    let corrected = fallen(NewtonParams::default().correcting_iterations);
    assert!((corrected / angle - 1.0).abs() < 0.05, "{corrected}, not {angle}");
    // A single Newton step is shortened by the line search, because a straight motion stretches a rod that
    // rotates.
    assert!(fallen(0) < 0.5 * angle, "{}", fallen(0));
}

/// Cloth above a solid, hair of which two are rooted in them, and grains, some with a gravity of their own.
fn mixed(params: DynamicsParams) -> (Dynamics, Vec<Point>, Vec<Vector>) {
    let (mut rest, triangles) = sheet(0.3, 0.3, 12, 12);
    let mut bodies = vec![Body::cloth("sheet", triangles, ClothMaterial::cotton())];
    let mut append = |positions: Vec<Point>, shift: Vector| {
        let first = rest.len() as u32;
        rest.extend(positions.iter().map(|p| p + shift));
        first
    };
    let (positions, tets) = block([0.2, 0.2, 0.1], [6, 6, 3]);
    let first = append(positions, Vector::new(0.0, 0.0, -0.2));
    bodies.push(Body::solid(
        "block",
        tets.iter().map(|t| t.map(|v| v + first)).collect(),
        SolidMaterial::jelly(),
    ));
    let (positions, edges) = strands(30, 15, 0.1, 0.01);
    let hair = append(positions, Vector::new(0.0, 0.0, 0.3));
    let mut edges: Vec<[u32; 2]> = edges.iter().map(|e| e.map(|v| v + hair)).collect();
    // Two hairs are rooted in the sheet and in the block.
    edges.extend([[0, hair], [first, hair + 15]]);
    bodies.push(Body::strands("hair", edges, StrandMaterial::hair()));
    let grains =
        append((0..700).map(|k| Point::new(0.01 * f64::from(k), 0.0, 1.0)).collect(), Vector::zeros());
    let split = grains + 350;
    bodies.push(Body::particles("sand", (grains..split).collect(), ParticleMaterial::sand()));
    let moon = Vector::new(0.0, 0.0, -1.62);
    bodies.push(
        Body::particles("moon", (split..split + 350).collect(), ParticleMaterial::sand()).with_gravity(moon),
    );
    let v =
        (0..rest.len()).map(|k| Vector::new((k as f64).sin(), 0.0, (k as f64 * 0.3).cos()) * 0.3).collect();
    (dynamics(&rest, bodies, params), rest, v)
}

#[test]
fn the_change_of_energy_is_that_of_the_sums_before_and_after() {
    let (dynamics, start, _) = mixed(DynamicsParams::default());
    let (dt, resolution) = (0.01, 1e-7);
    let moved_by = |every: usize, size: f64| -> Vec<Point> {
        let turn =
            |v: usize| Vector::new((7 * v % 5) as f64 - 2.0, (3 * v % 7) as f64 - 3.0, (v % 3) as f64 - 1.0);
        let displaced =
            |(v, x): (usize, &Point)| if v.is_multiple_of(every) { x + turn(v) * size } else { *x };
        start.iter().enumerate().map(displaced).collect()
    };
    let total = |x: &[Point]| {
        let v: Vec<Vector> = x.iter().zip(&start).map(|(x, start)| (x - start) / dt).collect();
        dynamics.energies(x, &v).total()
    };
    let from = moved_by(1, 1e-4);
    for (every, size) in [(1, 3e-4), (2, 1e-3), (97, 1e-3)] {
        let x: Vec<Point> =
            from.iter().zip(moved_by(every, size)).zip(&start).map(|((a, b), c)| a + (b - c)).collect();
        let (before, after) = (total(&from), total(&x));
        let change = dynamics.energy_change(&start, &from, &x, dt, resolution);
        let error = (change - (after - before)).abs();
        assert!(error < 1e-11 * (before.abs() + after.abs()) && change != 0.0, "{every}: {change} {error:e}");
        // Displacements below the resolution, beside others, do not count.
        let noise = 0.3 * resolution;
        let noisy: Vec<Point> = x
            .iter()
            .zip(&from)
            .map(|(x, from)| if x == from { x + Vector::new(noise, noise, -noise) } else { *x })
            .collect();
        assert_eq!(dynamics.energy_change(&start, &from, &noisy, dt, resolution), change);
        assert_eq!(dynamics.energy_change(&start, &from, &noisy, dt, 1.0), 0.0);
    }
}

#[test]
fn mixed_scenes_converge_and_every_body_falls_as_it_must() {
    let (mut dynamics, mut x, mut v) = mixed(DynamicsParams::default());
    let none = vec![false; x.len()];
    let (x0, v0) = (x.clone(), v.clone());
    let before = dynamics.momentum(&v);
    for _ in 0..5 {
        let keyframes = x.clone();
        for info in dynamics.solve_step(&mut x, &mut v, 0.01, &none, &keyframes, 2).expect("solves") {
            assert!(info.cg.converged && info.cg.iterations < 300 * info.iterations, "{info:?}");
        }
    }
    let count = x.len();
    for k in count - 700..count {
        let g = if k < count - 350 { -9.81 } else { -1.62 };
        let expected = x0[k] + v0[k] * 0.05 + Vector::z() * (g * 0.01 * 0.01 * 15.0);
        assert!((x[k] - expected).norm() < 1e-12, "grain {k}: {} {expected}", x[k]);
    }
    // Gravity is the only outer force.
    let masses = dynamics.model().masses();
    let weight: f64 = (0..count)
        .map(|k| masses[k] * dynamics.model().gravity(k, dynamics.params().environment.gravity).z)
        .sum();
    let change = dynamics.momentum(&v) - before - Vector::z() * (weight * 0.05);
    assert!(change.norm() < 1e-10 * weight.abs(), "{change}");
    let energies = dynamics.model().elastic_energies(&x);
    for energy in [energies.membrane, energies.solid, energies.strand_stretching, energies.strand_bending] {
        assert!(energy > 0.0, "{energies:?}");
    }
}

#[test]
fn mixed_scenes_give_the_same_bits_for_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let (mut dynamics, mut x, mut v) = mixed(DynamicsParams::default());
            let none = vec![false; x.len()];
            for _ in 0..2 {
                let keyframes = x.clone();
                dynamics.solve_step(&mut x, &mut v, 0.02, &none, &keyframes, 2).expect("solves");
            }
            x
        })
    };
    assert_eq!(run(1), run(3));
}
