//! The built-in drape at a small scale: a few steps, each judged.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot::check::StateOptions;
use bowknot::{Scene, Simulator};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::builtin("drape", 0.3)?;
    let mut simulator = Simulator::new(&scene)?;
    let start = simulator.positions().to_vec();
    for _ in 0..3 {
        simulator.step()?;
    }
    let moved = simulator.positions().iter().zip(&start).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    let report = simulator.judge().check_state(simulator.positions(), &StateOptions::default())?;
    println!("fell {:.1} mm, {} intersections", 1e3 * moved, report.intersection_count);
    assert!(moved > 0.0 && report.is_clear());
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
