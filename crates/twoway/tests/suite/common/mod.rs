//! Meshes and a plain time integrator for the tests.

use bowknot_geometry::{Point, Vector};
use bowknot_twoway::{ResolveInput, Resolver, Statistics};

mod draw;
mod sheet;

pub use draw::Draw;
pub use sheet::sheet;

/// Bodies that move freely between contacts: y = x + dt v + dt^2 g, then v from the resolved positions.
pub struct Flight {
    pub resolver: Resolver,
    pub x: Vec<Point>,
    pub v: Vec<Vector>,
    pub gravity: Vector,
    pub dt: f64,
}

impl Flight {
    /// A time step. `keyframe` gives the target of a prescribed vertex.
    pub fn step(&mut self, keyframe: impl Fn(usize, &Point) -> Option<Point>) -> Statistics {
        let dt = self.dt;
        let mut prescribed = vec![false; self.x.len()];
        let y: Vec<Point> = (0..self.x.len())
            .map(|i| match keyframe(i, &self.x[i]) {
                Some(place) => {
                    prescribed[i] = true;
                    place
                }
                None => self.x[i] + dt * self.v[i] + dt * dt * self.gravity,
            })
            .collect();
        let start = self.x.clone();
        let input = ResolveInput { prescribed: &prescribed, time_step: Some(dt), ..ResolveInput::default() };
        let report = self
            .resolver
            .resolve_with(&mut self.x, &y, &input, &mut ())
            .expect("the meshes and numbers of the tests are valid");
        for (v, (x, start)) in self.v.iter_mut().zip(self.x.iter().zip(&start)) {
            *v = (x - start) / dt;
        }
        report
    }

    /// Mean velocity of the first `count` vertices.
    pub fn velocity(&self, count: usize) -> Vector {
        self.v[..count].iter().sum::<Vector>() / count as f64
    }
}

/// Distances that share no code with the crates: closed forms by cases, each candidate a true pair of points.
pub mod brute_force {
    use bowknot_geometry::{Point, Topology};

    pub fn point_segment(p: &Point, a: &Point, b: &Point) -> f64 {
        let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (p - (a + t * (b - a))).norm()
    }

    pub fn point_triangle(p: &Point, t: [&Point; 3]) -> f64 {
        let edges = (0..3).map(|k| point_segment(p, t[k], t[(k + 1) % 3])).fold(f64::INFINITY, f64::min);
        let n = (t[1] - t[0]).cross(&(t[2] - t[0]));
        let inside = (0..3).all(|k| n.dot(&(t[(k + 1) % 3] - t[k]).cross(&(p - t[k]))) >= 0.0);
        if inside { edges.min((n.dot(&(p - t[0])) / n.norm()).abs()) } else { edges }
    }

    pub fn segment_segment(a: [&Point; 2], b: [&Point; 2]) -> f64 {
        let ends = [
            point_segment(a[0], b[0], b[1]),
            point_segment(a[1], b[0], b[1]),
            point_segment(b[0], a[0], a[1]),
            point_segment(b[1], a[0], a[1]),
        ];
        let ends = ends.into_iter().fold(f64::INFINITY, f64::min);
        let (u, v, w) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
        let (uu, uv, vv, uw, vw) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
        let det = uu * vv - uv * uv;
        let (s, t) = ((uv * vw - vv * uw) / det, (uu * vw - uv * uw) / det);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            ends.min((w + s * u - t * v).norm())
        } else {
            ends
        }
    }

    /// Calls `visit` with the vertices of every pair of primitives that share none, and their distance.
    pub fn pairs(topology: &Topology, x: &[Point], mut visit: impl FnMut(&[u32], &[u32], f64)) {
        let at = |v: u32| &x[v as usize];
        for &v in &topology.surface_vertices {
            for t in topology.triangles.iter().filter(|t| !t.contains(&v)) {
                visit(&[v], t, point_triangle(at(v), t.map(at)));
            }
            for &p in topology.particles.iter().filter(|p| **p != v) {
                visit(&[v], &[p], (at(v) - at(p)).norm());
            }
        }
        for (i, a) in topology.edges.iter().enumerate() {
            for b in topology.edges[..i].iter().filter(|b| !b.iter().any(|v| a.contains(v))) {
                visit(a, b, segment_segment(a.map(at), b.map(at)));
            }
            for &p in &topology.particles {
                visit(&[p], a, point_segment(at(p), at(a[0]), at(a[1])));
            }
        }
    }
}
