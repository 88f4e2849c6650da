//! A cloth in the loop of a game: its mesh comes from arrays, a hand grabs its corner, moves as the loop
//! says, grabs more of it, and lets go.
//!
//! ```text
//! cargo run --release -p bowknot --example game_loop
//! ```

#![allow(clippy::print_stdout)]

use bowknot::geometry::nalgebra::{Isometry3, Translation3, UnitQuaternion};
use bowknot::geometry::{Point, Vector};
use bowknot::scene::{BodySpec, ObstacleSpec, Scene};
use bowknot::shapes::{Ball, HalfSpaceShape, MeshArrays, Shape};
use bowknot::{SimulationError, Simulator};

/// Vertices along each side of the cloth.
const SIDE: u32 = 13;

/// A square cloth of half a meter, as a game has it: vertices and triangles.
fn cloth() -> MeshArrays {
    let step = 0.5 / f64::from(SIDE - 1);
    let vertex = |v: u32| Point::new(f64::from(v % SIDE) * step, f64::from(v / SIDE) * step, 0.5);
    let square = |q: u32| {
        let a = q / (SIDE - 1) * SIDE + q % (SIDE - 1);
        [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]]
    };
    let squares = 0..(SIDE - 1) * (SIDE - 1);
    MeshArrays::surface((0..SIDE * SIDE).map(vertex).collect(), squares.flat_map(square).collect())
}

fn scene() -> Scene {
    let ball = Shape::Ball(Ball { radius: 0.12, edge: 0.04 });
    let ball = ObstacleSpec { name: "ball".to_owned(), shape: Some(ball), ..ObstacleSpec::default() };
    let ground = Shape::HalfSpace(HalfSpaceShape::default());
    let ground = ObstacleSpec { name: "ground".to_owned(), shape: Some(ground), ..ObstacleSpec::default() };
    let mut scene = Scene { bodies: vec![BodySpec::from_arrays("cloth", cloth())], ..Scene::default() };
    scene.obstacles = vec![
        ObstacleSpec { translate: Vector::new(0.25, 0.25, 0.2), friction: 0.3, ..ball },
        ObstacleSpec { friction: 0.5, ..ground },
    ];
    scene.bodies[0].friction = 0.5;
    scene.simulation.dt = 1.0 / 60.0;
    scene
}

fn main() -> Result<(), SimulationError> {
    let mut simulator = Simulator::new(&scene())?;
    // The corner, and one vertex more to each side of it, that the hand grabs later.
    simulator.add_pin("thumb", "cloth", &[0])?;
    println!("  time  pins  lowest   hand's force  waits");
    for frame in 0..90_u32 {
        if frame == 20 {
            simulator.add_pin("finger", "cloth", &[1, SIDE])?;
        }
        if frame == 70 {
            simulator.remove_pin("thumb")?;
            simulator.remove_pin("finger")?;
        }
        // The hand goes up and across the ball; both pins are rigid parts of it.
        let raised = |frames: u32| Vector::new(0.008, 0.008, 0.003) * f64::from(frames.min(50));
        let names: Vec<String> = simulator.world().pins.iter().map(|pin| pin.name.clone()).collect();
        for name in &names {
            let since = if name == "thumb" { 0 } else { 20 };
            let way = raised(frame.min(50)) - raised(since);
            let hand = Isometry3::from_parts(Translation3::from(way), UnitQuaternion::identity());
            simulator.set_pin_pose(name, &hand)?;
        }
        let statistics = simulator.step()?;
        if frame % 10 == 9 {
            let force: Vector = names.iter().flat_map(|name| simulator.pin_forces(name)).flatten().sum();
            let lowest = simulator.positions()[..(SIDE * SIDE) as usize].iter().fold(1.0, |z, x| x.z.min(z));
            let (time, pins, waits) = (statistics.time, names.len(), statistics.waiting.len());
            println!("{time:6.2}  {pins:4}  {lowest:6.3} m  {:8.3} N  {waits:5}", force.z);
        }
    }
    Ok(())
}

#[test]
fn a_hand_lifts_the_cloth_and_lets_go() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
