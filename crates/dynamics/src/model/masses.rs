//! Lumped masses.

use super::measures::{area, volume};
use crate::body::{Body, BodyShape};
use bowknot_geometry::Point;

/// Shares of the mass of a quadratic tetrahedron that each corner and each middle of an edge gets: those of
/// the four small tetrahedra at the corners and of the octahedron between them, in equal parts to the
/// vertices of each.
const QUADRATIC_SHARES: [f64; 2] = [1.0 / 32.0, 7.0 / 48.0];

/// Smallest share of the mass of a rod's edge that its frame point gets: with less, single systems of a thin rod would
/// have masses too far apart. Twist then travels along a hair at a tenth of its speed, still 100 m/s.
const LEAST_FRAME_SHARE: f64 = 0.01;
/// The largest one.
const LARGEST_FRAME_SHARE: f64 = 0.25;

/// Lumped masses [kg]: each element gives equal shares of its mass to its vertices; a quadratic tetrahedron
/// gives [`QUADRATIC_SHARES`], the edge of a rod [`frame_share`] to its frame point.
pub(super) fn masses(positions: &[Point], bodies: &[Body]) -> Vec<f64> {
    let mut masses = vec![0.0; positions.len()];
    let at = |v: u32| positions[v as usize].coords;
    for body in bodies {
        let mut share = |vertices: &[u32], mass: f64| {
            vertices.iter().for_each(|&v| masses[v as usize] += mass / vertices.len() as f64);
        };
        match &body.shape {
            BodyShape::Cloth { triangles, material } => {
                triangles.iter().for_each(|t| share(t, area(&t.map(at)) * material.density));
            }
            BodyShape::Solid { tets, material } => {
                tets.iter().for_each(|t| share(t, volume(&t.map(at)) * material.density));
            }
            BodyShape::QuadraticSolid { tets, material } => {
                for tet in tets {
                    let mass = volume(&std::array::from_fn(|k| at(tet[k]))) * material.density;
                    for (k, &v) in tet.iter().enumerate() {
                        share(&[v], mass * QUADRATIC_SHARES[usize::from(k >= 4)]);
                    }
                }
            }
            BodyShape::Strands { edges, material } => {
                edges.iter().for_each(|e| share(e, (at(e[0]) - at(e[1])).norm() * material.density));
            }
            BodyShape::Rods { edges, material } => {
                for &[a, b, p] in edges {
                    let length = (at(a) - at(b)).norm();
                    let (mass, own) = (length * material.density, frame_share(material.radius, length));
                    share(&[a, b], mass * (1.0 - own));
                    share(&[p], mass * own);
                }
            }
            BodyShape::Particles { vertices, material } => {
                vertices.iter().for_each(|v| share(&[*v], material.mass()));
            }
            BodyShape::Obstacle { .. } => {}
        }
    }
    masses
}

/// The share of the mass of a rod's edge with which its frame point, at half of the `length`, has the moment of inertia
/// of a round rod about its axis, m r^2 / 2, within limits.
fn frame_share(radius: f64, length: f64) -> f64 {
    (2.0 * (radius / length).powi(2)).clamp(LEAST_FRAME_SHARE, LARGEST_FRAME_SHARE)
}
