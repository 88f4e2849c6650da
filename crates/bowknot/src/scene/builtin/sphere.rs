use super::{ball, ground, sheet};
use crate::scene::{Motion, Scene};

/// 5 cm above a ball of 40 cm radius that turns about the vertical by half a turn a second.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 2.0 / (223.0 * scale);
    let mut ball = ball(0.4, 0.4, 2.0 * edge);
    ball.motion = Some(Motion { spin: 180.0, ..Motion::default() });
    let mut scene = Scene {
        bodies: vec![sheet("sheet", 2.0, edge, [0.013, 0.007, 0.85], 7.0)],
        obstacles: vec![ball, ground()],
        ..Scene::default()
    };
    scene.simulation.frames = 200;
    scene
}
