//! A box of tetrahedra.

use super::limits::{limit_vertices, positive_lengths};
use super::mesh::segments;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Point;
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};

/// A box about the origin, filled with tetrahedra: a grid of cells, each divided into six.
///
/// Each cell has a diagonal that its six tetrahedra share (Kuhn 1960, "Some combinatorial lemmas in
/// topology"). Cells are mirror images of their neighbors, so that their faces agree and no direction is
/// preferred: parallel diagonals make a block twice as stiff in bending. From both ends the first diagonals
/// point inward, so that no tetrahedron has two faces on the surface where there are two cells or more each
/// way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Block {
    /// Lengths along x, y and z [m]. Default (0.2, 0.2, 0.2).
    pub size: [f64; 3],
    /// Length of the edges along the axes [m], rounded so that whole numbers fit. Default 0.04.
    pub edge: f64,
}

impl Default for Block {
    fn default() -> Self {
        Self { size: [0.2; 3], edge: 0.04 }
    }
}

/// Orders in which a path from a cell's corner to the opposite one takes the axes.
const PATHS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

impl Block {
    /// The mesh: tetrahedra of positive volume, vertices along x fastest, then y, then z.
    pub fn mesh(&self) -> Mesh {
        let n = self.cells();
        grid(n, |at| {
            let place = |c: usize| self.size[c] * (f64::from(at[c]) / f64::from(n[c]) - 0.5);
            Point::new(place(0), place(1), place(2))
        })
    }

    fn cells(&self) -> [u32; 3] {
        self.size.map(|length| segments(length, self.edge))
    }
}

impl Parameters for Block {
    fn check(&self, checks: &mut Checks) {
        let lengths = self.size.iter().map(|&s| ("size", s)).chain([("edge", self.edge)]);
        if positive_lengths(lengths, checks) {
            limit_vertices(self.size.iter().map(|s| s / self.edge + 1.0).product(), self.edge, checks);
        }
    }
}

/// A grid of cells, each of six tetrahedra, its vertices placed by `place`, which must keep orientations.
pub(super) fn grid(n: [u32; 3], place: impl Fn([u32; 3]) -> Point) -> Mesh {
    let vertex = |at: [u32; 3]| at[0] + (n[0] + 1) * (at[1] + (n[1] + 1) * at[2]);
    let mut mesh = Mesh::default();
    for z in 0..=n[2] {
        for y in 0..=n[1] {
            mesh.positions.extend((0..=n[0]).map(|x| place([x, y, z])));
        }
    }
    for z in 0..n[2] {
        for y in 0..n[1] {
            for x in 0..n[0] {
                let cell = [x, y, z];
                let upper: [bool; 3] = std::array::from_fn(|c| starts_above(cell[c], n[c]));
                let odd = upper.iter().filter(|u| **u).count() % 2 == 1;
                for (index, path) in PATHS.iter().enumerate() {
                    let mut at: [u32; 3] = std::array::from_fn(|c| cell[c] + u32::from(upper[c]));
                    let mut tet = [vertex(at); 4];
                    for (corner, &axis) in tet[1..].iter_mut().zip(path) {
                        at[axis] = if upper[axis] { at[axis] - 1 } else { at[axis] + 1 };
                        *corner = vertex(at);
                    }
                    // Even permutations and even numbers of mirrored axes keep the orientation.
                    if (index >= 3) != odd {
                        tet.swap(2, 3);
                    }
                    mesh.tets.push(tet);
                }
            }
        }
    }
    mesh
}

/// Whether the diagonals of the cells at `index` of `n` along an axis start at the upper end: not in the
/// first, in the last, and alternately between; about the middle of an odd number two neighbors are alike.
fn starts_above(index: u32, n: u32) -> bool {
    if 2 * index < n { index % 2 == 1 } else { (n - 1 - index).is_multiple_of(2) }
}
