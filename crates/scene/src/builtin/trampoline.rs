use super::sheet;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::kind::BodyKind;
use crate::material::Material;
use crate::pin::{PinSpec, Region, Side};
use crate::shapes::{Block, Shape, TetBall};
use bowknot_dynamics::{ClothMaterial, SolidMaterial};
use bowknot_geometry::{Point, Vector};

/// A sheet of 1.2 m, held along its four sides, catches a cube and two balls of jelly that fall from up to
/// 0.9 m. Solids keep their resolution: tetrahedra multiply with its cube.
pub(super) fn scene(scale: f64) -> Scene {
    let edge = 0.02 / scale;
    let mut mat = sheet("mat", 1.2, edge, [0.0, 0.0, 0.0], 0.0);
    // A jumping mat of polypropylene webbing: far stiffer than a garment, and edges that give by a tenth for
    // the springs that hold it.
    mat.material = Material::Cloth(ClothMaterial {
        density: 0.3,
        stretch_stiffness: 4000.0,
        bend_stiffness: 1e-4,
        stretch_limit: 1.1,
        ..ClothMaterial::default()
    });
    mat.friction = 0.4;
    let solid = |name: &str, shape: Shape, [x, y, z]: [f64; 3], turn: f64| BodySpec {
        name: name.to_owned(),
        kind: BodyKind::Solid,
        material: Material::Solid(SolidMaterial {
            young_modulus: 60e3,
            density: 400.0,
            ..SolidMaterial::jelly()
        }),
        shape: Some(shape),
        translate: Vector::new(x, y, z),
        rotate: Vector::new(turn, 0.5 * turn, 0.0),
        friction: 0.4,
        // Their own elasticity limits how far they stretch.
        stretch_limit: Some(f64::INFINITY),
        ..BodySpec::default()
    };
    let fine = 0.04 / scale.min(1.0);
    let ball = |radius: f64| Shape::TetBall(TetBall { radius, edge: fine });
    let cube = Shape::Block(Block { size: [0.16; 3], edge: fine });
    let side = |side: Side| PinSpec { body: "mat".to_owned(), side: Some(side), ..PinSpec::default() };
    // Between the corners, which the other two sides hold.
    let (inner, outer) = (0.6 - 0.5 * edge, 0.6 - 1e-6);
    let rest = |y: [f64; 2]| PinSpec {
        body: "mat".to_owned(),
        region: Some(Region { min: Point::new(-inner, y[0], -0.01), max: Point::new(inner, y[1], 0.01) }),
        ..PinSpec::default()
    };
    let mut scene = Scene {
        bodies: vec![
            mat,
            solid("cube", cube, [0.05, 0.02, 0.45], 25.0),
            solid("ball", ball(0.1), [-0.2, 0.1, 0.65], 0.0),
            solid("small-ball", ball(0.07), [0.18, -0.2, 0.85], 0.0),
        ],
        pins: vec![side(Side::XMin), side(Side::XMax), rest([-1.0, -outer]), rest([outer, 1.0])],
        ..Scene::default()
    };
    scene.simulation.frames = 150;
    scene
}
