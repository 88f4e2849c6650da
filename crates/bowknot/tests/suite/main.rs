//! Integration tests of the facade, in one binary.

/// What a scene lacks, and what is far away, takes no part.
mod absent;
/// The meshes and scenes of `assets`.
mod assets;
/// What users get wrong about kinds, materials, friction and sequences.
mod bad_bodies;
/// What users get wrong, and what they are told.
mod bad_input;
/// Solids, strands, particles, friction and sequences, from scene to motion.
mod bodies;
/// Elements of a caller: carried along, asleep, in checkpoints, and laws that press bodies into each other.
mod custom_elements;
/// Pins, obstacles, forces and bodies changed by code.
mod drive;
/// Linear and quadratic elements of solids.
mod elements;
/// Stretch limits of fabrics, and what overrides them.
mod fabrics;
/// The walking figure, what follows it, and its dresses.
mod figure;
/// The same bits on every machine, on any number of threads.
mod golden;
/// Pins that hold edges over their stretch limits.
mod held_apart;
/// Numbers far out of range at every key of a scene.
mod hostile;
mod integrators;
/// Sets of defaults: what `quick` saves, and that nothing intersects.
mod polygons;
/// Obstacles that appear and vanish.
mod presence;
mod presets;
/// `docs/scene-reference.md` follows the structs.
mod reference;
/// Strands that resist twist: theory, pins, restarts.
mod rods;
/// Output folders: what they hold, resuming, failing.
mod runs;
/// The time-step loop: free motion, pins, obstacles, restarts, threads.
mod simulation;
/// Bodies at rest: falling asleep, waking, what sleep costs.
mod sleep;
/// Shapes and periods of textbooks.
mod theory;

use bowknot::Scene;

/// A scene from TOML without mesh files.
fn scene(text: &str) -> Scene {
    Scene::from_toml(text, "").unwrap_or_else(|error| panic!("{error}"))
}
