//! Judging a run as it goes, `--check`.
//!
//! **Every accepted state and path is shown to be free of intersections, but not every state needs exact
//! predicates for that.** The first state, and the one that each time step ends with, are judged by
//! themselves; of every two-way step the straight path is, both its ends included. Let the start of a
//! path be clear and the path certified. Then so is its end, class by class of what
//! [`bowknot_check::Judge::check_state`] looks at:
//!
//! - half-spaces, two particles, a particle and a strand edge or triangle, two strand edges, and the few
//!   touching pairs of meshes that no edge-triangle pair stands for are classes that a path is judged
//!   for, at its end as at any other time;
//! - an edge and a triangle that share no vertex. Were they to meet at the end, there would be a first
//!   time at which they do, later than the start, as meeting is a closed condition. An edge that meets a
//!   triangle in its inside only, and crosses its plane there, did so a moment before as well; so at that
//!   first time an end of the edge is on the triangle, or the edge meets an edge of the triangle
//!   (a degenerate triangle consists of its edges). Either is a vertex-triangle or an edge-edge pair
//!   that shares no vertex, of the same two bodies, and the path is certified to be free of those.
//!
//! Pairs that do not move on the path, and are skipped there, are as they were at its start. What the
//! argument needs is asked for: a path must start, to the bit, where the last one ended, or its start is
//! judged by itself; and after a finding, states are judged one by one until one is clear.

use crate::simulator::{AcceptedStep, Simulator, describe_intersections};
use bowknot_check::{CheckError, MotionJudge, PathOptions, StateOptions};
use bowknot_geometry::Point;
use bowknot_scene::world::World;

/// How many findings are kept in words.
const KEPT: usize = 10;

/// Judges the straight path to every accepted state, and the state at the end of every time step.
#[derive(Debug)]
pub struct Checker {
    judge: MotionJudge,
    /// Which bodies and half-spaces were there when the judge was made.
    present: Vec<bool>,
    /// The state that was judged last, by itself or as the end of a path.
    last: Vec<Point>,
    /// Whether that state is known to be clear.
    clear: bool,
    states: usize,
    paths: usize,
    intersections: usize,
    findings: Vec<String>,
}

impl Checker {
    /// A checker of a simulation's states.
    pub fn new(simulator: &Simulator) -> Self {
        Self {
            judge: MotionJudge::new(simulator.judge()),
            present: simulator.present().to_vec(),
            last: Vec::new(),
            clear: false,
            states: 0,
            paths: 0,
            intersections: 0,
            findings: Vec::new(),
        }
    }

    /// Goes on after a time step at whose end obstacles may have appeared or vanished: the next path is then
    /// judged with those that are there, from a start that is judged by itself.
    pub fn follow(&mut self, simulator: &Simulator) {
        if self.present != simulator.present() {
            self.judge = MotionJudge::new(simulator.judge());
            self.present = simulator.present().to_vec();
            self.last.clear();
            self.clear = false;
        }
    }

    /// Judges the path to an accepted state, and where that does not tell, the states at its ends.
    ///
    /// # Errors
    /// Positions that are not finite, or beyond what exact arithmetic can take.
    pub fn judge(&mut self, accepted: &AcceptedStep<'_>, world: &World) -> Result<(), CheckError> {
        let place = format!(
            "time step {}, iteration {}, two-way step {}",
            accepted.step, accepted.iteration, accepted.state.step
        );
        if self.last != accepted.state.previous {
            self.judge_state(accepted.state.previous, &format!("{place}, at its start"), world)?;
        }
        self.judge_path(accepted.state.previous, accepted.state.positions, &place)?;
        if !self.clear {
            self.judge_state(accepted.state.positions, &place, world)?;
        }
        Ok(())
    }

    /// Judges the state that a time step ends with, by itself.
    ///
    /// # Errors
    /// As [`Self::judge`].
    pub fn judge_end(&mut self, step: usize, positions: &[Point], world: &World) -> Result<(), CheckError> {
        if !self.clear && self.last == positions {
            // Judged by itself already, and counted.
            return Ok(());
        }
        self.judge_state(positions, &format!("end of time step {step}"), world)
    }

    fn judge_state(&mut self, x: &[Point], place: &str, world: &World) -> Result<(), CheckError> {
        let options = StateOptions { limit: KEPT, distance: false };
        let report = self.judge.check_state(x, &options)?;
        for line in describe_intersections(world, &report.intersections) {
            self.find(format!("{place}: {line} intersect"));
        }
        self.clear = report.is_clear();
        self.last.clear();
        self.last.extend_from_slice(x);
        self.states += 1;
        self.intersections += report.intersection_count;
        Ok(())
    }

