//! A block of tetrahedra, for tests and examples.

use bowknot_geometry::Point;
use std::collections::BTreeMap;

/// A box with its corner at the origin, of `cells` cubes along each axis, each of six tets around its
/// diagonal: positions and tets. Vertex (i, j, k) has index i + (cells[0] + 1) * (j + (cells[1] + 1) * k).
pub fn block(size: [f64; 3], cells: [usize; 3]) -> (Vec<Point>, Vec<[u32; 4]>) {
    let index = |i: usize, j: usize, k: usize| (i + (cells[0] + 1) * (j + (cells[1] + 1) * k)) as u32;
    let at = |axis: usize, k: usize| size[axis] * k as f64 / cells[axis] as f64;
    let (mut positions, mut tets) = (Vec::new(), Vec::new());
    for k in 0..=cells[2] {
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                positions.push(Point::new(at(0, i), at(1, j), at(2, k)));
                if i < cells[0] && j < cells[1] && k < cells[2] {
                    let corner = |c: usize| index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
                    for [a, b] in [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]] {
                        tets.push([corner(0), corner(a), corner(b), corner(7)]);
                    }
                }
            }
        }
    }
    (positions, tets)
}

/// A mesh of tets with nodes in the middles of their edges.
pub fn quadratic(mut positions: Vec<Point>, tets: &[[u32; 4]]) -> (Vec<Point>, Vec<[u32; 10]>) {
    let mut middles = BTreeMap::new();
    let mut with_middles = Vec::new();
    for tet in tets {
        let mut nodes = [0; 10];
        nodes[..4].copy_from_slice(tet);
        for (node, [i, j]) in nodes[4..].iter_mut().zip([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]) {
            let [a, b] = [tet[i].min(tet[j]), tet[i].max(tet[j])];
            *node = *middles.entry([a, b]).or_insert_with(|| {
                positions.push(nalgebra::center(&positions[a as usize], &positions[b as usize]));
                positions.len() as u32 - 1
            });
        }
        with_middles.push(nodes);
    }
    (positions, with_middles)
}
