//! Judging many paths of the same elements, one after the other.

use crate::error::CheckError;
use crate::judge::Judge;
use crate::primitives::Scene;
use crate::report::{PathOptions, PathReport};
use bowknot_geometry::Point;

/// Paths after which the trees' order is found anew. Finding it costs about as much as judging a path;
/// in so few steps nothing that moves slowly loses its order, and what does costs time, not truth.
const RENEW_AFTER: usize = 16;

/// A judge that keeps its trees, and their memory, from one path to the next.
///
/// Only the order of the primitives in the trees is kept. Every box is computed from the positions of
/// the path that is judged, so the pairs looked at, and with them the verdict, are those of
/// [`Judge::check_path`], whatever was judged before.
#[derive(Debug)]
pub struct MotionJudge {
    judge: Judge,
    scene: Scene<2>,
    /// Paths judged with the present order; none: there is none yet.
    paths: Option<usize>,
}

impl MotionJudge {
    /// A judge of paths of the same elements.
    pub fn new(judge: Judge) -> Self {
        let scene = Scene::new(&judge);
        Self { judge, scene, paths: None }
    }

    /// The judge of single states and paths.
    pub fn judge(&self) -> &Judge {
        &self.judge
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
        let paths = self.paths.filter(|&paths| paths < RENEW_AFTER);
        let report = self.judge.check_path_with(&mut self.scene, paths.is_none(), x0, x1, options)?;
        self.paths = Some(paths.unwrap_or(0) + 1);
        Ok(report)
    }
}
