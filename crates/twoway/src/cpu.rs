//! Two-way steps on the CPU: search, backward step, forward step.

use crate::algorithm::{Processor, Progress};
use crate::error::ResolveError;
use crate::filter::apply_filter;
use crate::observer::{AcceptedState, Observer};
use crate::scene::CollisionScene;
use crate::stages::{BackwardStep, ForwardStep, Search};
use crate::state::ResolveState;
use crate::statistics::Statistics;
use crate::stop::Residuals;
use bowknot_constraints::FrictionModel;
use bowknot_geometry::Point;
use bowknot_stepper::StepReport;
use std::ops::ControlFlow;
use web_time::Instant;

/// The stages over the state of a call.
pub(crate) struct Cpu<'a, S, B, F> {
    pub scene: &'a CollisionScene,
    pub state: &'a mut ResolveState,
    pub search: &'a mut S,
    pub backward: &'a mut B,
    pub forward: &'a mut F,
    /// Of the last step.
    pub report: StepReport,
}

impl<S: Search, B: BackwardStep, F: ForwardStep<S>> Processor for Cpu<'_, S, B, F> {
    type Error = ResolveError;

    /// One step of Algorithm 1 of the paper. The search keeps D^(l), and a search is due if D^(l) < D^min, or by
    /// the rule that replaces it.
    fn steps(
        &mut self,
        _: usize,
        observer: &mut dyn Observer,
        statistics: &mut Statistics,
    ) -> Result<(usize, ControlFlow<()>), ResolveError> {
        let searches = statistics.searches;
        // Within the thread pool: a parallel loop that starts outside of it pays for the crossing.
        self.report = rayon::scope(|_| {
            self.search.update(self.scene, self.state, statistics);
            self.state.check_pairs(self.scene)?;
            if self.state.step == 0 && self.scene.friction_model() == FrictionModel::Filter {
                apply_filter(self.scene, self.state);
            }
            self.project(statistics);
            let report = self.advance(statistics);
            // A swept step lists pairs of its own.
            self.state.check_pairs(self.scene).map(|()| report)
        })?;
        statistics.skipped.searches += usize::from(statistics.searches == searches);
        let Self { scene, state, forward, report, .. } = self;
        let ResolveState { step, previous, x: positions, y: target, .. } = &**state;
        let observed = observer.accepted(&AcceptedState { step: *step, previous, positions, target });
        observer.waiting(&|| forward.waits(scene, state));
        state.step += 1;
        state.remaining = report.remaining;
        statistics.remaining_r = report.remaining_fraction;
        statistics.slowest_body = report.slowest.map(|v| scene.model().vertex_body()[v as usize]);
        Ok((1, observed))
    }

    fn report(&self, _: usize) -> StepReport {
        self.report
    }

    fn residuals(&mut self, _: usize) -> Residuals {
        self.backward.residuals(self.scene, self.state)
    }

    fn has_converged(&self) -> Option<bool> {
        self.backward.converged(self.scene, self.state)
    }

    fn is_free(&self, _: usize) -> bool {
        self.state.contacts.multipliers.iter().all(|&multiplier| multiplier == 0.0)
    }

    fn progress(&self, _: usize, of: Progress) -> f64 {
        match of {
            Progress::Lag => self.farthest(true, &self.state.target),
            Progress::Remaining => self.farthest(false, &self.state.y),
            Progress::Move => self.farthest(false, &self.state.previous),
        }
    }
}

impl<S: Search, B: BackwardStep, F: ForwardStep<S>> Cpu<'_, S, B, F> {
    /// The backward step, with its seconds.
    fn project(&mut self, statistics: &mut Statistics) {
        let timer = Instant::now();
        self.backward.project(self.scene, self.state, statistics);
        statistics.seconds.backward += timer.elapsed().as_secs_f64();
    }

    /// The forward step, with its seconds less those of searches that it makes.
    fn advance(&mut self, statistics: &mut Statistics) -> StepReport {
        let (timer, before) = (Instant::now(), statistics.seconds.of_search());
        let report = self.forward.advance(self.scene, self.state, self.search, statistics);
        let searched = statistics.seconds.of_search() - before;
        statistics.seconds.forward += timer.elapsed().as_secs_f64() - searched;
        report
    }

    /// Largest distance of a vertex to its place in `ends` [m], of those that are prescribed or of the others.
    fn farthest(&self, prescribed: bool, ends: &[Point]) -> f64 {
        let ResolveState { x, call, .. } = &*self.state;
        let vertices = (0..x.len()).filter(|&v| call.is_prescribed(v) == prescribed);
        vertices.map(|v| (ends[v] - x[v]).norm()).fold(0.0, f64::max)
    }
}
