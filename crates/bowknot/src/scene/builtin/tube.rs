use crate::scene::{BodySpec, Keyframe, Motion, PinSpec, Scene, Side};
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
    // Each end does half of everything.
    let end = |side: Side, sign: f64| {
        let at = |time: f64, turn: f64, approach: f64| Keyframe {
            time,
            translate: Vector::new(-0.5 * sign * approach, 0.0, 0.0),
            angle: 180.0 * sign * turn,
        };
        // The generators of the tube become helices that narrow towards the middle; with the ends this
        // near, none is longer than at rest.
        let keyframes = vec![
            at(0.0, 0.0, 0.0),
            at(0.2, 0.25, 0.02),
            at(0.4, 0.5, 0.08),
            at(0.6, 0.75, 0.14),
            at(0.8, 1.0, 0.2),
            at(1.5, 1.0, length - 0.35),
        ];
        PinSpec {
            body: "tube".to_owned(),
            side: Some(side),
            motion: Some(Motion { axis: Vector::x(), keyframes, ..Motion::default() }),
            ..PinSpec::default()
        }
    };
    let mut scene = Scene {
        bodies: vec![body],
        pins: vec![end(Side::XMin, -1.0), end(Side::XMax, 1.0)],
        ..Scene::default()
    };
    scene.simulation.frames = 150;
    // Under gravity the tube would swing below its ends rather than bunch up between them.
    scene.dynamics.gravity = Vector::zeros();
    scene
}
