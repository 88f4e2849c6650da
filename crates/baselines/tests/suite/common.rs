//! Scenes, and exact checks for intersections.

use bowknot_baselines::twoway::geometry::{HalfSpace, Point, Topology, Vector, intersection};
use bowknot_baselines::twoway::proximity::{BodyFilter, CollisionModel};
use bowknot_baselines::twoway::{
    AcceptedState, BackwardStep, CallInput, CollisionScene, ContactData, ForwardStep, Params, ResolveInput,
    ResolveState, Resolver, Search, Statistics,
};
use std::ops::ControlFlow;

#[path = "../../../twoway/tests/suite/common/draw.rs"]
mod draw;
#[path = "../../../twoway/tests/suite/common/sheet.rs"]
mod sheet;

pub use draw::Draw;
use sheet::sheet;

/// Vertices and a collision model of them.
#[derive(Clone)]
pub struct Scene {
    pub x: Vec<Point>,
    pub model: CollisionModel,
}

impl Scene {
    /// A fixed triangle in the plane z = 0, and a particle at `height` above its interior.
    pub fn vertex_above_triangle(height: f64) -> Self {
        let mut x = [[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [-1.0, 2.0, 0.0]].map(Point::from).to_vec();
        x.push(Point::new(0.1, 0.2, height));
        let topology = Topology::builder(4).triangles([[0, 1, 2]]).particles([3]).build().unwrap();
        let bodies = vec![BodyFilter::OBSTACLE, BodyFilter::DEFORMABLE];
        Self { x, model: CollisionModel::new(topology, vec![0, 0, 0, 1], bodies, vec![]).unwrap() }
    }

    /// Two sheets `gap` apart, two strands across them, particles on top, ground below, an obstacle beside
    /// it: every kind of pair, nearest neighbors `gap` apart.
    pub fn heap(gap: f64) -> Self {
        let (mut x, mut triangles, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
        let h = 0.1;
        sheet(3, h, gap, &mut x, &mut triangles);
        bodies.resize(x.len(), 0);
        let first = x.len();
        sheet(3, h, 2.0 * gap, &mut x, &mut triangles);
        x[first..].iter_mut().for_each(|p| *p += Vector::new(0.031, 0.022, 0.0));
        bodies.resize(x.len(), 1);
        let mut strands = Vec::new();
        for k in 0..2 {
            let first = x.len() as u32;
            for i in 0..5 {
                let (along, across) = (0.08 * f64::from(i), 0.13 + 0.05 * k as f64);
                let (u, v) = if k == 0 { (along, across) } else { (across, along) };
                x.push(Point::new(u, v, (3.0 + k as f64) * gap));
            }
            strands.extend((0..4).map(|i| [first + i, first + i + 1]));
        }
        bodies.resize(x.len(), 2);
        let first = x.len() as u32;
        for i in 0..4 {
            x.push(Point::new(0.1 + 0.04 * f64::from(i), 0.131, 4.1 * gap));
        }
        x.push(Point::new(0.1, 0.131, 5.1 * gap));
        let particles: Vec<u32> = (first..x.len() as u32).collect();
        bodies.resize(x.len(), 3);
        let first = x.len() as u32;
        for p in [[0.05, 0.05, 3.0 * gap], [0.1, 0.03, 3.2 * gap], [0.06, 0.1, 3.1 * gap]] {
            x.push(Point::from(p));
        }
        triangles.push([first, first + 1, first + 2]);
        bodies.resize(x.len(), 4);
        let topology = Topology::builder(x.len())
            .triangles(triangles)
            .strand_edges(strands.iter().copied())
            .particles(particles.iter().copied())
            .build()
            .unwrap();
        let mut filters = vec![BodyFilter::DEFORMABLE; 5];
        filters[4] = BodyFilter::OBSTACLE;
        let ground = HalfSpace::new(Point::origin(), Vector::z()).unwrap();
        Self { x, model: CollisionModel::new(topology, bodies, filters, vec![ground]).unwrap() }
    }

    /// Two sheets of `cells` x `cells` cells of 0.1 m, `gap` apart.
    pub fn two_sheets(cells: usize, gap: f64) -> Self {
        let (mut x, mut triangles) = (Vec::new(), Vec::new());
        sheet(cells, 0.1, 0.0, &mut x, &mut triangles);
        let n = x.len();
        sheet(cells, 0.1, gap, &mut x, &mut triangles);
        let bodies = (0..2 * n).map(|i| u32::from(i >= n)).collect();
        let topology = Topology::builder(2 * n).triangles(triangles).build().unwrap();
        Self {
            x,
            model: CollisionModel::new(topology, bodies, vec![BodyFilter::DEFORMABLE; 2], vec![]).unwrap(),
        }
    }

    /// The same with the upper sheet turned a little, so that few edges are parallel.
    pub fn turned_sheets(cells: usize, gap: f64) -> Self {
        let mut scene = Self::two_sheets(cells, gap);
        let (sine, cosine) = 0.4_f64.sin_cos();
        let middle = 0.05 * cells as f64;
        let n = scene.x.len() / 2;
        for p in &mut scene.x[n..] {
            let (u, v) = (p.x - middle, p.y - middle);
            (p.x, p.y) = (middle + cosine * u - sine * v, middle + sine * u + cosine * v);
        }
        scene
    }

    /// Targets of two sheets that change places and crumple on the way.
    pub fn swapped(&self) -> Vec<Point> {
        let n = self.x.len() / 2;
        let mut draw = Draw::new(5);
        (0..2 * n)
            .map(|v| {
                let other = self.x[(v + n) % (2 * n)];
                self.x[v] + 1.5 * (other.z - self.x[v].z) * Vector::z() + 0.02 * draw.vector()
            })
            .collect()
    }

    pub fn collision_scene(&self, params: Params) -> CollisionScene {
        CollisionScene::new(
            self.model.clone(),
            &self.x,
            &vec![0.01; self.x.len()],
            ContactData::default(),
            params,
        )
        .unwrap()
    }
}

/// The state at the start of a call, with the candidate pairs of its first search.
pub fn with_candidates(
    collision: &CollisionScene,
    search: &mut impl Search,
    x: &[Point],
    target: &[Point],
) -> ResolveState {
    let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
    let mut state = ResolveState {
        start: x.to_vec(),
        target: target.to_vec(),
        x: x.to_vec(),
        previous: x.to_vec(),
        y: target.to_vec(),
        call: CallInput::new(collision, x, target, &input).unwrap(),
        ..ResolveState::default()
    };
    search.begin(collision, &mut state, true);
    search.update(collision, &mut state, &mut Statistics::default());
    state
}

/// Resolves, and asserts that no accepted state nor any of 64 states between two of them intersects.
pub fn resolve_watched<S: Search, B: BackwardStep, F: ForwardStep<S>>(
    resolver: &mut Resolver<S, B, F>,
    scene: &Scene,
    target: &[Point],
    what: &str,
) -> (Vec<Point>, Statistics) {
    let mut x = scene.x.clone();
    assert_clear(&scene.model, &x, what);
    let mut watch = |state: &AcceptedState<'_>| {
        for k in 1..=64 {
            let t = f64::from(k) / 64.0;
            let between: Vec<Point> =
                state.previous.iter().zip(state.positions).map(|(a, b)| a + t * (b - a)).collect();
            assert_clear(&scene.model, &between, &format!("{what}, step {}, {t}", state.step));
        }
        ControlFlow::Continue(())
    };
    let input = ResolveInput { time_step: Some(0.01), ..ResolveInput::default() };
    let statistics = resolver.resolve_with(&mut x, target, &input, &mut watch).unwrap();
    (x, statistics)
}

/// Asserts by exact predicates on all pairs that no edge meets a triangle and that nothing is below the
/// ground.
pub fn assert_clear(model: &CollisionModel, x: &[Point], what: &str) {
    let topology = model.topology();
    let at = |v: u32| &x[v as usize];
    for triangle in &topology.triangles {
        let corners = triangle.map(at);
        let low = corners.iter().fold(*corners[0], |m, p| m.inf(p));
        let high = corners.iter().fold(*corners[0], |m, p| m.sup(p));
        for edge in topology.edges.iter().filter(|e| !e.iter().any(|v| triangle.contains(v))) {
            let [a, b] = edge.map(at);
            let apart = (0..3).any(|k| a[k].max(b[k]) < low[k] || a[k].min(b[k]) > high[k]);
            assert!(apart || !intersection::edge_triangle([a, b], corners), "{what}: {edge:?} {triangle:?}");
        }
    }
    for (v, p) in x.iter().enumerate().filter(|(v, _)| !model.is_obstacle(*v as u32)) {
        assert!(model.half_spaces().iter().all(|h| h.signed_distance(p) > 0.0), "{what}: {v} below ground");
    }
}

/// Asserts that `solve` has the same result on any number of threads.
pub fn assert_same_on_any_number_of_threads<R: PartialEq + Send>(solve: impl Fn() -> R + Send + Sync) {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(&solve)
    };
    let one = on(1);
    for threads in [2, 3, 5] {
        assert!(on(threads) == one, "{threads} threads");
    }
}
