//! The built-in scenes, a file each. Dimensions are fixed; `scale` multiplies the resolution.

mod blade;
mod bow_knot;
mod cards;
mod drape;
mod dress;
mod figure;
mod funnel;
mod gown;
mod hair;
mod knot;
mod mat;
mod needle;
mod reef_knot;
mod sand;
mod sphere;
mod stack;
mod trampoline;
mod tube;
mod woven;

use super::{BodySpec, Keyframe, Motion, ObstacleSpec, PinSpec, Scene, SceneError, Side, error::nearest};
use crate::shapes::{Ball, HalfSpaceShape, Shape, Sheet};
use bowknot_geometry::Vector;

/// A scene that needs no file.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name on the command line.
    pub name: &'static str,
    /// What happens in it, one line.
    pub summary: &'static str,
    make: fn(f64) -> Scene,
}

/// All built-in scenes.
pub const BUILTIN: &[Builtin] = &[
    Builtin { name: "drape", summary: "a sheet over a ball on the ground", make: drape::scene },
    Builtin {
        name: "needle",
        summary: "a sheet falls onto a sharp needle, dt = 1/20 s",
        make: needle::scene,
    },
    Builtin { name: "stack", summary: "four sheets fall onto a ball and the ground", make: stack::scene },
    Builtin { name: "sphere", summary: "a large sheet falls onto a rotating ball", make: sphere::scene },
    Builtin {
        name: "tube",
        summary: "a tube is twisted by its ends, then squeezed along its axis",
        make: tube::scene,
    },
    Builtin {
        name: "dress",
        summary: "a dress and two skirts over it on a walking figure that turns",
        make: dress::scene,
    },
    Builtin {
        name: "gown",
        summary: "a long gown of four layers on a figure that walks in a curve",
        make: gown::scene,
    },
    Builtin {
        name: "blade",
        summary: "five sheets drop onto a sharp blade, dt = 1/20 s",
        make: blade::scene,
    },
    Builtin {
        name: "funnel",
        summary: "a sheet is drawn through a funnel by its middle, dt = 1/20 s",
        make: funnel::scene,
    },
    Builtin {
        name: "bow-knot",
        summary: "two ribbons, loosely tied in a bow, are pulled tight",
        make: bow_knot::scene,
    },
    Builtin {
        name: "reef-knot",
        summary: "two ribbons, loosely tied in a reef knot, are pulled tight",
        make: reef_knot::scene,
    },
    Builtin { name: "mat", summary: "an elastic mat is wound up by its ends, tetrahedra", make: mat::scene },
    Builtin { name: "hair", summary: "strands on a head that shakes", make: hair::scene },
    Builtin { name: "sand", summary: "grains pour out of a funnel and heap", make: sand::scene },
    Builtin {
        name: "trampoline",
        summary: "a cube and two balls of jelly bounce on a sheet held along its sides",
        make: trampoline::scene,
    },
    Builtin { name: "cards", summary: "a house of three cards stands by friction", make: cards::scene },
    Builtin { name: "woven", summary: "a mat woven of strands falls on a ball", make: woven::scene },
];

/// Smallest scale: sheets still have a few edges.
const MIN_SCALE: f64 = 0.05;
/// Largest scale: millions of vertices.
const MAX_SCALE: f64 = 20.0;

pub(super) fn scene(name: &str, scale: f64) -> Result<Scene, SceneError> {
    let Some(builtin) = BUILTIN.iter().find(|b| b.name == name) else {
        let nearest = nearest(name, BUILTIN.iter().map(|b| b.name));
        return Err(SceneError::Unknown { name: name.to_owned(), nearest });
    };
    if !(scale.is_finite() && (MIN_SCALE..=MAX_SCALE).contains(&scale)) {
        return Err(SceneError::Scale { scale, min: MIN_SCALE, max: MAX_SCALE });
    }
    let mut scene = (builtin.make)(scale);
    scene.simulation.name = name.to_owned();
    scene.validate()?;
    Ok(scene)
}

fn sheet(name: &str, size: f64, edge: f64, [x, y, z]: [f64; 3], turn: f64) -> BodySpec {
    BodySpec {
        name: name.to_owned(),
        shape: Some(Shape::Sheet(Sheet { size: [size; 2], edge, ..Sheet::default() })),
        translate: Vector::new(x, y, z),
        rotate: Vector::new(0.0, 0.0, turn),
        ..BodySpec::default()
    }
}

fn ball(radius: f64, height: f64, edge: f64) -> ObstacleSpec {
    ObstacleSpec {
        name: "ball".to_owned(),
        shape: Some(Shape::Ball(Ball { radius, edge })),
        translate: Vector::new(0.0, 0.0, height),
        ..ObstacleSpec::default()
    }
}

fn ground() -> ObstacleSpec {
    ObstacleSpec {
        name: "ground".to_owned(),
        shape: Some(Shape::HalfSpace(HalfSpaceShape::default())),
        ..ObstacleSpec::default()
    }
}

/// Pins for both ends of a body along x, turned against each other and brought nearer: at each time [s] by
/// turns and by a length [m], of which either end makes half.
fn twisted_ends(body: &str, twist: &[(f64, f64, f64)]) -> Vec<PinSpec> {
    let end = |side: Side, sign: f64| {
        let keyframe = |&(time, turns, approach): &(f64, f64, f64)| Keyframe {
            time,
            translate: Vector::new(-0.5 * sign * approach, 0.0, 0.0),
            angle: 180.0 * sign * turns,
        };
        let keyframes = twist.iter().map(keyframe).collect();
        PinSpec {
            body: body.to_owned(),
            side: Some(side),
            motion: Some(Motion { axis: Vector::x(), keyframes, ..Motion::default() }),
            ..PinSpec::default()
        }
    };
    vec![end(Side::XMin, -1.0), end(Side::XMax, 1.0)]
}
