//! Simulations driven by code: pins, obstacles, forces and bodies between time steps, contact forces, and
//! that checkpoints hold all of it.

use bowknot::check::{Judge, PathOptions, StateOptions};
use bowknot::geometry::nalgebra::{Isometry3, Translation3, UnitQuaternion};
use bowknot::geometry::{Point, Vector};
use bowknot::scene::{BodySpec, Keyframe, Material, Motion, ObstacleSpec};
use bowknot::shapes::{HalfSpaceShape, MeshArrays, Shape};
use bowknot::simulator::{AcceptedStep, Checkpoint, DriveError, RestoreError, SimulationError};
use bowknot::{Scene, SimulationObserver, Simulator, World};
use std::ops::ControlFlow;

const BLOCK_AND_SHEET: &str = r#"
[simulation]
dt = 0.01

[contact]
delta = 0.004

[[body]]
name = "sheet"
shape = { type = "sheet", size = [0.2, 0.2], edge = 0.04 }
translate = [0, 0, 0.2]

[[body]]
name = "block"
kind = "solid"
shape = { type = "block", size = [0.06, 0.06, 0.06], edge = 0.03 }
elements = "linear"
friction = 0.5
translate = [0, 0, 0.035]

[[obstacle]]
name = "ground"
shape = "half-space"
friction = 0.5

[[obstacle]]
name = "ball"
shape = { type = "ball", radius = 0.05, edge = 0.025 }
translate = [0.3, 0, 0.2]

[[pin]]
body = "sheet"
side = "x-min"
"#;

fn scene() -> Scene {
    super::scene(BLOCK_AND_SHEET)
}

fn simulator() -> Simulator {
    Simulator::new(&scene()).expect("a simulator")
}

fn run(simulator: &mut Simulator, steps: usize) {
    (0..steps).for_each(|_| drop(simulator.step().unwrap_or_else(|error| panic!("{error}"))));
}

fn bits(simulator: &Simulator) -> Vec<[u64; 6]> {
    let state = simulator.positions().iter().zip(simulator.velocities());
    state.map(|(x, v)| [x.x, x.y, x.z, v.x, v.y, v.z].map(f64::to_bits)).collect()
}

fn of(simulator: &Simulator, name: &str) -> Vec<Point> {
    let body = &simulator.world().bodies[simulator.world().index_of(name).expect("a body")];
    body.all_vertices().map(|v| simulator.positions()[v as usize]).collect()
}

fn center(points: &[Point]) -> Vector {
    points.iter().map(|p| p.coords).sum::<Vector>() / points.len() as f64
}

fn shift(z: f64) -> Isometry3<f64> {
    Translation3::new(0.0, 0.0, z).into()
}

/// Whether the state is free of intersections.
fn is_clear(simulator: &Simulator) -> bool {
    let count = simulator.world().collision_vertices();
    let report = simulator.judge().check_state(&simulator.positions()[..count], &Default::default());
    report.expect("a judgment").is_clear()
}

/// Changes all that can be changed without setting the simulation up anew.
fn change_much(simulator: &mut Simulator) {
    simulator.add_pin("hand", "sheet", &[35, 34]).expect("free vertices");
    let up = |x: &Point| x + Vector::new(0.0, 0.0, 0.01);
    let targets: Vec<Point> = [35, 34].map(|v| up(&simulator.positions()[v])).to_vec();
    simulator.set_pin_targets("hand", &targets).expect("two targets");
    simulator.set_pin_pose("pin[0] of sheet", &shift(0.005)).expect("a pin");
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.05, 0.0);
    let pose = Isometry3::from_parts(Translation3::new(-0.02, 0.0, 0.0), turn);
    simulator.set_obstacle_pose("ball", &pose).expect("an obstacle");
    simulator.set_gravity(Vector::new(0.5, 0.0, -9.0)).expect("finite");
    let mut forces = vec![Vector::zeros(); simulator.positions().len()];
    forces[10] = Vector::new(0.0, 0.01, 0.0);
    simulator.set_external_forces(&forces).expect("one per vertex");
    simulator.set_velocities("block", &vec![Vector::new(0.0, 0.0, 0.2); 27]).expect("one per vertex");
}

