//! Times the proximity search on one state, for comparison with other programs (`crates/bench/peers`).
//!
//! ```text
//! cargo run --release -p bowknot-bench --example peer_search -- STATE.npz --radius 0.002 --threads 2
//! ```
//! All vertices count as one deformable body, so that a program without obstacles and groups searches for the same
//! pairs. Prints JSON.
#![allow(clippy::print_stdout)]

use anyhow::{Context, Result, anyhow};
use bowknot::geometry::{PairKind, Separation, Topology};
use bowknot::proximity::{CollisionModel, PairList, ProximitySearch};
use bowknot::recording::States;
use bowknot::simulator::cpu_seconds;
use clap::Parser;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[derive(Debug, Parser)]
struct Arguments {
    /// An archive with x, y (not used), F.
    state: PathBuf,
    /// Pairs nearer than this are listed [m].
    #[arg(long)]
    radius: f64,
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Searches that are timed, after one that is not.
    #[arg(long, default_value_t = 10)]
    repeats: usize,
    /// Writes the pairs as little-endian u32: kind (0 vertex-triangle, 1 edge-edge) and the four vertices.
    #[arg(long)]
    pairs: Option<PathBuf>,
}

/// Seconds of each search.
#[derive(Debug, Default, Serialize)]
struct Times {
    cpu: Vec<f64>,
    wall: Vec<f64>,
}

#[derive(Debug, Serialize)]
struct Report {
    vertices: usize,
    edges: usize,
    triangles: usize,
    threads: usize,
    candidates: u64,
    vertex_triangle: usize,
    edge_edge: usize,
    min_distance: Option<f64>,
    /// Trees are made anew by each search.
    fresh: Times,
    /// Trees are kept and refitted, as within a simulation.
    kept: Times,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let states = States::read(&arguments.state)?;
    let topology = Topology::builder(states.x.len())
        .triangles(states.triangles.iter().copied())
        .strand_edges(states.strands.iter().copied())
        .build()
        .map_err(|errors| anyhow!("{} faults, {}", errors.len(), errors[0]))?;
    let (edges, triangles) = (topology.edges.len(), topology.triangles.len());
    let model = CollisionModel::single_body(topology);
    let radii = vec![0.5 * arguments.radius; states.x.len()];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build()?;

    let (mut pairs, mut separations) = (PairList::default(), Vec::<Separation>::new());
    let mut timed = |search: &mut Option<ProximitySearch>, times: &mut Times| {
        let (wall, cpu) = (Instant::now(), cpu_seconds());
        let search = search.get_or_insert_with(|| ProximitySearch::new(&model));
        pool.install(|| search.search(&model, &states.x, &radii, &mut pairs, &mut separations));
        times.cpu.push(cpu_seconds() - cpu);
        times.wall.push(wall.elapsed().as_secs_f64());
        search.statistics().candidates
    };
    // The first brings memory and caches to where they stay.
    let mut kept_search = None;
    let candidates = timed(&mut kept_search, &mut Times::default());
    let (mut fresh, mut kept) = (Times::default(), Times::default());
    for _ in 0..arguments.repeats {
        timed(&mut kept_search, &mut kept);
        timed(&mut None, &mut fresh);
    }

    if let Some(path) = &arguments.pairs {
        write_pairs(path, &pairs)?;
    }
    let report = Report {
        vertices: states.x.len(),
        edges,
        triangles,
        threads: arguments.threads,
        candidates,
        vertex_triangle: pairs.range(PairKind::VertexTriangle).len(),
        edge_edge: pairs.range(PairKind::EdgeEdge).len(),
        min_distance: separations.iter().map(|s| s.distance).min_by(f64::total_cmp),
        fresh,
        kept,
    };
    println!("{}", serde_json::to_string(&report)?);
    Ok(())
}

fn write_pairs(path: &Path, pairs: &PairList) -> Result<()> {
    let mut bytes = Vec::new();
    for (code, kind) in [PairKind::VertexTriangle, PairKind::EdgeEdge].into_iter().enumerate() {
        for pair in &pairs.pairs()[pairs.range(kind)] {
            let numbers = [code as u32].into_iter().chain(pair.vertices);
            bytes.extend(numbers.flat_map(u32::to_le_bytes));
        }
    }
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}
