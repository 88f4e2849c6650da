//! What the scenes of a dressed figure share.

use crate::body::BodySpec;
use crate::description::Scene;
use crate::material::Material;
use crate::obstacle::ObstacleSpec;
use crate::pin::{PinSpec, Side};
use crate::shapes::{Figure, Garment, Shape};
use bowknot_dynamics::ClothMaterial;

/// A scene of the figure alone. There is no ground: feet would pinch cloth on it, and no hem reaches it.
pub(super) fn figure(figure: Figure) -> Scene {
    let figure = ObstacleSpec {
        name: "figure".to_owned(),
        shape: Some(Shape::Figure(figure)),
        ..ObstacleSpec::default()
    };
    Scene { obstacles: vec![figure], ..Scene::default() }
}

/// Adds a garment whose upper end is sewn to the figure.
pub(super) fn sew(scene: &mut Scene, name: &str, fabric: &str, garment: Garment) {
    scene.bodies.push(BodySpec {
        name: name.to_owned(),
        shape: Some(Shape::Garment(garment)),
        material: Material::Cloth(ClothMaterial::named(fabric).unwrap_or_default()),
        ..BodySpec::default()
    });
    scene.pins.push(PinSpec {
        body: name.to_owned(),
        side: Some(Side::ZMax),
        follow: Some("figure".to_owned()),
        ..PinSpec::default()
    });
}

/// Distance between layers [m]: `least`, or more where edges are so long that, as chords of a waist of
/// 8 cm radius, they would cut through the layer below.
pub(super) fn spacing(edge: f64, least: f64) -> f64 {
    least.max(1.3 * edge * edge / (8.0 * 0.08))
}
