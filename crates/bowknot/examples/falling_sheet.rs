//! The smallest simulation: a sheet falls onto a ball, and nothing ever intersects.
//!
//! `cargo run --release -p bowknot --example falling_sheet`

#![allow(clippy::print_stdout)]

use bowknot::{Scene, Simulator};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::builtin("drape", 0.4)?;
    let mut simulator = Simulator::new(&scene)?;
    println!("{} vertices", simulator.world().deformable_vertices);
    for _ in 0..30 {
        let s = simulator.step()?;
        println!(
            "t = {:.2} s: {:3} two-way steps, {:5} pairs, smallest gap {:.2} mm, stretch {:.3}, {:.3} s",
            s.time,
            s.two_way_steps,
            s.pairs,
            1e3 * s.min_gap_m.unwrap_or(f64::NAN),
            s.max_stretch,
            s.seconds.total
        );
    }
    // Exact predicates, and no code shared with the solver, say whether the promise was kept.
    let report = simulator.judge().check_state(simulator.positions(), &Default::default())?;
    assert!(report.is_clear());
    Ok(())
}
