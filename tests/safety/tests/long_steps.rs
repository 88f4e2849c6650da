//! Long steps that random problems hardly ever make dangerous: bodies that come near in a free flight.

use bowknot_geometry::{Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_safety::{Case, StepChecker};
use bowknot_twoway::{AcceptedState, Params, ResolveInput, Resolver};
use std::ops::ControlFlow;

/// Flat rectangles, a body each, with corners in the order (0, 0), (1, 0), (0, 1), (1, 1) along `sides`.
fn rectangles(sheets: &[(Point, [Vector; 2])]) -> Case {
    let corners = |(corner, [u, v]): &(Point, [Vector; 2])| [*corner, corner + u, corner + v, corner + u + v];
    let count = 4 * sheets.len();
    let triangles = (0..sheets.len() as u32)
        .flat_map(|k| [[4 * k, 4 * k + 1, 4 * k + 2], [4 * k + 1, 4 * k + 3, 4 * k + 2]]);
    let topology = Topology::builder(count).triangles(triangles).build().expect("vertices of their own");
    let bodies = (0..count as u32).map(|v| v / 4).collect();
    let filters = vec![BodyFilter::DEFORMABLE; sheets.len()];
    let model = CollisionModel::new(topology, bodies, filters, Vec::new()).expect("bodies");
    Case { name: "rectangles".to_owned(), model, positions: sheets.iter().flat_map(corners).collect() }
}

/// Moves each body by its displacements, one per call, and judges every step. Returns the number of steps.
fn follow(case: &Case, calls: &[&[Vector]]) -> usize {
    let mut params = Params::fast();
    (params.contact.delta, params.contact.min_separation) = (Some(1e-3), Some(0.0));
    params.solver.stop.max_steps = Some(8);
    let masses = vec![1.0; case.positions.len()];
    let mut resolver =
        Resolver::new(case.model.clone(), &case.positions, &masses, params).expect("a problem");
    let (mut checker, mut x) = (StepChecker::new(case), case.positions.clone());
    for moves in calls {
        let y: Vec<Point> =
            x.iter().zip(case.model.vertex_body()).map(|(p, &b)| p + moves[b as usize]).collect();
        let mut observe = |state: &AcceptedState<'_>| {
            checker.check_step(state.previous, state.positions);
            ControlFlow::Continue(())
        };
        resolver.resolve_with(&mut x, &y, &ResolveInput::default(), &mut observe).expect("valid input");
    }
    assert_eq!(checker.fault, None);
    checker.steps
}

fn at(x: f64, y: f64, z: f64) -> Point {
    Point::new(x, y, z)
}

const SQUARE: [Vector; 2] = [Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0)];

/// They are far apart when pairs are searched for, and come so near in a flight that the next step, within
/// the trust regions, could take them through each other.
#[test]
fn sheets_that_a_flight_has_brought_together_do_not_pass() {
    for gap in [0.02, 0.04, 0.08, 0.12] {
        let case = rectangles(&[(at(0.0, 0.0, 0.0), SQUARE), (at(0.1, 0.1, 3.0), SQUARE)]);
        let (flight, meeting) = (0.5 * (3.0 - gap), 0.09);
        let steps = follow(
            &case,
            &[
                &[Vector::z() * flight, -Vector::z() * flight],
                &[Vector::z() * meeting, -Vector::z() * meeting],
            ],
        );
        assert!(steps >= 2);
    }
}

/// A plate moves along x by `way`, a smaller one follows it at the distance `gap`, and a third, at `wall`,
/// stops the first but is not in the way of the second.
fn convoy(way: f64, wall: f64, gap: f64) {
    let plate = |x: f64, [y, z]: [[f64; 2]; 2]| {
        (at(x, y[0], z[0]), [Vector::y() * (y[1] - y[0]), Vector::z() * (z[1] - z[0])])
    };
    let case = rectangles(&[
        plate(0.0, [[0.0, 1.0], [0.0, 1.0]]),
        plate(-gap, [[0.2, 0.8], [0.1, 0.4]]),
        plate(wall, [[0.2, 0.8], [0.6, 0.9]]),
    ]);
    let moves = [Vector::x() * way, Vector::x() * way, Vector::zeros()];
    follow(&case, &[&moves, &moves]);
}

/// The search along the assumed paths does not see the followers, because they move alike: they are safe only
/// as long as both stay in their tubes.
#[test]
fn plates_that_follow_one_another_stop_when_the_first_is_stopped() {
    for gap in [0.3, 0.5, 0.7] {
        for wall in [0.1, 0.3, 0.6] {
            convoy(1.5, wall, gap);
        }
    }
}

/// The first plate ends within its tube, and the follower is so near that it meets it there: the search must
/// take the tubes into account.
#[test]
fn plates_that_follow_closely_do_not_pass_one_that_lags_within_its_tube() {
    for gap in [0.02, 0.05, 0.08] {
        for way in [0.8, 0.9, 1.0] {
            convoy(way, way - 0.01, gap);
        }
    }
}
