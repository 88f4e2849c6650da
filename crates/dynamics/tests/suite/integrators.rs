//! The integrators against theory: free fall, vibration, order, rotation, impacts.

use crate::common::{block, cloth_model, sheet, weightless, with_tolerance};
use crate::custom::{grains, group, spring};
use bowknot_dynamics::{
    Body, ClothMaterial, Dynamics, DynamicsModel, DynamicsParams, Integrator, RepulsionSpring, SolidMaterial,
    SpringKind,
};
use bowknot_geometry::{Point, Vector};

fn sdirk2(params: DynamicsParams) -> DynamicsParams {
    DynamicsParams { integrator: Integrator::Sdirk2, ..params }
}

#[test]
fn free_fall_is_that_of_galileo() {
    let (rest, triangles) = sheet(0.5, 0.4, 20, 16);
    let model = cloth_model(&rest, triangles, ClothMaterial::cotton());
    let mut dynamics = Dynamics::new(model, sdirk2(DynamicsParams::default())).expect("valid");
    let velocity = Vector::new(1.0, 2.0, 3.0);
    let (mut x, mut v) = (rest.clone(), vec![velocity; rest.len()]);
    let none = vec![false; rest.len()];
    let (dt, steps) = (0.05, 20);
    for _ in 0..steps {
        dynamics.solve_step(&mut x, &mut v, dt, &none, &rest, 1).expect("solves");
    }
    let (t, g) = (f64::from(steps) * dt, dynamics.params().environment.gravity);
    for k in 0..rest.len() {
        let expected = rest[k] + velocity * t + g * (0.5 * t * t);
        assert!((x[k] - expected).norm() < 1e-10, "vertex {k}: {} {expected}", x[k]);
        assert!((v[k] - (velocity + g * t)).norm() < 1e-10 / dt);
    }
}

/// Share of its energy that a vibration of two grains on a spring keeps in a time step in which it goes on by `phase`.
fn kept(integrator: Integrator, phase: f64) -> f64 {
    let rest = [Point::origin(), Point::new(0.1, 0.0, 0.0)];
    // Each grain of 1 g vibrates as on a spring of twice the stiffness to a wall.
    let dt = 0.01;
    let stiffness = 0.5e-3 * (phase / dt).powi(2);
    let model = grains(&rest).with_elements(group(vec![spring([0, 1], stiffness, 0.1)])).expect("valid");
    let params = DynamicsParams { integrator, ..weightless(with_tolerance(1e-12)) };
    let mut dynamics = Dynamics::new(model, params).expect("valid");
    let speed = Vector::new(0.01, 0.0, 0.0);
    let (mut x, mut v) = (rest.to_vec(), vec![-speed, speed]);
    let energy = |dynamics: &Dynamics, x: &[Point], v: &[Vector]| dynamics.energies(x, v).total();
    let before = energy(&dynamics, &x, &v);
    let steps = 10;
    for _ in 0..steps {
        dynamics.solve_step(&mut x, &mut v, dt, &[false; 2], &rest, 3).expect("solves");
    }
    (energy(&dynamics, &x, &v) / before).powf(1.0 / f64::from(steps))
}

#[test]
fn vibrations_lose_what_theory_says() {
    let gamma = 1.0 - 0.5_f64.sqrt();
    for phase in [0.2, 0.8, 3.0] {
        let square = phase * phase;
        let of_euler = 1.0 / (1.0 + square);
        let of_sdirk2 = (1.0 + (1.0 - 2.0 * gamma).powi(2) * square) / (1.0 + gamma * gamma * square).powi(2);
        let (euler, sdirk2) = (kept(Integrator::ImplicitEuler, phase), kept(Integrator::Sdirk2, phase));
        assert!((euler - of_euler).abs() < 1e-6, "{phase}: {euler} {of_euler}");
        assert!((sdirk2 - of_sdirk2).abs() < 1e-6, "{phase}: {sdirk2} {of_sdirk2}");
    }
}

