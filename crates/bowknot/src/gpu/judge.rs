//! Judges what a device computes, on the CPU: a driver that computes something else than it should is told, not trusted.

use super::error::GpuResolveError;
use bowknot_check::{Judge, MotionJudge, StateOptions};
use bowknot_geometry::{BodyFilter, Point};
use bowknot_twoway::CollisionScene;

/// The judge of a scene. To make one takes longer than to judge a state, so it is kept.
#[derive(Debug, Default)]
pub struct SceneJudge {
    /// The judge, and the bodies that it was made with: which of them are obstacles may change.
    made: Option<(Vec<BodyFilter>, MotionJudge)>,
}

impl SceneJudge {
    /// Refuses positions [m] that intersect.
    pub fn refuse_intersections(
        &mut self,
        scene: &CollisionScene,
        positions: &[Point],
    ) -> Result<(), GpuResolveError> {
        let mut state = self.of(scene).check_state(positions, &StateOptions { limit: 1, distance: false })?;
        match state.intersections.pop() {
            None => Ok(()),
            Some(first) => {
                Err(GpuResolveError::Intersects { count: state.intersection_count, first: Box::new(first) })
            }
        }
    }

    /// Whether nothing intersects and all gaps are wider than `least` [m].
    pub fn is_open(
        &mut self,
        scene: &CollisionScene,
        positions: &[Point],
        least: f64,
    ) -> Result<bool, GpuResolveError> {
        let state = self.of(scene).check_state(positions, &StateOptions { limit: 0, distance: true })?;
        let is_wide = state.nearest.is_none_or(|nearest| nearest.distance > least);
        Ok(state.intersection_count == 0 && is_wide)
    }

    fn of(&mut self, scene: &CollisionScene) -> &mut MotionJudge {
        let bodies = scene.model().bodies();
        let known = self.made.take().filter(|(known, _)| known == bodies);
        let made =
            known.unwrap_or_else(|| (bodies.to_vec(), MotionJudge::new(Judge::from_model(scene.model()))));
        &mut self.made.insert(made).1
    }
}
