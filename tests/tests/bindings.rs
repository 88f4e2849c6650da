//! A device that binds little: calls go on with smaller trust regions where it does not bind all candidates.

use bowknot::check::StateOptions;
use bowknot::gpu::{Device, TwinEngine};
use bowknot::{Scene, Simulator};
use bowknot_geometry::Point;

/// What a run did.
struct Course {
    /// Mean edge length [m].
    edge: f64,
    /// Two-way steps, and time steps that converged.
    steps: usize,
    converged: usize,
    /// Center of mass after each time step.
    centers: Vec<Point>,
}

/// Time steps of `blade`, each state judged, on twins that bind room for so many candidates.
fn blade(room: Option<u64>, time_steps: usize) -> Course {
    let scene = Scene::builtin("blade", 0.1).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let mut engine = TwinEngine::new();
    // The largest of the buffers with an entry per candidate.
    room.iter().for_each(|candidates| engine.limit_buffers(48 * candidates));
    simulator.set_backend(Box::new(Device::new("twins".to_owned(), engine))).expect("a backend");
    let judge = simulator.judge();
    let count = simulator.world().collision_vertices();
    let edge = simulator.resolver().scene().lengths().edge;
    let mut course = Course { edge, steps: 0, converged: 0, centers: Vec::new() };
    for step in 0..time_steps {
        let statistics = simulator.step().unwrap_or_else(|error| panic!("step {step}: {error}"));
        course.steps += statistics.two_way_steps;
        course.converged += usize::from(statistics.converged);
        course.centers.push(Point::from(statistics.center_of_mass));
        let options = StateOptions { limit: 1, distance: false };
        let state = judge.check_state(&simulator.positions()[..count], &options).expect("a report");
        assert!(state.is_clear(), "step {step}: {state:?}");
    }
    course
}

#[test]
fn a_scene_goes_on_where_its_candidates_are_more_than_a_device_binds() {
    const TIME_STEPS: usize = 8;
    let [plenty, few] = [None, Some(30_000)].map(|room| blade(room, TIME_STEPS));
    assert!(few.steps > plenty.steps, "{} two-way steps, {} with room", few.steps, plenty.steps);
    assert_eq!(few.converged, TIME_STEPS);
    // Two vertices may stop short of their targets by the tolerance of the stopping rule each.
    let apart = plenty.centers.iter().zip(&few.centers).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 0.02 * few.edge, "{apart} m, edges of {} m", few.edge);
}