/// Bindings move simulators between threads.
#[test]
fn a_simulator_may_go_to_another_thread() {
    let mut simulator = simulator();
    std::thread::spawn(move || simulator.step().map(|statistics| statistics.step))
        .join()
        .expect("no panic")
        .expect("a step");
}

#[test]
fn without_changes_a_world_of_its_own_and_steps_by_code_are_the_batch_run() {
    let mut batch = simulator();
    run(&mut batch, 8);
    let world = World::new(&scene()).expect("a world");
    let mut own = Simulator::from_world(world, &scene()).expect("a simulator");
    for _ in 0..8 {
        let _ = (own.contacts(), own.checkpoint(), own.scene().name().len());
        run(&mut own, 1);
    }
    assert_eq!(bits(&own), bits(&batch));
    assert_eq!(own.checkpoint().driven, Default::default());

    // What code sets to what it was changes nothing.
    let mut set = simulator();
    set.set_gravity(Vector::new(0.0, 0.0, -9.81)).expect("finite");
    set.set_material("block", Material::of(bowknot::scene::BodyKind::Solid)).expect("that of the scene");
    run(&mut set, 8);
    assert_eq!(bits(&set), bits(&batch));

    let mut world = World::new(&scene()).expect("a world");
    world.velocities.pop();
    let error = Simulator::from_world(world, &scene()).expect_err("too few").to_string();
    assert!(error.contains("velocities"), "{error}");
}

#[test]
fn pins_are_added_led_and_removed() {
    let mut simulator = simulator();
    simulator.add_pin("hand", "sheet", &[35, 29]).expect("free vertices");
    let grip = [35, 29].map(|v| simulator.positions()[v]);
    for step in 1..=10 {
        simulator.set_pin_pose("hand", &shift(0.004 * f64::from(step))).expect("a pin");
        run(&mut simulator, 1);
        for (v, x) in [35, 29].into_iter().zip(&grip) {
            let target = x + Vector::new(0.0, 0.0, 0.004 * f64::from(step));
            assert!((simulator.positions()[v] - target).norm() < 1e-12);
        }
    }
    // Two pins hold the sheet: what they exert is its weight and what accelerates it.
    let pins = ["hand", "pin[0] of sheet"];
    run(&mut simulator, 150);
    let about = Point::origin();
    let held: Vector = pins.iter().map(|pin| simulator.pin_wrench(pin, &about).expect("a pin").force).sum();
    let model = simulator.dynamics_model();
    let mass: f64 = model.masses()[..36].iter().sum();
    assert!((held.z - 9.81 * mass).abs() < 0.02 * 9.81 * mass, "{held} for {}", 9.81 * mass);
    let before = simulator.positions()[35].z;
    simulator.remove_pin("hand").expect("a pin");
    run(&mut simulator, 10);
    assert!(simulator.positions()[35].z < before - 0.02, "it falls, even if it slept");
    simulator.remove_pin("pin[0] of sheet").expect("a pin of the scene");
    simulator.add_pin("again", "sheet", &[0]).expect("free now");
    assert!(is_clear(&simulator));
}

#[test]
fn obstacles_go_where_code_leads_them_and_push_what_is_in_the_way() {
    let mut simulator = simulator();
    // The sheet hangs down; the ball goes to where it hangs.
    for step in 1..=40 {
        let way = Vector::new(-0.36, 0.0, -0.05) * (f64::from(step) / 40.0);
        let pose = Translation3::from(way).into();
        simulator.set_obstacle_pose("ball", &pose).expect("an obstacle");
        run(&mut simulator, 1);
        assert!(is_clear(&simulator));
    }
    let ball = of(&simulator, "ball");
    assert!((center(&ball) - Vector::new(-0.06, 0.0, 0.15)).norm() < 1e-3, "{}", center(&ball));
    // What swung away leans against it in the end.
    run(&mut simulator, 100);
    let load = simulator.contact_wrench("ball", &Point::from(center(&ball))).expect("an obstacle");
    assert!(load.force.norm() > 1e-4, "the sheet presses: {load:?}");
    // Its vertices one by one, in the order of its mesh.
    let wider: Vec<Point> = ball.iter().map(|x| x + (x - Point::from(center(&ball))) * 0.1).collect();
    simulator.set_obstacle_targets("ball", &wider).expect("one per vertex");
    run(&mut simulator, 2);
    let grown = of(&simulator, "ball");
    assert!(grown.iter().zip(&wider).all(|(x, y)| (x - y).norm() < 1e-3));
    // Keyframes over the time of the simulation, from the place in the scene.
    let keyframe = Keyframe { time: 0.4, translate: Vector::new(0.0, 0.0, 0.3), angle: 0.0 };
    let motion = Motion { keyframes: vec![keyframe], ..Motion::default() };
    simulator.set_obstacle_motion("ball", motion).expect("a motion");
    run(&mut simulator, 10);
    let ball = center(&of(&simulator, "ball"));
    assert!((ball - Vector::new(0.3, 0.0, 0.5)).norm() < 1e-9, "{ball}");
}

