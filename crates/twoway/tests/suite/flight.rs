//! Pairs beyond contact range: free flight, its end, and steps that reach farther than contacts.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

use crate::common::sheet;
use bowknot_check::{Judge, PathOptions};
use bowknot_geometry::{Point, Topology, Vector};
use bowknot_proximity::{BodyFilter, CollisionModel};
use bowknot_twoway::{AcceptedState, Params, ResolveInput, Resolver, Statistics};
use std::ops::ControlFlow;

/// Edge length of the sheets [m]. Contact range is 0.4 edges or less, and a step reaches 0.35.
const EDGE: f64 = 0.1;

/// Two level sheets, the second above the first. No step may let them meet: each path is judged.
struct Layers {
    x: Vec<Point>,
    resolver: Resolver,
}

impl Layers {
    /// Sheets at the given heights, as two bodies or as one.
    fn new(heights: [f64; 2], bodies: usize, params: Params) -> Self {
        let (mut x, mut triangles) = (Vec::new(), Vec::new());
        for height in heights {
            sheet(8, EDGE, height, &mut x, &mut triangles);
        }
        let half = x.len() / 2;
        let topology = Topology::builder(x.len()).triangles(triangles).build().unwrap();
        let of_vertices = (0..x.len()).map(|v| u32::from(v >= half && bodies == 2)).collect();
        let filters = vec![BodyFilter::DEFORMABLE; bodies];
        let model = CollisionModel::new(topology, of_vertices, filters, Vec::new()).unwrap();
        let resolver = Resolver::new(model, &x, &vec![1.0; x.len()], params).unwrap();
        Self { x, resolver }
    }

    /// One call that wants to move the lower and the upper sheet by these displacements [m].
    fn step(&mut self, lower: Vector, upper: Vector) -> Statistics {
        let half = self.x.len() / 2;
        let place = |(v, p): (usize, &Point)| p + if v < half { lower } else { upper };
        let target: Vec<Point> = self.x.iter().enumerate().map(place).collect();
        let judge = Judge::from_model(self.resolver.scene().model());
        let mut check = |state: &AcceptedState<'_>| {
            let path = judge.check_path(state.previous, state.positions, &PathOptions::default()).unwrap();
            assert!(path.is_clear(), "step {}: {} pairs meet", state.step, path.hit_count);
            ControlFlow::Continue(())
        };
        self.resolver.resolve_with(&mut self.x, &target, &ResolveInput::default(), &mut check).unwrap()
    }
}

/// Without long steps: every step stays within the trust regions.
fn short_steps() -> Params {
    let mut params = Params::fast();
    params.solver.forward.swept_travel = f64::INFINITY;
    params
}

#[test]
fn pairs_out_of_contact_range_limit_the_steps_that_reach_them() {
    // Two moves of 0.35 edges are longer than this gap, which is longer than contact range.
    let mut layers = Layers::new([0.0, 0.55 * EDGE], 2, short_steps());
    let contacts = layers.resolver.detect_contacts(&layers.x, &ResolveInput::default()).unwrap();
    assert!(contacts.pairs.is_empty());
    layers.step(EDGE * Vector::z(), -EDGE * Vector::z());
}

#[test]
fn bodies_in_free_flight_need_one_search_and_one_step() {
    let mut layers = Layers::new([0.0, 0.5], 2, Params::fast());
    for call in 0..6 {
        let [lower, upper] =
            [Vector::new(3.0, 1.0, 0.5), Vector::new(2.9, 1.1, 0.7)].map(|v| v * f64::from(call));
        let before = layers.x.clone();
        let report = layers.step(lower, upper);
        assert_eq!(report.steps, 1);
        assert!(report.searches <= usize::from(call == 0), "call {call}: {}", report.searches);
        let half = before.len() / 2;
        let error = |(v, (x, start)): (usize, (&Point, &Point))| {
            (x - start - if v < half { lower } else { upper }).norm()
        };
        let worst = layers.x.iter().zip(&before).enumerate().map(error).fold(0.0, f64::max);
        assert!(worst < 1e-12, "call {call}: {worst}");
    }
}

#[test]
fn bodies_that_want_to_change_places_do_not_fly() {
    for params in [short_steps(), Params::fast()] {
        let mut layers = Layers::new([0.0, 0.5], 2, params);
        let report = layers.step(Vector::new(4.0, 0.0, 2.0), Vector::new(4.0, 0.0, -2.0));
        assert!(report.steps > 1);
    }
}

/// In flight, lists lack the pairs of bodies that have come near: they must be found when it ends.
#[test]
fn bodies_that_meet_after_a_flight_do_not_pass() {
    for params in [short_steps(), Params::fast()] {
        let mut layers = Layers::new([0.0, 3.05], 2, params);
        let mut searches = 0;
        for call in 0..12 {
            let report = layers.step(Vector::new(1.0, 0.0, 0.0), Vector::new(1.0, 0.0, -0.4));
            searches += report.searches;
            assert!(call != 4 || searches <= 1, "{searches}");
        }
        assert!(searches > 1);
    }
}

#[test]
fn layers_of_a_body_do_not_cross_in_flight() {
    for params in [short_steps(), Params::fast()] {
        for gap in [0.3, 0.55] {
            // They close by 0.6 edges while the body moves far.
            let mut layers = Layers::new([0.0, gap * EDGE], 1, params.clone());
            let common = Vector::new(5.0, -3.0, 2.0);
            layers.step(common + 0.3 * EDGE * Vector::z(), common - 0.3 * EDGE * Vector::z());
        }
    }
}

/// The list of a body moves along with it, call after call, and still has the layers that come near at last.
#[test]
fn layers_of_a_body_that_close_after_a_flight_do_not_cross() {
    for params in [short_steps(), Params::fast()] {
        let mut layers = Layers::new([0.0, 1.2 * EDGE], 1, params);
        for _ in 0..8 {
            layers.step(Vector::new(5.0, 0.5, 0.1 * EDGE), Vector::new(5.0, 0.5, -0.1 * EDGE));
        }
    }
}

/// As before, with bodies that come back so gently that none of their trust regions is new.
#[test]
fn bodies_that_come_back_beside_where_they_were_are_found() {
    let mut layers = Layers::new([0.0, 0.12 * EDGE], 2, Params::fast());
    let up = EDGE * Vector::z();
    layers.step(-0.3 * up, 0.3 * up);
    for away in [2.0 * up, EDGE * Vector::new(3.3, 1.4, 0.0), -2.3 * up] {
        assert_eq!(layers.step(Vector::zeros(), away).searches, 0);
    }
    let report = layers.step(0.29 * up, -0.29 * up);
    assert!(report.searches > 0 && report.min_gap_m.is_some());
}
