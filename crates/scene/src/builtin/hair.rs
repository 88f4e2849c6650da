use super::ball;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::motion::{Keyframe, Motion};
use crate::pin::PinSpec;
use crate::shapes::{Root, Shape, Strands};
use bowknot_dynamics::StrandMaterial;
use bowknot_geometry::Vector;

/// 63,000 vertices and 62,000 edges, after Fig. 7c and 7d of the paper: 1,000 locks of 100 hairs each, 30 cm
/// long, stand out from the upper side of a ball of 10 cm radius, fall over it and swing as it shakes about
/// the vertical, 70 degrees to either side. A lock has the stiffness of its hairs, and stretches by 2 % at most.
pub(super) fn scene(scale: f64) -> Scene {
    let segments = (62.0 * scale).round().max(4.0) as usize;
    let count = (1000.0 * scale).round().max(8.0) as usize;
    let (radius, length) = (0.1, 0.3);
    // The roots stand off the ball, whose own edges lie below its sphere, by some contact distances.
    let strands = Strands {
        count,
        length,
        segments,
        root: Root::Sphere,
        radius: radius + 0.002,
        patch: 100.0,
        ..Strands::default()
    };
    let hair = BodySpec {
        name: "hair".to_owned(),
        kind: BodyKind::Strands,
        shape: Some(Shape::Strands(strands)),
        material: Material::Strands(StrandMaterial::lock()),
        stretch_limit: Some(1.02),
        translate: Vector::new(0.0, 0.0, 0.5),
        ..BodySpec::default()
    };
    let shake = |time: f64, angle: f64| Keyframe { time, angle, ..Keyframe::default() };
    let motion = Motion {
        keyframes: vec![
            shake(0.8, 0.0),
            shake(1.1, 70.0),
            shake(1.5, -70.0),
            shake(1.9, 70.0),
            shake(2.3, -70.0),
            shake(2.6, 0.0),
        ],
        ..Motion::default()
    };
    let mut head = ball(radius, 0.5, 0.01);
    head.name = "head".to_owned();
    head.motion = Some(motion.clone());
    let roots = PinSpec { body: "hair".to_owned(), roots: 2, motion: Some(motion), ..PinSpec::default() };
    let mut scene =
        Scene { bodies: vec![hair], obstacles: vec![head], pins: vec![roots], ..Scene::default() };
    scene.simulation.frames = 300;
    scene
}
