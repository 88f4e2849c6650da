//! Bodies that press on each other come to rest.

use bowknot::scene::Scene;
use bowknot::{Simulator, StepStatistics};
use bowknot_tests::theory;

const SLOT: &str = include_str!("../scenes/slot.toml");
const CUBE_ON_SHEET: &str = include_str!("../scenes/cube-on-sheet.toml");
const GRIPPED_CUBE: &str = include_str!("../scenes/gripped-cube.toml");
const STRIP: &str = include_str!("../scenes/strip-between-pads.toml");
const TWISTED_SHEET: &str = include_str!("../scenes/twisted-sheet.toml");
const LOWERED_CLOTH: &str = include_str!("../scenes/lowered-cloth.toml");
const GRAINS_AND_CLOTH: &str = include_str!("../scenes/grains-and-cloth.toml");

/// A scene with other values.
fn with(text: &str, before: &str, after: &str) -> String {
    assert!(text.contains(before), "{before} is not in the scene");
    text.replace(before, after)
}

/// What a run of a scene comes to.
struct Course {
    steps: Vec<StepStatistics>,
    /// The first time step after which everything sleeps.
    asleep: Option<usize>,
}

impl Course {
    fn of(text: &str, steps: usize) -> Self {
        let scene = Scene::from_toml(text, ".").expect("a scene");
        let mut simulator = Simulator::new(&scene).expect("a simulator");
        let steps: Vec<StepStatistics> = (0..steps).map(|_| simulator.step().expect("a step")).collect();
        let asleep = steps.iter().find(|s| s.asleep_vertices > 0 && s.max_speed == 0.0).map(|s| s.step);
        Self { steps, asleep }
    }

    /// Share of the time steps from one on that are solved.
    fn solved(&self, from: usize) -> f64 {
        let steps = &self.steps[from..];
        steps.iter().filter(|s| s.solved).count() as f64 / steps.len() as f64
    }

    fn most(&self, quantity: impl Fn(&StepStatistics) -> f64) -> f64 {
        self.steps.iter().map(quantity).fold(0.0, f64::max)
    }
}

#[test]
fn a_sheet_in_a_slot_narrower_than_two_contact_distances_stays_still() {
    for gap in [2.1e-3, 2e-3, 1.5e-3] {
        // Half of each box is 10 mm.
        let course = Course::of(&with(SLOT, "0.0115", &(0.01 + gap).to_string()), 60);
        let (speed, elastic) = (course.most(|s| s.max_speed), course.most(|s| s.energy.elastic));
        assert!(speed < 1e-9 && elastic < 1e-12, "{gap} m: {speed} m/s, {elastic} J");
        assert!(course.asleep.is_some_and(|step| step <= 60), "{gap} m: awake");
    }
}

#[test]
fn plates_that_close_on_a_sheet_hold_it() {
    let text = r#"
        [simulation]
        gravity = [0, 0, 0]
        [[body]]
        shape = { type = "sheet", size = [0.04, 0.04], edge = 0.02 }
        friction = 0.5
        [[obstacle]]
        shape = { type = "box", size = [0.05, 0.05, 0.02], edge = 0.025 }
        translate = [0, 0, -0.013]
        friction = 0.5
        motion = { keyframes = [{ time = 0.5, translate = [0, 0, 0.002] }] }
        [[obstacle]]
        shape = { type = "box", size = [0.05, 0.05, 0.02], edge = 0.025 }
        translate = [0, 0, 0.013]
        friction = 0.5
    "#;
    let course = Course::of(text, 150);
    let (speed, stretch) = (course.most(|s| s.max_speed), course.most(|s| s.max_stretch));
    assert!(speed < 0.02 && stretch < 1.001, "{speed} m/s, stretched {stretch} times");
    assert!(course.asleep.is_some(), "awake");
}

#[test]
fn a_cube_on_a_sheet_comes_to_rest_where_it_is() {
    let course = Course::of(CUBE_ON_SHEET, 100);
    assert!(course.asleep.is_some_and(|step| step <= 100), "awake after 1 s");
    let centers = [&course.steps[10], &course.steps[99]].map(|s| s.center_of_mass);
    let shift = (centers[1][0] - centers[0][0]).hypot(centers[1][1] - centers[0][1]);
    assert!(shift < 1e-4, "it has walked {shift} m");
}

