use bowknot::check::StateOptions;
use bowknot::{Scene, Simulator};

/// What a run did: Newton iterations, two-way steps, and the height of the center of mass after each time
/// step, and the largest number of springs.
struct Course {
    iterations: usize,
    steps: usize,
    heights: Vec<f64>,
    springs: usize,
}

/// A sheet falls on a ball; every state is judged.
fn course(preset: &str) -> Course {
    course_with(preset, &[])
}

fn course_with(preset: &str, more: &[&str]) -> Course {
    let preset_set = format!("contact.preset={preset}");
    let sets =
        [&[preset_set.as_str(), "body.0.velocity=[0, 0, -3]", "body.0.translate=[0.013, 0.007, 0.53]"], more]
            .concat();
    let scene = Scene::builtin("drape", 0.3).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let judge = simulator.judge();
    let mut course = Course { iterations: 0, steps: 0, heights: Vec::new(), springs: 0 };
    for step in 0..18 {
        let statistics = simulator.step().expect("a step");
        let state = judge.check_state(simulator.positions(), &StateOptions::default()).expect("a report");
        assert!(state.is_clear(), "{preset}, step {step}: {state:?}");
        course.iterations += statistics.newton_iterations;
        course.steps += statistics.two_way_steps;
        course.heights.push(statistics.center_of_mass[2]);
        course.springs = course.springs.max(statistics.repulsion_springs);
    }
    course
}

#[test]
fn the_repulsion_of_the_paper_takes_fewer_steps_and_is_nearer_to_contact_forces() {
    let with = course("paper");
    let without = course_with("paper", &["solver.repulsion.stiffness=0"]);
    assert!(with.springs > 0 && without.springs == 0, "{} {}", with.springs, without.springs);
    assert!(with.steps < without.steps, "{} {}", with.steps, without.steps);
    // Contact forces by the iterations that `fast` makes: the center of mass at the bounce, 0.28 m.
    let fast = course("fast");
    let apart = |course: &Course| {
        let heights = course.heights.iter().zip(&fast.heights);
        heights.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(
        3.0 * apart(&with) < apart(&without) && apart(&without) > 0.03,
        "{} {} m",
        apart(&with),
        apart(&without)
    );
}

#[test]
fn quick_needs_six_tenths_of_the_iterations_and_goes_the_same_way() {
    let (fast, quick) = (course("fast"), course("quick"));
    assert!(5 * quick.iterations < 3 * fast.iterations, "{} {}", quick.iterations, fast.iterations);
    assert!(5 * quick.steps < 3 * fast.steps, "{} {}", quick.steps, fast.steps);
    let apart = fast.heights.iter().zip(&quick.heights).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // Edges are 67 mm long, and the sheet falls by 0.2 m.
    assert!(apart < 0.01, "{apart}");
}
