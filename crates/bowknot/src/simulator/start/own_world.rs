//! Whether a world that a caller has made is one of its scene.

use bowknot_scene::world::World;
use bowknot_scene::{Scene, SceneError};

/// Refuses a world of other bodies than the scene has, or whose lists differ in length.
pub(crate) fn check_world(world: &World, scene: &Scene) -> Result<(), SceneError> {
    let of_scene = scene.bodies.iter().map(|body| &body.name);
    let mut of_scene: Vec<&String> = of_scene.chain(scene.obstacles.iter().map(|o| &o.name)).collect();
    let mut of_world: Vec<&String> = world.names().collect();
    of_scene.sort_unstable();
    of_world.sort_unstable();
    if of_scene != of_world {
        let message = format!("the world has the bodies {of_world:?}, but the scene {of_scene:?}");
        return Err(SceneError::Model(message));
    }
    let (vertices, collide) = (world.positions.len(), world.collision_vertices());
    for (what, given, expected) in [
        ("positions", vertices, vertices.max(collide)),
        ("velocities", world.velocities.len(), vertices),
        ("base", world.base.len(), collide),
        ("half_space_presence", world.half_space_presence.len(), world.half_space_names.len()),
    ] {
        if given != expected {
            let message = format!("the world's {what} has {given} entries, but must have {expected}");
            return Err(SceneError::Model(message));
        }
    }
    let is_gone = |v: &&u32| **v as usize >= vertices;
    match world.pins.iter().find_map(|pin| Some((pin, pin.vertices.iter().find(is_gone)?))) {
        Some((pin, v)) => Err(SceneError::Model(format!("{} holds vertex {v} of {vertices}", pin.name))),
        None => Ok(()),
    }
}
