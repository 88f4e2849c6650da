use super::{ball, ground, sheet};
use crate::description::Scene;

/// 2,601 vertices. The sheet is 1 m wide and starts 10 cm above a ball of 25 cm radius, a little off its
/// middle and turned, so that the folds are not symmetric.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 0.02 / scale;
    let mut scene = Scene {
        bodies: vec![sheet("sheet", 1.0, edge, [0.004, 0.002, 0.6], 7.0)],
        obstacles: vec![ball(0.25, 0.25, edge), ground()],
        ..Scene::default()
    };
    scene.simulation.frames = 100;
    scene
}
