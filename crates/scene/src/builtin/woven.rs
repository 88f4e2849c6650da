use super::ball;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::shapes::{Shape, Woven};
use bowknot_dynamics::StrandMaterial;
use bowknot_geometry::Vector;

/// A mat of 30 cm by 30 cm, plain-woven of cords, falls on a ball of 8 cm radius and hangs over it: warp and
/// weft hold each other by nothing but contact and friction.
pub(super) fn scene(scale: f64) -> Scene {
    // The mat keeps its size; there are more and thinner cords. They fill 0.36 of their spacing: in a looser
    // weave the outer ones slip off as soon as they hang.
    let count = ((COUNT * scale).round() as usize).max(4);
    let spacing = 0.3 / count as f64;
    let delta = 0.36 * spacing;
    let mut scene = Scene {
        bodies: vec![BodySpec {
            name: "mat".to_owned(),
            kind: BodyKind::Strands,
            shape: Some(Shape::Woven(Woven {
                count: [count; 2],
                spacing,
                // Where two cross they start 1.2 delta apart: near, and free of forces.
                amplitude: 0.6 * delta,
                segments: 4,
                fringe: 1,
            })),
            material: Material::Strands(StrandMaterial {
                density: 1.5e-3,
                stretch_stiffness: 50.0,
                bend_stiffness: 1e-7,
                radius: 0.5 * delta,
                ..StrandMaterial::yarn()
            }),
            translate: Vector::new(0.0, 0.0, 0.1),
            friction: 1.0,
            stretch_limit: Some(1.02),
            ..BodySpec::default()
        }],
        obstacles: vec![ball(0.08, 0.0, 0.6 * spacing)],
        ..Scene::default()
    };
    scene.obstacles[0].friction = 1.0;
    scene.contact.delta = Some(delta);
    // At 1/100 s the cords move by more than their thickness within a time step, and every crossing must be
    // found anew.
    scene.simulation.dt = 0.0025;
    // More iterations lower neither the residual nor what the cords store.
    scene.simulation.newton_iterations = 2;
    scene.simulation.frames = 200;
    scene
}

/// Cords each way at scale 1.
const COUNT: f64 = 15.0;
