//! A sheet is asked to go straight down, through a ball. Searches and steps alone drape it over the ball:
//! what meets the ball waits there, the rest goes on. A picture of the middle from the side is printed for
//! every few searches.
//!
//! `cargo run --release -p bowknot-stepper --example drape`
#![allow(clippy::print_stdout)]

use bowknot_geometry::{Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_stepper::{Forward, ForwardOptions};
use std::error::Error;
use std::f64::consts::{PI, TAU};

/// Squares along a side of the sheet, its length [m], and its height at the start [m].
const CELLS: u32 = 24;
const LENGTH: f64 = 2.0;
const HEIGHT: f64 = 0.8;
/// Rings and sectors of the ball, whose radius is 0.5 m.
const RINGS: u32 = 12;
const SECTORS: u32 = 24;
/// How far a vertex may go between two searches [m], and how many steps are made with a list.
const RADIUS: f64 = 0.05;
const STEPS: usize = 4;
/// Searches in all, and between two pictures.
const SEARCHES: usize = 24;
const BETWEEN: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut x, mut triangles) = sheet();
    let count = x.len();
    ball(&mut x, &mut triangles);
    let bodies = (0..x.len()).map(|v| u32::from(v >= count)).collect();
    let topology = Topology::builder(x.len()).triangles(triangles).build()?;
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, bodies, filters, vec![])?;

    let target: Vec<Point> =
        (0..x.len()).map(|v| if v < count { x[v] - 1.2 * Vector::z() } else { x[v] }).collect();
    // The ball rests, and its vertices add nothing to the pairs that are searched.
    let radii: Vec<f64> = (0..x.len()).map(|v| if v < count { RADIUS } else { 0.0 }).collect();
    let options = ForwardOptions { min_separation: 5e-3, ..ForwardOptions::default() };
    let mut forward = Forward::new(model, x, &radii, options)?;
    for search in 0..=SEARCHES {
        if search.is_multiple_of(BETWEEN) {
            let contacts = forward.contacts();
            let nearest = contacts.separations.iter().map(|s| s.width).fold(f64::INFINITY, f64::min);
            println!("after {search} searches: {} pairs, smallest gap {nearest:.4} m", contacts.pairs.len());
            draw(&forward.positions()[..count]);
        }
        for _ in 0..STEPS {
            forward.advance(&target)?;
        }
        forward.search(&radii)?;
    }
    Ok(())
}

fn sheet() -> (Vec<Point>, Vec<[u32; 3]>) {
    let (side, cell) = (CELLS + 1, LENGTH / f64::from(CELLS));
    let place = |k: u32| f64::from(k) * cell - 0.5 * LENGTH;
    let x = (0..side * side).map(|v| Point::new(place(v % side), place(v / side), HEIGHT)).collect();
    let corners = (0..CELLS * side).filter(|v| v % side < CELLS);
    let triangles = corners.flat_map(|v| [[v, v + 1, v + side], [v + 1, v + side + 1, v + side]]);
    (x, triangles.collect())
}

/// Adds the rings of a ball about the origin, without its poles.
fn ball(x: &mut Vec<Point>, triangles: &mut Vec<[u32; 3]>) {
    let first = x.len() as u32;
    for v in 0..RINGS * SECTORS {
        let polar = PI * (f64::from(v / SECTORS) + 0.5) / f64::from(RINGS);
        let around = TAU * f64::from(v % SECTORS) / f64::from(SECTORS);
        let (height, radius) = (0.5 * polar.cos(), 0.5 * polar.sin());
        x.push(Point::new(radius * around.cos(), radius * around.sin(), height));
    }
    for v in 0..(RINGS - 1) * SECTORS {
        let next = v - v % SECTORS + (v + 1) % SECTORS;
        let corners = [v, next, v + SECTORS, next + SECTORS].map(|v| v + first);
        triangles.push([corners[0], corners[2], corners[1]]);
        triangles.push([corners[1], corners[2], corners[3]]);
    }
}

/// Prints the middle row of the sheet, seen from the side, and the ball.
fn draw(sheet: &[Point]) {
    const COLUMNS: usize = 72;
    const ROWS: usize = 20;
    let mut picture = [[' '; COLUMNS]; ROWS];
    let column = |x: f64| ((x / 2.2 + 0.5) * COLUMNS as f64) as usize;
    let row = |z: f64| ((0.9 - z) / 1.45 * ROWS as f64) as usize;
    for k in 0..720 {
        let angle = PI * f64::from(k) / 360.0;
        picture[row(0.5 * angle.sin())][column(0.5 * angle.cos())] = '.';
    }
    let side = CELLS as usize + 1;
    let middle = &sheet[side * (side / 2)..][..side];
    for ends in middle.windows(2) {
        for k in 0..=16 {
            let p = ends[0] + (ends[1] - ends[0]) * (f64::from(k) / 16.0);
            picture[row(p.z)][column(p.x)] = '#';
        }
    }
    for line in picture {
        println!("  {}", String::from_iter(line).trim_end());
    }
}
