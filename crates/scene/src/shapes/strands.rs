//! A bundle of strands.

use super::limits::{MAX_VERTICES, positive_lengths};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, Vector};
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Strands of equal length, straight or curled, rooted on a plane or on a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Strands {
    /// Number of strands [1]. Default 25.
    pub count: usize,
    /// Length of each along its axis [m]; a curled one is longer along itself. Default 0.3.
    pub length: f64,
    /// Number of edges of each [1]. Default 20.
    pub segments: usize,
    /// What the roots are on. Default `plane`.
    pub root: Root,
    /// Distance of neighboring roots on the plane [m]. Default 0.01.
    pub spacing: f64,
    /// Radius of the sphere [m]. Default 0.1.
    pub radius: f64,
    /// Angle from the sphere's top to the edge of the patch that carries roots [deg], at most 180. Default
    /// 60.
    pub patch: f64,
    /// Radius of the curls [m]; 0 makes straight strands. Default 0.
    pub curl: f64,
    /// Number of turns that a curl makes [1]. Default 5.
    pub turns: f64,
}

/// Where the roots of [`Strands`] are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Root {
    /// On the xy plane, on a square grid about the origin; strands hang down.
    #[default]
    Plane,
    /// On a sphere about the origin, evenly over a patch about its top; strands stand out from it.
    Sphere,
}

impl Default for Strands {
    fn default() -> Self {
        Self {
            count: 25,
            length: 0.3,
            segments: 20,
            root: Root::default(),
            spacing: 0.01,
            radius: 0.1,
            patch: 60.0,
            curl: 0.0,
            turns: 5.0,
        }
    }
}

impl Strands {
    /// The mesh: strand after strand, each from its root on.
    pub fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        for index in 0..self.count {
            let (root, along) = self.root(index);
            // Any direction across will do; curls of neighbors are in step.
            let helper = if along.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
            let across = (helper - along * along.dot(&helper)).normalize();
            let other = along.cross(&across);
            let first = mesh.positions.len() as u32;
            for k in 0..=self.segments {
                let share = k as f64 / self.segments as f64;
                let (sin, cos) = libm::sincos(TAU * self.turns * share);
                // The helix begins at the root.
                let curl = (across * (cos - 1.0) + other * sin) * self.curl;
                mesh.positions.push(root + along * (self.length * share) + curl);
            }
            mesh.strands.extend((first..first + self.segments as u32).map(|v| [v, v + 1]));
        }
        mesh
    }

    /// Root and direction of a strand.
    fn root(&self, index: usize) -> (Point, Vector) {
        match self.root {
            Root::Plane => {
                let columns = (self.count as f64).sqrt().ceil() as usize;
                let rows = self.count.div_ceil(columns);
                let place = |i: usize, n: usize| (i as f64 - 0.5 * (n as f64 - 1.0)) * self.spacing;
                let root = Point::new(place(index % columns, columns), place(index / columns, rows), 0.0);
                (root, -Vector::z())
            }
            Root::Sphere => {
                // A spiral of equal areas: every golden angle a root (Vogel 1979, on the sphere).
                let golden = TAU * (1.0 - 2.0 / (1.0 + 5.0f64.sqrt()));
                let depth = 1.0 - libm::cos(self.patch.to_radians());
                let z = 1.0 - depth * (index as f64 + 0.5) / self.count as f64;
                let (sin, cos) = libm::sincos(golden * index as f64);
                let r = (1.0 - z * z).max(0.0).sqrt();
                let along = Vector::new(r * cos, r * sin, z);
                (Point::from(along * self.radius), along)
            }
        }
    }
}

impl Parameters for Strands {
    fn check(&self, checks: &mut Checks) {
        let mut lengths = vec![("length", self.length)];
        match self.root {
            Root::Plane => lengths.push(("spacing", self.spacing)),
            Root::Sphere => lengths.push(("radius", self.radius)),
        }
        positive_lengths(lengths, checks);
        for (key, count) in [("count", self.count), ("segments", self.segments)] {
            checks.count_at_least(key, count, 1);
        }
        if self.count as f64 * (self.segments as f64 + 1.0) > MAX_VERTICES {
            checks.refuse("count", self.count, format!("must make at most {MAX_VERTICES:e} vertices"));
        }
        if !(self.curl.is_finite() && self.curl >= 0.0) {
            checks.refuse("curl", self.curl, "must be a length in meters, at least 0");
        }
        checks.finite("turns", self.turns);
        if !(self.patch > 0.0 && self.patch <= 180.0) {
            checks.refuse("patch", self.patch, "must lie above 0 and be at most 180 degrees");
        }
    }
}
