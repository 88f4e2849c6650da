//! The surface of a tetrahedral mesh.

/// Faces of a tetrahedron with vertices 0 to 3, counter-clockwise seen from outside if its volume (x1 - x0) x
/// (x2 - x0) . (x3 - x0) / 6 is positive.
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];

/// The eight tetrahedra into which nodes in the middles of the edges divide one (Bey 1995, "Tetrahedral grid refinement").
///
/// `nodes` are the corners, then the middles of the edges 01, 02, 03, 12, 13, 23. Those at the corners come first; all have
/// positive volume where the one of the corners has.
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
