use super::fields;
use crate::shapes::*;
use bowknot_geometry::{Topology, boundary_triangles};
use bowknot_io::Mesh;
use std::f64::consts::PI;

fn volumes(mesh: &Mesh) -> Vec<f64> {
    let at = |v: u32| mesh.positions[v as usize];
    mesh.tets
        .iter()
        .map(|t| {
            let [a, b, c, d] = t.map(at);
            (b - a).cross(&(c - a)).dot(&(d - a)) / 6.0
        })
        .collect()
}

/// Euler characteristic of the surface: 2 for anything without holes.
fn surface_euler(mesh: &Mesh) -> i64 {
    let triangles = boundary_triangles(&mesh.tets);
    let topology = Topology::builder(mesh.positions.len()).triangles(triangles).build().expect("topology");
    let vertices = topology.surface_vertices.len() as i64;
    vertices - topology.edges.len() as i64 + topology.triangles.len() as i64
}

#[test]
fn a_block_is_filled_by_positive_tets_that_fit_together() {
    for (size, edge) in [([0.2, 0.3, 0.4], 0.1), ([0.3; 3], 0.1), ([0.1, 0.5, 0.5], 0.1)] {
        let mesh = Block { size, edge }.mesh();
        let volumes = volumes(&mesh);
        assert!(volumes.iter().all(|v| (v / (edge.powi(3) / 6.0) - 1.0).abs() < 1e-9), "{volumes:?}");
        assert!((volumes.iter().sum::<f64>() / size.iter().product::<f64>() - 1.0).abs() < 1e-12);
        // Faces that did not fit their neighbors would count as surface.
        let cells = size.map(|s| (s / edge).round());
        let faces = 4.0 * (cells[0] * cells[1] + cells[1] * cells[2] + cells[2] * cells[0]);
        assert_eq!(boundary_triangles(&mesh.tets).len() as f64, faces);
        assert_eq!(surface_euler(&mesh), 2);
    }
}

#[test]
fn no_tet_of_a_thick_block_has_two_faces_on_the_surface() {
    for mesh in [Block { size: [0.4; 3], edge: 0.1 }.mesh(), TetBall { radius: 0.1, edge: 0.02 }.mesh()] {
        let outside: std::collections::BTreeSet<u32> =
            boundary_triangles(&mesh.tets).into_iter().flatten().collect();
        assert!(mesh.tets.iter().all(|t| t.iter().any(|v| !outside.contains(v))));
    }
}

#[test]
fn a_tet_ball_has_the_volume_of_its_ball_and_no_slivers() {
    let ball = TetBall { radius: 0.2, edge: 0.02 };
    let mesh = ball.mesh();
    let volumes = volumes(&mesh);
    let exact = 4.0 / 3.0 * PI * 0.008;
    assert!((volumes.iter().sum::<f64>() / exact - 1.0).abs() < 0.02);
    let (low, high) = volumes.iter().fold((f64::MAX, 0.0f64), |(l, h), v| (l.min(*v), h.max(*v)));
    assert!(low > 0.0 && high / low < 6.0, "{low} {high}");
    assert_eq!(surface_euler(&mesh), 2);
    let at = |v: u32| mesh.positions[v as usize];
    for [a, b, c] in boundary_triangles(&mesh.tets) {
        let normal = (at(b) - at(a)).cross(&(at(c) - at(a)));
        assert!(normal.dot(&at(a).coords) > 0.0, "a face points inward");
        assert!([a, b, c].iter().all(|v| (at(*v).coords.norm() - 0.2).abs() < 1e-12));
    }
}

#[test]
fn strands_have_their_length_and_their_roots_in_place() {
    let straight = Strands { count: 10, length: 0.4, segments: 8, ..Strands::default() };
    let mesh = straight.mesh();
    assert_eq!((mesh.positions.len(), mesh.strands.len()), (90, 80));
    for strand in mesh.positions.chunks(9) {
        assert!((strand[8].z + 0.4).abs() < 1e-12 && strand[0].z == 0.0);
    }
    let curled = Strands { root: Root::Sphere, curl: 0.01, patch: 90.0, count: 200, ..Strands::default() };
    let mesh = curled.mesh();
    for strand in mesh.positions.chunks(21) {
        assert!((strand[0].coords.norm() - 0.1).abs() < 1e-12 && strand[0].z > 0.0);
        let length: f64 = strand.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        assert!((0.3..0.45).contains(&length), "{length}");
    }
    // Half of the roots are in the upper half of the area.
    let high = mesh.positions.chunks(21).filter(|strand| strand[0].z > 0.05).count();
    assert_eq!(high, 100);
}

#[test]
fn grains_keep_apart_and_come_out_alike() {
    let grains = Grains { count: [4, 5, 6], spacing: 0.01, jitter: 0.1, seed: 3 };
    let mesh = grains.mesh();
    assert_eq!((mesh.particles.len(), mesh.clone()), (120, grains.mesh()));
    assert_ne!(mesh, Grains { seed: 4, ..grains }.mesh());
    for (i, a) in mesh.positions.iter().enumerate() {
        assert!(mesh.positions[..i].iter().all(|b| (a - b).norm() >= 0.008 - 1e-12));
    }
}

#[test]
fn what_is_out_of_range_is_named() {
    assert_eq!(fields(Shape::Block(Block { size: [0.1, -1.0, 0.1], edge: f64::NAN })), ["size", "edge"]);
    assert_eq!(fields(Shape::Block(Block { size: [1.0; 3], edge: 1e-3 })), ["edge"]);
    assert_eq!(fields(Shape::TetBall(TetBall { radius: 0.0, edge: 1.0 })), ["radius"]);
    let strands =
        Strands { count: 0, segments: 0, length: 0.0, curl: -1.0, patch: 181.0, ..Strands::default() };
    assert_eq!(fields(Shape::Strands(strands)), ["length", "count", "segments", "curl", "patch"]);
    let grains = Grains { count: [1, 0, 1], spacing: 0.0, jitter: 0.5, seed: 0 };
    assert_eq!(fields(Shape::Grains(grains)), ["spacing", "count", "jitter"]);
}
