use super::scene;
use bowknot::{Scene, Simulator, StepStatistics};

/// A sheet of 11 by 11 vertices whose vertices `a` and `b` of the first row are held, the second one led.
fn sheet(a: usize, b: usize, keyframes: &str) -> Scene {
    scene(&format!(
        r#"
        body = [{{ name = "sheet", shape = {{ type = "sheet", size = [0.2, 0.2], edge = 0.02 }} }}]
        pin = [{{ vertices = [{a}] }}, {{ vertices = [{b}], motion = {{ keyframes = [{keyframes}] }} }}]
        "#
    ))
}

fn steps(simulator: &mut Simulator, count: usize) -> Vec<StepStatistics> {
    (0..count).map(|_| simulator.step().unwrap_or_else(|error| panic!("{error}"))).collect()
}

/// The edges longer than 1.0126 times their limit, with their ratios.
fn too_long(simulator: &Simulator) -> Vec<([u32; 2], f64)> {
    let (x, rest) = (simulator.positions(), simulator.resolver().scene().rest());
    let ratio = |&[a, b]: &[u32; 2]| {
        let length = |x: &[bowknot::geometry::Point]| (x[a as usize] - x[b as usize]).norm();
        ([a, b], length(x) / (1.05 * length(rest)))
    };
    let edges = simulator.world().collision.topology().edges.iter().map(ratio);
    edges.filter(|(_, ratio)| *ratio > 1.0126).collect()
}

#[test]
fn edges_between_pins_yield_and_no_others() {
    let mut simulator =
        Simulator::new(&sheet(4, 6, "{ time = 0.1 }, { time = 0.2, translate = [0.003, 0, 0] }"))
            .expect("sound");
    let steps = steps(&mut simulator, 60);
    assert!(steps.iter().all(|step| step.solved && step.prescribed_lag_m == 0.0));
    let two_way: usize = steps.iter().map(|step| step.two_way_steps).sum();
    assert!(two_way < 60 * 10, "{two_way} two-way steps");
    let edges: Vec<[u32; 2]> = too_long(&simulator).into_iter().map(|(edge, _)| edge).collect();
    assert_eq!(edges, [[4, 5], [5, 6]]);
    assert!(steps[59].max_stretch < 1.01 * 43.0 / 40.0, "{}", steps[59].max_stretch);
    let held = steps[59].held_apart.clone().expect("43 mm are too much");
    assert_eq!(held.to_string(), "vertices 4 and 6 of sheet are held 43.0 mm apart, edges allow 42.0 mm");
    assert!(steps[9].held_apart.is_none());
}

#[test]
fn pins_within_the_limits_ask_for_nothing() {
    let keyframes = "{ time = 0.1 }, { time = 0.2, translate = [0.0015, 0, 0] }";
    let mut simulator = Simulator::new(&sheet(4, 6, keyframes)).expect("sound");
    let steps = steps(&mut simulator, 30);
    assert!(steps.iter().all(|step| step.solved && step.held_apart.is_none()));
    assert_eq!(simulator.checkpoint().contacts.yielding, []);
}

#[test]
fn one_edge_between_pins_is_named() {
    let keyframes = "{ time = 0.0 }, { time = 0.1, translate = [0.003, 0, 0] }";
    let mut simulator = Simulator::new(&sheet(4, 5, keyframes)).expect("sound");
    let steps = steps(&mut simulator, 15);
    assert!(steps.iter().all(|step| step.solved));
    let held = steps[14].held_apart.as_ref().expect("23 mm are too much");
    assert_eq!(held.to_string(), "vertices 4 and 5 of sheet are held 23.0 mm apart, edges allow 21.0 mm");
}

/// Pins go apart and come back, and a run that is resumed on the way goes on to the same bits.
#[test]
fn edges_go_back_to_their_limits() {
    let scene = sheet(
        1,
        9,
        "{ time = 0.1 }, { time = 0.3, translate = [0.02, 0, 0] }, { time = 0.5, translate = [-0.01, 0, 0] }",
    );
    let mut simulator = Simulator::new(&scene).expect("sound");
    let mut all = steps(&mut simulator, 37);
    let checkpoint = simulator.checkpoint();
    assert!(!checkpoint.contacts.yielding.is_empty());
    all.extend(steps(&mut simulator, 3));
    let mut resumed = Simulator::new(&scene).expect("sound");
    resumed.restore(&checkpoint).expect("of the same scene");
    steps(&mut resumed, 3);
    assert_eq!(simulator.positions(), resumed.positions());
    all.extend(steps(&mut simulator, 40));
    let stretch = all.iter().map(|step| step.max_stretch).fold(0.0, f64::max);
    assert!((180.0 / 160.0 - 1e-3..1.16).contains(&stretch), "{stretch}");
    let unsolved: Vec<usize> = all.iter().filter(|step| !step.solved).map(|step| step.step).collect();
    assert!(unsolved.is_empty(), "{unsolved:?}");
    assert!(too_long(&simulator).is_empty(), "{:?}", too_long(&simulator));
    assert_eq!(simulator.checkpoint().contacts.yielding, []);
}

/// A pin that something stops asks for what it has reached, not for what its keyframes say.
#[test]
fn a_pin_that_waits_asks_for_nothing() {
    let text = r#"
        body = [{ name = "strip", shape = { type = "sheet", size = [0.2, 0.04], edge = 0.02 } }]
        pin = [{ side = "x-min" }, { side = "x-max", motion = { keyframes = [{ time = 0.0 }, { time = 0.3, translate = [0.2, 0, 0] }] } }]
        obstacle = [{ name = "wall", shape = { type = "box", size = [0.02, 0.2, 0.2], edge = 0.1 }, translate = [0.112, 0, 0] }]
        "#;
    let mut simulator = Simulator::new(&scene(text)).expect("sound");
    let steps = steps(&mut simulator, 30);
    assert!(steps[29].prescribed_lag_m > 0.15, "{}", steps[29].prescribed_lag_m);
    assert!(steps.iter().all(|step| step.held_apart.is_none()));
    assert!(too_long(&simulator).is_empty());
}

#[cfg(feature = "twins")]
#[test]
fn the_twins_of_the_kernels_let_edges_yield_as_well() {
    use bowknot::gpu::{Device, TwinEngine};
    let keyframes = "{ time = 0.0 }, { time = 0.1, translate = [0.003, 0, 0] }, { time = 0.2 }";
    let mut simulator = Simulator::new(&sheet(4, 6, keyframes)).expect("sound");
    simulator.set_backend(Box::new(Device::new("twins".to_owned(), TwinEngine::new()))).expect("supported");
    let steps = steps(&mut simulator, 25);
    assert!(
        steps.iter().all(|step| step.solved),
        "{:?}",
        steps.iter().map(|s| s.residual_m).collect::<Vec<_>>()
    );
    assert!(steps[9].held_apart.is_some() && steps[24].held_apart.is_none());
    assert!(too_long(&simulator).is_empty());
}
