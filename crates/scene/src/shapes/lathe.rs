//! A surface of revolution.

use super::mesh::{TriangleMesh, segments};
use super::sheet::cut;
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Point;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A profile turned about the z axis: a funnel, a bowl, a ring. A closed profile makes a solid wall with
/// normals outward; an open one a sheet without thickness, met from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Lathe {
    /// Corners of the profile as (distance from the axis, height) [m], joined by straight lines; distances
    /// above 0, and no two neighbors alike. Default: a ring of square cross-section.
    pub profile: Vec<[f64; 2]>,
    /// Whether the last corner is joined to the first. Default true.
    pub closed: bool,
    /// Length of the edges along the profile, and around where the profile is widest [m], rounded so that
    /// whole numbers fit. Default 0.02.
    pub edge: f64,
}

impl Default for Lathe {
    fn default() -> Self {
        Self { profile: vec![[0.2, 0.0], [0.25, 0.0], [0.25, 0.05], [0.2, 0.05]], closed: true, edge: 0.02 }
    }
}

impl Lathe {
    /// The mesh: ring by ring along the profile.
    pub fn mesh(&self) -> TriangleMesh {
        let profile = self.resampled();
        let widest = profile.iter().fold(0.0f64, |m, p| m.max(p[0]));
        // Even, so that alternating diagonals close around.
        let around = 2 * segments(0.5 * TAU * widest, self.edge).max(2);
        let mut mesh = TriangleMesh::default();
        for [radius, z] in &profile {
            for i in 0..around {
                let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(around));
                mesh.positions.push(Point::new(radius * cos, radius * sin, *z));
            }
        }
        let rings = profile.len() as u32;
        // Counter-clockwise in the half-plane is outward; a clockwise profile is turned over.
        let turned = self.closed && doubled_area(&profile) < 0.0;
        for j in 0..if self.closed { rings } else { rings - 1 } {
            let (this, following) = (j * around, (j + 1) % rings * around);
            for i in 0..around {
                let next = (i + 1) % around;
                let mut quad = [this + i, this + next, following + next, following + i];
                if turned {
                    quad.reverse();
                }
                mesh.triangles.extend(cut(quad, (i + j) % 2 == 1));
            }
        }
        mesh
    }

    /// Length of the profile [m].
    pub fn profile_length(&self) -> f64 {
        self.sides().map(|(a, b)| libm::hypot(b[0] - a[0], b[1] - a[1])).sum()
    }

    /// Neighboring corners.
    fn sides(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
        let n = self.profile.len();
        let count = if self.closed { n } else { n.saturating_sub(1) };
        (0..count).map(move |k| (self.profile[k], self.profile[(k + 1) % n]))
    }

    fn resampled(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for (a, b) in self.sides() {
            let n = segments(libm::hypot(b[0] - a[0], b[1] - a[1]), self.edge);
            for k in 0..n {
                let s = f64::from(k) / f64::from(n);
                points.push([a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s]);
            }
        }
        if !self.closed {
            points.extend(self.profile.last());
        }
        points
    }
}

impl Parameters for Lathe {
    fn check(&self, checks: &mut Checks) {
        let least = if self.closed { 3 } else { 2 };
        if self.profile.len() < least {
            let corners = format!("{} corners", self.profile.len());
            checks.refuse("profile", corners, format!("must be at least {least}"));
        }
        for (index, [radius, z]) in self.profile.iter().enumerate() {
            if !(radius.is_finite() && *radius > 0.0 && z.is_finite()) {
                let corner = format!("corner {index} at ({radius}, {z})");
                let allowed = "must have a distance from the axis above 0 and a finite height";
                checks.refuse("profile", corner, allowed);
            }
        }
        if let Some(index) = self.sides().position(|(a, b)| a == b) {
            let next = (index + 1) % self.profile.len();
            checks.refuse("profile", format!("corners {index} and {next}"), "must not be the same point");
        }
    }
}

/// Twice the area that a closed profile encloses, positive if it runs counter-clockwise.
fn doubled_area(profile: &[[f64; 2]]) -> f64 {
    let next = |k: usize| profile[(k + 1) % profile.len()];
    profile.iter().enumerate().map(|(k, a)| a[0] * next(k)[1] - a[1] * next(k)[0]).sum()
}
