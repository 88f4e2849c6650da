//! The built-in scenes. Dimensions are fixed; `scale` multiplies the resolution.

use super::{BodySpec, Keyframe, Motion, ObstacleSpec, PinSpec, Scene, SceneError, Side, error::nearest};
use crate::shapes::{Ball, Cone, HalfSpaceShape, Shape, Sheet, Tube};
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
    Builtin { name: "drape", summary: "a sheet over a ball on the ground", make: drape },
    Builtin { name: "needle", summary: "a sheet falls onto a sharp needle, dt = 1/20 s", make: needle },
    Builtin { name: "stack", summary: "four sheets fall onto a ball and the ground", make: stack },
    Builtin { name: "sphere", summary: "a large sheet falls onto a rotating ball", make: sphere },
    Builtin {
        name: "tube",
        summary: "a tube is twisted by its ends, then squeezed along its axis",
        make: tube,
    },
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

/// 2,601 vertices. The sheet is 1 m wide and starts 10 cm above a ball of 25 cm radius, a little off its
/// middle and turned, so that the folds are not symmetric.
fn drape(scale: f64) -> Scene {
    let edge = 0.02 / scale;
    let mut scene = Scene {
        bodies: vec![sheet("sheet", 1.0, edge, [0.004, 0.002, 0.6], 7.0)],
        obstacles: vec![ball(0.25, 0.25, edge), ground()],
        ..Scene::default()
    };
    scene.simulation.frames = 100;
    scene
}

/// 10,201 vertices and 20,000 triangles, after Fig. 9 and 17 of the paper. The sheet is 1 m wide and
/// starts 15 cm above a needle of 50 cm height and 2 cm base radius, its tip a single vertex.
fn needle(scale: f64) -> Scene {
    let edge = 0.01 / scale;
    let cone = Cone { radius: 0.02, height: 0.5, edge: 2.0 * edge, sides: 12 };
    let needle =
        ObstacleSpec { name: "needle".to_owned(), shape: Some(Shape::Cone(cone)), ..ObstacleSpec::default() };
    let mut scene = Scene {
        bodies: vec![sheet("sheet", 1.0, edge, [0.013, 0.007, 0.65], 0.0)],
        obstacles: vec![needle, ground()],
        ..Scene::default()
    };
    scene.simulation.dt = 0.05;
    scene.simulation.frames = 40;
    scene
}

/// 8,836 vertices: four sheets, each 1 m wide, 4 cm apart and turned against each other.
fn stack(scale: f64) -> Scene {
    let edge = 1.0 / (46.0 * scale);
    let layer = |k: u32| {
        let offset = 0.003 * f64::from(k);
        let place = [offset - 0.004, 0.005 - offset, 0.55 + 0.04 * f64::from(k)];
        sheet(&format!("sheet{k}"), 1.0, edge, place, 4.0 + 23.0 * f64::from(k))
    };
    let mut scene = Scene {
        bodies: (0..4).map(layer).collect(),
        obstacles: vec![ball(0.25, 0.25, edge), ground()],
        ..Scene::default()
    };
    scene.simulation.frames = 120;
    scene
}

/// 50,176 vertices and 99,458 triangles, after Fig. 18 of the paper. The sheet is 2 m wide and starts
/// 5 cm above a ball of 40 cm radius that turns about the vertical by half a turn a second.
fn sphere(scale: f64) -> Scene {
    let edge = 2.0 / (223.0 * scale);
    let mut ball = ball(0.4, 0.4, 2.0 * edge);
    ball.motion = Some(Motion { spin: 180.0, ..Motion::default() });
    let mut scene = Scene {
        bodies: vec![sheet("sheet", 2.0, edge, [0.013, 0.007, 0.85], 7.0)],
        obstacles: vec![ball, ground()],
        ..Scene::default()
    };
    scene.simulation.frames = 200;
    scene
}

/// 25,600 vertices and 50,880 triangles, after Fig. 23 of the paper. The tube has 20 cm radius and 125 cm
/// length; its ends are turned against each other by a full turn within 0.8 s while they approach as
/// far as the twist demands, then pushed together within 0.7 s to 35 cm. No gravity.
fn tube(scale: f64) -> Scene {
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
