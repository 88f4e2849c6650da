//! Pins that are led into an obstacle, with the collisions on the kernels: the cloth stays where it can be.

use bowknot::gpu::{Adapter, Device, DeviceEngine, Engine, TwinEngine, resolve_on};
use bowknot::simulator::CollisionBackend;
use bowknot::{Scene, Simulator};
use bowknot_geometry::{Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_tests::{Case, StepChecker};
use bowknot_twoway::{AcceptedState, Params, ResolveInput, Resolver, Statistics};
use std::fmt::Debug;
use std::ops::ControlFlow;

const EDGE: f64 = 0.1;

fn device() -> DeviceEngine {
    let adapter = Adapter::choose(None).expect("a device, of software if need be");
    DeviceEngine::open(&adapter).expect("it opens")
}

/// A sheet of nine by nine vertices above a pyramid, whose top is just beside one of four vertices in its
/// middle. The rows of triangles with that vertex have a short lever on the others.
fn sheet_above_pyramid() -> (Case, [usize; 4]) {
    let n = 9;
    let at = |k: u32| EDGE * (f64::from(k) - 0.5 * f64::from(n - 1));
    let mut x: Vec<Point> = (0..n * n).map(|k| Point::new(at(k % n), at(k / n), 0.02)).collect();
    let squares = (0..n * (n - 1)).filter(|k| k % n != n - 1);
    let mut triangles: Vec<[u32; 3]> =
        squares.flat_map(|k| [[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]).collect();
    let peak = x.len() as u32;
    let top = Point::new(x[30].x + 1e-4, x[30].y + 2e-4, 0.0);
    x.push(top);
    x.extend(
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(a, b)| top + EDGE * Vector::new(a, b, -1.0)),
    );
    triangles.extend((0..4).map(|k| [peak, peak + 1 + k, peak + 1 + (k + 1) % 4]));
    let topology = Topology::builder(x.len()).triangles(triangles).build().expect("a mesh");
    let bodies = (0..x.len() as u32).map(|v| u32::from(v >= peak)).collect();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, bodies, filters, vec![]).expect("a model");
    (Case { name: "pyramid".to_owned(), model, positions: x }, [30, 31, 39, 40])
}

/// Leads the pins to `depth` below the top of the pyramid [m], and the other vertices with them. What came of
/// it, the largest distance of a vertex of the sheet from its target [m], and the largest ratio of an edge to
/// its length at rest.
fn led_to<E: Engine + Debug + Send>(engine: Option<E>, depth: f64) -> (Statistics, f64, f64) {
    let (case, pins) = sheet_above_pyramid();
    let (mut x, count) = (case.positions.clone(), case.positions.len());
    let sheet = count - 5;
    let mut resolver =
        Resolver::new(case.model.clone(), &x, &vec![1.0; count], Params::fast()).expect("a scene");
    let mut y = x.clone();
    y[..sheet].iter_mut().for_each(|p| p.z -= 0.02 + depth);
    let (mut prescribed, mut groups) = (vec![false; count], vec![ResolveInput::NO_GROUP; count]);
    pins.iter().for_each(|&v| (prescribed[v], groups[v]) = (true, 0));
    let input = ResolveInput { prescribed: &prescribed, groups: &groups, ..ResolveInput::default() };
    let mut checker = StepChecker::new(&case);
    let mut observe = |state: &AcceptedState<'_>| {
        checker.check_step(state.previous, state.positions);
        ControlFlow::Continue(())
    };
    let statistics = match engine {
        Some(engine) => {
            resolve_on(engine, &mut resolver, &mut x, &y, &input, &mut observe).expect("a result")
        }
        None => resolver.resolve_with(&mut x, &y, &input, &mut observe).expect("a result"),
    };
    assert_eq!(checker.fault, None);
    let far = (0..sheet).map(|v| (x[v] - y[v]).norm()).fold(0.0, f64::max);
    let ratio = |&[a, b]: &[u32; 2]| {
        let length = |x: &[Point]| (x[a as usize] - x[b as usize]).norm();
        length(&x) / length(&case.positions)
    };
    let stretch = case.model.topology().edges.iter().map(ratio).fold(0.0, f64::max);
    (statistics, far, stretch)
}

