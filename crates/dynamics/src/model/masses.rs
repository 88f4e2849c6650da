//! Lumped masses.

use super::measures::{area, volume};
use crate::body::{Body, BodyShape};
use bowknot_geometry::Point;

/// Lumped masses [kg]: each element gives equal shares of its mass to its vertices.
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
