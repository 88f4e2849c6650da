//! Bodies that press on each other come to rest.

use bowknot::scene::Scene;
use bowknot::{Simulator, StepStatistics};

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

/// A sheet between two boxes that leave it a gap of so much on either side [m]; the contact distance is 2.2 mm.
fn slot(gap: f64) -> String {
    let half = 0.01 + gap;
    format!(
        r#"
        [simulation]
        gravity = [0, 0, 0]
        [[body]]
        shape = {{ type = "sheet", size = [0.04, 0.04], edge = 0.02 }}
        [[obstacle]]
        shape = {{ type = "box", size = [0.05, 0.05, 0.02], edge = 0.025 }}
        translate = [0, 0, -{half}]
        [[obstacle]]
        shape = {{ type = "box", size = [0.05, 0.05, 0.02], edge = 0.025 }}
        translate = [0, 0, {half}]
        "#
    )
}

#[test]
fn a_sheet_in_a_slot_narrower_than_two_contact_distances_stays_still() {
    for gap in [2.1e-3, 2e-3, 1.5e-3] {
        let course = Course::of(&slot(gap), 60);
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

/// A rubber cube on a cotton sheet on the ground, with a coefficient of friction.
fn pressed_sheet(friction: f64) -> String {
    format!(
        r#"
        [contact]
        delta = 0.001
        [[body]]
        name = "sheet"
        shape = {{ type = "sheet", size = [0.3, 0.3], edge = 0.02 }}
        translate = [0, 0, 0.001]
        friction = {friction}
        material = "cotton"
        [[body]]
        name = "cube"
        kind = "solid"
        shape = {{ type = "block", size = [0.06, 0.06, 0.06], edge = 0.02 }}
        translate = [0, 0, 0.0325]
        friction = {friction}
        material = "rubber"
        [[obstacle]]
        shape = {{ type = "half-space" }}
        friction = {friction}
        "#
    )
}

#[test]
fn a_cube_on_a_sheet_comes_to_rest_where_it_is() {
    let course = Course::of(&pressed_sheet(0.3), 100);
    assert!(course.asleep.is_some_and(|step| step <= 100), "awake after 1 s");
    let centers = [&course.steps[10], &course.steps[99]].map(|s| s.center_of_mass);
    let shift = (centers[1][0] - centers[0][0]).hypot(centers[1][1] - centers[0][1]);
    assert!(shift < 1e-4, "it has walked {shift} m");
}

#[test]
fn without_friction_a_cube_pushes_the_sheet_below_it_to_no_side() {
    let course = Course::of(&pressed_sheet(0.0), 100);
    let sideways = course.most(|s| s.momentum[0].hypot(s.momentum[1]));
    // The cube fell with 0.014 kg m/s.
    assert!(sideways < 1e-6, "{sideways} kg m/s");
}

/// A block without weight, pinned on one side, that moves inward by so much [m] until a time [s]. `axis` is 0 for x and 1 for y; it
/// stands at `place` on that axis.
struct Pad {
    name: &'static str,
    axis: usize,
    place: f64,
    size: [f64; 3],
    friction: f64,
    material: &'static str,
    way: f64,
    until: f64,
}

impl Pad {
    fn toml(&self) -> String {
        let Self { name, axis, place, size, friction, material, way, until } = self;
        let along = |length: f64| {
            let mut vector = [0.0; 3];
            vector[*axis] = length;
            vector
        };
        let side = format!("{}-{}", ["x", "y"][*axis], if *place < 0.0 { "min" } else { "max" });
        format!(
            r#"
            [[body]]
            name = "{name}"
            kind = "solid"
            shape = {{ type = "block", size = {size:?}, edge = 0.02 }}
            translate = {:?}
            friction = {friction}
            material = "{material}"
            gravity = [0, 0, 0]
            [[pin]]
            body = "{name}"
            side = "{side}"
            motion = {{ keyframes = [{{ time = {until}, translate = {:?} }}] }}
            "#,
            along(*place),
            along(-way * place.signum())
        )
    }
}

#[test]
fn a_cube_between_soft_pads_is_held() {
    let pad = |name: &'static str, place: f64| {
        let (size, friction, material) = ([0.02, 0.04, 0.04], 0.8, "silicone");
        Pad { name, axis: 0, place, size, friction, material, way: 0.001, until: 0.1 }.toml()
    };
    let text = format!(
        r#"
        [contact]
        delta = 0.001
        [[body]]
        name = "cube"
        kind = "solid"
        shape = {{ type = "block", size = [0.04, 0.04, 0.04], edge = 0.02 }}
        friction = 0.8
        material = "rubber"
        {}{}
        [solver.sleep]
        enabled = false
        "#,
        pad("left", -0.0311),
        pad("right", 0.0311)
    );
    let course = Course::of(&text, 200);
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

/// A strip of denim between two pads of rubber that close, pinned above for so long.
fn pinched_strip(friction: f64) -> String {
    let pad = |name: &'static str, place: f64| {
        let (size, material) = ([0.1, 0.02, 0.04], "rubber");
        Pad { name, axis: 1, place, size, friction, material, way: 0.006, until: 0.3 }.toml()
    };
    format!(
        r#"
        [simulation]
        air_drag = 1
        [contact]
        delta = 0.002
        [[body]]
        name = "strip"
        shape = {{ type = "sheet", size = [0.1, 0.3], edge = 0.02 }}
        rotate = [90, 0, 0]
        translate = [0, 0, -0.12]
        friction = {friction}
        material = "denim"
        [[pin]]
        body = "strip"
        side = "z-max"
        end = 0.4
        {}{}
        [solver.sleep]
        enabled = false
        "#,
        pad("left", -0.0151),
        pad("right", 0.0151)
    )
}

#[test]
fn pads_hold_a_strip_without_creep() {
    for friction in [0.3, 1.0] {
        let course = Course::of(&pinched_strip(friction), 300);
        let solved = course.solved(100);
        assert!(solved > 0.9, "mu = {friction}: {solved} of the time steps are solved");
        let speed = course.most(|s| s.max_speed);
        assert!(speed < 0.5, "mu = {friction}: {speed} m/s");
        let fallen = course.steps[199].center_of_mass[2] - course.steps[299].center_of_mass[2];
        assert!(fallen.abs() < 5e-5, "mu = {friction}: it creeps {fallen} m in a second");
    }
}

/// A sheet twisted by two turns, so that its edges are at their limits and its layers press on each other.
#[test]
fn a_twisted_sheet_is_solved_once_its_pins_rest() {
    let pin = |side: &str, sign: f64| {
        format!(
            "[[pin]]\nside = \"{side}\"\nmotion = {{ axis = [1, 0, 0], keyframes = [{{ time = 1.2, angle = {}, \
             translate = [{}, 0, 0] }}] }}\n",
            360.0 * sign,
            -0.05 * sign
        )
    };
    let text = format!(
        r#"
        [simulation]
        gravity = [0, 0, 0]
        [[body]]
        shape = {{ type = "sheet", size = [0.5, 0.25], edge = 0.03 }}
        material = {{ base = "cotton", stretch_damping = 0.05, bend_damping = 0.05 }}
        friction = 0.2
        {}{}
        "#,
        pin("x-min", -1.0),
        pin("x-max", 1.0)
    );
    let course = Course::of(&text, 240);
    let (solved, stretch) = (course.solved(160), course.steps[239].max_stretch);
    assert!(solved > 0.9, "{solved} of the time steps are solved");
    // Its limit is 1.05.
    assert!(stretch < 1.065, "stretched {stretch} times");
    let speed = course.steps[220..].iter().map(|s| s.max_speed).fold(0.0, f64::max);
    assert!(speed < 0.2, "{speed} m/s a second after its pins stopped");
}

/// Crumpled by a pin that lowers it on a table, and then released.
#[test]
fn a_cloth_that_is_lowered_on_a_table_lies_flat_on_itself() {
    let text = r#"
        [[body]]
        shape = { type = "sheet", size = [0.4, 0.4], edge = 0.02 }
        material = "cotton"
        friction = 0.4
        rotate = [0, 0, 45]
        translate = [0, 0, 0.6]
        [[obstacle]]
        shape = { type = "box", size = [0.8, 0.8, 0.05], edge = 0.05 }
        translate = [0, 0, -0.025]
        friction = 0.4
        [[pin]]
        side = "x-max"
        end = 3.0
        motion = { keyframes = [{ time = 1.0 }, { time = 2.8, translate = [0.0, 0.0, -0.57] }] }
    "#;
    let course = Course::of(text, 450);
    let end = &course.steps[449];
    let height = end.center_of_mass[2];
    assert!((0.01..0.045).contains(&height), "its mean height is {height} m");
    assert!(end.max_speed < 0.1, "{} m/s one and a half seconds after its release", end.max_speed);
}

#[test]
fn cloth_below_and_above_grains_comes_to_rest() {
    let sheet = |name: &str, z: f64| {
        format!(
            r#"
            [[body]]
            name = "{name}"
            shape = {{ type = "sheet", size = [0.2, 0.2], edge = 0.025 }}
            material = "cotton"
            friction = 0.5
            translate = [0, 0, {z}]
            "#
        )
    };
    let text = format!(
        r#"
        {}{}
        [[body]]
        name = "grains"
        kind = "particles"
        shape = {{ type = "grains", count = [4, 4, 3], spacing = 0.0165, jitter = 0.05 }}
        material = {{ base = "sand", radius = 0.004 }}
        friction = 0.5
        translate = [0, 0, 0.08]
        [[obstacle]]
        shape = "half-space"
        friction = 0.5
        "#,
        sheet("below", 0.01),
        sheet("above", 0.16)
    );
    let course = Course::of(&text, 150);
    assert!(course.asleep.is_some(), "awake after 1.5 s");
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
    let end = course.steps[149].max_speed;
    assert!(end < 1e-9, "{end} m/s after 1.5 s");
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
    // They touch at their distance of contact.
    let closest = course.steps.iter().filter_map(|s| s.min_gap_m).fold(f64::MAX, f64::min);
    assert!(closest > 3e-3, "{closest} m apart");
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
