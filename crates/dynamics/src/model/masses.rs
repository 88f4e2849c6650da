//! Lumped masses.

use super::measures::{area, volume};
use crate::body::{Body, BodyShape};
use bowknot_geometry::Point;

/// Shares of the mass of a quadratic tetrahedron that each corner and each middle of an edge gets: those of
/// the four small tetrahedra at the corners and of the octahedron between them, in equal parts to the
/// vertices of each.
const QUADRATIC_SHARES: [f64; 2] = [1.0 / 32.0, 7.0 / 48.0];

/// Lumped masses [kg]: each element gives equal shares of its mass to its vertices; a quadratic tetrahedron
/// gives [`QUADRATIC_SHARES`].
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
            BodyShape::Particles { vertices, material } => {
                vertices.iter().for_each(|v| share(&[*v], material.mass()));
            }
            BodyShape::Obstacle { .. } => {}
        }
    }
    masses
}