/// A sheet that falls from its horizontal rest shape, held along one side, after 0.1 s.
fn swung(integrator: Integrator, steps: u32) -> Vec<Point> {
    let (rest, triangles) = sheet(0.5, 0.4, 8, 8);
    let held: Vec<bool> = rest.iter().map(|p| p.x < 1e-9).collect();
    let model = cloth_model(&rest, triangles, ClothMaterial::cotton());
    let params = DynamicsParams { integrator, ..with_tolerance(1e-10) };
    let mut dynamics = Dynamics::new(model, params).expect("valid");
    let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
    let dt = 0.1 / f64::from(steps);
    for _ in 0..steps {
        dynamics.solve_step(&mut x, &mut v, dt, &held, &rest, 8).expect("solves");
    }
    x
}

#[test]
fn a_swinging_sheet_converges_with_second_order() {
    let reference = swung(Integrator::Sdirk2, 320);
    let error = |integrator, steps| {
        let squares =
            swung(integrator, steps).iter().zip(&reference).map(|(a, b)| (a - b).norm_squared()).sum::<f64>();
        (squares / reference.len() as f64).sqrt()
    };
    let errors = [10, 20, 40].map(|steps| error(Integrator::Sdirk2, steps));
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1]).log2() > 1.8, "{errors:?}");
    }
    // Implicit Euler with four times the time steps is farther from it.
    let euler = error(Integrator::ImplicitEuler, 40);
    assert!(euler > 5.0 * errors[0], "{euler} {errors:?}");
}

#[test]
fn a_spinning_block_keeps_its_momenta_and_energy() {
    let (rest, tetrahedra) = block([0.1, 0.1, 0.1], [3, 3, 3]);
    let material = SolidMaterial { young_modulus: 2e5, ..SolidMaterial::default() };
    let body = Body::solid("block", tetrahedra, material);
    let model = DynamicsModel::new(rest.clone(), vec![body]).expect("valid");
    let mut dynamics = Dynamics::new(model, sdirk2(weightless(with_tolerance(1e-8)))).expect("valid");
    let center = dynamics.center_of_mass(&rest);
    let spin = Vector::new(3.0, -4.0, 12.0);
    let (mut x, mut v) = (rest.clone(), rest.iter().map(|p| spin.cross(&(p - center))).collect::<Vec<_>>());
    let before = (dynamics.angular_momentum(&x, &v), dynamics.energies(&x, &v).total());
    let none = vec![false; rest.len()];
    for _ in 0..30 {
        dynamics.solve_step(&mut x, &mut v, 0.01, &none, &rest, 6).expect("solves");
        // It begins to spin without strain. While it stretches, exact momenta leave its energy an error.
        let now = dynamics.energies(&x, &v).total();
        assert!((0.99..1.002).contains(&(now / before.1)), "{now} J of {} J", before.1);
    }
    let turned = dynamics.angular_momentum(&x, &v);
    assert!((turned - before.0).norm() < 1e-9 * before.0.norm());
}

#[test]
fn a_grain_that_hits_a_half_space_stays_there_wherever_in_the_time_step_it_hits() {
    let reach = 1e-3;
    for height in [0.002, 0.004, 0.007, 0.009] {
        let rest = [Point::new(0.0, 0.0, height)];
        let mut dynamics =
            Dynamics::new(grains(&rest), sdirk2(weightless(with_tolerance(1e-12)))).expect("valid");
        let ground = |gap: f64| RepulsionSpring {
            kind: SpringKind::Contact,
            vertices: [0; 4],
            weights: [1.0, 0.0, 0.0, 0.0],
            normal: Vector::z(),
            offset: 0.0,
            reach,
            floor: 0.0,
            start_gap: gap,
            stiffness: 10.0,
            friction: 0.5,
            friction_ratio: Vector::zeros(),
        };
        let (mut x, mut v) = (rest.to_vec(), vec![Vector::new(0.3, 0.0, -1.0)]);
        for step in 0..4 {
            dynamics.set_repulsion(&[ground(x[0].z)]).expect("valid");
            dynamics.solve_step(&mut x, &mut v, 0.01, &[false], &rest, 8).expect("solves");
            assert!(x[0].z > 0.0, "{height}, step {step}: {}", x[0]);
            // The drag of the law lets contacts open slowly.
            assert!(v[0].z.abs() < 0.03, "{height}, step {step}: {}", v[0]);
        }
    }
}
