//! Vertices in the middles of the edges of tetrahedra.

use bowknot_geometry::Point;
use std::collections::HashMap;

/// Edges of a tetrahedron, in the order of the nodes 4 to 9 of a quadratic one.
pub(super) const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Appends a vertex in the middle of each edge and returns the quadratic tetrahedra: corners, then the middles of the edges 01,
/// 02, 03, 12, 13, 23.
pub(super) fn with_middles(positions: &mut Vec<Point>, tets: &[[u32; 4]]) -> Vec<[u32; 10]> {
    let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            positions.push(nalgebra::center(&positions[a as usize], &positions[b as usize]));
            positions.len() as u32 - 1
        })
    };
    let with_middles = |tet: &[u32; 4]| {
        let middles = EDGES.map(|[i, j]| middle(tet[i], tet[j]));
        std::array::from_fn(|k| if k < 4 { tet[k] } else { middles[k - 4] })
    };
    tets.iter().map(with_middles).collect()
}
