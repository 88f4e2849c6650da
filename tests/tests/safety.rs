//! From hard intersection-free states toward any finite target, no straight path of any step intersects. The
//! judge decides this exactly and shares no code with the stepper.
//!
//! `BOWKNOT_SEEDS=20 cargo test --release -p bowknot-tests safety` runs ten times as many cases.

use bowknot_geometry::{Point, Separation};
use bowknot_proximity::{PairList, ProximitySearch};
use bowknot_stepper::{Contacts, Stepper, TrustRegions};
use bowknot_tests::states::GENERATORS;
use bowknot_tests::targets::Rule;
use bowknot_tests::{Case, Random, StepChecker};
use bowknot_twoway::{
    AcceptedState, BackwardStep, BodyContact, CertifiedForward, CollisionScene, ForwardStep, LcpBackward,
    Params, ResolveError, ResolveInput, Resolver, Search, TrustRegionSearch,
};
use std::ops::ControlFlow;

/// Distances of targets [m].
const MAGNITUDES: [f64; 10] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1000.0];

pub fn seeds() -> u64 {
    std::env::var("BOWKNOT_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(2)
}

/// The result of a check with every generator, every rule and various magnitudes.
#[derive(Default)]
pub struct Outcome {
    runs: usize,
    /// Number of runs in which a vertex moved.
    moved: usize,
    faults: Vec<String>,
}

impl Outcome {
    /// Runs `check`, which returns the largest move of any vertex, or a fault.
    pub fn of(seeds: u64, check: impl Fn(&Case, &[Point]) -> Result<f64, String>) -> Self {
        let mut outcome = Self::default();
        for (g, generator) in GENERATORS.iter().enumerate() {
            for seed in 0..seeds {
                let case = generator(seed);
                for (r, rule) in Rule::ALL.into_iter().enumerate() {
                    let magnitude = MAGNITUDES[(3 * r + 7 * seed as usize + g) % MAGNITUDES.len()];
                    let mut random = Random::new(1000 * seed + r as u64);
                    let targets = rule.targets(&case, magnitude, &mut random);
                    outcome.runs += 1;
                    match check(&case, &targets) {
                        Ok(largest_move) => outcome.moved += usize::from(largest_move > 0.0),
                        Err(fault) => {
                            outcome.faults.push(format!("{}, {rule:?}, {magnitude:e} m: {fault}", case.name));
                        }
                    }
                }
            }
        }
        outcome
    }

    /// Share of the runs with a fault.
    pub fn caught(&self) -> f64 {
        self.faults.len() as f64 / self.runs as f64
    }

    pub fn assert_safe(&self) {
        let Self { runs, moved, faults } = self;
        assert!(faults.is_empty(), "{} of {runs} runs:\n{}", faults.len(), faults.join("\n"));
        // A step that never moves anything is safe but useless.
        assert!(10 * moved >= 9 * runs, "only {moved} of {runs} runs moved at all");
    }
}

/// The forward step by itself: search, bound, trust regions, advance, with nothing to soften the target.
struct Forward {
    search: ProximitySearch,
    stepper: Stepper,
    pairs: PairList,
    separations: Vec<Separation>,
    obstacle_vertices: Vec<u32>,
    planes: bool,
    /// Share of a gap that a step may use.
    damping: f64,
}

impl Forward {
    /// Minimum separation [m]: above 16 ulp at a kilometer.
    const MIN_SEPARATION: f64 = 1e-8;

    fn new(case: &Case, planes: bool, damping: f64) -> Self {
        let vertices = 0..case.positions.len() as u32;
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
        }
    }

    fn step(&mut self, case: &Case, x: &[Point], y: &[Point]) -> Vec<Point> {
        let model = &case.model;
        let trust_regions = TrustRegions {
            centers: x.to_vec(),
            radii: x.iter().zip(y).map(|(x, y)| (y - x).norm().clamp(1e-7, 5e-3)).collect(),
        };
        let radii: Vec<f64> =
            trust_regions.radii.iter().map(|radius| radius + 0.5 * Self::MIN_SEPARATION).collect();
        self.search.search(model, x, &radii, &mut self.pairs, &mut self.separations);
        let min_separations = vec![Self::MIN_SEPARATION; self.pairs.len()];
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

fn forward_alone(seeds: u64, planes: bool, damping: f64) -> Outcome {
    Outcome::of(seeds, |case, targets| {
        let mut forward = Forward::new(case, planes, damping);
        let mut checker = StepChecker::new(case);
        checker.follow(case, targets, 8, |x, y| forward.step(case, x, y));
        checker.fault.map_or(Ok(checker.largest_move), Err)
    })
}

#[test]
fn no_forward_step_by_planes_intersects() {
    forward_alone(seeds(), true, 0.9).assert_safe();
}

#[test]
fn no_forward_step_by_distances_intersects() {
    forward_alone(seeds(), false, 0.9).assert_safe();
}

/// The judge finds unsafe steps in these cases: steps by planes that use a tenth more than the whole gap, and
/// steps by distances that use twice the gap. (Two vertices rarely both use their whole isotropic bound, so a
/// tenth more is not enough there.)
#[test]
fn greedy_steps_are_caught() {
    for (planes, damping) in [(true, 1.1), (false, 2.0)] {
        assert!(forward_alone(1, planes, damping).caught() >= 0.1);
    }
}

fn whole_method(params: &Params, contact: impl Fn(f64) -> BodyContact + Sync) {
    watched(params, seeds(), |scene| {
        let bodies = vec![contact(scene.lengths().edge); scene.model().bodies().len()];
        let search = TrustRegionSearch::new(&scene);
        let backward: LcpBackward = LcpBackward::default();
        Resolver::with_stages(scene, search, backward, CertifiedForward::default()).with_bodies(bodies)
    })
    .assert_safe();
}

/// Checks every step of a loop of stages, from all states to all targets.
pub fn watched<S: Search, B: BackwardStep, F: ForwardStep>(
    params: &Params,
    seeds: u64,
    resolver: impl Fn(CollisionScene) -> Result<Resolver<S, B, F>, ResolveError>,
) -> Outcome {
    Outcome::of(seeds, |case, targets| {
        let mut checker = StepChecker::new(case);
        let mut x = case.positions.clone();
        let mut params = params.clone();
        params.solver.stop.max_steps = Some(12);
        // Coordinates of a kilometer need a minimum separation above their rounding.
        if params.contact.min_separation.is_none() {
            params.contact.min_separation = Some(1e-8);
        }
        let masses = vec![1.0; x.len()];
        let mut resolver = CollisionScene::new(case.model.clone(), &case.positions, &masses, params)
            .and_then(&resolver)
            .map_err(|error| format!("refused: {error}"))?;
        let mut last = x.clone();
        let mut observe = |state: &AcceptedState<'_>| {
            let joined = state.previous == last.as_slice();
            last.copy_from_slice(state.positions);
            if !joined {
                checker
                    .fault
                    .get_or_insert(format!("step {} does not start where the last one ended", state.step));
            }
            if checker.check_step(state.previous, state.positions) {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        resolver
            .resolve_with(&mut x, targets, &ResolveInput::default(), &mut observe)
            .map_err(|error| format!("refused: {error}"))?;
        if x != last {
            checker.fault.get_or_insert("the result is not the last accepted state".to_owned());
        }
        checker.fault.map_or(Ok(checker.largest_move), Err)
    })
}

#[test]
fn no_step_of_the_fast_preset_intersects() {
    whole_method(&Params::fast(), |_| BodyContact::default());
}

#[test]
fn no_step_of_the_paper_preset_intersects() {
    whole_method(&Params::paper(), |_| BodyContact::default());
}

#[test]
fn no_step_with_friction_and_thickness_intersects() {
    let rough = BodyContact { friction: 0.7, ..BodyContact::default() };
    // Small compared with the mesh: if all gaps were below the thickness, nothing would move.
    let thick = |edge: f64| BodyContact {
        thickness: Some((1e-3 * edge).max(1e-8)),
        stretch_limit: Some(f64::INFINITY),
        ..rough
    };
    for params in [Params::fast(), Params::paper()] {
        whole_method(&params, |_| rough);
        whole_method(&params, thick);
    }
}
