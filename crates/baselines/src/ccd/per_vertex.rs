//! A step size for each vertex: that of its own first impact, verified and backtracked (paper, section 5; Wu
//! et al. 2020 do so for vertex-vertex pairs).
//!
//! A time of impact is valid while both sides move with a common path time. If one vertex moves by a smaller
//! fraction of its way than another, their pair moves along other paths, and may meet earlier than before. So
//! the shortened paths are tested again, those of pairs that meet are shortened further, and so on until no
//! pair meets. If that takes too many rounds, all vertices move by the fraction of their last paths up to the
//! earliest impact.

use super::additive::AdditiveCcd;
use super::pairs::candidate_clearance;
use super::swept::{PathTime, SweptSearch};
use bowknot_errors::{Errors, ParamError, Parameters};
use bowknot_twoway::geometry::Vector;
use bowknot_twoway::stepper::{StepReport, Stepper};
use bowknot_twoway::{CollisionScene, ForwardStep, ResolveState, Statistics};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Smallest number of pairs of a parallel task.
const CHUNK: usize = 256;

/// Moves each vertex by the fraction of its way at which its first pair would meet.
#[derive(Debug, Default)]
pub struct PerVertexImpact {
    ccd: AdditiveCcd,
    stepper: Stepper,
    /// Paths of the present round.
    paths: Vec<Vector>,
    fractions: Vec<f64>,
    /// Whether each path differs from that of the last round.
    changed: Vec<bool>,
}

impl PerVertexImpact {
    /// Longest way of one step, in local edge lengths. Longer ways need many more candidate pairs.
    const MAX_LENGTH: f64 = 1.0;
    /// Largest number of rounds of verification.
    const MAX_ROUNDS: usize = 20;

    /// With these parameters of the CCD.
    ///
    /// # Errors
    /// Parameters out of their range.
    pub fn new(ccd: AdditiveCcd) -> Result<Self, Errors<ParamError>> {
        ccd.validate()?;
        Ok(Self { ccd, ..Self::default() })
    }

    /// Shortens the paths to the fractions so far, and marks those that change.
    fn shorten(&mut self) {
        for (v, d) in self.stepper.displacements().iter().enumerate() {
            let fraction = self.stepper.alpha(v);
            self.changed[v] = fraction != self.fractions[v];
            self.fractions[v] = fraction;
            self.paths[v] = fraction * d;
        }
    }

    /// Limits the vertices of all pairs with a changed path that meet along the present paths. Returns the
    /// fraction of these paths by which all vertices can move.
    fn limit(&self, scene: &CollisionScene, state: &ResolveState) -> f64 {
        let first = AtomicU64::new(1.0f64.to_bits());
        let pairs = &state.contacts.pairs;
        (0..pairs.len()).into_par_iter().with_min_len(CHUNK).for_each(|p| {
            let vertices = &pairs.pairs()[p].vertices[..pairs.kind(p).vertex_count()];
            if !vertices.iter().any(|&v| self.changed[v as usize]) {
                return;
            }
            let time = candidate_clearance(&self.ccd, scene, state, &self.paths, p, 1.0).time;
            if time < 1.0 {
                first.fetch_min(time.to_bits(), Ordering::Relaxed);
                for v in vertices.iter().map(|&v| v as usize) {
                    self.stepper.limit(v, time * self.fractions[v]);
                }
            }
        });
        f64::from_bits(first.into_inner())
    }

    fn limit_bodies(&mut self, scene: &CollisionScene, state: &ResolveState) {
        self.stepper.limit_by_bodies(scene.model(), scene.obstacle_vertices());
        self.stepper.limit_by_groups(state.call.groups().count());
    }
}

impl ForwardStep<SweptSearch> for PerVertexImpact {
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
        search: &mut SweptSearch,
        statistics: &mut Statistics,
    ) -> StepReport {
        self.stepper.set_target(&state.x, &state.y);
        for v in 0..state.x.len() {
            let length = self.stepper.displacements()[v].norm();
            let longest = Self::MAX_LENGTH * scene.local_edge(v);
            if length > longest {
                self.stepper.limit(v, longest / length);
            }
        }
        self.limit_bodies(scene, state);
        self.shorten();
        search.list(scene, state, &self.paths, PathTime::PerVertex, statistics);
        self.changed.fill(true);
        for round in 1..=Self::MAX_ROUNDS {
            let common = self.limit(scene, state);
            if common >= 1.0 {
                break;
            }
            if round == Self::MAX_ROUNDS {
                // With a common path time along the paths just tested, every pair is clear up to here. Pairs
                // without a changed path were tested in an earlier round and are clear all the way.
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
