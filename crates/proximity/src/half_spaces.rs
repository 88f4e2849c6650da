//! Vertices near analytic half-spaces, found in a linear pass. A half-space has no radius, so the radius of
//! the vertex counts twice.

use crate::pairs::Pair;
use bowknot_geometry::{CollisionModel, HalfSpace, Point, Vector, separation};
use rayon::prelude::*;

/// Vertices that one task tests.
const CHUNK: usize = 4096;

/// Lists the pairs of deformable vertices and half-spaces, in order, whose certified distance is at most
/// twice the `radius` of the vertex [m]. With `displacements` it lists the pairs that come near at some time
/// of the motion: the distance is linear in time, so it is smallest at the start or at the end.
///
/// The pairs stand in `chunks`, one list after the other.
pub fn near_half_spaces(
    model: &CollisionModel,
    positions: &[Point],
    displacements: Option<&[Vector]>,
    radius: impl Fn(usize) -> f64 + Sync,
    chunks: &mut Vec<Vec<Pair>>,
) {
    let half_spaces = model.half_spaces();
    if half_spaces.is_empty() {
        return chunks.clear();
    }
    let vertices = &model.topology().surface_vertices;
    chunks.resize_with(vertices.len().div_ceil(CHUNK), Vec::new);
    vertices.par_chunks(CHUNK).zip(chunks.par_iter_mut()).for_each(|(vertices, found)| {
        found.clear();
        for &v in vertices.iter().filter(|&&v| !model.is_obstacle(v)) {
            let start = positions[v as usize];
            let end = displacements.map(|u| start + u[v as usize]);
            let radius = 2.0 * radius(v as usize);
            for (half_space, index) in half_spaces.iter().zip(0..).filter(|(plane, _)| !plane.is_empty()) {
                // Each coordinate of the end is off by up to half a unit in its last place.
                let reaches =
                    |end: Point| is_near(half_space, &end, radius + f64::EPSILON * end.coords.abs().sum());
                if is_near(half_space, &start, radius) || end.is_some_and(reaches) {
                    found.push(Pair { elements: [v, index], vertices: [v; 4] });
                }
            }
        }
    });
}

#[inline]
fn is_near(half_space: &HalfSpace, point: &Point, radius: f64) -> bool {
    // Far above any rounding error, so most vertices need no certified width.
    let slack = 1e-9 * (1.0 + half_space.offset.abs() + point.coords.abs().sum());
    let distance = half_space.signed_distance(point);
    distance <= 2.0 * (radius + slack) && separation::separate_half_space(point, half_space).width <= radius
}
