use super::twisted_ends;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::elements::SolidElements;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::shapes::{Block, Shape};
use bowknot_dynamics::{SolidMaterial, SolidModel};
use bowknot_geometry::Vector;

/// 31,570 vertices and 92,160 tetrahedra, after Fig. 7a of the paper. The mat is 1.2 m long, 12.5 cm wide and
/// 4 mm thick, of the paper's St. Venant-Kirchhoff material; each end is turned by two turns, against each
/// other, within 2 s while they approach by 30 cm, so that it winds up into a rope and buckles. No gravity.
pub(super) fn scene(scale: f64) -> Scene {
    let (length, width, thickness) = (1.2, 0.125, 0.004);
    let edge = length / 384.0 / scale;
    let block = Block { size: [length, width, thickness], edge };
    let material = SolidMaterial { model: SolidModel::Stvk, ..SolidMaterial::silicone() };
    let body = BodySpec {
        name: "mat".to_owned(),
        kind: BodyKind::Solid,
        shape: Some(Shape::Block(block)),
        material: Material::Solid(material),
        // As the paper's, though it is one to two of them thick.
        elements: Some(SolidElements::Linear),
        stretch_limit: Some(f64::INFINITY),
        ..BodySpec::default()
    };
    let twist = [(0.0, 0.0, 0.0), (0.5, 1.0, 0.03), (1.0, 2.0, 0.1), (2.0, 4.0, 0.3)];
    let mut scene = Scene { bodies: vec![body], pins: twisted_ends("mat", &twist), ..Scene::default() };
    scene.simulation.frames = 220;
    scene.environment.gravity = Vector::zeros();
    scene
}
