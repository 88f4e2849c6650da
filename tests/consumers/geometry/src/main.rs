//! The smallest distance within a mesh, by all vertex-triangle pairs, and a check of its topology.
#![allow(clippy::print_stdout, reason = "a command")]

use bowknot_geometry::{PairKind, Point, Topology, distance, intersection, separation};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Two triangles of a square, and one that stands on edge 1 mm above it.
    let x = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.3, 0.2, 0.001],
        [0.3, 0.7, 0.5],
        [0.2, 0.4, 0.5],
    ]
    .map(Point::from);
    let topology = Topology::builder(x.len()).triangles([[0, 1, 2], [0, 2, 3], [4, 5, 6]]).build()?;
    let mut nearest = (f64::INFINITY, 0, [0; 3]);
    for v in 0..x.len() as u32 {
        for triangle in topology.triangles.iter().filter(|t| !t.contains(&v)) {
            let [a, b, c] = triangle.map(|v| x[v as usize]);
            let points = [x[v as usize], a, b, c];
            let measured = distance::closest(PairKind::VertexTriangle, &points).distance;
            let certified = separation::separate(PairKind::VertexTriangle, &points).width;
            assert!(certified <= measured + 1e-12);
            if measured < nearest.0 {
                nearest = (measured, v, *triangle);
            }
        }
    }
    println!("vertex {} is {:.6} m from triangle {:?}", nearest.1, nearest.0, nearest.2);
    assert_eq!(nearest.1, 4);
    assert!((nearest.0 - 0.001).abs() < 1e-15);
    let crossing = topology.edges.iter().any(|&[i, j]| {
        let edge = [&x[i as usize], &x[j as usize]];
        topology.triangles.iter().any(|t| {
            !t.contains(&i) && !t.contains(&j) && intersection::edge_triangle(edge, t.map(|v| &x[v as usize]))
        })
    });
    assert!(!crossing);
    Ok(())
}

#[test]
fn runs() {
    main().unwrap();
}
