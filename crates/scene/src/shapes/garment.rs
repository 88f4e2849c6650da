//! A garment around the figure: a tube of cloth from the chest or the waist down.

use super::figure::RestBody;
use super::mesh::{TriangleMesh, segments};
use bowknot_errors::{Checks, Parameters};
use bowknot_geometry::Point;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// A tube of cloth around the figure in its rest pose: rings about the z axis, convex and `gap` off the
/// body down to the waist, below it hanging from the hips and widened by `flare` and pleats. Arms are
/// outside of it. Layers that are nested need gaps and flares that grow from the inner to the outer one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Garment {
    /// Length of the edges [m], rounded so that whole numbers fit; at most 0.06. Smaller: finer folds,
    /// more work. Default 0.02.
    pub edge: f64,
    /// Height of the upper end [m], at most 1.28, below the arms. Default 1.255.
    pub top: f64,
    /// Height below which it widens [m]. Default 1.07.
    pub waist: f64,
    /// Height of the lower end [m]. Default 0.45.
    pub hem: f64,
    /// Distance to the body at the start [m]. Default 0.01.
    pub gap: f64,
    /// How much farther from the axis than the body the hem is [m]; 0: as wide as the hips. Default 0.2.
    pub flare: f64,
    /// Growth of the flare from the waist to the hem [1]: 1 a cone, larger ones a trumpet. Default 1.3.
    pub curve: f64,
    /// Number of pleats around [1], at most 200. Default 0.
    pub pleats: u32,
    /// How far the pleats stand out at the hem [m]. Default 0.
    pub pleat_depth: f64,
}

impl Default for Garment {
    fn default() -> Self {
        Self {
            edge: 0.02,
            top: 1.255,
            waist: 1.07,
            hem: 0.45,
            gap: 0.01,
            flare: 0.2,
            curve: 1.3,
            pleats: 0,
            pleat_depth: 0.0,
        }
    }
}

/// Longest edge [m]: the waist still has a dozen corners.
const LONGEST_EDGE: f64 = 0.06;
/// Directions in which the body is measured.
const DIRECTIONS: usize = 360;
/// Distance of the heights at which it is measured [m].
const STEP: f64 = 0.005;
/// Farther from the axis than any part of the body [m].
const OUTSIDE: f64 = 1.0;
/// Smallest radius of curvature of the convex body, that of the waist's sides [m].
const ROUNDEST: f64 = 0.08;

impl Garment {
    /// The mesh: vertices ring by ring from the upper end, each ring at one height.
    pub fn mesh(&self) -> TriangleMesh {
        let profile = Profile::new(self);
        let mut mesh = TriangleMesh::default();
        let mut above: Option<(u32, u32, f64)> = None;
        for (k, z) in self.heights(&profile).into_iter().enumerate() {
            let first = mesh.positions.len() as u32;
            // Vertices stand above the gaps of the ring before.
            let shift = if k % 2 == 1 { 0.5 } else { 0.0 };
            let ring = profile.ring(self, z, shift);
            let count = ring.len() as u32;
            mesh.positions.extend(ring);
            if let Some(above) = above {
                stitch(above, (first, count, shift), &mut mesh.triangles);
            }
            above = Some((first, count, shift));
        }
        mesh
    }

    /// Heights of the rings, evenly spaced along the cloth.
    fn heights(&self, profile: &Profile) -> Vec<f64> {
        let fine = segments(self.top - self.hem, STEP);
        let height = |k: u32| {
            // The ends exactly.
            let s = f64::from(k) / f64::from(fine);
            if k == fine { self.hem } else { self.top + (self.hem - self.top) * s }
        };
        let mean = |z: f64| {
            (0..DIRECTIONS).step_by(10).map(|d| profile.radius(self, angle(d), z)).sum::<f64>()
                / (DIRECTIONS / 10) as f64
        };
        let mut lengths = vec![0.0];
        let mut last = (height(0), mean(height(0)));
        for k in 1..=fine {
            let next = (height(k), mean(height(k)));
            lengths.push(lengths[k as usize - 1] + libm::hypot(next.0 - last.0, next.1 - last.1));
            last = next;
        }
        let whole = lengths[fine as usize];
        // The height of an equilateral triangle.
        let rows = segments(whole, self.edge * 0.75f64.sqrt());
        (0..=rows)
            .map(|row| {
                let at = whole * f64::from(row) / f64::from(rows);
                let k = lengths.partition_point(|l| *l <= at).clamp(1, fine as usize);
                if row == rows {
                    return self.hem;
                }
                let s = (at - lengths[k - 1]) / (lengths[k] - lengths[k - 1]);
                height(k as u32 - 1) + (height(k as u32) - height(k as u32 - 1)) * s
            })
            .collect()
    }

