//! A plain weave of strands.

use super::limits::{MAX_VERTICES, positive_lengths};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Point;
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A square of plain-woven strands about the origin: warp along x, weft along y, which pass over and under
/// each other in turn, as sine waves.
///
/// Where two cross, their axes lie two amplitudes apart; elsewhere they keep that distance roughly, so that
/// nothing touches at the start if the amplitude is above half the distance of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Woven {
    /// Numbers of strands along x and along y [1]. Default (20, 20).
    pub count: [usize; 2],
    /// Distance of neighboring strands [m]. Default 0.01.
    pub spacing: f64,
    /// Height of the waves over their middle [m]. Default 0.001.
    pub amplitude: f64,
    /// Number of edges from one crossing to the next [1]. Default 4.
    pub segments: usize,
    /// Length by which strands reach beyond the outermost crossings, in `spacing` [1]: whole numbers. Default
    /// 1.
    pub fringe: usize,
}

impl Default for Woven {
    fn default() -> Self {
        Self { count: [20, 20], spacing: 0.01, amplitude: 0.001, segments: 4, fringe: 1 }
    }
}

impl Woven {
    /// The mesh: strand after strand, those along x first, each in the direction of its axis.
    pub fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        for axis in [0, 1] {
            let (strands, crossings) = (self.count[axis], self.count[1 - axis]);
            let edges = self.edges(crossings);
            for strand in 0..strands {
                let first = mesh.positions.len() as u32;
                let across = self.centered(strand as f64, strands);
                for k in 0..=edges {
                    // Counted in crossings: a whole number at each, 0 at the first.
                    let at = k as f64 / self.segments as f64 - self.fringe as f64;
                    let along = self.centered(at, crossings);
                    // One is up where the other is down: at crossing (i, j) the one along x has the sign of
                    // (-1)^(i+j).
                    let sign = if (strand + axis) % 2 == 0 { 1.0 } else { -1.0 };
                    let height = sign * self.amplitude * libm::cos(PI * at);
                    mesh.positions.push(match axis {
                        0 => Point::new(along, across, height),
                        _ => Point::new(across, along, height),
                    });
                }
                mesh.strands.extend((first..first + edges as u32).map(|v| [v, v + 1]));
            }
        }
        mesh
    }

    /// Number of edges of a strand with so many crossings.
    fn edges(&self, crossings: usize) -> usize {
        self.segments * (crossings - 1 + 2 * self.fringe)
    }

    fn centered(&self, index: f64, count: usize) -> f64 {
        (index - 0.5 * (count as f64 - 1.0)) * self.spacing
    }
}

impl Parameters for Woven {
    fn check(&self, checks: &mut Checks) {
        positive_lengths([("spacing", self.spacing), ("amplitude", self.amplitude)], checks);
        let counts = [("count", self.count[0]), ("count", self.count[1]), ("segments", self.segments)];
        let before = checks.error_count();
        for (key, count) in counts {
            checks.count_at_least(key, count, 1);
        }
        if checks.error_count() > before {
            return;
        }
        let [x, y] = self.count.map(|count| count as f64);
        let crossings = 2.0 * x * y + 2.0 * self.fringe as f64 * (x + y);
        if crossings * self.segments as f64 > MAX_VERTICES {
            checks.refuse(
                "count",
                format!("{:?}", self.count),
                format!("must make at most {MAX_VERTICES:e} vertices"),
            );
        }
    }
}
