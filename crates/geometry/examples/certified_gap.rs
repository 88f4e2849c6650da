//! A vertex is pulled through a triangle, but never passes it.
//!
//! In each step it may use nine tenths of the certified gap along the contact normal, and it slides freely
//! across the normal. So it comes to rest on the side of the triangle where it started. An exact test, which
//! shares no code with the certified separation, checks every step.
//!
//! `cargo run --release -p bowknot-geometry --example certified_gap`

#![allow(clippy::print_stdout)]

use bowknot_geometry::{PairKind, Point, intersection, separation};

/// The part of the certified gap that one step may use.
const USED_PART: f64 = 0.9;
/// The part of the gap that is kept for rounding [m].
const MIN_GAP: f64 = 1e-9;

fn main() {
    let triangle = [Point::new(-3.0, -3.0, 0.0), Point::new(5.0, -3.0, 0.8), Point::new(-3.0, 5.0, 0.4)];
    let target = Point::new(0.3, 0.25, -2.0);
    let mut vertex = Point::new(0.2, 0.2, 1.0);
    println!("step         gap [m]  vertex [m]");
    for step in 0..10 {
        let points = [vertex, triangle[0], triangle[1], triangle[2]];
        let pair = separation::separate(PairKind::VertexTriangle, &points);
        println!("{step:4}  {:14.6e}  ({:.6}, {:.6}, {:.6})", pair.width, vertex.x, vertex.y, vertex.z);

        // The whole way to the target, but along the normal no farther than the limit.
        let wanted = target - vertex;
        let closing = -wanted.dot(&pair.normal);
        let limit = USED_PART * (pair.width - MIN_GAP).max(0.0);
        let next = vertex + wanted + pair.normal * (closing - limit).max(0.0);

        let [a, b, c] = &triangle;
        assert!(!intersection::edge_triangle([&vertex, &next], [a, b, c]), "the separation was wrong");
        vertex = next;
    }
    println!("no step intersected the triangle");
}
