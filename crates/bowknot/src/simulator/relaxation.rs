//! Relaxation of time steps whose iterations oscillate.

use super::solved::solved_vertices;
use bowknot_geometry::Point;
use bowknot_scene::world::World;

/// Share of the way to a target that is taken where the iterations oscillate. Contacts have the normals of
/// the state before, so that bodies pressed together overshoot, to one side and the other in turn.
const RELAXATION: f64 = 0.5;

/// Moves the target `y` back towards `x`, at the vertices that Newton's method solves with their contacts and
/// that are not prescribed.
pub(super) fn relax_target(world: &World, x: &[Point], y: &mut [Point], prescribed: &[bool]) {
    for v in solved_vertices(world, &[]).filter(|&v| !prescribed[v]) {
        y[v] = x[v] + (y[v] - x[v]) * RELAXATION;
    }
}
