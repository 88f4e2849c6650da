//! A hand with thin, finely meshed fingers that reaches through the bottom of a sheet with coarse edges.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::sheet;
use bowknot_geometry::{Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{Params, Resolver};
use std::f64::consts::TAU;

/// Edges of the sheet [m].
const SHEET_EDGE: f64 = 0.015;
const RADIUS: f64 = 0.008;
/// Length of a finger [m].
const LENGTH: f64 = 0.07;

/// A closed capsule without its vertices' places: rings of `around` vertices, and a vertex at each end.
struct Finger {
    along: usize,
    around: usize,
}

impl Finger {
    fn with_edges(edge: f64) -> Self {
        let along = (LENGTH / edge).ceil() as usize + 1;
        Self { along, around: ((TAU * RADIUS / edge).ceil() as usize).max(5) }
    }

    /// The finger points from `root` along +x and bends upward by `curl` [rad] over its length.
    fn points(&self, root: Point, curl: f64) -> Vec<Point> {
        let mut points = Vec::new();
        let mut center = root;
        let step = LENGTH / (self.along - 1) as f64;
        let direction = |s: f64| Vector::new((curl * s).cos(), 0.0, (curl * s).sin());
        points.push(center - RADIUS * direction(0.0));
        for ring in 0..self.along {
            let ahead = direction(ring as f64 / (self.along - 1) as f64);
            let up = Vector::new(-ahead.z, 0.0, ahead.x);
            for k in 0..self.around {
                let angle = TAU * k as f64 / self.around as f64;
                points.push(center + RADIUS * (angle.cos() * Vector::y() + angle.sin() * up));
            }
            if ring + 1 < self.along {
                center += step * ahead;
            }
        }
        points.push(center + RADIUS * direction(1.0));
        points
    }

    fn triangles(&self, first: u32, into: &mut Vec<[u32; 3]>) {
        let (along, around) = (self.along as u32, self.around as u32);
        let at = |ring: u32, k: u32| first + 1 + ring * around + k % around;
        let end = first + 1 + along * around;
        for k in 0..around {
            into.push([first, at(0, k + 1), at(0, k)]);
            into.push([end, at(along - 1, k), at(along - 1, k + 1)]);
            for ring in 0..along - 1 {
                into.push([at(ring, k), at(ring, k + 1), at(ring + 1, k)]);
                into.push([at(ring + 1, k), at(ring, k + 1), at(ring + 1, k + 1)]);
            }
        }
    }
}

/// Two-way steps of each of ten time steps in which a hand whose fingers have edges of `edge` rises and
/// bends its fingers.
fn steps(edge: f64) -> Vec<usize> {
    let finger = Finger::with_edges(edge);
    let pose = |time: f64| {
        let roots = (0..4).map(|k| Point::new(0.1, 0.1 + 0.022 * f64::from(k), -0.03 + 0.25 * time));
        let curl = |k: usize| (4.0 + k as f64) * time;
        roots.enumerate().flat_map(|(k, root)| finger.points(root, curl(k))).collect::<Vec<Point>>()
    };
    let (mut x, mut triangles) = (Vec::new(), Vec::new());
    sheet(19, SHEET_EDGE, 0.0, &mut x, &mut triangles);
    let cloth = x.len();
    let hand = pose(0.0);
    for k in 0..4 {
        finger.triangles((cloth + k * hand.len() / 4) as u32, &mut triangles);
    }
    x.extend(hand);
    let bodies = (0..x.len()).map(|v| u32::from(v >= cloth)).collect();
    let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
    let filters = vec![BodyFilter::DEFORMABLE, BodyFilter::OBSTACLE];
    let model = CollisionModel::new(topology, bodies, filters, vec![]).unwrap();
    let mut resolver = Resolver::new(model, &x, &vec![1.0; x.len()], Params::fast()).unwrap();
    let step = |time: usize| {
        let mut y = x.clone();
        y[..cloth].iter_mut().for_each(|p| p.z -= 1e-3);
        y[cloth..].copy_from_slice(&pose(0.02 * time as f64));
        let report = resolver.resolve(&mut x, &y).unwrap();
        assert!(report.converged && report.prescribed_lag_m < 1e-15, "{report:?}");
        report.steps
    };
    (1..=10).map(step).collect()
}

#[test]
fn thin_fingers_with_a_fine_mesh_take_about_as_many_steps_as_coarse_ones() {
    let (coarse, fine) = (steps(0.01), steps(0.002));
    let sum = |steps: &[usize]| steps.iter().sum::<usize>();
    assert!(sum(&coarse) > 15, "the hand must touch the sheet: {coarse:?}");
    assert!(sum(&fine) <= sum(&coarse) + sum(&coarse) / 4, "coarse {coarse:?}, fine {fine:?}");
}
