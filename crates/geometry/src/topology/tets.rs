//! The surface of a tetrahedral mesh, and its division by vertices in the middles of edges.

use crate::Point;
use std::collections::HashMap;

/// Faces of a tetrahedron with vertices 0 to 3, counter-clockwise seen from outside if its volume (x1 - x0) x
/// (x2 - x0) . (x3 - x0) / 6 is positive.
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

/// Edges of a tetrahedron with vertices 0 to 3, in the order of the nodes 4 to 9 of one of ten nodes.
pub const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Appends a vertex in the middle of each edge to the `positions` of `tets`, and returns tetrahedra of ten
/// nodes: the corners, then the middles of [`TETRAHEDRON_EDGES`].
///
/// # Panics
/// If a vertex is not among the positions.
pub fn add_edge_middles(positions: &mut Vec<Point>, tets: &[[u32; 4]]) -> Vec<[u32; 10]> {
    let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            positions.push(nalgebra::center(&positions[a as usize], &positions[b as usize]));
            positions.len() as u32 - 1
        })
    };
    let with_middles = |tet: &[u32; 4]| {
        let middles = TETRAHEDRON_EDGES.map(|[i, j]| middle(tet[i], tet[j]));
        std::array::from_fn(|k| if k < 4 { tet[k] } else { middles[k - 4] })
    };
    tets.iter().map(with_middles).collect()
}

/// The eight tetrahedra into which nodes in the middles of the edges divide one (Bey 1995, "Tetrahedral grid
/// refinement").
///
/// `nodes` are the corners, then the middles of [`TETRAHEDRON_EDGES`]. Those at the corners come first; all
/// have positive volume where the one of the corners has.
pub fn divide_tetrahedron(nodes: &[u32; 10]) -> [[u32; 4]; 8] {
    const PARTS: [[usize; 4]; 8] = [
        [0, 4, 5, 6],
        [4, 1, 7, 8],
        [5, 7, 2, 9],
        [6, 8, 9, 3],
        [4, 5, 6, 8],
        [4, 5, 8, 7],
        [5, 6, 8, 9],
        [5, 7, 9, 8],
    ];
    PARTS.map(|part| part.map(|k| nodes[k]))
}

/// The triangles that belong to one tetrahedron only: the surface of the solid.
///
/// They point outward if the tetrahedron has a positive volume, and are in the order of the tetrahedra. A
/// face of two or more tetrahedra is inside. O(n log n).
pub fn boundary_triangles(tets: &[[u32; 4]]) -> Vec<[u32; 3]> {
    let face = |place: usize| FACES[place % 4].map(|k| tets[place / 4][k]);
    let mut keyed: Vec<([u32; 3], usize)> = (0..4 * tets.len())
        .map(|place| {
            let mut key = face(place);
            key.sort_unstable();
            (key, place)
        })
        .collect();
    keyed.sort_unstable();
    let mut single: Vec<usize> =
        keyed.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0].1).collect();
    single.sort_unstable();
    single.into_iter().map(face).collect()
}

#[cfg(test)]
mod tests;
