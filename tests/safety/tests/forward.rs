//! The forward step by itself: search, bound, trust regions, advance, with nothing to soften the target.

use crate::steps::{expect, seeds};
use bowknot_geometry::{Point, Separation};
use bowknot_proximity::{PairList, ProximitySearch};
use bowknot_safety::search::{failing_share, search_many};
use bowknot_safety::{Case, Scenario, StepChecker, Tally, scenario};
use bowknot_stepper::{Bound, Contacts, ForwardOptions, Rounding, Stepper, TrustRegions};

struct Forward {
    search: ProximitySearch,
    stepper: Stepper,
    pairs: PairList,
    separations: Vec<Separation>,
    obstacle_vertices: Vec<u32>,
    planes: bool,
    /// Share of a gap that a step may use.
    damping: f64,
    /// Length of the unit of the scene [m].
    scale: f64,
    /// Minimum separation [m]: above 16 ulp of any coordinate.
    min_separation: f64,
}

impl Forward {
    fn new(case: &Case, targets: &[Point], scale: f64, planes: bool, damping: f64) -> Self {
        let vertices = 0..case.positions.len() as u32;
        let largest = case.positions.iter().chain(targets).map(|p| p.coords.amax()).fold(0.0, f64::max);
        let mut stepper = Stepper::default();
        stepper.begin(case.positions.len());
        Self {
            search: ProximitySearch::new(&case.model),
            stepper,
            pairs: PairList::default(),
            separations: Vec::new(),
            obstacle_vertices: vertices.filter(|&v| case.model.is_obstacle(v)).collect(),
            planes,
            damping,
            scale,
            min_separation: Rounding::smallest_min_separation(largest).max(1e-8 * scale),
        }
    }

    fn step(&mut self, case: &Case, x: &[Point], y: &[Point]) -> Vec<Point> {
        let model = &case.model;
        let (shortest, longest) = (1e-6 * self.scale, 5e-2 * self.scale);
        let trust_regions = TrustRegions {
            centers: x.to_vec(),
            radii: x.iter().zip(y).map(|(x, y)| (y - x).norm().clamp(shortest, longest)).collect(),
        };
        let radii: Vec<f64> =
            trust_regions.radii.iter().map(|radius| radius + 0.5 * self.min_separation).collect();
        self.search.search(model, x, &radii, &mut self.pairs, &mut self.separations);
        let min_separations = vec![self.min_separation; self.pairs.len()];
        let contacts = Contacts {
            pairs: &self.pairs,
            separations: &self.separations,
            min_separations: &min_separations,
        };

        self.stepper.set_target(x, y);
        if self.planes {
            self.stepper.limit_by_planes(&contacts, self.damping);
        } else {
            self.stepper.limit_by_distances(&contacts, self.damping);
        }
        self.stepper.limit_by_trust_regions(x, &trust_regions);
        self.stepper.limit_by_bodies(model, &self.obstacle_vertices);
        let mut next = x.to_vec();
        self.stepper.advance(&mut next);
        next
    }
}

/// Runs the first call of a problem.
fn check(scenario: &Scenario, planes: bool, damping: f64) -> Result<Tally, String> {
    let tally = Tally { cases: 1, ..Tally::default() };
    let Some(case) = scenario.case() else {
        return Ok(Tally { unusable: 1, ..tally });
    };
    let prescribed: Vec<bool> = (0..case.positions.len()).map(|v| case.model.is_obstacle(v as u32)).collect();
    let targets = scenario.calls[0].targets(&case, &case.positions, &prescribed, scenario.scale());
    let mut forward = Forward::new(&case, &targets, scenario.scale(), planes, damping);
    let mut checker = StepChecker::new(&case);
    checker.follow(&case, &targets, 8, |x, y| forward.step(&case, x, y));
    let moved = usize::from(checker.largest_move > 0.0);
    checker.fault.map_or(Ok(Tally { moved, steps: checker.steps, ..tally }), Err)
}

fn is_safe(planes: bool) {
    let check = |scenario: &_| check(scenario, planes, 0.9);
    let tally = expect(search_many(4, 300 * seeds(), scenario::any, check));
    assert!(2 * tally.moved >= tally.cases, "{tally:?}");
    let tally = expect(search_many(5, 24 * seeds(), scenario::generated, check));
    assert!(10 * tally.moved >= 9 * tally.cases, "{tally:?}");
}

#[test]
fn no_forward_step_by_planes_intersects() {
    is_safe(true);
}

#[test]
fn no_forward_step_by_distances_intersects() {
    is_safe(false);
}

/// Runs the first call of a problem by composed steps, several of them with a list.
fn check_composed(scenario: &Scenario, bound: Bound) -> Result<Tally, String> {
    let tally = Tally { cases: 1, ..Tally::default() };
    let Some(case) = scenario.case() else {
        return Ok(Tally { unusable: 1, ..tally });
    };
    let prescribed: Vec<bool> = (0..case.positions.len()).map(|v| case.model.is_obstacle(v as u32)).collect();
    let targets = scenario.calls[0].targets(&case, &case.positions, &prescribed, scenario.scale());
    let (shortest, longest) = (1e-6 * scenario.scale(), 5e-2 * scenario.scale());
    let radii = |x: &[Point]| -> Vec<f64> {
        x.iter().zip(&targets).map(|(x, y)| (y - x).norm().clamp(shortest, longest)).collect()
    };
    let options = ForwardOptions { bound, ..ForwardOptions::default() };
    let (model, start) = (case.model.clone(), case.positions.clone());
    let mut forward = bowknot_stepper::Forward::new(model, start.clone(), &radii(&start), options)
        .map_err(|error| error.to_string())?;
    let mut checker = StepChecker::new(&case);
    let mut is_due = false;
    checker.follow(&case, &targets, 12, |x, y| {
        if is_due {
            forward.search(&radii(x)).expect("positions within bounds");
        }
        is_due = forward.advance(y).expect("a target per vertex").search_due;
        forward.positions().to_vec()
    });
    let moved = usize::from(checker.largest_move > 0.0);
    checker.fault.map_or(Ok(Tally { moved, steps: checker.steps, ..tally }), Err)
}

#[test]
fn no_composed_step_intersects() {
    for bound in [Bound::Planes, Bound::Isotropic] {
        let check = |scenario: &_| check_composed(scenario, bound);
        let tally = expect(search_many(6, 300 * seeds(), scenario::any, check));
        assert!(2 * tally.moved >= tally.cases, "{tally:?}");
        let tally = expect(search_many(7, 24 * seeds(), scenario::generated, check));
        assert!(10 * tally.moved >= 9 * tally.cases, "{tally:?}");
    }
}

/// The judge finds unsafe steps in these cases: steps by planes that use a tenth more than the whole gap, and
/// steps by distances that use twice the gap. (Two vertices rarely both use their whole isotropic bound, so a
/// tenth more is not enough there.)
#[test]
fn greedy_steps_are_caught() {
    for (planes, damping) in [(true, 1.1), (false, 2.0)] {
        let caught = failing_share(5, 48, scenario::generated, |scenario| check(scenario, planes, damping));
        assert!(caught >= 0.1, "{caught} of the problems by {}", if planes { "planes" } else { "distances" });
    }
}
