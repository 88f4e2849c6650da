//! Moves the vertices of one state toward its targets by the forward step alone, for comparison with other programs
//! (`crates/bench/peers`).
//!
//! ```text
//! cargo run --release -p bowknot-bench --example peer_forward -- STATE.npz --radius 0.004 --tolerance 1e-4
//! ```
//! All vertices count as one deformable body; those that are to stay have their place as target. Prints JSON.
#![allow(clippy::print_stdout)]

use anyhow::{Context, Result, anyhow};
use bowknot::geometry::Topology;
use bowknot::proximity::CollisionModel;
use bowknot::recording::States;
use bowknot::simulator::cpu_seconds;
use bowknot::stepper::{Bound, Forward, ForwardOptions};
use clap::Parser;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Debug, Parser)]
struct Arguments {
    /// An archive with x, y, F.
    state: PathBuf,
    /// How far a vertex may go before the next search [m].
    #[arg(long)]
    radius: f64,
    /// Largest remaining distance of a vertex that has arrived [m].
    #[arg(long)]
    tolerance: f64,
    #[arg(long, default_value_t = 200)]
    max_steps: usize,
    /// The isotropic bound in place of planes.
    #[arg(long)]
    isotropic: bool,
    /// Writes the positions at the end as little-endian f64.
    #[arg(long)]
    positions: Option<PathBuf>,
}

#[derive(Debug, Serialize)]
struct Report {
    /// The sum of the vertices' distances to their targets, before each step and at the end [m].
    remaining: Vec<f64>,
    /// The largest of these distances at the end [m].
    largest_remaining: f64,
    searches: usize,
    cpu: f64,
    wall: f64,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let states = States::read(&arguments.state)?;
    let topology = Topology::builder(states.x.len())
        .triangles(states.triangles.iter().copied())
        .build()
        .map_err(|errors| anyhow!("{} faults, {}", errors.len(), errors[0]))?;
    let model = CollisionModel::single_body(topology);
    let radii = vec![arguments.radius; states.x.len()];
    let bound = if arguments.isotropic { Bound::Isotropic } else { Bound::Planes };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let start = states.x.clone();
    let (forward, report) = pool.install(|| -> Result<_> {
        let (wall, cpu) = (Instant::now(), cpu_seconds());
        let mut forward = Forward::new(model, start, &radii, ForwardOptions { bound, ..Default::default() })?;
        let distance = |forward: &Forward| -> f64 {
            forward.positions().iter().zip(&states.y).map(|(x, y)| (y - x).norm()).sum()
        };
        let mut report = Report {
            remaining: vec![distance(&forward)],
            largest_remaining: f64::INFINITY,
            searches: 1,
            cpu: 0.0,
            wall: 0.0,
        };
        while report.remaining.len() <= arguments.max_steps && report.largest_remaining > arguments.tolerance
        {
            let step = forward.advance(&states.y)?;
            report.remaining.push(distance(&forward));
            report.largest_remaining = step.remaining;
            if step.search_due && step.remaining > arguments.tolerance {
                forward.search(&radii)?;
                report.searches += 1;
            }
        }
        (report.cpu, report.wall) = (cpu_seconds() - cpu, wall.elapsed().as_secs_f64());
        Ok((forward, report))
    })?;
    if let Some(path) = &arguments.positions {
        let numbers = forward.positions().iter().flat_map(|x| [x.x, x.y, x.z]);
        let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    }
    println!("{}", serde_json::to_string(&report)?);
    Ok(())
}
