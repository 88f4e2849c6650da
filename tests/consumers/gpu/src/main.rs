//! A triangle is asked to go far below another one; step by step it comes near, pushes it, and never passes
//! through.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_gpu::geometry::{CollisionModel, Point, Topology};
use bowknot_gpu::{Call, Collision, Constraints, Lengths, Settings, TwinEngine};

fn main() -> Result<(), Box<dyn std::error::Error>> {
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
        TwinEngine::new(),
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
        let z: Vec<f64> = collision.positions()?.iter().map(|x| x.z).collect();
        let gap = z[..3].iter().fold(f64::INFINITY, |low, z| low.min(*z))
            - z[3..].iter().fold(f64::MIN, |high, z| high.max(*z));
        println!("step {step:2}: gap {gap:.3e} m, moved {:.3e} m", report.largest_move);
        assert!(gap > 1e-3);
    }
    Ok(())
}

#[test]
fn runs() {
    main().unwrap_or_else(|error| panic!("{error}"));
}
