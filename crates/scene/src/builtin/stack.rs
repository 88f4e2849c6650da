use super::{ball, ground, sheet};
use crate::description::Scene;

/// 8,836 vertices: four sheets, each 1 m wide, 4 cm apart and turned against each other.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 1.0 / (46.0 * scale);
    let layer = |k: u32| {
        let offset = 0.003 * f64::from(k);
        let place = [offset - 0.004, 0.005 - offset, 0.55 + 0.04 * f64::from(k)];
        sheet(&format!("sheet{k}"), 1.0, edge, place, 4.0 + 23.0 * f64::from(k))
    };
    let mut scene = Scene {
        bodies: (0..4).map(layer).collect(),
        obstacles: vec![ball(0.25, 0.25, edge), ground()],
        ..Scene::default()
    };
    scene.simulation.frames = 120;
    scene
}
