//! Which bodies Newton's method solves together with their contacts.
//!
//! Rows of the collision stage hold grains exactly, as these have no forces but those of contacts: where a scene has grains
//! alone, rows do it at a fifth of the cost. Beside bodies that deform, Newton's method solves grains too. What lies on a grain
//! presses through it on the body below; if rows passed that on, they and Newton's method would move the body in turn for ever.

use bowknot_scene::BodyKind;
use bowknot_scene::world::World;

/// The vertices of bodies that Newton's method solves together with their contacts, those of bodies `asleep`
/// excepted; that has one entry per body, or none at all.
pub(super) fn solved_vertices<'a>(world: &'a World, asleep: &'a [bool]) -> impl Iterator<Item = usize> + 'a {
    let kinds = || world.bodies.iter().filter_map(|body| body.kind);
    let any = kinds().any(|kind| kind != BodyKind::Particles);
    let awake = |body: usize| !asleep.get(body).copied().unwrap_or(false);
    let bodies = world.bodies.iter().enumerate();
    let bodies = bodies.filter(move |(index, body)| any && body.kind.is_some() && awake(*index));
    bodies.flat_map(|(_, body)| body.vertices.clone().chain(body.interior.clone())).map(|v| v as usize)
}
