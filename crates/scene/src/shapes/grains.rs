//! Particles in a box.

use super::limits::{MAX_VERTICES, positive_lengths};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::{Point, Vector};
use bowknot_io::Mesh;
use serde::{Deserialize, Serialize};

/// Particles about the origin on a cubic lattice, each moved off its place by a little, differently but
/// always alike.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Grains {
    /// Numbers along x, y and z [1]. Default 10 each.
    pub count: [usize; 3],
    /// Distance of neighbors on the lattice [m]; at least the grain size, so that none begins inside of
    /// another. Default 0.01.
    pub spacing: f64,
    /// Largest displacement off the lattice along each axis [1], in `spacing`, below 0.5. It breaks the
    /// symmetry by which grains would balance on each other. Default 0.05.
    pub jitter: f64,
    /// Which of the random patterns [1]. Default 0.
    pub seed: u64,
}

impl Default for Grains {
    fn default() -> Self {
        Self { count: [10; 3], spacing: 0.01, jitter: 0.05, seed: 0 }
    }
}

impl Grains {
    /// The mesh: particles along x fastest, then y, then z.
    pub fn mesh(&self) -> Mesh {
        let [nx, ny, nz] = self.count;
        let mut random = Random(self.seed);
        let mut mesh = Mesh::default();
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    let place = |i: usize, n: usize| i as f64 - 0.5 * (n as f64 - 1.0);
                    let lattice = Vector::new(place(x, nx), place(y, ny), place(z, nz));
                    let off = Vector::from([0; 3].map(|_| self.jitter * (2.0 * random.next() - 1.0)));
                    mesh.particles.push(mesh.positions.len() as u32);
                    mesh.positions.push(Point::from((lattice + off) * self.spacing));
                }
            }
        }
        mesh
    }
}

impl Parameters for Grains {
    fn check(&self, checks: &mut Checks) {
        positive_lengths([("spacing", self.spacing)], checks);
        if self.count.contains(&0) {
            checks.refuse("count", format!("{:?}", self.count), "must be at least 1 each way");
        }
        if self.count.iter().map(|&n| n as f64).product::<f64>() > MAX_VERTICES {
            checks.refuse(
                "count",
                format!("{:?}", self.count),
                format!("must make at most {MAX_VERTICES:e} particles"),
            );
        }
        if !(0.0..0.5).contains(&self.jitter) {
            checks.refuse("jitter", self.jitter, "must lie from 0 to below 0.5");
        }
    }
}

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    /// The next number, in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
