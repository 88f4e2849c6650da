use super::{ball, ground, sheet};
use crate::description::Scene;
use crate::motion::Motion;
use crate::obstacle::ObstacleSpec;

/// Of everything with everything.
const FRICTION: f64 = 0.4;

/// 50,176 vertices and 99,458 triangles, after Fig. 18 of the paper. The sheet is 2 m wide and starts 5 cm
/// above a ball of 40 cm radius that turns about the vertical by half a turn a second and drags it along by
/// friction.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 2.0 / (223.0 * scale);
    let mut ball = ball(0.4, 0.4, 2.0 * edge);
    ball.motion = Some(Motion { spin: 180.0, ..Motion::default() });
    ball.friction = FRICTION;
    let mut sheet = sheet("sheet", 2.0, edge, [0.013, 0.007, 0.85], 7.0);
    sheet.friction = FRICTION;
    let mut scene = Scene {
        bodies: vec![sheet],
        obstacles: vec![ball, ObstacleSpec { friction: FRICTION, ..ground() }],
        ..Scene::default()
    };
    scene.simulation.frames = 200;
    scene
}