#[test]
fn without_friction_a_cube_pushes_the_sheet_below_it_to_no_side() {
    let smooth = with(CUBE_ON_SHEET, "friction = 0.3", "friction = 0");
    let table = r#"shape = { type = "box", size = [0.5, 0.5, 0.1], edge = 0.1 }
        translate = [0, 0, -0.05]"#;
    for text in [smooth.clone(), with(&smooth, r#"shape = { type = "half-space" }"#, table)] {
        let course = Course::of(&text, 100);
        let sideways = course.most(|s| s.momentum[0].hypot(s.momentum[1]));
        let fall = course.most(|s| s.momentum[2].abs());
        assert!(sideways < 1e-9 * fall, "{sideways} of {fall} kg m/s");
    }
}

#[test]
fn a_cube_between_soft_pads_is_held() {
    let course = Course::of(GRIPPED_CUBE, 200);
    let fallen = course.steps[100].center_of_mass[2] - course.steps[199].center_of_mass[2];
    assert!(fallen.abs() < 1e-5, "it creeps {fallen} m in a second");
}

#[test]
fn a_pile_of_blocks_falls_asleep_and_goes_on() {
    let block = |k: usize, x: f64| {
        format!(
            r#"
            [[body]]
            name = "block{k}"
            kind = "solid"
            shape = {{ type = "block", size = [0.05, 0.05, 0.05], edge = 0.025 }}
            translate = [{x}, 0, {}]
            material = "rubber"
            friction = 0.5
            "#,
            0.03 + 0.06 * k as f64
        )
    };
    let blocks: String = (0..3).map(|k| block(k, 0.004 * k as f64)).collect();
    let course = Course::of(
        &format!("{blocks}\n[[obstacle]]\nshape = {{ type = \"half-space\" }}\nfriction = 0.5\n"),
        200,
    );
    assert!(course.asleep.is_some(), "awake");
}

#[test]
fn a_finger_holds_a_sheet_on_the_ground_at_rest() {
    let text = r#"
        [contact]
        delta = 0.001
        [[body]]
        name = "sheet"
        shape = { type = "sheet", size = [0.3, 0.3], edge = 0.02 }
        translate = [0, 0, 0.001]
        friction = 0.3
        material = "cotton"
        [[body]]
        name = "finger"
        kind = "solid"
        shape = { type = "block", size = [0.06, 0.06, 0.06], edge = 0.02 }
        translate = [0, 0, 0.035]
        friction = 0.3
        material = "silicone"
        [[pin]]
        body = "finger"
        side = "z-max"
        motion = { keyframes = [{ time = 0.3, translate = [0, 0, -0.008] }] }
        [[obstacle]]
        shape = { type = "half-space" }
        friction = 0.3
    "#;
    let course = Course::of(text, 130);
    assert!(course.asleep.is_some_and(|step| step <= 130), "awake a second after the finger stopped");
    let (speed, stretch) = (course.most(|s| s.max_speed), course.most(|s| s.max_stretch));
    assert!(speed < 0.1 && stretch < 1.05, "{speed} m/s, stretched {stretch} times");
}

#[test]
fn pads_hold_a_strip_without_creep() {
    for friction in [0.3, 0.8, 0.9, 1.0, 1.05] {
        let strip = with(STRIP, "friction = 0.5", &format!("friction = {friction}"));
        let course = Course::of(&format!("{strip}[solver.sleep]\nenabled = false\n"), 300);
        let solved = course.solved(100);
        assert!(solved > 0.9, "mu = {friction}: {solved} of the time steps are solved");
        let speed = course.most(|s| s.max_speed);
        assert!(speed < 0.5, "mu = {friction}: {speed} m/s");
        let fallen = course.steps[199].center_of_mass[2] - course.steps[299].center_of_mass[2];
        assert!(fallen.abs() < 5e-6, "mu = {friction}: it creeps {fallen} m in a second");
    }
}

/// Its edges are at their limits, and its layers press on each other.
#[test]
fn a_twisted_sheet_is_solved_once_its_pins_rest() {
    let course = Course::of(&with(TWISTED_SHEET, "edge = 0.02", "edge = 0.03"), 240);
    let (solved, stretch) = (course.solved(160), course.steps[239].max_stretch);
    assert!(solved > 0.9, "{solved} of the time steps are solved");
    // Its limit is 1.05.
    assert!(stretch < 1.065, "stretched {stretch} times");
    let speed = course.steps[220..].iter().map(|s| s.max_speed).fold(0.0, f64::max);
    assert!(speed < 0.2, "{speed} m/s a second after its pins stopped");
}

/// How it crumples depends on its start by micrometres, so of three starts the median counts.
#[test]
fn a_cloth_that_is_lowered_on_a_table_lies_flat_on_itself() {
    let ends = ["0.6", "0.60001", "0.60002"].map(|height| {
        let start = format!("translate = [0, 0, {height}]");
        let course = Course::of(&with(LOWERED_CLOTH, "translate = [0, 0, 0.6]", &start), 450);
        let end = &course.steps[449];
        [end.center_of_mass[2], end.max_speed]
    });
    let median = |k: usize| {
        let mut values = ends.map(|end| end[k]);
        values.sort_by(f64::total_cmp);
        values[1]
    };
    let (height, speed) = (median(0), median(1));
    assert!((0.01..0.045).contains(&height), "mean heights and speeds: {ends:?}");
    assert!(speed < 0.1, "mean heights and speeds one and a half seconds after the release: {ends:?}");
}

#[test]
fn cloth_below_and_above_grains_comes_to_rest() {
    let course = Course::of(GRAINS_AND_CLOTH, 150);
    assert!(course.asleep.is_some(), "awake after 1.5 s");
}

#[test]
fn a_snug_sleeve_over_two_balls_falls_asleep() {
    let ball = |name: &str, x: f64| {
        format!(
            r#"
            [[obstacle]]
            name = "{name}"
            friction = 0.3
            shape = {{ type = "ball", radius = 0.05, edge = 0.01 }}
            translate = [{x}, 0.0, 0.0]
            "#
        )
    };
    let sleeve = r#"
        [[body]]
        name = "sleeve"
        friction = 0.3
        shape = { type = "tube", radius = 0.0535, length = 0.4, edge = 0.0125 }
    "#;
    let course = Course::of(&(sleeve.to_owned() + &ball("left", -0.08) + &ball("right", 0.08)), 250);
    assert!(course.asleep.is_some(), "awake after 2.5 s");
    assert!(course.solved(50) > 0.95, "{} of the time steps are solved", course.solved(50));
}

#[test]
fn blocks_between_a_floor_and_a_wall_come_to_rest() {
    let block = |k: usize, rotate: [f64; 3], translate: [f64; 3]| {
        format!(
            r#"
            [[body]]
            name = "part{k}"
            kind = "solid"
            shape = {{ type = "block", size = [0.09, 0.05, 0.035], edge = 0.025 }}
            material = "rubber"
            friction = 0.4
            rotate = {rotate:?}
            translate = {translate:?}
            "#
        )
    };
    let text = format!(
        r#"
        [[obstacle]]
        name = "floor"
        shape = "half-space"
        friction = 0.4
        [[obstacle]]
        name = "wall"
        shape = {{ type = "box", size = [0.02, 0.3, 0.15], edge = 0.1 }}
        translate = [-0.06, 0, 0.06]
        friction = 0.4
        {}{}{}
        "#,
        block(0, [-10.0, 35.0, 139.0], [0.013, 0.017, 0.08]),
        block(1, [20.0, 40.0, 148.0], [0.011, -0.019, 0.18]),
        block(2, [20.0, -7.0, 141.0], [0.015, 0.02, 0.28])
    );
    let course = Course::of(&text, 150);
    assert!(course.asleep.is_some(), "awake after 1.5 s");
}

/// A soft ball under a plate that presses it to a fifth of its height, and leaves again.
#[test]
fn a_ball_that_was_pressed_flat_recovers() {
    let text = r#"
        [[body]]
        name = "ball"
        kind = "solid"
        shape = { type = "tet-ball", radius = 0.05, edge = 0.02 }
        material = { density = 100, young_modulus = 1e4, poisson_ratio = 0.4, model = "stable-neo-hookean" }
        translate = [0, 0, 0.0525]
        friction = 0.2
        [[obstacle]]
        name = "floor"
        shape = { type = "half-space" }
        friction = 0.2
        [[obstacle]]
        name = "press"
        shape = { type = "box", size = [0.3, 0.3, 0.04], edge = 0.1 }
        translate = [0, 0, 0.13]
        [obstacle.motion]
        keyframes = [
            { time = 0.6, translate = [0, 0, -0.09] },
            { time = 0.8, translate = [0, 0, -0.09] },
            { time = 1.0, translate = [0, 0, 0.1] },
        ]
    "#;
    let course = Course::of(text, 160);
    let speed = course.most(|s| s.max_speed);
    assert!(speed < 10.0, "{speed} m/s");
    assert_eq!(course.steps[159].inverted_tets, 0);
}

#[test]
fn a_column_of_grains_stands() {
    let text = r#"
        [[body]]
        kind = "particles"
        shape = { type = "grains", count = [1, 1, 8], spacing = 0.0165, jitter = 0.05 }
        material = { base = "sand", radius = 0.004 }
        friction = 0.5
        translate = [0, 0, 0.08]
        [[obstacle]]
        shape = "half-space"
        friction = 0.5
    "#;
    let course = Course::of(text, 150);
    assert!(course.asleep.is_some_and(|step| step <= 100), "awake after 1 s");
    // They touch at their distance of contact, a diameter of 8 mm, however near they are within their body.
    let height = course.steps[149].center_of_mass[2];
    assert!((height / 0.032 - 1.0).abs() < 0.02, "the center of mass is {height} m high");
}

/// Two patches that fall on each other rest as far apart as parts of one body as they do as two bodies.
#[test]
fn parts_of_a_body_rest_as_far_apart_as_bodies() {
    let folder = tempfile::tempdir().expect("a folder");
    let corners =
        |height: f64| format!("v 0 0 {height}\nv 0.05 0 {height}\nv 0 0.05 {height}\nv 0.05 0.05 {height}\n");
    let [lower, upper] = [corners(0.005), corners(0.012)];
    let [first, second] = ["f 1 2 4\nf 1 4 3\n", "f 5 6 8\nf 5 8 7\n"];
    let meshes = [
        ("both", lower.clone() + &upper + first + second),
        ("lower", lower + first),
        ("upper", upper + first),
    ];
    for (name, text) in meshes {
        std::fs::write(folder.path().join(format!("{name}.obj")), text).expect("writes");
    }
    let height = |meshes: &[&str]| {
        let body = |mesh: &&str| format!("[[body]]\nmesh = \"{mesh}.obj\"\nfriction = 0.3\n");
        let bodies: String = meshes.iter().map(body).collect();
        let ground = "[[obstacle]]\nshape = \"half-space\"\nfriction = 0.3\n";
        let text = format!("[contact]\ndelta = 0.01\n{ground}{bodies}");
        let mut simulator = theory::simulator(&text, folder.path(), &[]);
        (0..100).map(|_| simulator.step().expect("a step").center_of_mass[2]).last().expect("a step")
    };
    let [together, apart] = [height(&["both"]), height(&["lower", "upper"])];
    assert!((together / apart - 1.0).abs() < 0.02, "{together} m high as one body, {apart} m as two");
    assert!(together > 0.014, "{together} m high");
}

/// A pile of sand keeps its height, in place of flowing on.
#[test]
fn a_pile_of_grains_comes_to_rest() {
    let scene = Scene::builtin("sand", 0.07).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let heights: Vec<f64> = (0..250).map(|_| simulator.step().expect("a step").center_of_mass[2]).collect();
    let sunk = heights[199] - heights[249];
    assert!(sunk.abs() < 2e-3 * heights[199], "{sunk} of {} m in half a second", heights[199]);
}

/// A block that falls on a taut sheet gains no energy from it: what contacts and edges at their limits store
/// they give back, and no more.
#[test]
fn a_block_on_a_taut_sheet_gains_no_energy() {
    let text = r#"
        [[body]]
        name = "sheet"
        shape = { type = "sheet", size = [0.4, 0.4], edge = 0.04 }
        stretch_limit = 1.05
        friction = 0.3
        [[pin]]
        body = "sheet"
        side = "x-min"
        [[pin]]
        body = "sheet"
        side = "x-max"
        [[body]]
        name = "block"
        kind = "solid"
        shape = { type = "block", size = [0.12, 0.12, 0.12], edge = 0.04 }
        material = { density = 1000, young_modulus = 1e5 }
        friction = 0.3
        translate = [0, 0, 0.12]
    "#;
    let course = Course::of(text, 100);
    let total = |s: &StepStatistics| s.energy.kinetic + s.energy.elastic + s.energy.potential;
    let (mut least, mut rise) = (f64::INFINITY, 0.0f64);
    for step in &course.steps {
        least = least.min(total(step));
        rise = rise.max(total(step) - least);
    }
    let [highest, lowest] = [f64::max, f64::min].map(|pick: fn(f64, f64) -> f64| {
        course.steps.iter().map(|s| s.energy.potential).reduce(pick).expect("a step")
    });
    assert!(rise < 0.01 * (highest - lowest), "{rise} J of {} J", highest - lowest);
}
