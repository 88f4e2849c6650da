//! An open cylinder.

use super::mesh::{TriangleMesh, segments};
use super::sheet::cut;
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// An open cylinder along the x axis, centered at the origin, normals outward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Tube {
    /// Radius [m]. Default 0.2.
    pub radius: f64,
    /// Length along x [m]. Default 1.
    pub length: f64,
    /// Length of the edges [m], rounded so that whole numbers fit. Smaller: finer folds, more work.
    /// Default 0.02.
    pub edge: f64,
}

impl Default for Tube {
    fn default() -> Self {
        Self { radius: 0.2, length: 1.0, edge: 0.02 }
    }
}

impl Tube {
    /// The mesh: vertices ring by ring from the lower end, 3 a ring at least and an even number above.
    pub fn mesh(&self) -> TriangleMesh {
        // Even, so that alternating diagonals close around.
        let around = 2 * segments(0.5 * TAU * self.radius, self.edge).max(2);
        let along = segments(self.length, self.edge);
        let mut mesh = TriangleMesh::default();
        for j in 0..=along {
            let x = self.length * (f64::from(j) / f64::from(along) - 0.5);
            for i in 0..around {
                let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(around));
                mesh.positions.push(Point::new(x, self.radius * cos, self.radius * sin));
            }
        }
        for j in 0..along {
            for i in 0..around {
                let next = (i + 1) % around;
                let (low, high) = (j * around, (j + 1) * around);
                mesh.triangles.extend(cut([low + i, low + next, high + next, high + i], (i + j) % 2 == 1));
            }
        }
        mesh
    }
}
