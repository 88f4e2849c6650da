//! A sheet is asked to go 10 km below another one; step by step it comes near, and never passes through.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_stepper::geometry::{Point, Topology, Vector};
use bowknot_stepper::proximity::CollisionModel;
use bowknot_stepper::{Forward, ForwardOptions};
use std::error::Error;

/// Vertices along a side of a sheet.
const SIDE: u32 = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let count = SIDE * SIDE;
    let sheet = |height: f64| (0..count).map(move |v| [v % SIDE, v / SIDE].map(f64::from)).map(at(height));
    let start: Vec<Point> = sheet(0.0).chain(sheet(0.7)).collect();
    let (lower, upper) = start.split_at(count as usize);
    let target: Vec<Point> =
        lower.iter().copied().chain(upper.iter().map(|x| x - 1e4 * Vector::z())).collect();
    let squares = (0..count).filter(|v| v % SIDE < SIDE - 1 && v / SIDE < SIDE - 1);
    let lower: Vec<[u32; 3]> =
        squares.flat_map(|v| [[v, v + 1, v + SIDE], [v + 1, v + SIDE + 1, v + SIDE]]).collect();
    let upper = lower.iter().map(|triangle| triangle.map(|v| v + count));
    let topology = Topology::builder(start.len()).triangles(lower.iter().copied().chain(upper)).build()?;

    let radii = vec![0.3; start.len()];
    let options = ForwardOptions { min_separation: 1e-6, ..ForwardOptions::default() };
    let mut forward = Forward::new(CollisionModel::single_body(topology), start, &radii, options)?;
    for step in 0..12 {
        let report = forward.advance(&target)?;
        let contacts = forward.contacts();
        let gap = contacts.separations.iter().map(|s| s.width).fold(f64::INFINITY, f64::min);
        println!(
            "step {step:2}: gap {gap:.3e} m of {} pairs, moved {:.3e} m",
            contacts.pairs.len(),
            report.largest_move
        );
        assert!(gap >= 1e-6);
        if report.search_due {
            forward.search(&radii)?;
        }
    }
    let height = |v: u32| forward.positions()[v as usize].z;
    assert!((0..count).all(|v| height(v) < height(v + count)), "the sheets are in order");
    assert!((0..count).any(|v| height(v + count) - height(v) < 2e-6), "and as near as they may");
    Ok(())
}

/// The vertices of a sheet, half of an edge apart from those of a sheet at height 0.
fn at(height: f64) -> impl Fn([f64; 2]) -> Point {
    move |[x, y]| Point::new(x + 0.3 * height, y + 0.4 * height, height)
}

#[test]
fn runs() {
    main().unwrap();
}
