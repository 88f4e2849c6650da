//! Which bodies Newton's method solves together with their contacts.

use bowknot_scene::BodyKind;
use bowknot_scene::world::World;

/// The vertices of bodies that Newton's method solves together with their contacts, those of bodies `asleep`
/// excepted; that has one entry per body, or none at all.
pub(super) fn solved_vertices<'a>(world: &'a World, asleep: &'a [bool]) -> impl Iterator<Item = usize> + 'a {
    let awake = |body: usize| !asleep.get(body).copied().unwrap_or(false);
    let bodies = world.bodies.iter().enumerate();
    let bodies = bodies.filter(move |(index, body)| body.kind.is_some_and(is_solved) && awake(*index));
    bodies.flat_map(|(_, body)| body.vertices.clone().chain(body.interior.clone())).map(|v| v as usize)
}

/// Whether Newton's method solves bodies of a kind together with their contacts. Rows alone hold grains,
/// which they do exactly.
pub(super) fn is_solved(kind: BodyKind) -> bool {
    kind != BodyKind::Particles
}