#[test]
fn cloth_stays_where_it_is_when_its_pins_are_led_into_an_obstacle() {
    for depth in [-0.005, 0.005, 0.05] {
        let cpu = led_to(None::<TwinEngine>, depth);
        let twins = led_to(Some(TwinEngine::new()), depth);
        let kernels = led_to(Some(device()), depth);
        for (what, (report, far, stretch)) in [("CPU", cpu), ("twins", twins), ("kernels", kernels)] {
            println!(
                "{what}, {depth} m below: {} steps, {far:.4} m left, stretch {stretch:.4}",
                report.steps
            );
            // Nothing asks for more than to stay above the pyramid, by the contact distance of a tenth of an
            // edge.
            assert!(far < depth.max(0.0) + 0.25 * EDGE, "{what}, {depth}: {far}, {report:?}");
            assert!(report.steps <= 40, "{what}, {depth}: {} steps", report.steps);
            // The device may stop at the nearest point of its grid.
            assert_eq!(report.prescribed_lag_m == 0.0, depth < 0.0, "{what}, {depth}: {report:?}");
        }
    }
}

/// Four vertices in the middle of a sheet are led down into a ball, 10 mm below its top, and stay there.
const INTO_A_BALL: &str = r#"
[simulation]
dt = 0.01
frames = 30
[solver.sleep]
enabled = false
[contact]
stretch_limit = 1.05
[[body]]
name = "sheet"
friction = 0.3
shape = { type = "sheet", size = [0.4, 0.4], edge = 0.033333 }
translate = [0.0, 0.0, 0.05]
material = { density = 0.15, stretch_stiffness = 261.0, bend_stiffness = 2.34e-6 }
[[pin]]
box = { min = [-0.0033, -0.0033, -1.0], max = [0.0366, 0.0366, 1.0] }
motion = { keyframes = [{ time = 0.0 }, { time = 0.09, translate = [0.0, 0.0, -0.06] }] }
[[obstacle]]
name = "ball"
shape = { type = "ball", radius = 0.1, edge = 0.02 }
translate = [0.0, 0.0, -0.1]
"#;

/// The largest stretch of a time step, the number of two-way steps, and the largest kinetic energy [J].
fn into_a_ball(backend: Option<Box<dyn CollisionBackend>>, time_steps: usize) -> (f64, usize, f64) {
    let scene = Scene::from_toml(INTO_A_BALL, std::path::Path::new(".")).expect("a scene");
    let mut simulator = Simulator::new(&scene).expect("a simulator");
    if let Some(backend) = backend {
        simulator.set_backend(backend).expect("settings that the kernels have");
    }
    let (mut stretch, mut steps, mut energy) = (0.0f64, 0, 0.0f64);
    for _ in 0..time_steps {
        let statistics = simulator.step().expect("a step");
        stretch = stretch.max(statistics.max_stretch);
        steps += statistics.two_way_steps;
        energy = energy.max(statistics.energy.kinetic);
    }
    (stretch, steps, energy)
}

#[test]
fn pins_led_into_a_ball_stretch_cloth_no_more_than_on_the_cpu() {
    let twins: Box<dyn CollisionBackend> = Box::new(Device::new("twins".to_owned(), TwinEngine::new()));
    let kernels: Box<dyn CollisionBackend> = Box::new(Device::new("kernels".to_owned(), device()));
    // The pins would be inside of the ball after eight time steps. A driver in software is slow.
    for (what, backend, time_steps) in [("twins", twins, 30), ("kernels", kernels, 11)] {
        let cpu = into_a_ball(None, time_steps);
        let found = into_a_ball(Some(backend), time_steps);
        println!("{what}: stretch, two-way steps and kinetic energy [J] {found:?}, on the CPU {cpu:?}");
        assert!(found.0 < cpu.0 + 0.03, "{what}: {found:?}, on the CPU {cpu:?}");
    }
}
