//! Checks additive CCD on queries with an exact ground truth, and times it.
//!
//! `cargo run --release -p bowknot-baselines --example ccd_queries -- FOLDER` reads every
//! `FOLDER/*/{edge-edge,vertex-face}/*.csv` in the format of Wang, Ferguson, Schneider, Jiang, Attene and
//! Panozzo (2021), "A Large-Scale Benchmark and an Inclusion-Based Algorithm for Continuous Collision
//! Detection": eight lines a query, four vertices before and four after; numerator and denominator of each
//! coordinate; 1 in the seventh column if they meet.
#![allow(clippy::print_stdout)] // it is a command

use bowknot_baselines::ccd::{AdditiveCcd, ClosingSpeed};
use bowknot_baselines::twoway::geometry::{PairKind, Point, Vector};
use std::path::{Path, PathBuf};
use std::time::Instant;

struct Query {
    x: [Point; 4],
    paths: [Vector; 4],
    meets: bool,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: ccd_queries FOLDER")?;
    println!("set, kind, queries, meet | slackness, speed: missed, false alarms, mean distances, ns a query");
    for set in children(Path::new(&folder))? {
        for (name, kind) in [("edge-edge", PairKind::EdgeEdge), ("vertex-face", PairKind::VertexTriangle)] {
            let mut queries = Vec::new();
            if set.join(name).is_dir() {
                for file in children(&set.join(name))? {
                    read(&file, &mut queries).map_err(|error| format!("{}: {error}", file.display()))?;
                }
            }
            if queries.is_empty() {
                continue;
            }
            let meet = queries.iter().filter(|q| q.meets).count();
            let set = set.file_name().unwrap_or_default().to_string_lossy();
            println!("{set}, {name}, {}, {meet}", queries.len());
            for slackness in [0.1, 1e-3, 1e-6] {
                for speed in [ClosingSpeed::Travel, ClosingSpeed::Slab] {
                    check(kind, &queries, AdditiveCcd { slackness, speed, ..AdditiveCcd::default() });
                }
            }
        }
    }
    Ok(())
}

fn check(kind: PairKind, queries: &[Query], ccd: AdditiveCcd) {
    let (mut missed, mut alarms, mut distances) = (0, 0, 0);
    let timer = Instant::now();
    for query in queries {
        let found = ccd.clearance(kind, &query.x, &query.paths, 0.0, 1.0);
        missed += u32::from(query.meets && found.time >= 1.0);
        alarms += u32::from(!query.meets && found.time < 1.0);
        distances += u64::from(found.iterations);
    }
    let count = queries.len() as f64;
    let nanoseconds = timer.elapsed().as_secs_f64() * 1e9 / count;
    let mean = distances as f64 / count;
    let speed = ccd.speed;
    println!("  {:e}, {speed:?}: {missed}, {alarms}, {mean:.1}, {nanoseconds:.0}", ccd.slackness);
}

fn children(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut paths = std::fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .filter(|path| {
            path.as_ref().map_or(true, |p| p.is_dir() || p.extension().is_some_and(|e| e == "csv"))
        })
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    Ok(paths)
}

fn read(file: &Path, queries: &mut Vec<Query>) -> Result<(), Box<dyn std::error::Error>> {
    let text = std::fs::read_to_string(file)?;
    let rows = text.lines().map(row).collect::<Result<Vec<_>, _>>()?;
    if rows.len() % 8 != 0 {
        return Err(format!("{} lines are no whole number of queries", rows.len()).into());
    }
    for query in rows.chunks_exact(8) {
        let x = std::array::from_fn(|k| query[k].0);
        // Ends are exact, paths are rounded; this changes a time of impact by rounding only.
        let paths = std::array::from_fn(|k| query[k + 4].0 - query[k].0);
        queries.push(Query { x, paths, meets: query[0].1 });
    }
    Ok(())
}

fn row(line: &str) -> Result<(Point, bool), Box<dyn std::error::Error>> {
    let numbers = line.split(',').map(|n| n.trim().parse::<f64>()).collect::<Result<Vec<_>, _>>()?;
    match numbers[..] {
        [a, b, c, d, e, f, meets] => Ok((Point::new(a / b, c / d, e / f), meets != 0.0)),
        _ => Err(format!("{} columns instead of 7: {line}", numbers.len()).into()),
    }
}