#[test]
fn a_teleport_is_judged() {
    let mut simulator = simulator();
    run(&mut simulator, 3);
    let before = bits(&simulator);
    let world = simulator.world().clone();
    let block = world.index_of("block").expect("a body");
    let order = world.bodies[block].mesh_order();
    let moved = |by: Vector| -> Vec<Point> {
        order.iter().map(|v| world.positions[v.expect("in use") as usize] + by).collect()
    };
    let into_ball = moved(Vector::new(0.3, 0.0, 0.165));
    let error = simulator.place("block", &into_ball).expect_err("it would cut the ball");
    let SimulationError::Drive(DriveError::Intersects { what, lines, count }) = &error else {
        panic!("{error}")
    };
    assert!(what == "block" && *count > 0 && lines[0].contains("ball"), "{error}");
    assert_eq!(bits(&simulator), before);
    run(&mut simulator, 1);

    let aside = moved(Vector::new(0.0, 0.5, 0.1));
    simulator.place("block", &aside).expect("a clear place");
    assert_eq!(of(&simulator, "block").len(), aside.len());
    assert!((center(&of(&simulator, "block")) - center(&aside)).norm() < 1e-12);
    simulator
        .place("ball", &of(&simulator, "ball").iter().map(|x| x + Vector::z()).collect::<Vec<_>>())
        .expect("a clear place");
    run(&mut simulator, 3);
    assert!((center(&of(&simulator, "ball")).z - 1.2).abs() < 1e-9, "it stays there");
}

#[test]
fn faulty_changes_name_what_they_are_about_and_change_nothing() {
    let mut simulator = simulator();
    let message = |error: DriveError| error.to_string();
    let nan = [Point::new(0.0, f64::NAN, 0.0)];
    let errors = [
        message(simulator.add_pin("a", "shet", &[0]).expect_err("no such body")),
        message(simulator.add_pin("a", "sheet", &[36]).expect_err("too large")),
        message(simulator.add_pin("a", "sheet", &[0]).expect_err("held")),
        message(simulator.add_pin("a", "sheet", &[35, 35]).expect_err("twice")),
        message(simulator.add_pin("a", "sheet", &[]).expect_err("none")),
        message(simulator.add_pin("pin[0] of sheet", "sheet", &[35]).expect_err("taken")),
        message(simulator.add_pin("a", "ball", &[0]).expect_err("an obstacle")),
        message(simulator.set_pin_targets("b", &[]).expect_err("no such pin")),
        message(simulator.set_pin_targets("pin[0] of sheet", &nan).expect_err("one for six")),
        message(simulator.set_obstacle_pose("ground", &shift(0.1)).expect_err("a half-space")),
        message(simulator.set_obstacle_targets("ball", &nan).expect_err("one")),
        message(simulator.set_obstacle_pose("ball", &shift(f64::INFINITY)).expect_err("infinite")),
        message(simulator.set_velocities("block", &[]).expect_err("none")),
        message(simulator.set_velocities("ball", &[]).expect_err("an obstacle")),
        message(simulator.set_gravity(Vector::new(0.0, 0.0, f64::NAN)).expect_err("NaN")),
    ];
    let named = ["shet", "36", "pin[0] of sheet", "by a", "no vertex", "already", "sheet, block", "\"b\""];
    let named = named.into_iter().chain(["6 vertices", "ball", "ball", "finite", "block", "ball", "gravity"]);
    for (error, name) in errors.iter().zip(named) {
        assert!(error.contains(name), "{name} in: {error}");
    }
    let too_many = Motion { spin: f64::NAN, ..Motion::default() };
    simulator.set_obstacle_motion("ball", too_many).expect_err("NaN");
    simulator.place("block", &[]).expect_err("none");
    simulator.set_friction("ball", -1.0).expect_err("negative");
    let cloth = Material::default();
    simulator.set_material("block", cloth).expect_err("a material of cloth");
    simulator.remove("nothing").expect_err("no such body");
    let taken = BodySpec::from_arrays("ball", MeshArrays::points(vec![Point::origin()]));
    simulator.add_body(taken).expect_err("a name that is taken");
    assert_eq!(simulator.checkpoint().driven, Default::default());
    let mut other = self::simulator();
    run(&mut simulator, 3);
    run(&mut other, 3);
    assert_eq!(bits(&simulator), bits(&other));
}

