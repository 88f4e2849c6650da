use super::*;
use crate::{Point, Topology};

/// Six tetrahedra that fill the unit cube, all around its diagonal from vertex 0 to vertex 7.
fn cube() -> (Vec<Point>, Vec<[u32; 4]>) {
    let positions = (0..8).map(|v| Point::new((v & 1) as f64, (v >> 1 & 1) as f64, (v >> 2) as f64));
    let around = [1, 3, 2, 6, 4, 5];
    let tets = (0..6).map(|k| [0, around[k], around[(k + 1) % 6], 7]);
    (positions.collect(), tets.collect())
}

/// Six times the volume within a closed surface, by the divergence theorem.
fn six_volumes(positions: &[Point], triangles: &[[u32; 3]]) -> f64 {
    let corners = triangles.iter().map(|t| t.map(|v| positions[v as usize].coords));
    corners.map(|[a, b, c]| a.cross(&b).dot(&c)).sum()
}

#[test]
fn a_tetrahedron_is_bounded_by_its_faces() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point::from);
    let faces = boundary_triangles(&[[0, 1, 2, 3]]);
    assert_eq!(faces, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
    assert_eq!(six_volumes(&positions, &faces), 1.0);
    assert_eq!(six_volumes(&positions, &boundary_triangles(&[[0, 2, 1, 3]])), -1.0);
}

#[test]
fn the_surface_of_a_cube_is_closed_and_points_outward() {
    let (positions, tets) = cube();
    let faces = boundary_triangles(&tets);
    assert_eq!((faces.len(), six_volumes(&positions, &faces)), (12, 6.0));
    let topology = Topology::builder(8).triangles(faces).build().unwrap();
    assert_eq!(topology.edges.len(), 18, "Euler: 8 - 18 + 12 = 2");
}

#[test]
fn what_is_shared_is_inside() {
    assert_eq!(boundary_triangles(&[]), [[0_u32; 3]; 0]);
    assert_eq!(boundary_triangles(&[[0, 1, 2, 3], [0, 2, 1, 4]]).len(), 6);
    // Three on one face: no surface, though no solid either.
    assert_eq!(boundary_triangles(&[[0, 1, 2, 3], [0, 2, 1, 4], [0, 1, 2, 5]]).len(), 9);
}

#[test]
fn a_tetrahedron_is_divided_into_eight_of_equal_volume() {
    let corners = [[0.1, 0.2, 0.3], [1.2, 0.1, 0.2], [0.4, 0.9, 0.6], [0.3, 0.4, 1.3]].map(Point::from);
    let mut positions = corners.to_vec();
    let nodes = add_edge_middles(&mut positions, &[[0, 1, 2, 3]]);
    assert_eq!((nodes.len(), positions.len()), (1, 10));
    let volume = |tet: &[u32; 4]| six_volumes(&positions, &boundary_triangles(&[*tet]));
    let parts = divide_tetrahedron(&nodes[0]);
    let whole = volume(&[0, 1, 2, 3]);
    assert!(
        parts.iter().all(|part| (volume(part) - whole / 8.0).abs() < 1e-15),
        "{:?}",
        parts.map(|p| volume(&p))
    );
    // They share their faces but those on the surface, four on each side.
    assert_eq!(boundary_triangles(&parts).len(), 16);
}
