//! A mesh file as a scene: the mesh falls on a ball that stands on the ground. Ball and gaps are sized to the
//! mesh.

use crate::args::Up;
use crate::exit::Failure;
use bowknot::geometry::{Point, Vector};
use bowknot::io::{Import, IoError, MESH_ENDINGS, Mesh, read_mesh, read_mesh_part};
use bowknot::scene::{BodyKind, BodySpec, Material, ObstacleSpec, Scene};
use bowknot::shapes::{Ball, HalfSpaceShape, Shape};
use std::path::Path;

/// Radius of the ball, relative to the larger horizontal extent of the mesh.
const BALL_RADIUS: f64 = 0.25;
/// Gap between the ball and the lowest vertex at the start, relative to the same extent.
const GAP: f64 = 0.05;
/// The gap is at least so many mean edge lengths: twice the contact distance that a scene has by default.
/// Nearer, a coarse mesh would be thrown off at the start.
const EDGE_GAP: f64 = 0.2;

/// Whether the argument SCENE names a mesh file rather than a scene.
pub fn is_mesh(name: &str) -> bool {
    let extension = Path::new(name).extension().unwrap_or_default().to_ascii_lowercase();
    MESH_ENDINGS.iter().any(|known| extension == *known)
}

/// The options `--up` and `--scale` as assignments to keys of the scene of a mesh.
pub fn assignments(up: Option<Up>, scale: Option<f64>) -> Vec<String> {
    let up = up.map(|up| format!("body.0.up=\"{}\"", up.name()));
    // Debug formatting keeps a whole number a float.
    let scale = scale.map(|scale| format!("body.0.scale={scale:?}"));
    up.into_iter().chain(scale).collect()
}

/// The scene of a mesh file. `sets` may change how it is imported (`body.0.up=y`), so its size is measured
/// after them.
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
    let mesh = read(path, body)?;
    let body = &mut scene.bodies[0];
    body.kind = kind(&mesh);
    body.material = Material::of(body.kind);
    if body.kind == BodyKind::Solid {
        body.stretch_limit = Some(f64::INFINITY);
    }
    let (low, high) = extent(&mesh.positions);
    let size = (high.x - low.x).max(high.y - low.y).max((high.z - low.z) * 0.1);

    let gap = (GAP * size).max(EDGE_GAP * mean_edge(&mesh));
    let radius = BALL_RADIUS * size;
    let center = Vector::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, low.z - gap - radius);
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

/// The mesh of a body, or the part that it names.
pub fn read(path: &Path, body: &BodySpec) -> Result<Mesh, IoError> {
    let import = Import { up: body.up, scale: body.scale };
    match &body.part {
        Some(part) => read_mesh_part(path, &import, part),
        None => read_mesh(path, &import),
    }
}

/// The kind of body that the elements of a mesh suggest.
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

/// Mean length of the edges of all elements [m]; 0 without any. Edges count once for each element that they
/// belong to.
fn mean_edge(mesh: &Mesh) -> f64 {
    let of_triangles = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let of_tets = mesh.tets.iter().flat_map(|&[a, b, c, d]| [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]]);
    let edges = of_triangles.chain(of_tets).chain(mesh.strands.iter().copied());
    let length = |[a, b]: [u32; 2]| (mesh.positions[a as usize] - mesh.positions[b as usize]).norm();
    let (sum, count) = edges.map(length).fold((0.0, 0u32), |(sum, count), length| (sum + length, count + 1));
    sum / f64::from(count.max(1))
}

/// The lower and upper corner of the bounding box.
pub fn extent(positions: &[Point]) -> (Point, Point) {
    let first = positions.first().copied().unwrap_or_default();
    positions.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}
