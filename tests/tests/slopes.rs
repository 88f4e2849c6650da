//! Bodies slide on slopes as Coulomb's law predicts, for all tessellations of the ground.

use bowknot_tests::contact::{Ground, Slider, Slope};

/// Checks speeds over the time steps 23 to 25 at 1/100 s: those of sliding bodies are within a share of
/// theory, and those of sticking bodies are nearly zero.
fn check(slider: Slider, grounds: &[Ground]) {
    for &ground in grounds {
        for (friction, share) in [(0.0, 0.02), (0.1, 0.03)] {
            let slope = Slope::new(slider, ground, friction);
            let (found, expected) = (slope.run(25).speed(23..26), slope.acceleration() * 0.24);
            assert!(
                (found - expected).abs() < share * expected,
                "{slider:?} on {ground:?}, mu = {friction}: {found} m/s, not {expected}"
            );
        }
        let slope = Slope::new(slider, ground, 0.5);
        let speed = slope.run(25).speed(23..26);
        assert!(speed.abs() < 1e-3, "{slider:?} on {ground:?} creeps at {speed} m/s");
    }
}

#[test]
fn cubes_slide_on_meshes_as_on_a_plane() {
    let grounds = [
        Ground::HalfSpace,
        Ground::CoarseBox,
        Ground::Irregular,
        Ground::Slivers,
        Ground::Seam,
        Ground::Slab,
    ];
    check(Slider::JellyCube, &grounds);
    check(Slider::StiffCube, &grounds[..5]);
}

#[test]
fn a_patch_of_cloth_slides_on_meshes_as_on_a_plane() {
    check(Slider::Patch, &Ground::ALL);
}

#[test]
fn strands_slide_on_meshes_as_on_a_plane() {
    let grounds = [Ground::HalfSpace, Ground::Box, Ground::Irregular, Ground::Seam];
    check(Slider::Strands, &grounds[1..]);
    for ground in grounds {
        let slope = Slope::new(Slider::Strands, ground, 0.3);
        let (found, expected) = (slope.run(25).speed(23..26), slope.acceleration() * 0.24);
        assert!((found - expected).abs() < 0.03 * expected, "{ground:?}: {found} m/s, not {expected}");
    }
}

#[test]
fn grains_slide_on_meshes_as_on_a_plane() {
    check(Slider::Grains, &Ground::ALL);
}

#[test]
fn on_25_degrees_bodies_speed_up_as_theory_says() {
    for friction in [0.3, 0.4] {
        let sliders = [
            Slider::JellyCube,
            Slider::StiffCube,
            Slider::Patch,
            Slider::Strands,
            Slider::Grains,
            Slider::Layers,
        ];
        for slider in sliders {
            for ground in [Ground::HalfSpace, Ground::Irregular] {
                let slope = Slope { degrees: 25.0, ..Slope::new(slider, ground, friction) };
                let run = slope.run(50);
                // While it settles friction is not that of its weight.
                let gained = run.speed(48..51) - run.speed(23..26);
                let ratio = gained / (slope.acceleration() * 0.25);
                assert!((ratio - 1.0).abs() < 0.01, "{slider:?} on {ground:?}, mu = {friction}: {ratio}");
            }
        }
    }
}

#[test]
fn at_mu_0_3_speeds_are_right_within_what_one_percent_of_friction_makes_of_them() {
    // An error of 1 % of friction gives one of 4.7 % of the acceleration here.
    for (slider, grounds, share) in [
        (Slider::Patch, &[Ground::HalfSpace, Ground::Box, Ground::Irregular, Ground::Seam][..], 0.03),
        (Slider::Layers, &[Ground::HalfSpace, Ground::Irregular], 0.03),
        (Slider::Grains, &Ground::ALL, 0.03),
        (Slider::StiffCube, &[Ground::HalfSpace, Ground::Slivers, Ground::Seam], 0.03),
        (Slider::JellyCube, &Ground::ALL, 0.1),
    ] {
        for &ground in grounds {
            let slope = Slope::new(slider, ground, 0.3);
            let (found, expected) = (slope.run(25).speed(23..26), slope.acceleration() * 0.24);
            assert!(
                (found - expected).abs() < share * expected,
                "{slider:?} on {ground:?}: {found} m/s, not {expected}"
            );
        }
    }
}

#[test]
fn cubes_accelerate_at_mu_0_3_as_coulombs_law_has_it() {
    // Unlike speeds, accelerations do not depend on how a soft cube begins to slide. On a soft slab it
    // oscillates with its ground.
    for (slider, grounds) in [(Slider::JellyCube, &Ground::ALL[..7]), (Slider::StiffCube, &Ground::ALL)] {
        for &ground in grounds {
            let slope = Slope::new(slider, ground, 0.3);
            let (found, expected) = (slope.run(36).acceleration(12, 36), slope.acceleration());
            assert!(
                (found - expected).abs() < 0.03 * expected,
                "{slider:?} on {ground:?}: {found} m/s^2, not {expected}"
            );
        }
    }
}

#[test]
fn short_time_steps_slide_as_long_ones() {
    for slider in [Slider::JellyCube, Slider::StiffCube, Slider::Patch, Slider::Grains] {
        for ground in [Ground::HalfSpace, Ground::Box, Ground::Irregular] {
            for friction in [0.0, 0.1] {
                let slope = Slope { dt: 0.0025, ..Slope::new(slider, ground, friction) };
                let (found, expected) = (slope.run(60).acceleration(20, 60), slope.acceleration());
                assert!(
                    (found - expected).abs() < 0.03 * expected,
                    "{slider:?} on {ground:?}, mu = {friction}: {found} m/s^2, not {expected}"
                );
            }
        }
    }
}

#[test]
fn what_sticks_creeps_less_than_a_tenth_of_a_millimetre_in_a_second() {
    for slider in [Slider::JellyCube, Slider::StiffCube, Slider::Patch, Slider::Grains] {
        for ground in [Ground::HalfSpace, Ground::Box, Ground::Irregular] {
            let track = Slope::new(slider, ground, 0.5).run(130);
            let way = (track.places[130] - track.places[30]).norm();
            assert!(way < 1e-4, "{slider:?} on {ground:?} creeps {way} m");
        }
    }
    let track = Slope::new(Slider::Layers, Ground::HalfSpace, 0.5).run(130);
    let way = (track.places[130] - track.places[30]).norm();
    assert!(way < 1e-4, "three layers creep {way} m");
}

#[test]
fn a_patch_keeps_its_direction_across_the_diagonals_of_a_mesh() {
    let slope = Slope { heading: 37.0, ..Slope::new(Slider::Patch, Ground::Irregular, 0.1) };
    let [along, across] = slope.run(25).way();
    assert!(along > 0.05 && across.abs() < 0.01 * along, "{along} m along, {across} m across");
}

#[test]
fn a_patch_on_a_level_mesh_keeps_its_speed() {
    let slope = Slope { degrees: 0.0, speed: 0.2, ..Slope::new(Slider::Patch, Ground::Box, 0.0) };
    let speed = slope.run(100).speed(98..101);
    assert!((speed - 0.2).abs() < 0.002, "{speed} m/s");
}