/// The block once more, given by arrays, at a place.
fn another(name: &str, at: Vector) -> BodySpec {
    let mesh =
        Shape::Block(bowknot::shapes::Block { size: [0.06; 3], edge: 0.03 }).elements().expect("a mesh");
    let spec = BodySpec::from_arrays(name, MeshArrays::volume(mesh.positions, mesh.tets));
    BodySpec { translate: at, friction: 0.5, ..spec }
}

#[test]
fn bodies_come_and_go() {
    let mut simulator = simulator();
    run(&mut simulator, 5);
    let sheet = of(&simulator, "sheet");
    let inside = another("second", Vector::new(0.01, 0.0, 0.035));
    let error = simulator.add_body(inside).expect_err("it would cut the first");
    assert!(matches!(error, SimulationError::Drive(DriveError::Intersects { .. })), "{error}");
    assert_eq!(simulator.world().bodies.len(), 3);

    simulator.add_body(another("second", Vector::new(0.0, 0.1, 0.035))).expect("a clear place");
    assert_eq!(of(&simulator, "sheet"), sheet, "the others stay where they are");
    assert_eq!(simulator.step_index(), 5);
    simulator.set_pin_pose("pin[0] of sheet", &shift(0.01)).expect("pins are kept");
    let mut alone = self::simulator();
    run(&mut alone, 5);
    alone.set_pin_pose("pin[0] of sheet", &shift(0.01)).expect("a pin");
    run(&mut simulator, 5);
    let tolerance: f64 = (0..5).map(|_| alone.step().expect("a step").tolerance_m).sum();
    let distances = of(&simulator, "sheet").into_iter().zip(of(&alone, "sheet")).map(|(a, b)| (a - b).norm());
    let farthest = distances.fold(0.0, f64::max);
    assert!(farthest < tolerance, "to the tolerance of the time steps: {farthest} m, {tolerance} m");

    let wall = ObstacleSpec {
        name: "wall".to_owned(),
        shape: Some(Shape::HalfSpace(HalfSpaceShape { normal: Vector::y() })),
        translate: Vector::new(0.0, -0.2, 0.0),
        ..ObstacleSpec::default()
    };
    simulator.add_obstacle(wall).expect("a clear place");
    let mut forces = vec![Vector::zeros(); simulator.positions().len()];
    let second = simulator.world().bodies[simulator.world().index_of("second").expect("a body")].clone();
    forces[second.vertices.start as usize] = Vector::new(0.0, 0.0, 0.5);
    simulator.set_external_forces(&forces).expect("one per vertex");
    simulator.remove("block").expect("a body");
    simulator.remove("ball").expect("an obstacle");
    let second = simulator.world().bodies[simulator.world().index_of("second").expect("a body")].clone();
    let forces = simulator.checkpoint().driven.external_forces;
    assert_eq!(forces[second.vertices.start as usize], Vector::new(0.0, 0.0, 0.5));
    assert_eq!(forces.len(), simulator.positions().len());
    simulator.set_friction("ground", 0.3).expect("a half-space");
    let names: Vec<_> = simulator.world().names().cloned().collect();
    assert_eq!(names, ["sheet", "second", "ground", "wall"]);
    run(&mut simulator, 5);
    assert!(is_clear(&simulator));

    // The state of the changed scene, in a simulator of the scene that it began with.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("state.npz");
    let middle = simulator.checkpoint();
    middle.write(&file).expect("write");
    assert_eq!(Checkpoint::read(&file).expect("read"), middle);
    run(&mut simulator, 3);
    let mut resumed = self::simulator();
    resumed.restore_checked(&middle).expect("a checkpoint");
    run(&mut resumed, 3);
    assert_eq!(bits(&resumed), bits(&simulator));
    // And back to the start.
    resumed.restore(&self::simulator().checkpoint()).expect("the start");
    let mut fresh = self::simulator();
    run(&mut resumed, 5);
    run(&mut fresh, 5);
    assert_eq!(bits(&resumed), bits(&fresh));
}

