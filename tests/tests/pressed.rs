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

#[test]
fn a_cube_between_soft_pads_is_held() {
    let text = r#"
        [contact]
        delta = 0.001
        [[body]]
        name = "cube"
        kind = "solid"
        shape = { type = "block", size = [0.04, 0.04, 0.04], edge = 0.02 }
        friction = 0.8
        material = "rubber"
        [[body]]
        name = "left"
        kind = "solid"
        shape = { type = "block", size = [0.02, 0.04, 0.04], edge = 0.02 }
        translate = [-0.0311, 0, 0]
        friction = 0.8
        material = "silicone"
        gravity = [0, 0, 0]
        [[body]]
        name = "right"
        kind = "solid"
        shape = { type = "block", size = [0.02, 0.04, 0.04], edge = 0.02 }
        translate = [0.0311, 0, 0]
        friction = 0.8
        material = "silicone"
        gravity = [0, 0, 0]
        [[pin]]
        body = "left"
        side = "x-min"
        motion = { keyframes = [{ time = 0.1, translate = [0.001, 0, 0] }] }
        [[pin]]
        body = "right"
        side = "x-max"
        motion = { keyframes = [{ time = 0.1, translate = [-0.001, 0, 0] }] }
        [solver.sleep]
        enabled = false
    "#;
    let course = Course::of(text, 200);
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
