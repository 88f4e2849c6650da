//! Scenes and targets.

use bowknot_check::{Judge, StateOptions};
use bowknot_geometry::{BodyFilter, CollisionModel, HalfSpace, Point, Topology, Vector};
use bowknot_gpu::{Adapter, Collision, CollisionError, Constraints, DeviceEngine, Engine, Lengths, Settings};

pub const EDGE: f64 = 0.02;
pub const MIN_SEPARATION: f64 = 1e-4;
pub const MARGIN: f64 = 2e-3;
pub const DELTA: f64 = 1e-3;
pub const STRETCH: f64 = 1.1;

/// A scene with everything that collides: two sheets, an obstacle, strands, particles, the ground.
pub struct Scene {
    pub model: CollisionModel,
    pub x: Vec<Point>,
    /// Local edge length of all vertices.
    pub edge: f64,
}

pub fn scene() -> Scene {
    let (mut x, mut triangles, mut strands, mut bodies) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let n = 9usize;
    for (body, height) in [0.03, 0.033, 0.027].into_iter().enumerate() {
        let first = x.len() as u32;
        for k in 0..n * n {
            let warp = 1e-4 * ((k * 37 % 11) as f64 - 5.0);
            x.push(Point::new((k % n) as f64 * EDGE, (k / n) as f64 * EDGE, height + warp));
        }
        for k in (0..n * n - n).filter(|k| k % n != n - 1) {
            let [a, b, c, d] = [k, k + 1, k + n + 1, k + n].map(|v| first + v as u32);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        bodies.resize(x.len(), body as u32);
    }
    for strand in 0..3 {
        let first = x.len() as u32;
        let y = 0.03 + 0.04 * f64::from(strand);
        x.extend((0..8).map(|k| Point::new(0.01 + EDGE * f64::from(k), y, 0.036 + 1e-4 * f64::from(strand))));
        strands.extend((first..first + 7).map(|v| [v, v + 1]));
    }
    bodies.resize(x.len(), 3);
    let first = x.len() as u32;
    for k in 0..27 {
        let place = [k % 3, k / 3 % 3, k / 9].map(f64::from);
        x.push(Point::new(0.05 + 0.003 * place[0], 0.068 + 0.003 * place[1], 0.039 + 0.003 * place[2]));
    }
    bodies.resize(x.len(), 4);
    let topology = Topology::builder(x.len())
        .triangles(triangles)
        .strand_edges(strands)
        .particles((first..x.len() as u32).collect::<Vec<_>>())
        .build()
        .unwrap();
    let mut filters = vec![BodyFilter::DEFORMABLE; 5];
    filters[2] = BodyFilter::OBSTACLE;
    let ground = HalfSpace::new(Point::origin(), Vector::new(0.1, 0.0, 1.0)).unwrap();
    let model = CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap();
    let x = x.into_iter().map(|p| p + Vector::new(3.0, -2.0, 0.05) - Vector::new(0.0, 0.0, 0.3)).collect();
    Scene { model, x, edge: EDGE }
}

pub fn collision<E: Engine>(engine: E, scene: &Scene, constraints: &Constraints<'_>) -> Collision<E> {
    try_collision(engine, scene, constraints).unwrap()
}

pub fn try_collision<E: Engine>(
    engine: E,
    scene: &Scene,
    constraints: &Constraints<'_>,
) -> Result<Collision<E>, CollisionError> {
    with_settings(engine, scene, constraints, &Settings::default())
}

pub fn with_settings<E: Engine>(
    engine: E,
    scene: &Scene,
    constraints: &Constraints<'_>,
    settings: &Settings,
) -> Result<Collision<E>, CollisionError> {
    let count = scene.x.len();
    let edges = &scene.model.topology().edges;
    let length = |[a, b]: [u32; 2]| (scene.x[a as usize] - scene.x[b as usize]).norm();
    let lengths = Lengths {
        edges: &vec![scene.edge; count],
        margins: &vec![MARGIN; count],
        deltas: &vec![DELTA; count],
        half_space_deltas: &[],
        thicknesses: &[],
        half_space_thicknesses: &[],
        min_separation: MIN_SEPARATION,
        edge_limits: &edges.iter().map(|edge| STRETCH * length(*edge)).collect::<Vec<f64>>(),
    };
    Collision::new(engine, &scene.model, &scene.x, &scene.x, &lengths, constraints, settings)
}

pub fn device() -> DeviceEngine {
    let adapter = Adapter::choose(None).unwrap_or_else(|error| panic!("{error}"));
    DeviceEngine::open(&adapter).unwrap()
}

/// Targets that fold the sheets through each other, the obstacle, the strands and the ground.
pub fn target(scene: &Scene, random: &mut fastrand::Rng) -> Vec<Point> {
    let body = scene.model.vertex_body();
    let wave = 20.0 + 60.0 * random.f64();
    let shift = Vector::new(random.f64() - 0.5, random.f64() - 0.5, random.f64() - 0.5) * 0.2;
    let target = |(v, x): (usize, &Point)| {
        let bent = Vector::new(0.0, 0.0, 0.05 * (wave * x.x).sin() * (wave * x.y).cos());
        match body[v] {
            2 => x + shift * 0.2,
            k => x + bent + if k % 2 == 0 { shift } else { -shift },
        }
    };
    scene.x.iter().enumerate().map(target).collect()
}

pub fn assert_no_intersections(scene: &Scene, x: &[Point], what: &str) {
    let judge = Judge::from_model(&scene.model);
    let report = judge.check_state(x, &StateOptions { limit: 1, distance: true }).unwrap();
    assert_eq!(report.intersection_count, 0, "{what}: {report:?}");
}

/// Triangles of a sheet of n x n vertices, the first of which has that number.
pub fn sheet_triangles(n: u32, first: u32) -> impl Iterator<Item = [u32; 3]> {
    let corners = (0..n * (n - 1)).filter(move |k| k % n != n - 1).map(move |k| first + k);
    corners.flat_map(move |k| [[k, k + 1, k + n + 1], [k, k + n + 1, k + n]])
}

/// Root mean square of the distances of points.
pub fn distance(x: &[Point], y: &[Point]) -> f64 {
    let squares: f64 = x.iter().zip(y).map(|(x, y)| (x - y).norm_squared()).sum();
    (squares / x.len() as f64).sqrt()
}

/// A sheet of n x n vertices that hangs from a row of vertices that do not move; which these are, and targets
/// so far below.
pub fn hanging_sheet(n: u32, depth: f64) -> (Scene, Vec<bool>, Vec<Point>) {
    let x: Vec<Point> =
        (0..n * n).map(|k| Point::new(EDGE * f64::from(k % n), 0.0, -EDGE * f64::from(k / n))).collect();
    let topology = Topology::builder(x.len()).triangles(sheet_triangles(n, 0)).build().unwrap();
    let pinned: Vec<bool> = (0..n * n).map(|k| k < n).collect();
    let below = |(x, pinned): (&Point, &bool)| if *pinned { *x } else { x - depth * Vector::z() };
    let target = x.iter().zip(&pinned).map(below).collect();
    (Scene { model: CollisionModel::single_body(topology), x, edge: EDGE }, pinned, target)
}
