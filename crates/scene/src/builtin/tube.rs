use super::twisted_ends;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::shapes::{Shape, Tube};
use bowknot_geometry::Vector;

/// 25,600 vertices and 50,880 triangles, after Fig. 23 of the paper. The tube has 20 cm radius and 125 cm
/// length; its ends are turned against each other by a full turn within 0.8 s while they approach as
/// far as the twist demands, then pushed together within 0.7 s to 35 cm. No gravity.
pub(super) fn scene(scale: f64) -> Scene {
    let around = 160.0;
    let radius = 0.2;
    let edge = std::f64::consts::TAU * radius / around / scale;
    let length = 159.0 * std::f64::consts::TAU * radius / around;
    let body = BodySpec {
        name: "tube".to_owned(),
        shape: Some(Shape::Tube(Tube { radius, length, edge })),
        ..BodySpec::default()
    };
    // The generators of the tube become helices that narrow towards the middle; with the ends this
    // near, none is longer than at rest.
    let twist = [
        (0.0, 0.0, 0.0),
        (0.2, 0.25, 0.02),
        (0.4, 0.5, 0.08),
        (0.6, 0.75, 0.14),
        (0.8, 1.0, 0.2),
        (1.5, 1.0, length - 0.35),
    ];
    let mut scene = Scene { bodies: vec![body], pins: twisted_ends("tube", &twist), ..Scene::default() };
    scene.simulation.frames = 150;
    // Under gravity the tube would swing below its ends rather than bunch up between them.
    scene.environment.gravity = Vector::zeros();
    scene
}