/// What has the name of something that was removed is not that.
#[test]
fn what_is_removed_and_added_anew_is_where_its_spec_says() {
    let text = format!("{BLOCK_AND_SHEET}[[pin]]\nbody = \"sheet\"\nvertices = [35]\nfollow = \"ball\"\n");
    let mut simulator = Simulator::new(&super::scene(&text)).expect("a simulator");
    let error = simulator.remove("ball").expect_err("a pin follows it").to_string();
    assert!(error.contains("pin[1] of sheet"), "{error}");
    simulator.remove_pin("pin[1] of sheet").expect("a pin");
    simulator.remove("ball").expect("an obstacle");
    let ball = scene().obstacles[1].clone();
    simulator.add_obstacle(ObstacleSpec { translate: Vector::new(0.5, 0.0, 0.0), ..ball }).expect("clear");
    let at = Vector::new(0.5, 0.0, 0.0);
    assert!((center(&of(&simulator, "ball")) - at).norm() < 1e-9);
    let mut resumed = Simulator::new(&super::scene(&text)).expect("a simulator");
    resumed.restore(&simulator.checkpoint()).expect("a checkpoint");
    run(&mut simulator, 2);
    run(&mut resumed, 2);
    assert!((center(&of(&resumed, "ball")) - at).norm() < 1e-9);
    assert_eq!(bits(&resumed), bits(&simulator));
}

#[test]
fn a_stiffer_material_bends_less() {
    let mut lowest = [1e3, 1e6].map(|young_modulus| {
        let mut simulator = simulator();
        let Material::Solid(solid) = Material::of(bowknot::scene::BodyKind::Solid) else { panic!("a solid") };
        let soft = bowknot::dynamics::SolidMaterial { young_modulus, ..solid };
        simulator.set_material("block", Material::Solid(soft)).expect("a material");
        run(&mut simulator, 40);
        let block = of(&simulator, "block");
        block.iter().map(|x| x.z).fold(f64::MIN, f64::max)
    });
    lowest[1] -= 0.001;
    assert!(lowest[0] < lowest[1], "{lowest:?}");
}

#[test]
fn checkpoints_hold_what_code_has_changed() {
    let mut whole = simulator();
    run(&mut whole, 3);
    change_much(&mut whole);
    let untouched = whole.checkpoint();
    run(&mut whole, 2);
    let middle = whole.checkpoint();
    run(&mut whole, 4);

    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("state.npz");
    for checkpoint in [&untouched, &middle] {
        checkpoint.write(&file).expect("write");
        let read = Checkpoint::read(&file).expect("read");
        assert_eq!(&read, checkpoint);
        let text = toml::to_string(checkpoint).expect("text");
        assert_eq!(&toml::from_str::<Checkpoint>(&text).expect("a checkpoint"), checkpoint);
        let text = serde_json::to_string(checkpoint).expect("text");
        let read_json: Checkpoint = serde_json::from_str(&text).expect("a checkpoint");
        assert_eq!(read_json.driven.pins, checkpoint.driven.pins);
        let mut resumed = simulator();
        resumed.restore(&read).expect("a checkpoint");
        run(&mut resumed, whole.step_index() - checkpoint.step);
        assert_eq!(bits(&resumed), bits(&whole));
    }
    // Roll back in place: what was changed since is forgotten.
    whole.set_gravity(Vector::zeros()).expect("finite");
    whole.remove_pin("hand").expect("a pin");
    let end = {
        let mut resumed = simulator();
        resumed.restore(&middle).expect("a checkpoint");
        run(&mut resumed, 4);
        bits(&resumed)
    };
    whole.restore(&middle).expect("a checkpoint");
    run(&mut whole, 4);
    assert_eq!(bits(&whole), end);
}

