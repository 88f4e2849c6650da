//! Two fingers of a robot close on a soft block, lift it and hold it. What the contacts exert on the fingers
//! must carry the block's weight.
//!
//! ```text
//! cargo run --release -p bowknot --example fingers
//! ```

#![allow(clippy::print_stdout)]

use bowknot::geometry::nalgebra::Translation3;
use bowknot::geometry::{Point, Vector};
use bowknot::scene::{BodyKind, BodySpec, Material, ObstacleSpec, Scene};
use bowknot::shapes::{Block, Cuboid, HalfSpaceShape, Shape};
use bowknot::{SimulationError, Simulator};

/// Error of the force balance that is accepted [1]: a time step ends at a tolerance.
const ACCEPTED: f64 = 0.01;

fn obstacle(name: &str, shape: Shape, x: f64, z: f64) -> ObstacleSpec {
    let (shape, translate) = (Some(shape), Vector::new(x, 0.0, z));
    ObstacleSpec { name: name.to_owned(), shape, translate, friction: 0.8, ..ObstacleSpec::default() }
}

/// A soft block of 4 cm on the ground, between two fingers.
fn scene() -> Scene {
    let Material::Solid(solid) = Material::of(BodyKind::Solid) else { unreachable!("that of a solid") };
    let block = BodySpec {
        name: "block".to_owned(),
        kind: BodyKind::Solid,
        shape: Some(Shape::Block(Block { size: [0.04; 3], edge: 0.01 })),
        material: Material::Solid(bowknot::dynamics::SolidMaterial { young_modulus: 1e5, ..solid }),
        translate: Vector::new(0.0, 0.0, 0.0215),
        friction: 0.8,
        ..BodySpec::default()
    };
    let finger = || Shape::Box(Cuboid { size: [0.01, 0.03, 0.03], edge: 0.01 });
    let mut scene = Scene { bodies: vec![block], ..Scene::default() };
    scene.obstacles = vec![
        obstacle("left", finger(), -0.028, 0.022),
        obstacle("right", finger(), 0.028, 0.022),
        obstacle("ground", Shape::HalfSpace(HalfSpaceShape::default()), 0.0, 0.0),
    ];
    scene
}

fn main() -> Result<(), SimulationError> {
    let mut simulator = Simulator::new(&scene())?;
    let weight = 9.81 * simulator.dynamics_model().total_mass();
    println!("weight of the block: {weight:.4} N");
    println!("  time  left: x, z          right: x, z         ground: z");
    let force = |simulator: &Simulator, name| simulator.contact_wrench(name, &Point::origin());
    let mut carried = Vector::zeros();
    for step in 0..120 {
        // Close in 0.3 s until each finger is 3 mm inside of where the block was, then lift by 3 cm in 0.4 s.
        let closed = 0.006 * f64::min(f64::from(step) / 30.0, 1.0);
        let lifted = 0.03 * (f64::from(step - 30) / 40.0).clamp(0.0, 1.0);
        simulator.set_obstacle_pose("left", &Translation3::new(closed, 0.0, lifted).into())?;
        simulator.set_obstacle_pose("right", &Translation3::new(-closed, 0.0, lifted).into())?;
        simulator.step()?;
        let [left, right, ground] =
            ["left", "right", "ground"].map(|name| force(&simulator, name).map(|wrench| wrench.force));
        let (left, right, ground) = (left?, right?, ground?);
        carried = left + right;
        if step % 10 == 9 {
            println!(
                "{:6.2}  {:8.3} {:8.4} N  {:8.3} {:8.4} N  {:8.4} N",
                simulator.time(),
                left.x,
                left.z,
                right.x,
                right.z,
                ground.z
            );
        }
    }
    let error = (carried + Vector::new(0.0, 0.0, weight)).norm() / weight;
    println!("error of the force balance while it is held: {:.2} % of the weight", 100.0 * error);
    assert!(error < ACCEPTED, "the fingers carry {carried:?}");
    Ok(())
}

#[test]
fn fingers_carry_the_weight_of_what_they_hold() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
