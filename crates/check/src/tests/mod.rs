//! Tests of the judge: against an exact oracle, against all pairs, and one by one.

mod motion;
mod oracle;
mod paths;
mod states;

use super::{CheckError, Intersection, Judge, PairClass, Parts, PathOptions, StateOptions};
use bowknot_geometry::{HalfSpace, Point, Vector};

/// Seeded random numbers.
struct Random(fastrand::Rng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    /// Uniform in [-1, 1).
    fn unit(&mut self) -> f64 {
        2.0 * self.0.f64() - 1.0
    }

    fn integer(&mut self, low: i64, high: i64) -> i64 {
        self.0.i64(low..=high)
    }

    fn point(&mut self, scale: f64) -> Point {
        Point::new(scale * self.unit(), scale * self.unit(), scale * self.unit())
    }

    fn vector(&mut self, scale: f64) -> Vector {
        self.point(scale).coords
    }
}

/// A sheet of n x n vertices with unit sides in the plane z = `height`, and its triangles from vertex
/// number `first` on.
fn sheet(n: u32, height: f64, first: u32) -> (Vec<Point>, Vec<[u32; 3]>) {
    let step = 1.0 / (n - 1) as f64;
    let points =
        (0..n * n).map(|i| Point::new((i % n) as f64 * step, (i / n) as f64 * step, height)).collect();
    let mut triangles = Vec::new();
    for y in 0..n - 1 {
        for x in 0..n - 1 {
            let i = first + y * n + x;
            triangles.extend([[i, i + 1, i + n + 1], [i, i + n + 1, i + n]]);
        }
    }
    (points, triangles)
}

fn judge_of(vertex_count: usize, triangles: &[[u32; 3]], strands: &[[u32; 2]], particles: &[u32]) -> Judge {
    Judge::new(&Parts { vertex_count, triangles, strands, particles, ..Parts::default() })
        .expect("valid parts")
}

fn points(list: &[[f64; 3]]) -> Vec<Point> {
    list.iter().map(|&p| Point::from(p)).collect()
}
