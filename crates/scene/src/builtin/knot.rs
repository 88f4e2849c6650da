//! What the two knots share: ribbons along given curves, and the hands that pull them.

use crate::body::BodySpec;
use crate::description::Scene;
use crate::material::Material;
use crate::motion::{Keyframe, Motion};
use crate::pin::{PinSpec, Region};
use crate::shapes::{Ribbon, Shape};
use bowknot_dynamics::ClothMaterial;
use bowknot_geometry::{Point, Vector};

/// A curve as control points of a [`Ribbon`]: position [mm], direction across [0.001].
pub(super) type Curve = [[f64; 6]];

/// Half a turn about the y axis, (x, y, z) -> (-x, y, -z): it exchanges the two ribbons of either knot.
pub(super) fn turned(v: Vector) -> Vector {
    Vector::new(-v.x, v.y, -v.z)
}

/// The two ribbons: `left` along the curve, `right` the same after half a turn about the y axis.
pub(super) fn ribbons(curve: &Curve, width: f64, edge: f64) -> Vec<BodySpec> {
    let points = curve.iter().map(|c| Point::new(c[0], c[1], c[2]) * 1e-3).collect();
    let across = curve.iter().map(|c| Vector::new(c[3], c[4], c[5]) * 1e-3).collect();
    let shape = Shape::Ribbon(Ribbon { points, across, width, edge });
    let ribbon = |name: &str, turn: f64| BodySpec {
        name: name.to_owned(),
        shape: Some(shape.clone()),
        rotate: Vector::new(0.0, turn, 0.0),
        material: Material::Cloth(material()),
        ..BodySpec::default()
    };
    vec![ribbon("left", 0.0), ribbon("right", 180.0)]
}

/// A ribbon that stretches like loosely woven cotton and bends like stiff satin.
fn material() -> ClothMaterial {
    ClothMaterial { density: 0.2, stretch_stiffness: 250.0, bend_stiffness: 5e-5, ..ClothMaterial::cotton() }
}

/// A hand: it takes the vertices of a ribbon in a box and carries them along a straight line.
#[derive(Clone, Copy)]
pub(super) struct Hand {
    /// Corners of the box, for the left ribbon [m].
    pub low: [f64; 3],
    pub high: [f64; 3],
    /// Where it carries them [m], by when [s].
    pub travel: Vector,
    pub time: f64,
    /// Turn on the way [deg] about an axis through a point.
    pub turn: f64,
    pub axis: Vector,
    pub center: Point,
}

impl Hand {
    /// A hand that does not turn.
    pub fn new(low: [f64; 3], high: [f64; 3], travel: Vector, time: f64) -> Self {
        Self { low, high, travel, time, turn: 0.0, axis: Vector::z(), center: Point::origin() }
    }

    /// The hand on the left ribbon, and its image on the right one.
    pub fn pair(&self) -> [PinSpec; 2] {
        let pin = |body: &str, image: fn(Vector) -> Vector| {
            let corners = [self.low, self.high].map(|c| image(Vector::from(c)));
            let keyframe = Keyframe { time: self.time, translate: image(self.travel), angle: self.turn };
            PinSpec {
                body: body.to_owned(),
                region: Some(Region {
                    min: Point::from(corners[0].inf(&corners[1])),
                    max: Point::from(corners[0].sup(&corners[1])),
                }),
                motion: Some(Motion {
                    axis: image(self.axis),
                    center: Point::from(image(self.center.coords)),
                    keyframes: vec![keyframe],
                    ..Motion::default()
                }),
                ..PinSpec::default()
            }
        };
        [pin("left", |v| v), pin("right", turned)]
    }
}

/// The scene of a knot: no gravity, as the hands hold it in the air.
pub(super) fn scene(bodies: Vec<BodySpec>, hands: &[Hand], frames: usize) -> Scene {
    let mut scene = Scene { bodies, pins: hands.iter().flat_map(Hand::pair).collect(), ..Scene::default() };
    scene.simulation.frames = frames;
    scene.environment.gravity = Vector::zeros();
    scene
}

#[cfg(test)]
mod tests;
