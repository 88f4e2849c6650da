use super::{ground, sheet};
use crate::description::Scene;
use crate::obstacle::ObstacleSpec;
use crate::shapes::{Cone, Shape};

/// 10,201 vertices and 20,000 triangles, after Fig. 9 and 17 of the paper. The sheet is 1 m wide and
/// starts 15 cm above a needle of 50 cm height and 2 cm base radius, its tip a single vertex.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 0.01 / scale;
    let cone = Cone { radius: 0.02, height: 0.5, edge: 2.0 * edge, sides: 12 };
    let needle =
        ObstacleSpec { name: "needle".to_owned(), shape: Some(Shape::Cone(cone)), ..ObstacleSpec::default() };
    let mut scene = Scene {
        bodies: vec![sheet("sheet", 1.0, edge, [0.013, 0.007, 0.65], 0.0)],
        obstacles: vec![needle, ground()],
        ..Scene::default()
    };
    scene.simulation.dt = 0.05;
    scene.simulation.frames = 40;
    scene
}
