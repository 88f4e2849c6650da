//! Friction of belts, balls and hanging sheets, and the distances that bodies slide, compared with theory.

use bowknot_tests::contact::{Ground, Slider, Slope};
use bowknot_tests::theory;

#[test]
fn a_belt_holds_by_the_exponential_of_its_angle() {
    for (degrees, friction) in [(90.0, 0.4), (180.0, 0.2), (180.0, 0.4), (360.0, 0.4)] {
        let [found, expected] = theory::belt(degrees, friction, &[]);
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{degrees} deg, mu = {friction}: {found}, not {expected}"
        );
    }
}

#[test]
fn a_rope_over_a_bar_holds_up_to_the_exponential_of_its_angle() {
    for friction in [0.3, 0.5] {
        let held = theory::rope(0.9, friction, (150, 300), &[]);
        let slides = theory::rope(1.1, friction, (50, 100), &[]);
        assert!(held.abs() < 1e-6 && slides > 1e-2, "mu = {friction}: {held} m/s below, {slides} m/s above");
    }
}

#[test]
fn a_ball_rolls_down_a_slope() {
    for dt in [0.01, 0.0025] {
        let steps = (0.4 / dt) as usize;
        let ratio = theory::rolling_ball(10.0, 0.01, dt, steps / 4..steps, &[]);
        assert!((ratio - 1.0).abs() < 0.05, "at {dt} s: {ratio} of 5/7 g sin a");
    }
}

#[test]
fn a_sheet_slides_over_a_rounded_edge_where_what_hangs_pulls_enough() {
    for friction in [0.2, 0.4] {
        let settled = theory::table_edge(0.95, friction, 20, &[]);
        let held = theory::table_edge(0.95, friction, 100, &[]);
        let slid = theory::table_edge(1.05, friction, 100, &[]);
        assert!(held < 1e-3 && slid > 5e-2, "mu = {friction}: {held} m below, {slid} m above");
        let creep = (held - settled) / 0.8;
        assert!(creep < 2e-6, "mu = {friction}: creeps by {creep} m/s");
    }
}

#[test]
fn bodies_stop_after_the_way_that_friction_leaves_them() {
    let stops = [
        (Slider::Patch, 0.01, &Ground::ALL[..]),
        (Slider::Grains, 0.01, &Ground::ALL[..]),
        (Slider::JellyCube, 0.03, &[Ground::HalfSpace, Ground::Box, Ground::CoarseBox, Ground::Irregular]),
        (
            Slider::StiffCube,
            0.03,
            &[Ground::HalfSpace, Ground::Box, Ground::Flush, Ground::Seam, Ground::Slab],
        ),
        (Slider::Layers, 0.01, &[Ground::Box, Ground::Irregular]),
        (Slider::Strands, 0.05, &[Ground::Irregular, Ground::Seam]),
    ];
    for (slider, share, grounds) in stops {
        for &ground in grounds {
            let slope = Slope { degrees: 0.0, speed: 0.8, ..Slope::new(slider, ground, 0.3) };
            let ratio = theory::stopping_distance(&slope);
            assert!((ratio - 1.0).abs() < share, "{slider:?} on {ground:?}: {ratio} of the way");
        }
    }
}

#[test]
fn bodies_keep_their_speed_for_a_second_across_edges_seams_and_flush_boxes() {
    for (slider, grounds) in [
        (Slider::JellyCube, &[Ground::Irregular, Ground::Flush, Ground::Seam, Ground::Slivers][..]),
        (Slider::StiffCube, &[Ground::Irregular, Ground::Flush, Ground::Seam]),
        (Slider::Patch, &Ground::ALL),
        (Slider::Layers, &[Ground::Irregular, Ground::Flush]),
        (Slider::Strands, &[Ground::Irregular, Ground::Seam]),
        (Slider::Grains, &[Ground::Box, Ground::Irregular, Ground::Slivers, Ground::Slab]),
    ] {
        for &ground in grounds {
            let slope = Slope { degrees: 0.0, speed: 0.2, ..Slope::new(slider, ground, 0.0) };
            let ratio = slope.run(100).speed(98..101) / 0.2;
            assert!((ratio - 1.0).abs() < 0.01, "{slider:?} on {ground:?}: {ratio} of its speed");
        }
    }
}
