//! A closed cone.

use super::mesh::{TriangleMesh, segments};
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A cone on the xy plane: the base about the origin, the tip, a single vertex, above it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Cone {
    /// Radius of the base [m]. Default 0.02.
    pub radius: f64,
    /// Height of the tip [m]. Default 0.5.
    pub height: f64,
    /// Length of the edges along the side and across the base [m], rounded so that whole numbers fit.
    /// Default 0.02.
    pub edge: f64,
    /// Number of corners of the cross-section [1], from 3 to 1000. Larger: rounder. Default 12.
    pub sides: u32,
}

impl Default for Cone {
    fn default() -> Self {
        Self { radius: 0.02, height: 0.5, edge: 0.02, sides: 12 }
    }
}

impl Cone {
    /// The mesh: the tip, rings from the tip down to the rim, rings across the base, its center.
    pub fn mesh(&self) -> TriangleMesh {
        let n = self.sides.clamp(3, 1000);
        let down = segments(libm::hypot(self.radius, self.height), self.edge);
        let across = segments(self.radius, self.edge);
        let mut mesh = TriangleMesh::default();
        mesh.positions.push(Point::new(0.0, 0.0, self.height));
        // Radius and height of each ring; the base's inner rings follow those of the side.
        let side = (1..=down).map(|k| {
            let s = f64::from(k) / f64::from(down);
            (self.radius * s, self.height * (1.0 - s))
        });
        let base = (1..across).map(|k| (self.radius * (1.0 - f64::from(k) / f64::from(across)), 0.0));
        let mut rings = 0;
        for (radius, z) in side.chain(base) {
            for i in 0..n {
                let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(n));
                mesh.positions.push(Point::new(radius * cos, radius * sin, z));
            }
            rings += 1;
        }
        let center = mesh.positions.len() as u32;
        mesh.positions.push(Point::origin());
        for i in 0..n {
            let next = (i + 1) % n;
            mesh.triangles.push([0, 1 + i, 1 + next]);
            for ring in 0..rings - 1 {
                let (upper, lower) = (1 + ring * n, 1 + (ring + 1) * n);
                mesh.triangles.push([upper + i, lower + i, lower + next]);
                mesh.triangles.push([upper + i, lower + next, upper + next]);
            }
            let last = 1 + (rings - 1) * n;
            mesh.triangles.push([last + i, center, last + next]);
        }
        mesh
    }
}
