//! A ball of tetrahedra.

use super::block::grid;
use super::limits::{limit_vertices, positive_lengths};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, Vector};
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// A ball about the origin, filled with tetrahedra: the grid of a cube, each of its shells moved to a sphere.
///
/// On a shell the grid's lines are equal angles apart (the equiangular cubed sphere, Ronchi, Iacono and
/// Paolucci 1996), so that edges differ by less than a factor of two.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TetBall {
    /// Radius [m]. Default 0.1.
    pub radius: f64,
    /// Length of the edges along the surface [m], rounded so that an even number fits a quarter circle.
    /// Default 0.03.
    pub edge: f64,
}

impl Default for TetBall {
    fn default() -> Self {
        Self { radius: 0.1, edge: 0.03 }
    }
}

impl TetBall {
    /// The mesh: tetrahedra of positive volume.
    pub fn mesh(&self) -> Mesh {
        let half = (FRAC_PI_4 * self.radius / self.edge).round().clamp(1.0, 1e6);
        let n = 2 * half as u32;
        grid([n; 3], |at| {
            let place = Vector::from(at.map(|i| f64::from(i) / half - 1.0));
            let shell = place.amax();
            if shell == 0.0 {
                return Point::origin();
            }
            let direction = place.map(|c| libm::tan(FRAC_PI_4 * c / shell));
            Point::from(direction * (self.radius * shell / direction.norm()))
        })
    }
}

impl Parameters for TetBall {
    fn check(&self, checks: &mut Checks) {
        if positive_lengths([("radius", self.radius), ("edge", self.edge)], checks) {
            limit_vertices((FRAC_PI_2 * self.radius / self.edge + 1.0).powi(3), self.edge, checks);
        }
    }
}
