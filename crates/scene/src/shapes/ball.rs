//! A closed sphere.

use super::mesh::{TriangleMesh, segments};
use bowknot_geometry::{Point, Vector};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A sphere about the origin: an icosahedron whose faces are divided evenly and moved out to the
/// radius, so that triangles are of nearly equal size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ball {
    /// Radius [m]. Default 0.25.
    pub radius: f64,
    /// Length of the edges [m], rounded so that a whole number fits. Smaller: rounder. Default 0.02.
    pub edge: f64,
}

impl Default for Ball {
    fn default() -> Self {
        Self { radius: 0.25, edge: 0.02 }
    }
}

/// Edge length of the icosahedron in a unit sphere.
const EDGE: f64 = 1.051_462_224_238_267_2;

/// Faces of the icosahedron, counter-clockwise from outside: vertex 0 is the north pole, 1-5 and 6-10
/// the two rings, 11 the south pole.
const FACES: [[u32; 3]; 20] = [
    [0, 1, 2],
    [0, 2, 3],
    [0, 3, 4],
    [0, 4, 5],
    [0, 5, 1],
    [1, 6, 2],
    [2, 6, 7],
    [2, 7, 3],
    [3, 7, 8],
    [3, 8, 4],
    [4, 8, 9],
    [4, 9, 5],
    [5, 9, 10],
    [5, 10, 1],
    [1, 10, 6],
    [6, 11, 7],
    [7, 11, 8],
    [8, 11, 9],
    [9, 11, 10],
    [10, 11, 6],
];

impl Ball {
    /// The mesh: 10 n^2 + 2 vertices, n the number of segments that an edge of the icosahedron has.
    pub fn mesh(&self) -> TriangleMesh {
        let n = segments(EDGE * self.radius, self.edge);
        let corners = corners();
        let mut mesh = TriangleMesh::default();
        // Vertices on shared edges and corners, by the corners that they lie between and their weights.
        let mut shared: BTreeMap<[(u32, u32); 3], u32> = BTreeMap::new();
        for face in FACES {
            let mut index = BTreeMap::new();
            for j in 0..=n {
                for i in 0..=n - j {
                    let weights = [n - i - j, i, j];
                    let mut key: [(u32, u32); 3] = std::array::from_fn(|c| match weights[c] {
                        0 => (u32::MAX, 0),
                        weight => (face[c], weight),
                    });
                    key.sort_unstable();
                    let vertex = *shared.entry(key).or_insert_with(|| {
                        // Summed in the order of the key: the same bits from either face.
                        let sum = key
                            .iter()
                            .filter(|(_, weight)| *weight > 0)
                            .fold(Vector::zeros(), |sum: Vector, &(c, w)| {
                                sum + corners[c as usize] * f64::from(w)
                            });
                        mesh.positions.push(Point::from(sum.normalize() * self.radius));
                        mesh.positions.len() as u32 - 1
                    });
                    index.insert((i, j), vertex);
                }
            }
            for j in 0..n {
                for i in 0..n - j {
                    mesh.triangles.push([index[&(i, j)], index[&(i + 1, j)], index[&(i, j + 1)]]);
                    if i + j + 1 < n {
                        mesh.triangles.push([index[&(i + 1, j)], index[&(i + 1, j + 1)], index[&(i, j + 1)]]);
                    }
                }
            }
        }
        mesh
    }
}

fn corners() -> [Vector; 12] {
    let z = 1.0 / 5.0f64.sqrt();
    let r = 2.0 * z;
    std::array::from_fn(|c| match c {
        0 => Vector::z(),
        11 => -Vector::z(),
        _ => {
            let lower = c > 5;
            let turn = ((c - 1) % 5) as f64 + if lower { 0.5 } else { 0.0 };
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * turn / 5.0);
            Vector::new(r * cos, r * sin, if lower { -z } else { z })
        }
    })
}