    fn judge_path(&mut self, x0: &[Point], x1: &[Point], place: &str) -> Result<(), CheckError> {
        let options = PathOptions { limit: KEPT, ..PathOptions::default() };
        let report = self.judge.check_path(x0, x1, &options)?;
        for hit in &report.hits {
            self.find(format!("{place}, on the way: {hit}"));
        }
        self.clear &= report.is_clear();
        self.last.clear();
        self.last.extend_from_slice(x1);
        self.paths += 1;
        self.intersections += report.hit_count;
        Ok(())
    }

    fn find(&mut self, finding: String) {
        tracing::error!("{finding}");
        if self.findings.len() < KEPT {
            self.findings.push(finding);
        }
    }

    /// States judged by themselves.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Paths judged, one each two-way step.
    pub fn paths(&self) -> usize {
        self.paths
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use bowknot_geometry::Vector;
    use bowknot_twoway::AcceptedState;

    /// A sheet above a ball, clear of it, and a checker.
    struct Case {
        simulator: Simulator,
        checker: Checker,
        /// Where the sheet is, ever lower.
        states: Vec<Vec<Point>>,
    }

    impl Case {
        fn new(drops: &[f64]) -> Self {
            let scene = Scene::builtin("drape", 0.2).expect("a scene");
            let simulator = Simulator::new(&scene).expect("a simulator");
            let world = simulator.world();
            let start = &simulator.positions()[..world.collision_vertices()];
            let dropped = |by: f64| {
                let mut x = start.to_vec();
                x[..world.deformable_vertices].iter_mut().for_each(|p| *p -= Vector::z() * by);
                x
            };
            let states = drops.iter().map(|&by| dropped(by)).collect();
            Self { checker: Checker::new(&simulator), states, simulator }
        }

        fn step(&mut self, from: usize, to: usize) {
            let (previous, positions) = (&self.states[from][..], &self.states[to][..]);
            let state = AcceptedState { step: 0, previous, positions, target: positions };
            let accepted = AcceptedStep { step: 1, iteration: 0, state };
            self.checker.judge(&accepted, self.simulator.world()).expect("valid points");
        }

        fn end(&mut self, at: usize) {
            let world = self.simulator.world();
            self.checker.judge_end(1, &self.states[at], world).expect("valid points");
        }

        /// States judged by themselves, and paths.
        fn judged(&self) -> [usize; 2] {
            [self.checker.states(), self.checker.paths()]
        }
    }

    #[test]
    fn states_along_certified_paths_are_not_judged_again() {
        let mut case = Case::new(&[0.0, 1e-4, 2e-4, 3e-4]);
        case.step(0, 1);
        case.step(1, 2);
        assert_eq!(case.judged(), [1, 2]);
        case.end(2);
        assert_eq!(case.judged(), [2, 2]);
        case.step(2, 3);
        assert_eq!(case.judged(), [2, 3]);
        // A path that starts elsewhere than where the last one ended.
        case.step(0, 1);
        assert_eq!(case.judged(), [3, 4]);
        assert_eq!((case.checker.intersections(), case.checker.findings().len()), (0, 0));
    }

    #[test]
    fn after_a_finding_states_are_judged_until_one_is_clear() {
        // The second state has the ball through the sheet.
        let mut case = Case::new(&[0.0, 0.1, 0.1 + 1e-9, -0.1]);
        case.step(0, 1);
        assert_eq!(case.judged(), [2, 1]);
        let found = case.checker.intersections();
        assert!(found > 0);
        assert!(case.checker.findings().iter().any(|line| line.contains("on the way")));
        case.end(1);
        assert_eq!((case.judged(), case.checker.intersections()), ([2, 1], found), "counted twice");
        case.step(1, 2);
        assert_eq!(case.judged(), [3, 2]);
        assert!(case.checker.intersections() > found);
        // Back above it, and clear again: the next state is so by its path.
        case.step(2, 3);
        assert_eq!(case.judged(), [4, 3]);
        case.step(3, 3);
        assert_eq!(case.judged(), [4, 4]);
    }

    #[test]
    fn a_start_that_intersects_is_found_though_nothing_moves() {
        let mut case = Case::new(&[0.1]);
        case.step(0, 0);
        assert!(case.checker.intersections() > 0);
        assert_eq!(case.judged(), [2, 1]);
    }
}
