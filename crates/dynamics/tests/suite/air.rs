//! Wind and drag: terminal velocities, flags, stability at any time step.

use crate::common::{block, cloth_model, dynamics, sheet, strands, with_tolerance};
use bowknot_dynamics::{
    Body, ClothMaterial, Dynamics, DynamicsParams, Environment, ParticleMaterial, SolidMaterial,
    StrandMaterial,
};
use bowknot_geometry::{Point, Vector};

/// Density of air [kg/m^3].
const AIR: f64 = 1.2;

/// Air with the default gravity.
fn air() -> Environment {
    Environment { air_density: AIR, ..Environment::default() }
}

fn with_environment(environment: Environment) -> DynamicsParams {
    DynamicsParams { environment, ..with_tolerance(1e-8) }
}

/// Mean velocity after `steps` of `dt` from velocity `v0`.
fn fall(mut dynamics: Dynamics, rest: &[Point], v0: Vector, dt: f64, steps: usize) -> Vector {
    let (mut x, mut v) = (rest.to_vec(), vec![v0; rest.len()]);
    let none = vec![false; x.len()];
    for _ in 0..steps {
        let keyframes = x.clone();
        dynamics.solve_step(&mut x, &mut v, dt, &none, &keyframes, 1).expect("solves");
    }
    dynamics.momentum(&v) / dynamics.model().total_mass()
}

#[test]
fn everything_falls_at_its_terminal_velocity() {
    let g = 9.81;
    let terminal =
        |weight: f64, area: f64, coefficient: f64| (2.0 * weight / (AIR * area * coefficient)).sqrt();
    let (flat, triangles) = sheet(0.5, 0.4, 8, 8);
    let cloth = ClothMaterial::cotton();
    let (cube, tets) = block([0.2, 0.2, 0.1], [2, 2, 1]);
    let foam = SolidMaterial::foam();
    // A strand that lies across the fall.
    let (hanging, edges) = strands(1, 10, 0.1, 1.0);
    let lying: Vec<Point> = hanging.iter().map(|p| Point::new(p.z, 0.0, 0.0)).collect();
    let (hair, sand) = (StrandMaterial::hair(), ParticleMaterial::sand());
    let cases = [
        ("sheet", &flat, Body::cloth("a", triangles, cloth), terminal(cloth.density * g, 1.0, 1.2)),
        // Top and bottom count half each; on the sides there is skin friction.
        (
            "cube",
            &cube,
            Body::solid("a", tets, foam),
            terminal(foam.density * 0.004 * g, 0.04, 1.2 + 0.02 * 0.5 * 2.0),
        ),
        ("hair", &lying, Body::strands("a", edges, hair), terminal(hair.density * g, 2.0 * hair.radius, 1.2)),
        ("grain", &vec![Point::origin()], Body::particles("a", vec![0], sand), {
            terminal(sand.mass() * g, std::f64::consts::PI * sand.radius * sand.radius, 0.47)
        }),
    ];
    for (name, rest, body, expected) in cases {
        for (dt, steps) in [(0.01, 400), (0.2, 40)] {
            let dynamics = dynamics(rest, vec![body.clone()], with_environment(air()));
            let v = fall(dynamics, rest, Vector::zeros(), dt, steps);
            assert!((v.z / -expected - 1.0).abs() < 0.002, "{name} at dt = {dt}: {} {expected}", v.z);
        }
    }
}

#[test]
fn a_free_sheet_ends_at_the_speed_of_the_wind_at_any_time_step() {
    let (rest, triangles) = sheet(0.5, 0.4, 8, 8);
    let wind = Vector::new(0.0, 20.0, 30.0);
    for dt in [0.01, 0.05, 1.0, 100.0] {
        let params = with_environment(Environment { gravity: Vector::zeros(), wind, ..air() });
        let model = cloth_model(&rest, triangles.clone(), ClothMaterial::cotton());
        let dynamics = Dynamics::new(model, params).expect("valid");
        let v = fall(dynamics, &rest, Vector::new(1.0, 0.0, -500.0), dt, 400);
        // Across the sheet it reaches the speed of the wind; along it there is only friction, which is
        // slower.
        assert!((v - wind).z.abs() < 0.05 * wind.z, "dt = {dt}: {v}");
        assert!(v.norm() <= 501.0 && v.y >= 0.0, "dt = {dt}: {v}");
    }
}

#[test]
fn a_flag_in_the_wind_streams_and_stays_bounded() {
    let (rest, triangles) = sheet(0.6, 0.4, 18, 12);
    for dt in [0.01, 0.1, 1.0] {
        let model = cloth_model(&rest, triangles.clone(), ClothMaterial::cotton());
        let params = with_environment(Environment { wind: Vector::new(8.0, 1.0, 0.0), ..air() });
        let mut dynamics = Dynamics::new(model, params).expect("valid");
        let held: Vec<bool> = rest.iter().map(|p| p.x < 1e-9).collect();
        let (mut x, mut v) = (rest.clone(), vec![Vector::zeros(); rest.len()]);
        let mut mean = Vector::zeros();
        let steps = 150;
        for step in 0..steps {
            dynamics.solve_step(&mut x, &mut v, dt, &held, &rest, 2).expect("solves");
            assert!(dynamics.max_stretch(&x) < 1.6, "dt = {dt}, step {step}: {}", dynamics.max_stretch(&x));
            if step >= steps / 2 {
                mean += (dynamics.center_of_mass(&x) - Point::new(0.0, 0.2, 0.0)) / (steps / 2) as f64;
            }
        }
        // In still air it would hang straight down.
        assert!(mean.x > 0.1, "dt = {dt}: {mean}");
    }
}

#[test]
fn wind_without_air_changes_no_bit() {
    let (rest, triangles) = sheet(0.5, 0.4, 8, 8);
    let run = |environment: Environment| {
        let model = cloth_model(&rest, triangles.clone(), ClothMaterial::cotton());
        let params = DynamicsParams { environment, ..DynamicsParams::default() };
        fall(Dynamics::new(model, params).expect("valid"), &rest, Vector::new(1.0, 2.0, 3.0), 0.01, 5)
    };
    let wind = Vector::new(9.0, 0.0, 0.0);
    assert_eq!(run(Environment::default()), run(Environment { wind, ..Environment::default() }));
}
