//! A sharp wedge.

use super::mesh::{TriangleMesh, segments};
use super::sheet::cut;
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};

/// A wedge such as a blade: a prism along the y axis, centered, its base on the xy plane, its upper edge a
/// single line of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wedge {
    /// Length along y [m]. Default 1.
    pub length: f64,
    /// Thickness of the base along x [m]. Default 0.02.
    pub thickness: f64,
    /// Height of the sharp edge [m]. Default 0.5.
    pub height: f64,
    /// Length of the edges along the blade and down its sides [m], rounded so that whole numbers fit. Default
    /// 0.02.
    pub edge: f64,
}

impl Default for Wedge {
    fn default() -> Self {
        Self { length: 1.0, thickness: 0.02, height: 0.5, edge: 0.02 }
    }
}

impl Wedge {
    /// The mesh: cross-section by cross-section along y; in each the sharp edge's vertex, the left side
    /// downwards, the right side downwards.
    pub fn mesh(&self) -> TriangleMesh {
        let along = segments(self.length, self.edge);
        let down = segments(libm::hypot(self.height, 0.5 * self.thickness), self.edge);
        let mut mesh = TriangleMesh::default();
        for j in 0..=along {
            let y = self.length * (f64::from(j) / f64::from(along) - 0.5);
            mesh.positions.push(Point::new(0.0, y, self.height));
            for side in [-0.5, 0.5] {
                for k in 1..=down {
                    let s = f64::from(k) / f64::from(down);
                    mesh.positions.push(Point::new(side * self.thickness * s, y, self.height * (1.0 - s)));
                }
            }
        }
        let section = 2 * down + 1;
        let left = |j: u32, k: u32| j * section + k;
        let right = |j: u32, k: u32| j * section + if k == 0 { 0 } else { down + k };
        for j in 0..along {
            for k in 0..down {
                let flip = (j + k) % 2 == 1;
                let quad = [left(j, k), left(j + 1, k), left(j + 1, k + 1), left(j, k + 1)];
                mesh.triangles.extend(cut(quad, flip));
                let quad = [right(j, k), right(j, k + 1), right(j + 1, k + 1), right(j + 1, k)];
                mesh.triangles.extend(cut(quad, flip));
            }
            let base = [left(j, down), left(j + 1, down), right(j + 1, down), right(j, down)];
            mesh.triangles.extend(cut(base, j % 2 == 1));
        }
        for (j, front) in [(0, true), (along, false)] {
            for k in 0..down {
                // The uppermost quadrilateral is a triangle.
                let quad = [left(j, k), left(j, k + 1), right(j, k + 1), right(j, k)];
                let triangles =
                    if k == 0 { vec![[quad[0], quad[1], quad[2]]] } else { cut(quad, false).to_vec() };
                let turn = |[a, b, c]: [u32; 3]| if front { [a, b, c] } else { [a, c, b] };
                mesh.triangles.extend(triangles.into_iter().map(turn));
            }
        }
        mesh
    }
}
