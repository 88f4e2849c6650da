use super::ground;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::obstacle::ObstacleSpec;
use crate::shapes::{Grains, Lathe, Shape};
use bowknot_dynamics::ParticleMaterial;
use bowknot_geometry::Vector;

/// 30,000 grains, after Fig. 7e and 7f of the paper. They fill a funnel, pour out of its neck of 10 cm width
/// onto the ground 12 cm below, and heap. A grain is 4 mm across at scale 1; coarser scales have fewer and
/// larger ones in the same volume.
pub(super) fn scene(scale: f64) -> Scene {
    // Sheets double their edge length where the scale halves; so do grains.
    let diameter = 0.004 / libm::pow(scale, 2.0 / 3.0);
    let material = ParticleMaterial { radius: 0.5 * diameter, ..ParticleMaterial::sand() };
    let spacing = 1.06 * diameter;
    // A column of square cross-section within the mouth.
    let side = (0.13 / spacing).round().max(2.0) as usize;
    let layers = (30_000.0 * scale * scale / (side * side) as f64).round().max(1.0) as usize;
    let grains = Grains { count: [side, side, layers], spacing, jitter: 0.02, seed: 1 };
    let bottom = 0.33;
    let sand = BodySpec {
        name: "sand".to_owned(),
        kind: BodyKind::Particles,
        shape: Some(Shape::Grains(grains)),
        material: Material::Particles(material),
        translate: Vector::new(0.0, 0.0, bottom + 0.5 * spacing * layers as f64),
        friction: 0.5,
        ..BodySpec::default()
    };
    let (neck, mouth) = (0.05, 0.16);
    let wall = 0.006;
    let profile = vec![
        [neck, 0.12],
        [neck, 0.15],
        [mouth, 0.29],
        [mouth, 0.52],
        [mouth + wall, 0.52],
        [mouth + wall, 0.288],
        [neck + wall, 0.148],
        [neck + wall, 0.12],
    ];
    let funnel = ObstacleSpec {
        name: "funnel".to_owned(),
        shape: Some(Shape::Lathe(Lathe { profile, edge: 0.02, ..Lathe::default() })),
        friction: 0.3,
        ..ObstacleSpec::default()
    };
    let ground = ObstacleSpec { friction: 0.6, ..ground() };
    let mut scene = Scene { bodies: vec![sand], obstacles: vec![funnel, ground], ..Scene::default() };
    scene.simulation.frames = 200;
    // Grains touch everywhere: a wider range would list pairs with the neighbors' neighbors.
    scene.contact.range = 1.2;
    scene
}