    /// How far below the waist, from 0 to 1 at the hem, as the flare grows.
    fn below(&self, z: f64) -> f64 {
        libm::pow(((self.waist - z) / (self.waist - self.hem)).max(0.0), self.curve)
    }

    /// An area that that of the cloth does not exceed [m^2].
    pub(super) fn area(&self) -> f64 {
        let outward = self.flare + self.pleat_depth;
        // Pleats lengthen a ring by their slopes.
        let around = TAU * (0.35 + self.gap + outward) + 2.0 * f64::from(self.pleats) * self.pleat_depth;
        around * (self.top - self.hem + outward + 0.5)
    }
}

impl Parameters for Garment {
    fn check(&self, checks: &mut Checks) {
        let ranges = [
            ("edge", self.edge, f64::MIN_POSITIVE, LONGEST_EDGE),
            ("top", self.top, 0.05, 1.28),
            ("hem", self.hem, 0.0, 1.28),
            ("gap", self.gap, 1e-3, 0.2),
            ("flare", self.flare, 0.0, 2.0),
            ("curve", self.curve, 0.5, 5.0),
            ("pleats", f64::from(self.pleats), 0.0, 200.0),
            ("pleat_depth", self.pleat_depth, 0.0, 0.5),
        ];
        for (key, value, least, most) in ranges {
            if !(least..=most).contains(&value) {
                let range = if least == f64::MIN_POSITIVE { "above 0" } else { &format!("from {least}") };
                checks.refuse(key, value, format!("must lie {range} to {most}"));
            }
        }
        if self.hem > self.top - 0.05 {
            let allowed = format!("must lie at least 0.05 m below top, which is {} m", self.top);
            checks.refuse("hem", self.hem, allowed);
        }
        if !(self.waist > self.hem && self.waist <= 1.28) {
            checks.refuse("waist", self.waist, "must lie above hem and be at most 1.28 m");
        }
    }
}

fn angle(direction: usize) -> f64 {
    TAU * direction as f64 / DIRECTIONS as f64
}

/// Radii of the body, convex and offset, by height and direction.
struct Profile {
    top: f64,
    radii: Vec<[f64; DIRECTIONS]>,
}

impl Profile {
    fn new(garment: &Garment) -> Self {
        let body = RestBody::new();
        let rows = ((garment.top - garment.hem) / STEP).ceil() as usize + 2;
        // Edges are chords: their middles lie this far inside of the curve that they follow.
        let gap = garment.gap + garment.edge * garment.edge / (8.0 * ROUNDEST);
        let mut radii: Vec<[f64; DIRECTIONS]> =
            (0..rows).into_par_iter().map(|k| section(&body, garment.top - STEP * k as f64, gap)).collect();
        // Below the waist the cloth hangs from the widest place above.
        for k in 1..rows {
            if garment.top - STEP * k as f64 <= garment.waist {
                let above = radii[k - 1];
                radii[k].iter_mut().zip(above).for_each(|(r, above)| *r = r.max(above));
            }
        }
        Self { top: garment.top, radii }
    }

    /// Distance of the cloth from the axis.
    fn radius(&self, garment: &Garment, angle: f64, z: f64) -> f64 {
        let row = ((self.top - z) / STEP).clamp(0.0, self.radii.len() as f64 - 1.001);
        let column = (angle / TAU).rem_euclid(1.0) * DIRECTIONS as f64;
        let (k, d) = (row as usize, column as usize % DIRECTIONS);
        let (u, v) = (row - k as f64, column - column.floor());
        let along = |k: usize| {
            let row = &self.radii[k];
            row[d] + (row[(d + 1) % DIRECTIONS] - row[d]) * v
        };
        let pleat = 0.5 + 0.5 * libm::cos(f64::from(garment.pleats) * angle);
        let pleat = if garment.pleats > 0 { garment.pleat_depth * pleat } else { 0.0 };
        along(k) + (along(k + 1) - along(k)) * u + (garment.flare + pleat) * garment.below(z)
    }

    /// The vertices of a ring: evenly spaced, the first moved by `shift` of their distance.
    fn ring(&self, garment: &Garment, z: f64, shift: f64) -> Vec<Point> {
        let fine = 4 * DIRECTIONS;
        let at = |d: usize| {
            let angle = TAU * d as f64 / fine as f64;
            let radius = self.radius(garment, angle, z);
            Point::new(radius * libm::cos(angle), radius * libm::sin(angle), z)
        };
        let mut lengths = vec![0.0];
        let curve: Vec<Point> = (0..=fine).map(at).collect();
        for d in 0..fine {
            lengths.push(lengths[d] + (curve[d + 1] - curve[d]).norm());
        }
        let count = segments(lengths[fine], garment.edge).max(6);
        (0..count)
            .map(|i| {
                let along = lengths[fine] * (f64::from(i) + shift) / f64::from(count);
                let d = lengths.partition_point(|l| *l <= along).clamp(1, fine);
                let s = (along - lengths[d - 1]) / (lengths[d] - lengths[d - 1]);
                curve[d - 1] + (curve[d] - curve[d - 1]) * s
            })
            .collect()
    }
}

