//! Free flight before the steps of a device: bodies that are apart move as a whole, and nothing passes
//! through.

use bowknot::gpu::{TwinEngine, resolve_on};
use bowknot_geometry::{HalfSpace, Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_tests::{Case, Random, StepChecker};
use bowknot_twoway::{AcceptedState, Params, ResolveInput, Resolver};
use std::ops::ControlFlow;

/// Rectangles in any places and directions, a body each: corners in the order (0, 0), (1, 0), (0, 1), (1, 1).
/// The first is an obstacle if asked for; below all of them is a half-space.
fn rectangles(random: &mut Random, bodies: usize, obstacle: bool) -> Case {
    let mut positions = Vec::new();
    for body in 0..bodies {
        let corner =
            Point::from(random.vector(2.0)) + 4.0 * body as f64 * random.between(0.3, 1.0) * Vector::z();
        let u = random.direction();
        let v = u.cross(&random.direction());
        positions.extend([corner, corner + u, corner + v, corner + u + v]);
    }
    let ground = positions.iter().map(|p| p.z).fold(f64::INFINITY, f64::min) - random.between(0.05, 3.0);
    let triangles = (0..bodies as u32).flat_map(|k| [[0, 1, 2], [1, 3, 2]].map(|t| t.map(|v| 4 * k + v)));
    let topology =
        Topology::builder(positions.len()).triangles(triangles).build().expect("vertices of their own");
    let mut filters = vec![BodyFilter::DEFORMABLE; bodies];
    if obstacle {
        filters[0] = BodyFilter::OBSTACLE;
    }
    let half_space = HalfSpace { normal: Vector::z(), offset: ground };
    let of_vertex = (0..positions.len() as u32).map(|v| v / 4).collect();
    let model = CollisionModel::new(topology, of_vertex, filters, vec![half_space]).expect("bodies");
    Case { name: "rectangles".to_owned(), model, positions }
}

/// What became of a call.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    steps: usize,
    /// Whether the first step is longer than those of the device.
    flies: bool,
    converged: bool,
    /// Largest distance from the target at the end [m].
    left: f64,
}

/// Resolves a problem on the twins of the kernels; every state and path is judged.
fn resolve(case: &Case, targets: &[Point]) -> Option<Course> {
    let mut params = Params::fast();
    params.contact.delta = Some(1e-2);
    let masses = vec![1.0; case.positions.len()];
    let mut resolver = Resolver::new(case.model.clone(), &case.positions, &masses, params).ok()?;
    let (mut checker, mut x) = (StepChecker::new(case), case.positions.clone());
    let mut course = Course::default();
    let mut observe = |state: &AcceptedState<'_>| {
        checker.check_step(state.previous, state.positions);
        let ways = state.positions.iter().zip(state.previous).map(|(end, start)| (end - start).norm());
        course.flies |= state.step == 0 && ways.fold(0.0, f64::max) > 0.5;
        ControlFlow::Continue(())
    };
    let input = ResolveInput::default();
    let statistics =
        resolve_on(TwinEngine::new(), &mut resolver, &mut x, targets, &input, &mut observe).ok()?;
    assert_eq!(checker.fault, None);
    course.steps = statistics.steps;
    course.converged = statistics.converged;
    course.left = x.iter().zip(targets).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
    Some(course)
}

#[test]
fn bodies_that_fly_as_a_whole_do_not_pass_through_each_other() {
    let mut random = Random::new(16);
    let (mut flights, mut solved) = (0, 0);
    for round in 0..300 {
        let bodies = 1 + random.below(5);
        let case = rectangles(&mut random, bodies, round % 3 == 0);
        let common = random.magnitude(0.3, 30.0) * random.direction();
        let moves: Vec<Vector> =
            (0..bodies).map(|_| common + random.magnitude(1e-3, 10.0) * random.direction()).collect();
        let bends = random.magnitude(1e-6, 0.3);
        let target = |(x, body): (&Point, &u32)| x + moves[*body as usize] + random.vector(bends);
        let targets: Vec<Point> = case.positions.iter().zip(case.model.vertex_body()).map(target).collect();
        if let Some(course) = resolve(&case, &targets) {
            solved += 1;
            flights += usize::from(course.flies);
        }
    }
    assert!(solved > 150 && flights > 50, "{flights} flights in {solved} problems");
}

/// Two sheets far above a half-space, one above the other.
#[test]
fn bodies_fly_alone_or_as_one_and_not_onto_a_half_space() {
    let sheet = |at: Point| {
        let [u, v] = [Vector::x(), Vector::y()];
        [at, at + u, at + v, at + u + v]
    };
    let mut case = rectangles(&mut Random::new(1), 2, false);
    case.positions = [sheet(Point::new(0.0, 0.0, 10.0)), sheet(Point::new(0.2, 0.1, 18.0))].concat();
    let moved = |moves: [Vector; 2]| -> Vec<Point> {
        case.positions.iter().enumerate().map(|(v, x)| x + moves[v / 4]).collect()
    };

    // Alike: a single step, and one that finds nothing left to do.
    let alike = resolve(&case, &moved([5.0 * Vector::x(); 2])).expect("a result");
    assert!(alike.flies && alike.converged && alike.steps <= 3 && alike.left < 1e-6, "{alike:?}");
    // Toward each other, but not so far that they meet.
    let nearer = resolve(&case, &moved([3.0 * Vector::z(), -3.0 * Vector::z()])).expect("a result");
    assert!(nearer.flies && nearer.converged && nearer.steps <= 3 && nearer.left < 1e-6, "{nearer:?}");
    // Through each other while both go aside: they fly aside as one and then go around each other.
    let aside = 7.0 * Vector::x();
    let through =
        resolve(&case, &moved([aside + 5.0 * Vector::z(), aside - 5.0 * Vector::z()])).expect("a result");
    assert!(through.flies && (10..50).contains(&through.steps), "{through:?}");
    // Onto the half-space: no flight.
    let down = resolve(&case, &moved([-30.0 * Vector::z(); 2])).expect("a result");
    assert!(!down.flies && down.left > 10.0, "{down:?}");
}
