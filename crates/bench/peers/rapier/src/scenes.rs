//! The scenes: meshes, materials, obstacles and prescribed motion. SI units, z is up.
//!
//! Bowknot's scene files of the same names lie in `../soft_scenes`; they take their meshes from here.

use crate::meshes::{self, Mesh, Point};
use std::f64::consts::PI;

pub const GRAVITY: f64 = 9.81;
pub const TILT: f64 = 20.0;

/// A fabric, Bowknot's cotton: mass per area [kg/m2] and stiffness against stretch [N/m].
pub const CLOTH_DENSITY: f64 = 0.1503;
pub const CLOTH_STIFFNESS: f64 = 261.078;
pub const SOLID_DENSITY: f64 = 1000.0;
/// How much farther apart than in contact things start [m].
const CLEARANCE: f64 = 1e-3;

pub struct Body {
    pub name: String,
    pub mesh: Mesh,
    /// Young's modulus [Pa] and Poisson's ratio of a solid.
    pub elastic: [f64; 2],
    pub grips: Vec<Grip>,
}

/// Vertices that are led, and what becomes of them.
pub struct Grip {
    pub vertices: Vec<u32>,
    pub motion: Motion,
    /// When they are let go [s].
    pub end: f64,
}

/// Turns about the x axis and moves along it, both linear in time until `end`, held after it.
#[derive(Clone, Copy)]
pub struct Motion {
    pub turn: f64,
    pub along: f64,
    pub end: f64,
}

impl Motion {
    pub fn place(&self, [x, y, z]: Point, time: f64) -> Point {
        let share = (time / self.end).min(1.0);
        let (s, c) = (share * self.turn).sin_cos();
        [x + share * self.along, c * y - s * z, s * y + c * z]
    }
}

pub enum Obstacle {
    /// Radius and center of a ball, with a mesh whose vertices lie on it.
    Ball(f64, Point, Mesh),
    /// The plane through the origin with this normal. It has no mesh and is not judged.
    Plane(Point),
}

pub struct Scene {
    pub bodies: Vec<Body>,
    pub obstacles: Vec<Obstacle>,
    pub gravity: f64,
    pub friction: f64,
    pub seconds: f64,
}

/// How far from the surface of a body its contacts begin, in distances of neighbors.
pub struct Skin {
    /// Toward another body, on each side.
    pub side: f64,
    /// Toward a plane.
    pub on_plane: f64,
}

pub const NAMES: [&str; 6] = ["ball", "sheets", "ribbon", "slope", "stack", "pinch"];

/// The scene `name`, or nothing; `size` is the number of vertices along a side of a sheet or a cube. What is
/// to be in contact starts 1 mm farther apart than its `skin`.
pub fn named(name: &str, size: Option<usize>, skin: &Skin) -> Option<Scene> {
    Some(match name {
        "ball" => drape(size.unwrap_or(51), 1.0, 1, 0.12),
        "sheets" => drape(size.unwrap_or(41), 0.8, 5, 0.04),
        "ribbon" => ribbon(size.unwrap_or(13)),
        "slope" => slope(size.unwrap_or(7), skin),
        "stack" => stack(size.unwrap_or(7), skin),
        "pinch" => pinch(size.unwrap_or(17), skin),
        _ => return None,
    })
}

fn scene(bodies: Vec<Body>, obstacles: Vec<Obstacle>) -> Scene {
    Scene { bodies, obstacles, gravity: GRAVITY, friction: 0.0, seconds: 1.0 }
}

fn body(name: impl Into<String>, mesh: Mesh) -> Body {
    Body { name: name.into(), mesh, elastic: [0.0; 2], grips: Vec::new() }
}

/// Sheets above a ball, the lowest and any two of them by `gap`.
fn drape(size: usize, side: f64, count: usize, gap: f64) -> Scene {
    let radius = 0.25;
    // Off the center, so that no vertex is right above the top.
    let sheets = (0..count).map(|k| {
        let height = gap * (k + 1) as f64;
        let mesh = meshes::sheet([side; 2], [size; 2]).moved(|[x, y, _]| [x + 0.004, y + 0.002, height]);
        body(format!("sheet{k}"), mesh)
    });
    let center = [0.0, 0.0, -radius];
    let mesh = meshes::ball(radius, 64, 32).moved(|[x, y, z]| [x, y, z - radius]);
    scene(sheets.collect(), vec![Obstacle::Ball(radius, center, mesh)])
}

