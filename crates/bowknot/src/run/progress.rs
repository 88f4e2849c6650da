//! Where a run is, between time steps and within slow ones.

use super::checker::Checker;
use crate::simulator::{NearStart, StepStatistics, WaitingElements};
use bowknot_scene::world::{SceneInfo, World};
use std::ops::ControlFlow;
use std::time::Duration;
use web_time::Instant;

/// How long a time step takes before it is reported while it goes on, and how often it then is.
const SLOW: [Duration; 2] = [Duration::from_secs(2), Duration::from_secs(1)];

/// Where a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Time steps made, those before a resumption included.
    pub step: usize,
    /// Time steps to be made.
    pub frames: usize,
    /// What is simulated.
    pub world: &'a World,
    /// Counts of it.
    pub info: &'a SceneInfo,
    /// Pairs that started nearer than their contact distance; none of a run that is resumed.
    pub near_starts: &'a [NearStart],
    /// The last time step; none before the first, and within one.
    pub statistics: Option<&'a StepStatistics>,
    /// Intersections found so far, if checked.
    pub intersections: Option<usize>,
    /// The time step that goes on; none between time steps.
    pub within: Option<WithinStep<'a>>,
}

/// A time step that goes on for long.
#[derive(Clone, Copy, Debug)]
pub struct WithinStep<'a> {
    /// Two-way steps so far.
    pub two_way_steps: usize,
    /// Wall time so far [s].
    pub seconds: f64,
    /// What holds back the vertices that have farthest to go, farthest first.
    pub waits: &'a [WaitingElements],
}

/// Tells the caller of a run where it is.
pub(super) struct Reporter<'a> {
    progress: &'a mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>,
    frames: usize,
    world: &'a World,
    info: &'a SceneInfo,
    near_starts: &'a [NearStart],
    /// As [`SLOW`].
    slow: [Duration; 2],
    /// Time steps made.
    step: usize,
    /// When the present time step began.
    began: Instant,
    /// When it was reported last.
    reported: Option<Instant>,
    two_way_steps: usize,
    /// What the caller has answered within the time step.
    flow: ControlFlow<()>,
}

impl<'a> Reporter<'a> {
    pub fn new(
        progress: &'a mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>,
        frames: usize,
        world: &'a World,
        info: &'a SceneInfo,
        near_starts: &'a [NearStart],
    ) -> Self {
        let (began, flow) = (Instant::now(), ControlFlow::Continue(()));
        Self {
            progress,
            frames,
            world,
            info,
            near_starts,
            slow: SLOW,
            step: 0,
            began,
            reported: None,
            two_way_steps: 0,
            flow,
        }
    }

    /// Reports after `step` time steps; the next one begins when this returns.
    pub fn between_steps(
        &mut self,
        step: usize,
        statistics: Option<&StepStatistics>,
        checker: Option<&Checker>,
    ) -> ControlFlow<()> {
        self.step = step;
        let flow = self.report(statistics, checker, None);
        (self.began, self.reported, self.two_way_steps) = (Instant::now(), None, 0);
        flow
    }

    /// Counts two-way steps. Breaks if the caller has said so since the last ones.
    pub fn advanced(&mut self, steps: usize) -> ControlFlow<()> {
        self.two_way_steps += steps;
        self.flow
    }

    /// Reports within a time step, if that is due; `tell` tells what it waits for.
    pub fn waiting(&mut self, tell: &dyn Fn() -> Vec<WaitingElements>, checker: Option<&Checker>) {
        let now = Instant::now();
        let due = self.reported.map_or(self.began + self.slow[0], |reported| reported + self.slow[1]);
        if now < due {
            return;
        }
        self.reported = Some(now);
        let seconds = (now - self.began).as_secs_f64();
        let within = WithinStep { two_way_steps: self.two_way_steps, seconds, waits: &tell() };
        self.flow = self.report(None, checker, Some(within));
    }

    fn report(
        &mut self,
        statistics: Option<&StepStatistics>,
        checker: Option<&Checker>,
        within: Option<WithinStep<'_>>,
    ) -> ControlFlow<()> {
        let intersections = checker.map(Checker::intersections);
        let Self { frames, world, info, near_starts, step, .. } = *self;
        (self.progress)(&Progress {
            step,
            frames,
            world,
            info,
            near_starts,
            statistics,
            intersections,
            within,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use bowknot_twoway::WaitReason;
    use std::cell::Cell;

    #[test]
    fn only_slow_time_steps_are_reported_within_and_asked_what_they_wait_for() {
        let scene = Scene::builtin("drape", 0.2).expect("a scene");
        let world = World::new(&scene).expect("a world");
        let info = world.info(0.01);
        let mut seen = Vec::new();
        let mut progress = |progress: &Progress<'_>| {
            let within = progress.within.map(|within| (within.two_way_steps, within.waits.len()));
            seen.push((progress.step, within));
            if seen.len() == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let asked = Cell::new(0);
        let tell = || {
            asked.set(asked.get() + 1);
            vec![WaitingElements {
                elements: Vec::new(),
                bodies: Vec::new(),
                place_m: [0.0; 3],
                gap_m: None,
                remaining_m: 1.0,
                reason: WaitReason::Planes,
            }]
        };
        let mut reporter = Reporter::new(&mut progress, 5, &world, &info, &[]);
        assert!(reporter.between_steps(4, None, None).is_continue());
        // Fast so far.
        for _ in 0..3 {
            assert!(reporter.advanced(1).is_continue());
            reporter.waiting(&tell, None);
        }
        assert_eq!(asked.get(), 0);
        reporter.slow = [Duration::ZERO, Duration::from_secs(1000)];
        for _ in 0..2 {
            assert!(reporter.advanced(1).is_continue());
            reporter.waiting(&tell, None);
        }
        assert_eq!(asked.get(), 1, "the second report is not due yet");
        reporter.slow[1] = Duration::ZERO;
        reporter.waiting(&tell, None);
        assert!(reporter.advanced(1).is_break(), "as the caller has answered");
        assert_eq!(seen, [(4, None), (4, Some((4, 1))), (4, Some((5, 1)))]);
    }
}
