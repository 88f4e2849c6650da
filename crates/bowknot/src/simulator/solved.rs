//! Which bodies Newton's method solves together with their contacts.

use bowknot_scene::BodyKind;
use bowknot_scene::world::World;

/// The vertices of bodies that Newton's method solves together with their contacts.
pub(super) fn solved_vertices(world: &World) -> impl Iterator<Item = usize> + '_ {
    let bodies = world.bodies.iter().filter(|body| body.kind.is_some_and(is_solved));
    bodies.flat_map(|body| body.vertices.clone().chain(body.interior.clone())).map(|v| v as usize)
}

/// Whether Newton's method solves bodies of a kind together with their contacts. Rows alone hold grains,
/// which they do exactly.
pub(super) fn is_solved(kind: BodyKind) -> bool {
    kind != BodyKind::Particles
}
