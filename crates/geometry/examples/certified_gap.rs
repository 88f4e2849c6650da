//! A vertex is pulled through a triangle, and never gets there.
//!
//! Each step it may spend nine tenths of the certified gap along the contact normal and slides
//! freely across it, so it comes to rest on the triangle's side where it started. An exact test, which
//! shares no code with the certificate, watches every step.
//!
//! `cargo run --release -p bowknot-geometry --example certified_gap`

#![allow(clippy::print_stdout)]

use bowknot_geometry::{PairKind, Point, intersection, separation};

/// The part of the certified gap that one step may spend.
const SPENT: f64 = 0.9;
/// A gap that is left over for rounding [m].
const FLOOR: f64 = 1e-9;

fn main() {
    let triangle = [Point::new(-3.0, -3.0, 0.0), Point::new(5.0, -3.0, 0.8), Point::new(-3.0, 5.0, 0.4)];
    let target = Point::new(0.3, 0.25, -2.0);
    let mut vertex = Point::new(0.2, 0.2, 1.0);
    println!("step         gap [m]  vertex [m]");
    for step in 0..10 {
        let points = [vertex, triangle[0], triangle[1], triangle[2]];
        let pair = separation::separate(PairKind::VertexTriangle, &points);
        println!("{step:4}  {:14.6e}  ({:.6}, {:.6}, {:.6})", pair.width, vertex.x, vertex.y, vertex.z);

        // The whole way to the target, except that along the normal only the budget is spent.
        let wanted = target - vertex;
        let closing = -wanted.dot(&pair.normal);
        let budget = SPENT * (pair.width - FLOOR).max(0.0);
        let next = vertex + wanted + pair.normal * (closing - budget).max(0.0);

        let [a, b, c] = &triangle;
        assert!(!intersection::edge_triangle([&vertex, &next], [a, b, c]), "the certificate was wrong");
        vertex = next;
    }
    println!("no step met the triangle");
}
