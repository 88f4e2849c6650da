//! Elements of a caller in a simulation: nothing intersects whatever they want, they stay with their bodies,
//! sleep with them, and checkpoints refuse simulators that lack them.

use super::scene;
use bowknot::check::StateOptions;
use bowknot::dynamics::geometry::{Point, Vector};
use bowknot::dynamics::{AssemblySprings, Trial, Watched};
use bowknot::dynamics::{CustomElement, ElementMatrix, ElementModel, NewtonBackend};
use bowknot::dynamics::{
    NewtonBackendError, NewtonSolve, NewtonStep, NewtonTarget, OutOfBalance, SolveLimits,
};
use bowknot::geometry::nalgebra::Matrix3;
use bowknot::scene::{BodySpec, ObstacleSpec};
use bowknot::shapes::{Ball, MeshArrays, Shape};
use bowknot::simulator::{DriveError, RestoreError, SimulationError};
use bowknot::{Scene, Simulator};
use std::sync::Arc;

/// Energy k/2 |x1 - x0|^2: two vertices that want to be at one place.
#[derive(Debug)]
struct Attraction {
    vertices: [u32; 2],
    stiffness: f64,
}

impl CustomElement for Attraction {
    fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    fn energy(&self, x: &[Point]) -> f64 {
        0.5 * self.stiffness * (x[1] - x[0]).norm_squared()
    }

    fn gradient(&self, x: &[Point], gradient: &mut [Vector]) {
        gradient[1] = (x[1] - x[0]) * self.stiffness;
        gradient[0] = -gradient[1];
    }

    fn hessian(&self, _x: &[Point], hessian: &mut ElementMatrix<'_>) {
        let block = Matrix3::from_diagonal_element(self.stiffness);
        hessian.add(0, 0, &block);
        hessian.add(1, 1, &block);
        hessian.add(0, 1, &-block);
    }

    fn is_positive_semidefinite(&self) -> bool {
        true
    }

    fn is_invariant(&self) -> bool {
        true
    }
}

fn attraction(vertices: [u32; 2], stiffness: f64) -> Arc<dyn CustomElement> {
    Arc::new(Attraction { vertices, stiffness })
}

/// A law without a value.
#[derive(Debug)]
struct Nothing([u32; 1]);

impl CustomElement for Nothing {
    fn vertices(&self) -> &[u32] {
        &self.0
    }

    fn energy(&self, _x: &[Point]) -> f64 {
        f64::NAN
    }

    fn gradient(&self, _x: &[Point], _gradient: &mut [Vector]) {}

