//! A closed box.

use super::mesh::{TriangleMesh, segments};
use super::sheet::cut;
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A box about the origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Cuboid {
    /// Lengths along x, y and z [m]. Default (0.5, 0.5, 0.5).
    pub size: [f64; 3],
    /// Length of the edges [m], rounded so that whole numbers fit. Default 0.05.
    pub edge: f64,
}

impl Default for Cuboid {
    fn default() -> Self {
        Self { size: [0.5; 3], edge: 0.05 }
    }
}

impl Cuboid {
    /// The mesh.
    pub fn mesh(&self) -> TriangleMesh {
        let n = self.size.map(|length| segments(length, self.edge));
        let mut mesh = TriangleMesh::default();
        let mut index: BTreeMap<[u32; 3], u32> = BTreeMap::new();
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for upper in [false, true] {
                for j in 0..n[v] {
                    for i in 0..n[u] {
                        let corner = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                            let mut at = [0; 3];
                            (at[axis], at[u], at[v]) = (if upper { n[axis] } else { 0 }, i, j);
                            *index.entry(at).or_insert_with(|| {
                                let place =
                                    |c: usize| self.size[c] * (f64::from(at[c]) / f64::from(n[c]) - 0.5);
                                mesh.positions.push(Point::new(place(0), place(1), place(2)));
                                mesh.positions.len() as u32 - 1
                            })
                        });
                        let [a, b, c, d] = corner;
                        let outward = if upper { [a, b, c, d] } else { [a, d, c, b] };
                        mesh.triangles.extend(cut(outward, (i + j) % 2 == 1));
                    }
                }
            }
        }
        mesh
    }
}
