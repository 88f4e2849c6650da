//! Milliseconds per search on folded cloth, or on a state given as raw files.
//!
//! ```text
//! cargo run --release -p bowknot-proximity --example time_search -- [VERTICES [THREADS [REPEATS]]]
//! cargo run --release -p bowknot-proximity --example time_search -- POSITIONS TRIANGLES [THREADS [REPEATS]]
//! ```
//! POSITIONS holds little-endian f64 triples, TRIANGLES little-endian u32 triples. Pairs nearer than 2 mm are
//! listed with their contact geometry.
#![allow(clippy::print_stdout)]

#[path = "../tests/suite/scenes/folded.rs"]
mod folded;

use bowknot_geometry::{Point, Separation, Topology};
use bowknot_proximity::{CollisionModel, PairList, ProximitySearch};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let from_files = arguments.first().is_some_and(|a| a.parse::<usize>().is_err());
    let number =
        |index: usize, default: usize| arguments.get(index).map_or(Ok(default), |a| a.parse::<usize>());
    let (positions, triangles, next) = if from_files {
        let (positions, triangles) = read(&arguments)?;
        (positions, triangles, 2)
    } else {
        let (positions, triangles) = folded::folded_cloth(number(0, 10_000)?, 0.0015);
        (positions, triangles, 1)
    };
    let threads = number(next, 2)?;
    let repeats = number(next + 1, 20)?.max(1);

    let topology = Topology::builder(positions.len())
        .triangles(triangles)
        .build()
        .map_err(|errors| format!("{} faults, {}", errors.len(), errors[0]))?;
    println!(
        "{} vertices, {} edges, {} triangles, {threads} threads",
        topology.vertex_count,
        topology.edges.len(),
        topology.triangles.len()
    );
    let model = CollisionModel::single_body(topology);
    let radii = vec![0.001; positions.len()];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;

    let mut search = ProximitySearch::new(&model);
    let (mut pairs, mut separations) = (PairList::default(), Vec::new());
    let mut run = || {
        let start = Instant::now();
        pool.install(|| search.search(&model, &positions, &radii, &mut pairs, &mut separations));
        (start.elapsed().as_secs_f64() * 1e3, search.statistics())
    };
    let (first, _) = run();
    let before = cpu_ticks();
    let mut times: Vec<f64> = (0..repeats).map(|_| run().0).collect();
    let after = cpu_ticks();
    let statistics = run().1;
    times.sort_by(f64::total_cmp);
    println!("first {first:.2} ms, then median {:.2} ms, least {:.2} ms", times[repeats / 2], times[0]);
    if let (Some(before), Some(after)) = (before, after) {
        println!("CPU time {:.2} ms per search", 10.0 * (after - before) as f64 / repeats as f64);
    }
    println!("{statistics:?}");
    let least = separations.iter().map(|s| s.distance).fold(f64::INFINITY, f64::min);
    println!("smallest distance {least:.6e} m; all bits together {:016x}", checksum(&pairs, &separations));
    Ok(())
}

/// Changes with any bit of the result: the same on every machine, instruction set and thread count.
fn checksum(pairs: &PairList, separations: &[Separation]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bits: u64| hash = (hash ^ bits).wrapping_mul(0x0100_0000_01b3).rotate_left(23);
    for (pair, s) in pairs.pairs().iter().zip(separations) {
        pair.elements.iter().for_each(|&e| add(u64::from(e)));
        s.normal.iter().chain(&s.weights).chain(&[s.distance, s.width]).for_each(|x| add(x.to_bits()));
    }
    hash
}

/// CPU time of this process so far in hundredths of a second, where the system tells (Linux).
fn cpu_ticks() -> Option<u64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
    Some(fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?)
}

type Mesh = (Vec<Point>, Vec<[u32; 3]>);

fn read(paths: &[String]) -> Result<Mesh, Box<dyn Error>> {
    let [positions, triangles, ..] = paths else { return Err("two files are needed".into()) };
    let positions: Vec<f64> = chunks(&std::fs::read(positions)?).map(f64::from_le_bytes).collect();
    let triangles: Vec<u32> = chunks(&std::fs::read(triangles)?).map(u32::from_le_bytes).collect();
    let positions = positions.chunks_exact(3).map(|p| Point::new(p[0], p[1], p[2])).collect();
    Ok((positions, triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect()))
}

fn chunks<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> {
    bytes.chunks_exact(N).map(|chunk| std::array::from_fn(|i| chunk[i]))
}
