//! Momentum and energy of bodies that fly, collide and fall.

use bowknot_tests::theory;
use std::path::Path;

#[test]
fn bodies_that_meet_keep_both_momenta_and_gain_no_energy() {
    // Head on, and with two offsets; with friction.
    for offset in [[0.0, 0.0], [0.03, 0.0], [0.031, 0.017]] {
        for modulus in [1e5, 1e7] {
            let found = theory::meeting(offset, modulus, 40, &[]);
            assert!(found.momentum < 1e-8 && found.angular < 1e-8, "{offset:?}, {modulus} Pa: {found:?}");
            assert!(found.energy < 1.0 + 1e-9, "{offset:?}, {modulus} Pa: {found:?}");
        }
    }
}

#[test]
fn a_body_that_spins_keeps_spinning() {
    // 0.2 rad per step; implicit Euler would lose 2 % in each step.
    let [angular, energy] = theory::spinning_cube(20.0, 100, &[]);
    assert!(angular < 1e-8, "lost {angular} of its angular momentum");
    assert!((0.0..1e-3).contains(&energy), "lost {energy} of its energy");
}

#[test]
fn a_cube_that_falls_is_not_kicked_aside() {
    for mesh in [false, true] {
        for rotate in [[0.0; 3], [45.0, 0.0, 0.0], [45.0, 35.264_389_682_754_654, 0.0]] {
            // It falls at 0.9 m/s.
            let [aside, gain] = theory::dropped_cube(rotate, 0.0, mesh, 30, &[]);
            assert!(aside < 1e-3, "{rotate:?} on a mesh ({mesh}): {aside} m/s");
            assert!(gain < 0.0, "{rotate:?} on a mesh ({mesh}): {gain} J");
        }
    }
    let [aside, _] = theory::dropped_cube([0.0; 3], 0.3, true, 30, &[]);
    assert!(aside < 1e-3, "with friction: {aside} m/s");
}

#[test]
fn a_cube_thrown_at_a_floor_comes_back_alike_from_a_mesh_and_a_half_space() {
    for modulus in [2e4, 1e5, 1e6] {
        let [plane, mesh] = [false, true].map(|mesh| theory::thrown_cube(modulus, mesh, 16, &[])[15]);
        // It may lose all of its speed, but must not go on into the floor.
        assert!((0.0..1.0).contains(&plane) && (plane - mesh).abs() < 0.02, "{modulus} Pa: {plane}, {mesh}");
    }
}

/// From 10 micrometres to 1 km, at up to 250 times its size in a time step: a ball keeps its shape, in one
/// iteration of one two-way step; two where rounding is worth a tolerance.
#[test]
fn balls_of_any_size_fly_rigidly_at_any_speed() {
    let cases = [(5e-6, 0.0), (2.5e-4, 0.0), (1e-3, 50.0), (2.5e-3, 15.0), (0.05, 300.0), (500.0, 3000.0)];
    for (radius, speed) in cases {
        let text = format!(
            "[[body]]\nkind = \"solid\"\nmaterial = \"silicone\"\nvelocity = [{:e}, 0, {:e}]\n\
             shape = {{ type = \"tet-ball\", radius = {radius:e}, edge = {:e} }}\n",
            0.3 * speed,
            -speed,
            0.4 * radius
        );
        let mut simulator = theory::simulator(&text, Path::new(""), &[]);
        let start = simulator.positions().to_vec();
        for _ in 0..20 {
            let statistics = simulator.step().expect("a step");
            let (iterations, steps) = (statistics.newton_iterations, statistics.two_way_steps);
            assert!(iterations.max(steps) <= if radius < 1e-5 { 2 } else { 1 }, "{iterations}, {steps}");
        }
        let x = simulator.positions();
        let way = x[0] - start[0];
        let torn = x.iter().zip(&start).map(|(x, s)| ((x - s) - way).norm()).fold(0.0, f64::max);
        assert!(torn < 1e-9 * radius, "radius {radius} m at {speed} m/s: torn by {} radii", torn / radius);
    }
}
