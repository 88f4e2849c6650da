//! How often a simulation on a device waits for it: steps that are submitted together have the same bits as
//! one by one.

use bowknot::dynamics::DeviceWork;
use bowknot::gpu::{ConjugateGradients, Device, TwinEngine};
use bowknot::{Scene, Simulator};
use bowknot_geometry::Point;

/// A run with so many steps per submission at most.
struct Course {
    counts: DeviceWork,
    two_way_steps: usize,
    end: Vec<Point>,
}

fn on_twins(scene: &Scene, most: usize, with_dynamics: bool) -> Simulator {
    let mut device = Device::new("twins".to_owned(), TwinEngine::new());
    device.set_steps_per_submission(most);
    let mut simulator = Simulator::new(scene).expect("a simulator");
    simulator.set_backend(Box::new(device)).expect("settings that the kernels have");
    if with_dynamics {
        let dynamics = ConjugateGradients::new("twins".to_owned(), TwinEngine::new());
        simulator.set_dynamics_backend(Some(Box::new(dynamics))).expect("elements that the kernels have");
    }
    simulator
}

fn course(scene: &Scene, time_steps: usize, most: usize, with_dynamics: bool) -> Course {
    let mut simulator = on_twins(scene, most, with_dynamics);
    let (mut two_way_steps, mut counts) = (0, DeviceWork::default());
    for _ in 0..time_steps {
        let statistics = simulator.step().expect("a step");
        two_way_steps += statistics.two_way_steps;
        counts = counts + statistics.device.unwrap_or_default();
    }
    Course { counts, two_way_steps, end: simulator.positions().to_vec() }
}

/// What a device is asked for in the first time steps of five scenes: submissions, dispatches, waits and buffers.
#[test]
fn scenes_ask_for_so_much() {
    let falls = ["body.0.velocity=[0,0,-4]".to_owned()];
    let scenes = [
        ("drape", 0.2, 24),
        ("needle", 0.12, 8),
        ("stack", 0.15, 12),
        ("bow-knot", 0.05, 8),
        ("sand", 0.05, 20),
    ];
    let counts = scenes.map(|(name, scale, time_steps)| {
        let scene = Scene::builtin(name, scale).expect("a scene");
        let scene = if name == "drape" { scene.with_sets(&falls).expect("a speed") } else { scene };
        let DeviceWork { submissions, dispatches, waits, buffers, .. } =
            course(&scene, time_steps, 8, true).counts;
        (name, [submissions, dispatches, waits, buffers])
    });
    let expected = [
        ("drape", [560, 50280, 555, 208]),
        ("needle", [437, 54443, 433, 208]),
        ("stack", [88, 4087, 86, 160]),
        ("bow-knot", [27, 3179, 27, 136]),
        ("sand", [84, 5756, 84, 140]),
    ];
    assert_eq!(counts, expected);
}

/// The same for a bow-knot in contact, where the first time step knows nothing of the iterations that systems take.
#[test]
fn a_bow_knot_in_contact_asks_for_so_much() {
    let scene = Scene::builtin("bow-knot", 0.2).expect("a scene");
    let mut on_cpu = Simulator::new(&scene).expect("a simulator");
    (0..60).for_each(|_| drop(on_cpu.step().expect("a step")));
    let mut simulator = on_twins(&scene, 8, true);
    simulator.restore(&on_cpu.checkpoint()).expect("a state");
    let counts = [(); 8].map(|()| {
        let device = simulator.step().expect("a step").device.unwrap_or_default();
        [device.submissions, device.dispatches, device.waits]
    });
    let expected = [
        [40, 2493, 40],
        [25, 2331, 25],
        [19, 2318, 19],
        [19, 2314, 19],
        [33, 2978, 33],
        [20, 2149, 20],
        [43, 3277, 43],
        [17, 1979, 17],
    ];
    assert_eq!(counts, expected);
}

#[test]
fn steps_that_are_submitted_together_have_the_same_bits_and_fewer_waits() {
    for (name, scale, time_steps) in [("drape", 0.2, 24), ("needle", 0.12, 8)] {
        let scene = Scene::builtin(name, scale)
            .and_then(|scene| scene.with_sets(&["body.0.velocity=[0,0,-4]".to_owned()]))
            .expect("a scene");
        let [one, eight] = [1, 8].map(|most| course(&scene, time_steps, most, false));
        assert!(one.end == eight.end, "{name}");
        assert_eq!(one.two_way_steps, eight.two_way_steps, "{name}");
        assert!(one.counts.submissions >= one.two_way_steps, "{name}");
        assert!(eight.counts.submissions < one.counts.submissions, "{name}");
        assert!(eight.counts.waits < one.counts.waits, "{name}");
    }
}
