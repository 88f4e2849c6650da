//! Tets with nodes in the middles of their edges, for tests and examples.

use bowknot_geometry::Point;
use std::collections::BTreeMap;

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
