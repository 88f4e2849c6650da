//! Judging many states and paths of the same elements, one after the other.

use crate::error::CheckError;
use crate::judge::Judge;
use crate::primitives::Scene;
use crate::report::{PathOptions, PathReport, StateOptions, StateReport};
use bowknot_geometry::Point;

/// States or paths after which the trees' order is found anew. Finding it costs about as much as judging one;
/// in so few steps nothing that moves slowly loses its order, and what does costs time, not truth.
const RENEW_AFTER: usize = 16;

/// A judge that keeps its trees, and their memory, from one state or path to the next.
///
/// Only the order of the primitives in the trees is kept. Every box is computed from the positions that are
/// judged, so the pairs looked at, and with them the verdict, are those of [`Judge::check_state`] and
/// [`Judge::check_path`], whatever was judged before.
#[derive(Debug)]
pub struct MotionJudge {
    judge: Judge,
    states: Trees<1>,
    paths: Trees<2>,
}

/// Trees that are kept, once there are some.
#[derive(Debug, Default)]
struct Trees<const K: usize> {
    scene: Option<Scene<K>>,
    /// How often the present order was used.
    uses: usize,
}

impl<const K: usize> Trees<K> {
    /// The trees, and whether they must be arranged anew.
    fn next(&mut self, judge: &Judge) -> (&mut Scene<K>, bool) {
        if self.scene.is_none() || self.uses == RENEW_AFTER {
            self.uses = 0;
        }
        self.uses += 1;
        (self.scene.get_or_insert_with(|| Scene::new(judge)), self.uses == 1)
    }
}

impl MotionJudge {
    /// A judge of states and paths of the same elements.
    pub fn new(judge: Judge) -> Self {
        Self { judge, states: Trees::default(), paths: Trees::default() }
    }

    /// The judge of single states and paths.
    pub fn judge(&self) -> &Judge {
        &self.judge
    }

    /// The verdict of [`Judge::check_state`], in less time.
    ///
    /// # Errors
    /// As [`Judge::check_state`].
    pub fn check_state(&mut self, x: &[Point], options: &StateOptions) -> Result<StateReport, CheckError> {
        let (scene, arrange) = self.states.next(&self.judge);
        self.judge.check_state_with(scene, arrange, x, options)
    }

    /// The verdict of [`Judge::check_path`], in less time.
    ///
    /// # Errors
    /// As [`Judge::check_path`].
    pub fn check_path(
        &mut self,
        x0: &[Point],
        x1: &[Point],
        options: &PathOptions,
    ) -> Result<PathReport, CheckError> {
        let (scene, arrange) = self.paths.next(&self.judge);
        self.judge.check_path_with(scene, arrange, x0, x1, options)
    }
}