#[test]
fn a_restored_state_is_judged_if_asked() {
    let mut simulator = simulator();
    run(&mut simulator, 2);
    let mut bad = simulator.checkpoint();
    let world = simulator.world().clone();
    let sheet = world.bodies[0].vertices.clone();
    sheet.for_each(|v| bad.positions[v as usize].z -= 0.165);
    let before = bits(&simulator);
    let error = simulator.restore_checked(&bad).expect_err("the sheet cuts the block");
    let RestoreError::Intersects { lines, count } = &error else { panic!("{error}") };
    assert!(*count > 0 && lines[0].contains("block") && lines[0].contains("sheet"), "{error}");
    assert_eq!(bits(&simulator), before);

    // Changes of a damaged file are refused, not a panic.
    let damage: [fn(&mut Checkpoint); 8] = [
        |c| c.positions.truncate(3),
        |c| c.driven.pushed = vec![true],
        |c| c.driven.external_forces = vec![Vector::zeros()],
        |c| c.driven.gravity = Some(Vector::new(f64::NAN, 0.0, 0.0)),
        |c| c.driven.pins.iter_mut().flatten().for_each(|pin| pin.vertices[0] = 1 << 20),
        |c| c.driven.pins.iter_mut().flatten().for_each(|pin| pin.follow = Some(0)),
        |c| c.driven.obstacles.clear_and_misname(),
        |c| c.driven.scene = Some(Box::default()),
    ];
    change_much(&mut simulator);
    let sound = simulator.checkpoint();
    for (index, damage) in damage.into_iter().enumerate() {
        let mut bad = sound.clone();
        damage(&mut bad);
        let error = simulator.restore(&bad).expect_err(&format!("damage {index}"));
        assert!(!error.to_string().is_empty());
    }
    assert_eq!(simulator.checkpoint(), sound);
    fn question_mark(simulator: &mut Simulator, checkpoint: &Checkpoint) -> Result<(), SimulationError> {
        simulator.restore(checkpoint)?;
        simulator.step()?;
        Ok(())
    }
    question_mark(&mut simulator, &sound).expect("sound");
}

/// Judges each accepted state and path.
struct Judged {
    judge: Judge,
    states: usize,
}

impl SimulationObserver for Judged {
    fn accepted(&mut self, accepted: &AcceptedStep<'_>) -> ControlFlow<()> {
        let x = accepted.state.positions;
        let path = self.judge.check_path(accepted.state.previous, x, &PathOptions::default());
        let state = self.judge.check_state(x, &StateOptions { distance: false, ..StateOptions::default() });
        assert!(path.expect("judged").is_clear() && state.expect("judged").is_clear());
        self.states += 1;
        ControlFlow::Continue(())
    }
}

#[test]
fn whatever_code_asks_for_nothing_intersects() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut simulator = simulator();
    let mut judged = Judged { judge: simulator.judge(), states: 0 };
    for step in 0..60 {
        let mut vector = |size: f64| Vector::from([0; 3].map(|_| size * (2.0 * random.f64() - 1.0)));
        // Far jumps, through whatever is there and into the ground.
        let turn = UnitQuaternion::from_scaled_axis(vector(1.0));
        let pose = Isometry3::from_parts(Translation3::from(vector(0.3) - Vector::x() * 0.2), turn);
        simulator.set_obstacle_pose("ball", &pose).expect("finite");
        if step % 5 == 0 {
            let throw = vector(3.0);
            simulator.set_velocities("block", &vec![throw; 27]).expect("one per vertex");
            simulator.set_gravity(vector(20.0)).expect("finite");
        }
        match step % 12 {
            3 => simulator.add_pin("hand", "block", &[0, 13, 26]).expect("free vertices"),
            9 => simulator.remove_pin("hand").expect("a pin"),
            _ => {}
        }
        if (3..9).contains(&(step % 12)) {
            let targets = [0; 3].map(|_| Point::from(vector(0.2)));
            simulator.set_pin_targets("hand", &targets).expect("three targets");
        }
        let way = Translation3::from(vector(0.1)).into();
        simulator.set_pin_pose("pin[0] of sheet", &way).expect("a pin");
        simulator.step_observed(&mut judged).unwrap_or_else(|error| panic!("{error}"));
        assert!(is_clear(&simulator), "time step {step}");
    }
    assert!(judged.states > 100, "{} states", judged.states);
}

