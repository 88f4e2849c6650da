//! Judging a run as it goes, `--check`.

use crate::check::{CheckError, Judge, PathOptions, StateOptions};
use crate::simulator::{AcceptedStep, Simulator, describe_intersections};
use crate::world::World;

/// How many findings are kept in words.
const KEPT: usize = 10;

/// Judges every accepted state, and the straight path to it.
#[derive(Debug)]
pub struct Checker {
    judge: Judge,
    states: usize,
    intersections: usize,
    findings: Vec<String>,
}

impl Checker {
    /// A checker of a simulation's states.
    pub fn new(simulator: &Simulator) -> Self {
        Self { judge: simulator.judge(), states: 0, intersections: 0, findings: Vec::new() }
    }

    /// Judges an accepted state and the path to it.
    ///
    /// # Errors
    /// Positions that are not finite, or beyond what exact arithmetic can take.
    pub fn judge(&mut self, accepted: &AcceptedStep<'_>, world: &World) -> Result<(), CheckError> {
        let place = format!(
            "time step {}, iteration {}, two-way step {}",
            accepted.step, accepted.iteration, accepted.state.step
        );
        let options = StateOptions { limit: KEPT, distance: false };
        let state = self.judge.check_state(accepted.state.positions, &options)?;
        for line in describe_intersections(world, &state.intersections) {
            self.find(format!("{place}: {line} intersect"));
        }
        let options = PathOptions { limit: KEPT, ..PathOptions::default() };
        let path = self.judge.check_path(accepted.state.previous, accepted.state.positions, &options)?;
        for hit in &path.hits {
            self.find(format!("{place}, on the way: {hit}"));
        }
        self.states += 1;
        self.intersections += state.intersection_count + path.hit_count;
        Ok(())
    }

    fn find(&mut self, finding: String) {
        tracing::error!("{finding}");
        if self.findings.len() < KEPT {
            self.findings.push(finding);
        }
    }

    /// States judged.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Intersections found so far, in states and on paths.
    pub fn intersections(&self) -> usize {
        self.intersections
    }

    /// The first findings, in words.
    pub fn findings(&self) -> &[String] {
        &self.findings
    }
}