/// For each direction the distance from the axis to the hull of what is nearer than `gap` to the body.
fn section(body: &RestBody, z: f64, gap: f64) -> [f64; DIRECTIONS] {
    let reach: [f64; DIRECTIONS] = std::array::from_fn(|d| {
        let (sin, cos) = libm::sincos(angle(d));
        // Inwards by what the field guarantees to be free.
        let mut radius = OUTSIDE;
        while radius > 0.0 {
            let free = body.field_without_arms(&Point::new(radius * cos, radius * sin, z)) - gap;
            if free < 1e-5 {
                break;
            }
            radius -= free;
        }
        radius.max(0.0)
    });
    // The hull by its supporting lines, one for each direction.
    let cosines: [f64; DIRECTIONS] = std::array::from_fn(|d| libm::cos(angle(d)));
    let between = |d: usize, e: usize| cosines[(d + DIRECTIONS - e) % DIRECTIONS];
    let support: [f64; DIRECTIONS] =
        std::array::from_fn(|d| (0..DIRECTIONS).map(|e| reach[e] * between(d, e)).fold(0.0, f64::max));
    std::array::from_fn(|d| {
        let lines = (0..DIRECTIONS).filter(|e| between(d, *e) > 1e-3);
        lines.map(|e| support[e] / between(d, e)).fold(OUTSIDE, f64::min)
    })
}

/// Triangles between two rings, each given by its first vertex, their number, and the shift of the first
/// along the ring, in distances of its vertices. Of the two edges that could come next the one that ends
/// first is taken.
fn stitch(upper: (u32, u32, f64), lower: (u32, u32, f64), triangles: &mut Vec<[u32; 3]>) {
    let place = |(_, count, shift): (u32, u32, f64), i: u32| (f64::from(i) + shift) / f64::from(count);
    let vertex = |(first, count, _): (u32, u32, f64), i: u32| first + i % count;
    let (mut i, mut j) = (0, 0);
    while i < upper.1 || j < lower.1 {
        let (a, b) = (vertex(upper, i), vertex(lower, j));
        let down = j < lower.1 && (i == upper.1 || place(lower, j + 1) <= place(upper, i + 1));
        if down {
            triangles.push([a, b, vertex(lower, j + 1)]);
            j += 1;
        } else {
            triangles.push([a, b, vertex(upper, i + 1)]);
            i += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_keeps_its_gap_and_faces_outwards_at_every_resolution() {
        let body = RestBody::new();
        for edge in [0.008, 0.02, 0.045, 0.06] {
            let garment = Garment { edge, pleats: 10, pleat_depth: 0.04, hem: 0.2, ..Garment::default() };
            let mesh = garment.mesh();
            let top = mesh.positions.iter().filter(|p| p.z == garment.top).count();
            assert!(top >= 6 && mesh.positions.iter().any(|p| p.z == garment.hem));
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
                let middle = Point::from((a.coords + b.coords + c.coords) / 3.0);
                for p in [a, b, c, middle, nalgebra::center(&a, &b)] {
                    let free = body.field(&p);
                    assert!(free > 0.75 * garment.gap, "edge {edge}: {free} m at {p}");
                }
                let normal = (b - a).cross(&(c - a));
                let outward = bowknot_geometry::Vector::new(middle.x, middle.y, 0.0);
                assert!(normal.dot(&outward) > 0.0, "edge {edge}: at {middle}");
            }
        }
    }

    #[test]
    fn edges_have_about_the_length_asked_for() {
        let garment = Garment { pleats: 12, pleat_depth: 0.05, ..Garment::default() };
        let mesh = garment.mesh();
        let (mut sum, mut shortest, mut longest) = (0.0, f64::INFINITY, 0.0f64);
        for t in &mesh.triangles {
            for k in 0..3 {
                let [a, b] = [t[k], t[(k + 1) % 3]].map(|v| mesh.positions[v as usize]);
                let length = (b - a).norm();
                (sum, shortest, longest) = (sum + length, shortest.min(length), longest.max(length));
            }
        }
        let mean = sum / (3 * mesh.triangles.len()) as f64;
        assert!((mean / garment.edge - 1.0).abs() < 0.05, "{mean}");
        assert!(shortest > 0.6 * garment.edge && longest < 1.6 * garment.edge, "{shortest} {longest}");
    }
}
