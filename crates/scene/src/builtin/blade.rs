use super::{ground, sheet};
use crate::description::Scene;
use crate::obstacle::ObstacleSpec;
use crate::shapes::{Shape, Wedge};

/// 59,405 vertices and 116,640 triangles, after Fig. 22 of the paper. Five sheets, each 1 m wide, 4 cm apart,
/// turned and shifted against each other, start 5 cm above the edge of a blade of 160 cm length, 50 cm height
/// and 2 cm thickness at its base; the edge is a single line of vertices.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 1.0 / (108.0 * scale);
    let blade = Wedge { length: 1.6, thickness: 0.02, height: 0.5, edge: 2.0 * edge };
    let layer = |k: u32| {
        let n = f64::from(k);
        // To alternate sides, so that some sheets slide off to the left and some to the right.
        let side = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let place = [side * (0.03 + 0.02 * n), 0.013 * n - 0.02, 0.55 + 0.04 * n];
        sheet(&format!("sheet{k}"), 1.0, edge, place, 3.0 + 17.0 * n)
    };
    let mut scene = Scene {
        bodies: (0..5).map(layer).collect(),
        obstacles: vec![
            ObstacleSpec {
                name: "blade".to_owned(),
                shape: Some(Shape::Wedge(blade)),
                ..ObstacleSpec::default()
            },
            ground(),
        ],
        ..Scene::default()
    };
    scene.simulation.dt = 0.05;
    scene.simulation.frames = 60;
    scene
}
