use super::ground;
use crate::body::BodySpec;
use crate::description::Scene;
use crate::material::Material;
use crate::shapes::{Shape, Sheet};
use bowknot_dynamics::ClothMaterial;
use bowknot_geometry::Vector;

/// Width and length of a playing card [m].
const WIDTH: f64 = 0.063;
const LENGTH: f64 = 0.088;
/// Distance that contacts are separated to [m], twice the thickness of a card; the house starts a little
/// wider.
const DELTA: f64 = 0.0006;
const GAP: f64 = 1.05 * DELTA;
/// Coefficient of friction [1] of cards on each other and on the table; a smooth table lets them slide apart.
const FRICTION: f64 = 0.5;

/// Three playing cards of 63 by 88 mm make a house: two lean against each other, 22 and 20 degrees off the
/// vertical, and a third closes the open end, 25 degrees off it. Friction alone holds them, for 5 s.
///
/// A card is a stiff sheet of 0.3 kg/m^2. Its stiffness in the plane is that of a plate of its thickness h
/// and bending stiffness D, 12 (1 - nu^2) D / h^2.
pub(super) fn scene(scale: f64) -> Scene {
    let card = |name: &str, size: [f64; 2], rotate: Vector, translate: Vector| BodySpec {
        name: name.to_owned(),
        shape: Some(Shape::Sheet(Sheet { size, edge: 0.021 / scale, ..Sheet::default() })),
        rotate,
        translate,
        material: Material::Cloth(ClothMaterial {
            density: 0.3,
            stretch_stiffness: 6e5,
            poisson_ratio: 0.3,
            bend_stiffness: 5e-3,
            thickness: 0.3e-3,
            ..ClothMaterial::default()
        }),
        friction: FRICTION,
        ..BodySpec::default()
    };
    // Half a card's extent across and upward at an angle off the vertical [deg].
    let half = |angle: f64| {
        let (sin, cos) = libm::sincos(angle.to_radians());
        (0.5 * LENGTH * sin, 0.5 * LENGTH * cos)
    };
    let (left, right, third) = (22.0, 20.0, 25.0);
    // The upper edge of the left card, at x = 0, touches the face of the right one, which ends a little
    // higher.
    let ((left_x, left_z), (right_x, right_z)) = (half(left), half(right));
    let top = GAP / libm::cos(right.to_radians()) - 2.0 * (right_z - left_z) * libm::tan(right.to_radians());
    let (third_y, third_z) = half(third);
    let along = [LENGTH, WIDTH];
    let mut scene = Scene {
        bodies: vec![
            card("left", along, Vector::new(0.0, left - 90.0, 0.0), Vector::new(-left_x, 0.0, left_z + GAP)),
            card(
                "right",
                along,
                Vector::new(0.0, 90.0 - right, 0.0),
                Vector::new(top + right_x, 0.0, right_z + GAP),
            ),
            card(
                "third",
                [WIDTH, LENGTH],
                Vector::new(90.0 - third, 0.0, 0.0),
                Vector::new(0.0, -0.5 * WIDTH - GAP - third_y, third_z + GAP),
            ),
        ],
        obstacles: vec![ground()],
        ..Scene::default()
    };
    scene.obstacles[0].friction = FRICTION;
    scene.contact.delta = Some(DELTA);
    scene.simulation.frames = 500;
    scene
}
