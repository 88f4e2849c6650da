//! Algorithm 1: the two-way loop, its stopping rule, and when it is cut short. A processor makes the steps.

use crate::input::ResolveInput;
use crate::observer::Observer;
use crate::scene::CollisionScene;
use crate::stall::StallDetector;
use crate::statistics::Statistics;
use crate::stop::{Residuals, StopTest};
use bowknot_stepper::StepReport;
use std::ops::ControlFlow;
use web_time::Instant;

/// Makes two-way steps: on the CPU by the stages, on a device several of them at once.
///
/// Steps that were made together have numbers from 0.
pub trait Processor {
    /// Why a step could not be made.
    type Error;

    /// Makes up to `most` two-way steps, at least one, and shows them to the observer. Returns how many it made, and
    /// whether the observer lets the call go on. A processor may end earlier, where the rule is met by itself.
    ///
    /// # Errors
    /// What the processor fails of.
    fn steps(
        &mut self,
        most: usize,
        observer: &mut dyn Observer,
        statistics: &mut Statistics,
    ) -> Result<(usize, ControlFlow<()>), Self::Error>;

    /// What step `k` of the last ones came to.
    fn report(&self, k: usize) -> StepReport;

    /// Residuals after step `k` of the last ones.
    fn residuals(&mut self, k: usize) -> Residuals;

    /// Whether the method has converged by a rule of its own; None: the stopping rule decides.
    fn has_converged(&self) -> Option<bool> {
        None
    }

    /// Whether no contact presses after step `k` of the last ones.
    fn is_free(&self, k: usize) -> bool;

    /// What a stall shows in after step `k` of the last ones.
    fn progress(&self, k: usize, of: Progress) -> f64;
}

/// Distances of vertices that tell whether a call stalls, the largest of each kind [m].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Of prescribed vertices to their keyframes.
    Lag,
    /// Of the others to where the step wanted to go.
    Remaining,
    /// Of the others to where they were before the step.
    Move,
}

/// A call of the two-way loop.
#[derive(Debug)]
pub struct Call {
    timer: Instant,
    stop: StopTest,
    stall: StallDetector,
}

impl Call {
    /// Starts the clock and the rules of a call.
    pub fn new(scene: &CollisionScene, input: &ResolveInput<'_>) -> Self {
        let edge = scene.lengths().edge;
        Self {
            timer: Instant::now(),
            stop: StopTest::new(&scene.params().solver.stop, edge, input.time_step, input.max_steps),
            stall: StallDetector::new(edge, scene.arrival_distance()),
        }
    }

    /// The stopping rule.
    pub fn stop(&self) -> &StopTest {
        &self.stop
    }

    /// Seconds since the call began.
    pub fn seconds(&self) -> f64 {
        self.timer.elapsed().as_secs_f64()
    }

    /// Makes steps until the rule is met, the observer ends the call, time or steps are used up, or no progress is
    /// possible. `statistics.steps` are the steps so far.
    ///
    /// # Errors
    /// Those of the processor.
    pub fn run<P: Processor>(
        &mut self,
        processor: &mut P,
        observer: &mut dyn Observer,
        statistics: &mut Statistics,
    ) -> Result<(), P::Error> {
        while self.stop.allows_step(statistics.steps) {
            // A stall can then end the call after the last of them alone.
            let most = self.stall.steps_left().min(self.stop.max_steps() - statistics.steps);
            let (made, observed) = processor.steps(most, observer, statistics)?;
            let mut is_stalled = false;
            for k in 0..made {
                statistics.steps += 1;
                statistics.converged = self.is_met(processor, k, statistics.steps);
                let distance = |of| processor.progress(k, of);
                is_stalled = self.stall.update(
                    distance(Progress::Lag),
                    || distance(Progress::Remaining),
                    || distance(Progress::Move),
                );
            }
            let is_out_of_time = self.stop.is_out_of_time(self.seconds());
            if statistics.converged || observed.is_break() || is_out_of_time || is_stalled {
                break;
            }
        }
        Ok(())
    }

    /// Whether step `k` of the last ones, after which there are `steps`, ends the call.
    fn is_met<P: Processor>(&mut self, processor: &mut P, k: usize, steps: usize) -> bool {
        let report = processor.report(k);
        let is_met = match processor.has_converged() {
            Some(converged) => converged,
            None => self.stop.is_met(&report, || processor.residuals(k)),
        };
        is_met && !self.stop.takes_finishing_step(&report, steps, || processor.is_free(k))
    }
}
