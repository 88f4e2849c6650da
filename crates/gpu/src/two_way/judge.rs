//! Judges what a device computes, on the CPU: a faulty driver causes an error, never an intersecting state.

use super::error::GpuResolveError;
use bowknot_geometry::{Identity, Point};
use bowknot_twoway::CollisionScene;
use bowknot_twoway::check::{Judge, MotionJudge, StateOptions};

/// The judge of a scene. To make one takes longer than to judge a state, so it is kept.
#[derive(Debug, Default)]
pub struct SceneJudge {
    /// The judge, and of the collision model that it was made for.
    made: Option<(Identity, MotionJudge)>,
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
        let model = scene.model();
        let made = self.made.take().filter(|(made_for, _)| *made_for == model.identity());
        let make = || (model.identity(), MotionJudge::new(Judge::from_model(model)));
        &mut self.made.insert(made.unwrap_or_else(make)).1
    }
}