/// A name that no obstacle has.
trait Misname {
    fn clear_and_misname(&mut self);
}

impl<V> Misname for std::collections::BTreeMap<String, V> {
    fn clear_and_misname(&mut self) {
        let drives: Vec<V> = std::mem::take(self).into_values().collect();
        self.extend(drives.into_iter().map(|drive| ("nothing".to_owned(), drive)));
    }
}

#[test]
fn contacts_carry_the_weight_of_what_lies_on_them() {
    let mut simulator = simulator();
    run(&mut simulator, 120);
    let world = simulator.world().clone();
    let block = &world.bodies[world.index_of("block").expect("a body")];
    let masses = simulator.dynamics_model().masses();
    let weight = 9.81 * block.all_vertices().map(|v| masses[v as usize]).sum::<f64>();
    assert_eq!(9.81 * simulator.mass_of("block").expect("a body"), weight);
    assert_eq!(simulator.mass_of("ground").expect("a half-space"), 0.0);
    assert!(simulator.mass_of("blok").is_err());
    let ground = simulator.contact_wrench("ground", &Point::origin()).expect("a half-space");
    assert!((ground.force.z + weight).abs() < 0.01 * weight, "{ground:?} for {weight} N");
    assert!(ground.torque.norm() < 0.01 * weight * 0.06, "{ground:?}");
    let on_block = simulator.contact_wrench("block", &Point::origin()).expect("a body");
    assert!((on_block.force + ground.force).norm() < 1e-12);
    let by =
        |other: &str| simulator.contact_wrench_by("block", other, &Point::origin()).expect("names").force;
    assert!((by("ground") - on_block.force).norm() < 1e-12 && by("block").norm() < 1e-12);
    assert!(simulator.contact_wrench_by("block", "grund", &Point::origin()).is_err());
    let contacts = simulator.contacts();
    assert!(!contacts.is_empty());
    for contact in &contacts {
        let mean = |sign: f64| -> Vector {
            let on_side = (0..4).filter(|k| contact.weights[*k] * sign > 0.0);
            on_side
                .map(|k| simulator.positions()[contact.vertices[k] as usize].coords * contact.weights[k])
                .sum()
        };
        assert!((mean(1.0) - contact.points[0].coords).norm() < 1e-12);
        assert!((0.0..0.005).contains(&contact.gap) && contact.normal_force() >= 0.0, "{contact:?}");
        assert!(contact.friction().norm() <= 0.51 * contact.normal_force() + 1e-9, "{contact:?}");
    }
    // After a restart they are the same.
    let mut resumed = self::simulator();
    resumed.restore(&simulator.checkpoint()).expect("a checkpoint");
    assert_eq!(resumed.contacts(), contacts);
}

#[test]
fn what_code_changes_wakes_bodies_asleep() {
    let mut asleep = simulator();
    run(&mut asleep, 250);
    let block = asleep.world().index_of("block").expect("a body");
    assert!(asleep.asleep()[block], "the block should sleep by now");
    let state = asleep.checkpoint();
    let changes: [fn(&mut Simulator); 4] = [
        |s| s.set_velocities("block", &vec![Vector::new(0.0, 0.0, 0.5); 27]).expect("one per vertex"),
        |s| s.set_gravity(Vector::new(0.0, 0.0, 3.0)).expect("finite"),
        |s| s.set_material("block", Material::of(bowknot::scene::BodyKind::Solid)).expect("a material"),
        |s| s.add_pin("tip", "block", &[26]).expect("a vertex"),
    ];
    for change in changes {
        asleep.restore(&state).expect("a checkpoint");
        assert!(asleep.asleep()[block]);
        change(&mut asleep);
        let changed = asleep.checkpoint();
        run(&mut asleep, 1);
        assert!(!asleep.asleep()[block]);
        run(&mut asleep, 2);
        let mut resumed = simulator();
        resumed.restore(&changed).expect("a checkpoint");
        run(&mut resumed, 3);
        assert_eq!(bits(&resumed), bits(&asleep));
    }
}
