//! A step size for each vertex: that of its own first impact, verified and backtracked (paper, section 5; Wu et al. 2020 do
//! so for vertex-vertex pairs).
//!
//! A time of impact holds while both sides move on one clock. Once a vertex goes a smaller fraction of its way than another,
//! their pair moves along other paths, and may meet earlier or at all: so the paths as shortened are tested again, those of
//! pairs that meet are shortened further, and so on until none does. Where that does not end soon, all vertices go the
//! fraction of their last paths that the earliest impact leaves.

use super::AdditiveCcd;
use super::pairs::clearance;
use super::reach::{Clocks, PathSearch};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::stepper::{StepReport, Stepper};
use bowknot_twoway::{CollisionScene, ForwardStep, ResolveState, Search, Statistics};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Pairs that one parallel task handles at least.
const CHUNK: usize = 256;

/// Moves each vertex by the fraction of its way at which it would first meet something.
#[derive(Debug)]
pub struct PerVertexImpact {
    ccd: AdditiveCcd,
    longest: f64,
    rounds: usize,
    stepper: Stepper,
    search: PathSearch,
    /// Paths of the present round, and whether each differs from the last round's.
    paths: Vec<Vector>,
    fractions: Vec<f64>,
    changed: Vec<bool>,
}

impl PerVertexImpact {
    /// Longest way of one step, in local edge lengths: pairs that may meet on clocks of their own multiply with it.
    const LONGEST: f64 = 1.0;
    /// Rounds of verification.
    const ROUNDS: usize = 20;

    /// With these settings of the CCD.
    pub fn new(ccd: AdditiveCcd) -> Self {
        Self {
            ccd,
            longest: Self::LONGEST,
            rounds: Self::ROUNDS,
            stepper: Stepper::default(),
            search: PathSearch::default(),
            paths: Vec::new(),
            fractions: Vec::new(),
            changed: Vec::new(),
        }
    }

    /// Paths from the fractions as limited so far; which of them are new.
    fn shorten(&mut self) {
        for (v, d) in self.stepper.displacements().iter().enumerate() {
            let fraction = self.stepper.alpha(v);
            self.changed[v] = fraction != self.fractions[v];
            self.fractions[v] = fraction;
            self.paths[v] = fraction * d;
        }
    }

    /// Limits the vertices of all pairs that meet along the present paths, of those that have a new one. Returns how far
    /// all vertices can go along them.
    fn limit(&self, scene: &CollisionScene, state: &ResolveState) -> f64 {
        let first = AtomicU64::new(1.0f64.to_bits());
        let pairs = &state.contacts.pairs;
        (0..pairs.len()).into_par_iter().with_min_len(CHUNK).for_each(|p| {
            let vertices = &pairs.pairs()[p].vertices[..pairs.kind(p).vertex_count()];
            if !vertices.iter().any(|&v| self.changed[v as usize]) {
                return;
            }
            let time = clearance(&self.ccd, scene, state, &self.paths, p, 1.0).time;
            if time < 1.0 {
                first.fetch_min(time.to_bits(), Ordering::Relaxed);
                for v in vertices.iter().map(|&v| v as usize) {
                    self.stepper.limit(v, time * self.fractions[v]);
                }
            }
        });
        f64::from_bits(first.into_inner())
    }

    fn limit_bodies(&self, scene: &CollisionScene, state: &ResolveState) {
        self.stepper.limit_by_bodies(scene.model(), scene.obstacle_vertices());
        self.stepper.limit_by_groups(state.call.groups().count());
    }
}

impl Default for PerVertexImpact {
    fn default() -> Self {
        Self::new(AdditiveCcd::default())
    }
}

impl ForwardStep for PerVertexImpact {
    fn begin(&mut self, scene: &CollisionScene, state: &ResolveState) {
        let count = scene.rest().len();
        self.stepper.begin(count);
        self.stepper.set_groups(state.call.groups().of_vertices());
        self.paths.resize(count, Vector::zeros());
        self.fractions.resize(count, 0.0);
        self.changed.resize(count, true);
    }

    fn advance(
        &mut self,
        scene: &CollisionScene,
        state: &mut ResolveState,
        search: &mut dyn Search,
        statistics: &mut Statistics,
    ) -> StepReport {
        self.stepper.set_target(&state.x, &state.y);
        for v in 0..state.x.len() {
            let length = self.stepper.displacements()[v].norm();
            let longest = self.longest * scene.local_edge(v);
            if length > longest {
                self.stepper.limit(v, longest / length);
            }
        }
        self.limit_bodies(scene, state);
        self.shorten();
        self.search.list(scene, state, search, &self.paths, Clocks::Own, 0.0, statistics);
        self.changed.fill(true);
        for round in 1..=self.rounds {
            let common = self.limit(scene, state);
            if common >= 1.0 {
                break;
            }
            if round == self.rounds {
                // On one clock along the paths just tested, every pair is clear up to here: those that were tested
                // before, all the way.
                for v in 0..self.paths.len() {
                    self.stepper.limit(v, common * self.fractions[v]);
                }
            }
            self.limit_bodies(scene, state);
            self.shorten();
        }
        state.previous.clone_from(&state.x);
        self.stepper.advance(&mut state.x)
    }
}