    fn hessian(&self, _x: &[Point], _hessian: &mut ElementMatrix<'_>) {}
}

/// Two sheets above each other, and a ground.
const SHEETS: &str = r#"
[solver.sleep]
enabled = true
time = 0.1

[[body]]
name = "low"
shape = { type = "sheet", size = [0.1, 0.1], edge = 0.02 }
translate = [0, 0, 0.01]
friction = 0.5

[[body]]
name = "high"
shape = { type = "sheet", size = [0.1, 0.1], edge = 0.02 }
translate = [0.003, 0.002, 0.06]
friction = 0.5

[[obstacle]]
name = "ground"
shape = "half-space"
friction = 0.5
"#;

fn simulator() -> Simulator {
    Simulator::new(&scene(SHEETS)).expect("a simulator")
}

fn step(simulator: &mut Simulator) {
    let statistics = simulator.step().unwrap_or_else(|error| panic!("{error}"));
    let count = simulator.world().collision_vertices();
    let options = StateOptions { limit: 3, distance: false };
    let report = simulator.judge().check_state(&simulator.positions()[..count], &options).expect("finite");
    assert!(report.is_clear(), "time step {}: {:?}", statistics.step, report.intersections);
}

fn bits(simulator: &Simulator) -> Vec<[u64; 6]> {
    let state = simulator.positions().iter().zip(simulator.velocities());
    state.map(|(x, v)| [x.x, x.y, x.z, v.x, v.y, v.z].map(f64::to_bits)).collect()
}

/// Each vertex of one sheet is drawn to that of the other.
fn all_to_all(simulator: &Simulator, stiffness: f64) -> Vec<Arc<dyn CustomElement>> {
    let vertex = |body: &str, k: u32| simulator.vertex(body, k).expect("a vertex");
    (0..36).map(|k| attraction([vertex("low", k), vertex("high", k)], stiffness)).collect()
}

/// As if the sheets were to be pressed through each other: each vertex wants to be where another one of the
/// other sheet is, across the sheet.
#[test]
fn a_law_that_presses_bodies_into_each_other_makes_no_intersection() {
    let mut simulator = simulator();
    let vertex = |body: &str, k: u32| simulator.vertex(body, k).expect("a vertex");
    let crossed: Vec<_> =
        (0..36).map(|k| attraction([vertex("low", k), vertex("high", 35 - k)], 200.0)).collect();
    simulator.add_elements("greed", crossed).expect("sound elements");
    (0..25).for_each(|_| step(&mut simulator));
    let energies = simulator.dynamics_model().elastic_energies(simulator.positions());
    assert!(energies.custom > 1e-4 && energies.total() >= energies.custom, "{energies:?}");
}

#[test]
fn elements_are_added_set_and_removed_and_change_nothing_while_there_are_none() {
    let mut plain = simulator();
    let mut other = simulator();
    (0..3).for_each(|_| {
        step(&mut plain);
        step(&mut other);
    });
    let elements = all_to_all(&other, 1.0);
    other.add_elements("glue", elements.clone()).expect("sound elements");
    assert_eq!(bits(&other), bits(&plain), "the state stays");
    other.remove_elements("glue").expect("there");
    (0..3).for_each(|_| {
        step(&mut plain);
        step(&mut other);
    });
    assert_eq!(bits(&other), bits(&plain));

    // Order of names, not of calls.
    let mut one = simulator();
    let mut two = simulator();
    let (a, b) = (elements[..5].to_vec(), elements[5..].to_vec());
    one.add_elements("a", a.clone()).and_then(|()| one.add_elements("b", b.clone())).expect("sound elements");
    two.add_elements("b", b.clone()).and_then(|()| two.add_elements("a", a.clone())).expect("sound elements");
    let stronger: Vec<_> = b.iter().map(|e| attraction([e.vertices()[0], e.vertices()[1]], 3.0)).collect();
    for simulator in [&mut one, &mut two] {
        step(simulator);
        simulator.set_elements("b", stronger.clone()).expect("the same vertices");
        (0..3).for_each(|_| step(simulator));
    }
    assert_eq!(bits(&one), bits(&two));
    assert_ne!(bits(&one)[0], bits(&plain)[0]);
}

#[test]
fn refusals_say_why_and_leave_the_simulator_as_it_was() {
    let mut simulator = simulator();
    let ball = Shape::Ball(Ball { radius: 0.02, edge: 0.01 });
    let ball = ObstacleSpec { name: "ball".to_owned(), shape: Some(ball), ..ObstacleSpec::default() };
    simulator.add_obstacle(ObstacleSpec { translate: Vector::new(0.2, 0.0, 0.1), ..ball }).expect("clear");
    let before = bits(&simulator);
    let mut refused = |name: &str, elements| {
        simulator.add_elements(name, elements).expect_err("must be refused").to_string()
    };
    assert_eq!(
        refused("x", vec![attraction([0, 72], 1.0), attraction([1, 1], 1.0)]),
        "custom element 0 of \"x\": vertex 72 belongs to the obstacle \"ball\", which no element moves: let the \
         element hold that place itself, and replace it where the obstacle moves; custom element 1 of \"x\": it \
         names vertex 1 twice"
    );
    assert!(refused("x", vec![attraction([0, 100_000], 1.0)]).contains("it names vertex 100000"));
    let elements = all_to_all(&simulator, 1.0);
    simulator.add_elements("glue", elements.clone()).expect("sound elements");
    let error = simulator.add_elements("glue", elements).expect_err("taken").to_string();
    assert_eq!(error, "\"glue\" is the name of a group of custom elements already; names must differ");
    let error = simulator.set_elements("paste", Vec::new()).expect_err("unknown").to_string();
    assert_eq!(error, "no custom elements \"paste\"; there are: glue");
    let error = simulator.remove_elements("paste").expect_err("unknown").to_string();
    assert_eq!(error, "no custom elements \"paste\"; there are: glue");
    let error = simulator.set_elements("glue", Vec::new()).expect_err("too few").to_string();
    assert_eq!(error, "custom elements \"glue\": 0 given in place of 36");
    let error = simulator.vertex("low", 36).expect_err("too large").to_string();
    assert_eq!(error, "body low has no vertex 36; its mesh has 36, counted from 0");
    assert_eq!(bits(&simulator), before);

    let error = simulator.set_dynamics_backend(Some(Box::new(Idle))).expect_err("the CPU alone").to_string();
    assert!(error.contains("the custom elements \"glue\" are computed by the CPU alone"), "{error}");
    simulator.remove_elements("glue").expect("there");
    simulator.set_dynamics_backend(Some(Box::new(Idle))).expect("no elements");
    let elements = all_to_all(&simulator, 1.0);
    let error = simulator.add_elements("glue", elements).expect_err("a backend").to_string();
    assert!(error.contains("the custom elements \"glue\" are computed by the CPU alone"), "{error}");
    assert!(simulator.dynamics_backend().is_some());
}

#[test]
fn a_law_without_a_value_ends_the_time_step_with_its_name() {
    let mut simulator = simulator();
    step(&mut simulator);
    simulator.add_elements("odd", vec![Arc::new(Nothing([40]))]).expect("a vertex");
    let before = bits(&simulator);
    let error = simulator.step().expect_err("no value");
    assert!(matches!(error, SimulationError::Target { step: 2, .. }));
    assert!(error.to_string().contains("custom element 0 of \"odd\": its energy is not finite"), "{error}");
    assert_eq!(bits(&simulator), before);
    simulator.remove_elements("odd").expect("there");
    step(&mut simulator);
}

#[test]
fn elements_stay_with_their_bodies_when_others_come_and_go() {
    let mut simulator = simulator();
    let extra = |name: &str, x: f64| {
        let corners = [[x, 0.0, 0.3], [x + 0.05, 0.0, 0.3], [x, 0.05, 0.3]].map(Point::from);
        BodySpec::from_arrays(name, MeshArrays::surface(corners.to_vec(), vec![[0, 1, 2]]))
    };
    simulator.add_body(extra("first", 0.2)).expect("clear");
    let joined = |simulator: &Simulator| {
        let [a, b] =
            [("first", 0), ("high", 3)].map(|(body, k)| simulator.vertex(body, k).expect("a vertex"));
        vec![attraction([a, b], 5.0)]
    };
    let elements = joined(&simulator);
    simulator.add_elements("rope", elements).expect("sound");
    step(&mut simulator);
    let energy =
        |simulator: &Simulator| simulator.dynamics_model().elastic_energies(simulator.positions()).custom;
    let before = energy(&simulator);
    assert!(before > 0.0);
    // Removing a body gives those after it other numbers.
    simulator.remove("low").expect("nothing needs it");
    assert!((energy(&simulator) - before).abs() < 1e-12 * before);
    let vertices = simulator.dynamics_model().element_groups()[0].elements[0].vertices().to_vec();
    assert_eq!(vertices, joined(&simulator)[0].vertices());
    simulator.set_elements("rope", joined(&simulator)).expect("the numbers of now");
    step(&mut simulator);
    let error = simulator.remove("first").expect_err("needed").to_string();
    assert_eq!(error, "custom elements \"rope\" act on body first; remove them first");
    simulator.remove_elements("rope").expect("there");
    simulator.remove("first").expect("no longer needed");
}

#[test]
fn checkpoints_need_the_elements_that_they_were_made_with() {
    let mut first = simulator();
    let elements = all_to_all(&first, 2.0);
    let before = first.checkpoint();
    first.add_elements("glue", elements.clone()).expect("sound");
    (0..3).for_each(|_| step(&mut first));
    let checkpoint = first.checkpoint();
    (0..3).for_each(|_| step(&mut first));

    let mut second = simulator();
    let refused = |simulator: &mut Simulator, checkpoint| {
        let error = simulator.restore(checkpoint).expect_err("must be refused");
        assert!(matches!(error, RestoreError::Elements { .. }));
        error.to_string()
    };
    assert_eq!(
        refused(&mut second, &checkpoint),
        "its custom elements \"glue\" are not there, and a checkpoint holds no code: add them before it is \
         restored"
    );
    second.add_elements("glue", elements[1..].to_vec()).expect("sound");
    assert_eq!(refused(&mut second, &checkpoint), "its custom elements \"glue\" have other vertices");
    assert_eq!(
        refused(&mut second, &before),
        "its custom elements \"glue\" were not there: remove them before it is restored"
    );
    second.remove_elements("glue").expect("there");
    second.add_elements("glue", elements).expect("sound");
    // As a file has it.
    let text = toml::to_string(&checkpoint).expect("a checkpoint");
    second.restore(&toml::from_str(&text).expect("the same checkpoint")).expect("the same elements");
    (0..3).for_each(|_| step(&mut second));
    assert_eq!(bits(&second), bits(&first));
}

#[test]
fn bodies_that_elements_join_sleep_and_wake_together() {
    // Beside each other on the ground.
    let mut scene: Scene = scene(SHEETS);
    scene.bodies[1].translate = Vector::new(0.2, 0.0, 0.01);
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    // At rest length 0 a spring would pull the sheets together; friction holds them.
    let [a, b] = [("low", 0), ("high", 0)].map(|(body, k)| simulator.vertex(body, k).expect("a vertex"));
    let rope = |stiffness: f64| vec![attraction([a, b], stiffness)];
    simulator.add_elements("rope", rope(1e-5)).expect("sound");
    for _ in 0..100 {
        step(&mut simulator);
        assert_eq!(simulator.asleep()[0], simulator.asleep()[1], "both or none");
    }
    assert!(simulator.asleep()[0], "both are at rest");
    // The bodies asleep are restored as they are.
    let checkpoint = simulator.checkpoint();
    let mut other = Simulator::new(&scene).expect("a simulator");
    other.add_elements("rope", rope(1e-5)).expect("sound");
    other.restore(&checkpoint).expect("the same elements");
    assert!(other.asleep()[0] && other.asleep()[1]);
    let mut damaged = checkpoint;
    damaged.sleep.islands[0] = bowknot::simulator::SleepState::AWAKE;
    assert!(matches!(other.restore(&damaged), Err(RestoreError::Sleep)));

    // The same object wakes nothing, another law does.
    let same = simulator.dynamics_model().element_groups()[0].elements.clone();
    simulator.set_elements("rope", same).expect("the same vertices");
    step(&mut simulator);
    assert!(simulator.asleep()[0]);
    simulator.set_elements("rope", rope(3.0)).expect("the same vertices");
    let before = simulator.positions()[a as usize];
    for _ in 0..10 {
        step(&mut simulator);
    }
    assert!(!simulator.asleep()[0] && !simulator.asleep()[1]);
    assert!((simulator.positions()[a as usize] - before).norm() > 1e-3, "the rope pulls");
}

#[test]
fn a_sleeper_and_what_is_awake_have_their_own_elements() {
    // A third sheet falls beside two at rest, held by an element within itself.
    let third = "[[body]]\nname = \"third\"\nshape = { type = \"sheet\", size = [0.1, 0.1], edge = 0.02 }\n\
                 translate = [-0.3, 0, 3.0]\n";
    let mut scene: Scene = scene(&format!("{SHEETS}{third}"));
    scene.bodies[1].translate = Vector::new(0.2, 0.0, 0.01);
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    let vertex = |body: &str, k: u32| simulator.vertex(body, k).expect("a vertex");
    let elements = |stiffness: f64| {
        vec![
            attraction([vertex("low", 0), vertex("high", 0)], 1e-5),
            attraction([vertex("third", 0), vertex("third", 35)], stiffness),
        ]
    };
    let (weak, strong) = (elements(0.01), elements(2.0));
    let ends = [vertex("third", 0), vertex("third", 35)].map(|v| v as usize);
    simulator.add_elements("ropes", weak.clone()).expect("sound");
    for _ in 0..60 {
        step(&mut simulator);
    }
    assert_eq!(simulator.asleep()[..3], [true, true, false]);
    let distance =
        |simulator: &Simulator| (simulator.positions()[ends[0]] - simulator.positions()[ends[1]]).norm();
    let before = distance(&simulator);
    simulator
        .set_elements("ropes", vec![Arc::clone(&weak[0]), Arc::clone(&strong[1])])
        .expect("the same vertices");
    for _ in 0..5 {
        step(&mut simulator);
    }
    assert_eq!(simulator.asleep()[..3], [true, true, false], "only the third has another element");
    assert!(distance(&simulator) < before - 1e-3, "its element pulls");
}

#[test]
fn only_drive_errors_come_from_setting_elements() {
    let error = simulator().set_elements("x", Vec::new()).expect_err("unknown");
    assert!(matches!(error, DriveError::Elements { .. }));
}

/// A backend that is never asked.
#[derive(Debug)]
struct Idle;

fn never<T>() -> Result<T, NewtonBackendError> {
    Err("never asked".into())
}

impl NewtonBackend for Idle {
    fn name(&self) -> String {
        "idle".to_owned()
    }
    fn set_model(&mut self, _: &ElementModel) -> Result<(), NewtonBackendError> {
        never()
    }
    fn begin_step(&mut self, _: &NewtonStep<'_>) -> Result<(), NewtonBackendError> {
        never()
    }
    fn begin_target(&mut self, _: &NewtonTarget<'_>) -> Result<Watched, NewtonBackendError> {
        never()
    }
    fn linearize(&mut self, _: bool) -> Result<(), NewtonBackendError> {
        never()
    }
    fn diagonal(&mut self, _: &mut Vec<Matrix3<f64>>) -> Result<(), NewtonBackendError> {
        never()
    }
    fn solve(&mut self, _: &AssemblySprings<'_>, _: &SolveLimits) -> Result<NewtonSolve, NewtonBackendError> {
        never()
    }
    fn component_residuals(&mut self, _: &mut Vec<Vector>) -> Result<(), NewtonBackendError> {
        never()
    }
    fn translate(&mut self, _: &[Vector]) -> Result<(), NewtonBackendError> {
        never()
    }
    fn place(&mut self, _: f64) -> Result<Trial, NewtonBackendError> {
        never()
    }
    fn begin_search(&mut self) -> Result<(Watched, Trial), NewtonBackendError> {
        never()
    }
    fn start_from_trial(&mut self) -> Result<(), NewtonBackendError> {
        never()
    }
    fn keep_trial(&mut self) -> Result<(), NewtonBackendError> {
        never()
    }
    fn start_from_kept_trial(&mut self) -> Result<(), NewtonBackendError> {
        never()
    }
    fn target(&mut self, _: &mut [Vector]) -> Result<(), NewtonBackendError> {
        never()
    }
    fn out_of_balance(
        &mut self,
        _: &AssemblySprings<'_>,
        _: &[Vector],
        _: &[bool],
        _: bool,
    ) -> Result<OutOfBalance, NewtonBackendError> {
        never()
    }
}
