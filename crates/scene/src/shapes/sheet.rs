//! A flat rectangle.

use super::mesh::{TriangleMesh, segments};
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};

/// A flat rectangle in the xy plane, centered at the origin, normal z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sheet {
    /// Lengths along x and y [m]. Default (1, 1).
    pub size: [f64; 2],
    /// Length of the edges [m], rounded so that a whole number fits. Smaller: finer folds, more work.
    /// Default 0.02.
    pub edge: f64,
    /// Which way the squares are cut into triangles: `alternating` or `parallel`. Default `alternating`.
    pub diagonals: Diagonals,
}

/// Which way the squares of a [`Sheet`] are cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Diagonals {
    /// Neighboring squares differently: bends alike in both diagonal directions.
    #[default]
    Alternating,
    /// All the same way.
    Parallel,
}

impl Default for Sheet {
    fn default() -> Self {
        Self { size: [1.0, 1.0], edge: 0.02, diagonals: Diagonals::default() }
    }
}

impl Sheet {
    /// The mesh: vertices row by row along x, from the lower corner.
    pub fn mesh(&self) -> TriangleMesh {
        let [nx, ny] = self.size.map(|length| segments(length, self.edge));
        let coordinate = |i: u32, n: u32, length: f64| length * (f64::from(i) / f64::from(n) - 0.5);
        let mut mesh = TriangleMesh::default();
        for j in 0..=ny {
            for i in 0..=nx {
                let (x, y) = (coordinate(i, nx, self.size[0]), coordinate(j, ny, self.size[1]));
                mesh.positions.push(Point::new(x, y, 0.0));
            }
        }
        let vertex = |i: u32, j: u32| j * (nx + 1) + i;
        for j in 0..ny {
            for i in 0..nx {
                let corners = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                let flip = self.diagonals == Diagonals::Alternating && (i + j) % 2 == 1;
                mesh.triangles.extend(cut(corners, flip));
            }
        }
        mesh
    }
}

/// Two triangles of a quadrilateral, cut from its first corner, or from its second.
pub(super) fn cut([a, b, c, d]: [u32; 4], flip: bool) -> [[u32; 3]; 2] {
    if flip { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
}
