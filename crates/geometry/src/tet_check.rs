//! Faults of tetrahedral meshes.

use crate::point::{Point, Vector};

/// Six times the volume over the cube of the longest edge below which a tetrahedron is flat. Far above the
/// rounding of the volume, so that the sign of a larger one is certain.
const FLAT: f64 = 1e-12;

/// What keeps a tetrahedral mesh from being a solid.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TetFaults {
    /// Tetrahedra without volume, ascending.
    pub flat: Vec<usize>,
    /// Tetrahedra of negative volume, ascending: swapping two vertices cures them.
    pub turned: Vec<usize>,
    /// Tetrahedra that lie on the same side of a face that they share.
    pub overlapping: Vec<SharedSide>,
}

/// Two tetrahedra on the same side of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SharedSide {
    /// The tetrahedra, the earlier first.
    pub tets: [usize; 2],
    /// Vertices of the face, ascending.
    pub face: [u32; 3],
}

/// Finds flat, turned and overlapping tetrahedra. Flat ones, and those that name a vertex twice, overlap
/// nothing. Of several on one side of a face each makes a pair with the next. O(n log n).
///
/// Vertices must exist.
pub fn check_tets(positions: &[Point], tets: &[[u32; 4]]) -> TetFaults {
    let mut faults = TetFaults::default();
    // Face, side of its plane, tetrahedron.
    let mut faces: Vec<([u32; 3], bool, usize)> = Vec::with_capacity(4 * tets.len());
    for (index, tet) in tets.iter().enumerate() {
        let corners = tet.map(|v| positions[v as usize]);
        if is_flat(&corners) {
            faults.flat.push(index);
            continue;
        }
        let positive = signed_volume(&corners) > 0.0;
        if !positive {
            faults.turned.push(index);
        }
        for apex in 0..4 {
            let mut face = [0, 1, 2].map(|k| tet[k + usize::from(k >= apex)]);
            // The side that the apex is on: swapping two vertices of the tetrahedron turns it over.
            let even = sort(&mut face) == (apex % 2 == 1);
            faces.push((face, even == positive, index));
        }
    }
    faces.sort_unstable();
    let pairs = faces.windows(2).filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1));
    faults.overlapping =
        pairs.map(|pair| SharedSide { tets: [pair[0].2, pair[1].2], face: pair[0].0 }).collect();
    faults.overlapping.sort_unstable();
    faults
}

/// Whether a tetrahedron has no volume, up to a trillionth of the cube of its longest edge.
pub fn is_flat(corners: &[Point; 4]) -> bool {
    let longest = longest_edge(corners);
    // Relative to the longest edge, so that no cube leaves the range of `f64`.
    longest == 0.0 || six_volumes(corners, longest).abs() <= FLAT
}

/// Volume of a tetrahedron, positive if (x1 - x0) x (x2 - x0) . (x3 - x0) is [m^3].
pub fn signed_volume(corners: &[Point; 4]) -> f64 {
    let longest = longest_edge(corners);
    if longest == 0.0 { 0.0 } else { six_volumes(corners, longest) / 6.0 * longest * longest * longest }
}

/// The smallest height of a tetrahedron over its longest edge: 0.82 of a regular one, 0 of a flat one.
pub fn thinness(corners: &[Point; 4]) -> f64 {
    let longest = longest_edge(corners);
    if longest == 0.0 {
        return 0.0;
    }
    let areas = (0..4).map(|apex| {
        let [p, q, r] = [0, 1, 2].map(|k| corners[k + usize::from(k >= apex)]);
        ((q - p) / longest).cross(&((r - p) / longest)).norm()
    });
    let largest = areas.fold(0.0, f64::max);
    if largest == 0.0 { 0.0 } else { six_volumes(corners, longest).abs() / largest }
}

fn longest_edge([a, b, c, d]: &[Point; 4]) -> f64 {
    [b - a, c - a, d - a, c - b, d - b, d - c].iter().map(Vector::norm).fold(0.0, f64::max)
}

/// Six times the volume, with `unit` as the unit of length.
fn six_volumes([a, b, c, d]: &[Point; 4], unit: f64) -> f64 {
    let [ab, ac, ad] = [b - a, c - a, d - a].map(|e| e / unit);
    ab.cross(&ac).dot(&ad)
}

/// Sorts three numbers. Returns whether that took an even number of swaps.
fn sort(face: &mut [u32; 3]) -> bool {
    let mut even = true;
    for [i, j] in [[0, 1], [1, 2], [0, 1]] {
        if face[i] > face[j] {
            face.swap(i, j);
            even = !even;
        }
    }
    even
}

#[cfg(test)]
mod tests;