/// A ribbon of 1 m by 8 cm whose ends turn against each other, three turns in 3 s, and approach by half its length.
fn ribbon(size: usize) -> Scene {
    let (length, width) = (1.0, 0.08);
    let along = ((size - 1) as f64 * length / width).round() as usize + 1;
    let mut ribbon = body("ribbon", meshes::sheet([length, width], [along, size]));
    for (first, sign) in [(0, 1.0), ((along - 1) * size, -1.0)] {
        let motion = Motion { turn: sign * 3.0 * PI, along: sign * 0.25 * length, end: 3.0 };
        let vertices = (first as u32..(first + size) as u32).collect();
        ribbon.grips.push(Grip { vertices, motion, end: f64::INFINITY });
    }
    Scene { gravity: 0.0, seconds: 3.5, ..scene(vec![ribbon], Vec::new()) }
}

/// A cube of jelly on a slope.
fn slope(size: usize, skin: &Skin) -> Scene {
    let side = 0.1;
    let mesh = meshes::block([side; 3], [size; 3]);
    let height = 0.5 * side + skin.on_plane * mesh.spacing + CLEARANCE;
    let (s, c) = TILT.to_radians().sin_cos();
    let place = |[x, y, z]: Point| [c * x + s * (z + height), y, c * (z + height) - s * x];
    let cube = Body { elastic: [1.0e5, 0.4], ..body("cube", mesh.moved(place)) };
    Scene { friction: 0.3, ..scene(vec![cube], vec![Obstacle::Plane([s, 0.0, c])]) }
}

/// Five cubes on each other, turned against each other. A column of them stands: it would buckle under its own weight
/// above 0.75 m.
fn stack(size: usize, skin: &Skin) -> Scene {
    let side = 0.08;
    let mesh = meshes::block([side; 3], [size; 3]);
    let mut bodies = Vec::new();
    let mut height = 0.5 * side + skin.on_plane * mesh.spacing + CLEARANCE;
    for (k, yaw) in [0.0_f64, 12.0, -7.0, 9.0, -12.0].into_iter().enumerate() {
        let (s, c) = yaw.to_radians().sin_cos();
        let turned = mesh.clone().moved(|[x, y, z]| [c * x - s * y, s * x + c * y, z + height]);
        bodies.push(Body { elastic: [1.0e6, 0.4], ..body(format!("cube{k}"), turned) });
        height += side + 2.0 * skin.side * mesh.spacing + CLEARANCE;
    }
    let ground = Obstacle::Plane([0.0, 0.0, 1.0]);
    Scene { friction: 0.5, seconds: 2.0, ..scene(bodies, vec![ground]) }
}

/// Two stiff pads close on a hanging cloth, which is held at its upper edge until 0.5 s and by the pads from then on.
fn pinch(size: usize, skin: &Skin) -> Scene {
    let (width, height) = (0.16, 0.24);
    let rows = (size - 1) * 3 / 2 + 1;
    // The sheet's x axis becomes z, its y axis stays.
    let hang = |[x, y, _]: Point| [0.0, y, x];
    let mut cloth = body("cloth", meshes::sheet([height, width], [rows, size]).moved(hang));
    let still = Motion { turn: 0.0, along: 0.0, end: 1.0 };
    let upper = ((rows - 1) * size) as u32..(rows * size) as u32;
    cloth.grips.push(Grip { vertices: upper.collect(), motion: still, end: 0.5 });
    let cloth_skin = skin.side * cloth.mesh.spacing;
    let mut bodies = vec![cloth];
    for (name, sign) in [("left", -1.0), ("right", 1.0)] {
        // rapier takes tetrahedra below its float's epsilon, 0.12 cm3, for degenerate: they would have no elasticity.
        let (thickness, mesh) = (0.02, meshes::block([0.02, 0.04, 0.02], [3, 5, 3]));
        let away = 0.5 * thickness + skin.side * mesh.spacing + cloth_skin + CLEARANCE;
        let mesh = mesh.moved(|[x, y, z]| [x + sign * away, y, z + 0.5 * height - 0.03]);
        let back = sign * (away + 0.5 * thickness);
        let held =
            (0..mesh.points.len() as u32).filter(|&i| (mesh.points[i as usize][0] - back).abs() < 1e-9);
        // Each goes the clearance and half a millimeter more, by which it is compressed.
        let motion = Motion { turn: 0.0, along: -sign * (CLEARANCE + 0.5e-3), end: 0.3 };
        let grip = Grip { vertices: held.collect(), motion, end: f64::INFINITY };
        bodies.push(Body { elastic: [1.0e6, 0.4], grips: vec![grip], ..body(name, mesh) });
    }
    Scene { friction: 0.5, seconds: 60.0, ..scene(bodies, Vec::new()) }
}
