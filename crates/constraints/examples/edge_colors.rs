//! Colors of a sheet's edges: their number, their sizes, and a check that edges of one color share no
//! movable vertex.
//!
//! `cargo run --release -p bowknot-constraints --example edge_colors`
#![allow(clippy::print_stdout)]

use bowknot_constraints::{EdgeLimits, EdgeReference};
use bowknot_geometry::{Point, Topology};
use std::error::Error;

/// Vertices along each side.
const SIDE: u32 = 40;
/// Largest ratio of an edge's length to its rest length.
const STRETCH: f64 = 1.1;

fn main() -> Result<(), Box<dyn Error>> {
    let rest: Vec<Point> = (0..SIDE * SIDE)
        .map(|v| Point::new(0.01 * f64::from(v % SIDE), 0.01 * f64::from(v / SIDE), 0.0))
        .collect();
    let mut triangles = Vec::new();
    for j in 0..SIDE - 1 {
        for i in 0..SIDE - 1 {
            let a = j * SIDE + i;
            triangles.extend([[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]]);
        }
    }
    let topology = Topology::builder(rest.len()).triangles(triangles).build()?;
    // One side is held. Edges between held vertices need no limit, and edges that share a held vertex may
    // have one color.
    let movable: Vec<bool> = (0..SIDE * SIDE).map(|v| v >= SIDE).collect();

    let mut limits = EdgeLimits::new(&topology, &rest, &movable, |_| STRETCH);
    let (edges, rows) = (topology.edges.len(), limits.balls.len());
    println!("{edges} edges, {rows} of them with a movable vertex, {} colors", limits.color_count());
    for (color, range) in limits.color_starts().windows(2).enumerate() {
        let (start, end) = (range[0] as usize, range[1] as usize);
        println!("  color {color:2}: {:5} edges", end - start);
        let mut taken = vec![false; rest.len()];
        for ball in &limits.balls[start..end] {
            for v in ball.vertices.map(|v| v as usize).into_iter().filter(|&v| movable[v]) {
                assert!(
                    !std::mem::replace(&mut taken[v], true),
                    "vertex {v} is in two edges of color {color}"
                );
            }
        }
    }

    // A call that starts from the sheet stretched by a twentieth, with a target stretched by a fifth.
    let stretched = |factor: f64| rest.iter().map(|p| Point::new(factor * p.x, p.y, p.z)).collect::<Vec<_>>();
    limits.begin(&stretched(1.05), EdgeReference::Rest);
    let stretch = limits.stretch(&stretched(1.2));
    println!(
        "stretched by a fifth: {:.3} of the limit, {:.3} of the start, {:.3} of the rest length",
        stretch.to_limit, stretch.to_start, stretch.to_rest
    );
    Ok(())
}
