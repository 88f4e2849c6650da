//! A loose mesh as a scene: it falls on a ball on the ground, in proportion to its size.

use crate::failure::Failure;
use bowknot::geometry::{Point, Vector};
use bowknot::io::{Import, MESH_ENDINGS, Mesh, read_mesh};
use bowknot::scene::{BodyKind, BodySpec, Material, ObstacleSpec, Scene};
use bowknot::shapes::{Ball, HalfSpaceShape, Shape};
use std::path::Path;

/// Radius of the ball, as a share of the mesh's larger horizontal extent.
const BALL: f64 = 0.25;
/// Gap between the ball and the lowest vertex at the start, as a share of the same.
const GAP: f64 = 0.05;

/// Whether a SCENE argument is a mesh rather than a scene.
pub fn is_mesh(name: &str) -> bool {
    let ending = Path::new(name).extension().unwrap_or_default().to_ascii_lowercase();
    MESH_ENDINGS.iter().any(|known| ending == *known)
}

/// The scene of a loose mesh. `sets` may say how to import it (`body.0.up=y`), so the size is taken after them.
pub fn scene(name: &str, sets: &[String]) -> Result<Scene, Failure> {
    let path = Path::new(name);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut scene = Scene {
        bodies: vec![BodySpec {
            name: "body".to_owned(),
            mesh: Some(path.to_owned()),
            ..BodySpec::default()
        }],
        ..Scene::default()
    };
    scene.simulation.name = stem;
    scene.simulation.frames = 150;
    let imported = scene.clone().with_sets(sets).map_err(Failure::input)?;
    let body = &imported.bodies[0];
    let mesh = read_mesh(path, &Import { up: body.up, scale: body.scale })?;
    let body = &mut scene.bodies[0];
    body.kind = kind(&mesh);
    body.material = Material::of(body.kind);
    if body.kind == BodyKind::Solid {
        body.stretch_limit = Some(f64::INFINITY);
    }
    let (low, high) = extent(&mesh.positions);
    let size = (high.x - low.x).max(high.y - low.y).max((high.z - low.z) * 0.1);

    let radius = BALL * size;
    let center = Vector::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, low.z - GAP * size - radius);
    let ball = ObstacleSpec {
        name: "ball".to_owned(),
        shape: Some(Shape::Ball(Ball { radius, edge: radius / 12.0 })),
        translate: center,
        ..ObstacleSpec::default()
    };
    let ground = ObstacleSpec {
        name: "ground".to_owned(),
        shape: Some(Shape::HalfSpace(HalfSpaceShape::default())),
        translate: center - Vector::new(0.0, 0.0, radius),
        ..ObstacleSpec::default()
    };
    scene.obstacles = vec![ball, ground];
    scene.with_sets(sets).map_err(Failure::input)
}

/// What a mesh is of by its elements.
fn kind(mesh: &Mesh) -> BodyKind {
    if !mesh.tets.is_empty() {
        BodyKind::Solid
    } else if !mesh.triangles.is_empty() {
        BodyKind::Cloth
    } else if !mesh.strands.is_empty() {
        BodyKind::Strands
    } else {
        BodyKind::Particles
    }
}

fn extent(positions: &[Point]) -> (Point, Point) {
    let first = positions.first().copied().unwrap_or_default();
    positions.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}
