use bowknot::check::StateOptions;
use bowknot::{Scene, Simulator};

/// What a run did: Newton iterations, two-way steps, and the height of the center of mass after each time
/// step.
struct Course {
    iterations: usize,
    steps: usize,
    heights: Vec<f64>,
}

/// A sheet falls on a ball; every state is judged.
fn course(preset: &str) -> Course {
    let sets = [
        format!("contact.preset={preset}"),
        "body.0.velocity=[0, 0, -3]".to_owned(),
        "body.0.translate=[0.013, 0.007, 0.53]".to_owned(),
    ];
    let scene = Scene::builtin("drape", 0.3).and_then(|scene| scene.with_sets(&sets)).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let judge = simulator.judge();
    let mut course = Course { iterations: 0, steps: 0, heights: Vec::new() };
    for step in 0..18 {
        let statistics = simulator.step().expect("a step");
        let state = judge.check_state(simulator.positions(), &StateOptions::default()).expect("a report");
        assert!(state.is_clear(), "{preset}, step {step}: {state:?}");
        course.iterations += statistics.newton_iterations;
        course.steps += statistics.two_way_steps;
        course.heights.push(statistics.center_of_mass[2]);
    }
    course
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
