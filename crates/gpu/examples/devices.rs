//! Lists the devices of this machine, and lets a triangle fall onto another one on the first of them.
#![allow(clippy::print_stdout, reason = "an example")]

use bowknot_geometry::{CollisionModel, Point, Topology};
use bowknot_gpu::{Adapter, Call, Collision, Constraints, DeviceEngine, Lengths, Settings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    Adapter::all().iter().enumerate().for_each(|(number, adapter)| println!("device {number}: {adapter}"));
    let engine = DeviceEngine::open(&Adapter::choose(None)?)?;
    let at = |z: f64| [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y, z));
    let topology = Topology::builder(6).triangles([[0, 1, 2], [3, 4, 5]]).build()?;
    let model = CollisionModel::single_body(topology);
    let start = [at(0.5), at(0.0)].concat();
    let lengths = Lengths {
        edges: &[1.0; 6],
        margins: &[0.05; 6],
        deltas: &[0.02; 6],
        half_space_deltas: &[],
        thicknesses: &[],
        half_space_thicknesses: &[],
        min_separation: 1e-3,
        edge_limits: &[],
    };
    let mut collision = Collision::new(
        engine,
        &model,
        &start,
        &start,
        &lengths,
        &Constraints::default(),
        &Settings::default(),
    )?;
    collision.begin(&Call::toward(&[at(-10.0), at(0.0)].concat()))?;
    for step in 0..12 {
        let report = collision.step()?;
        println!(
            "step {step:2}: height {:.3e} m, moved {:.3e} m",
            collision.positions()?[0].z,
            report.largest_move
        );
    }
    Ok(())
}
