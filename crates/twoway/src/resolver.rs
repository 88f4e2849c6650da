//! Algorithm 1.

use crate::{Observer, Params, ResolveError, Statistics};
use bowknot_geometry::Point;
use bowknot_proximity::CollisionModel;

/// What changes from call to call.
#[derive(Clone, Copy, Debug, Default)]
pub struct Call<'a> {
    /// Which vertices are prescribed: they go to their target and yield to nothing, but wait where they
    /// would cut through. Obstacle vertices always are. Empty: none but those.
    pub prescribed: &'a [bool],
    /// Time step that the call stands for [s]; scales the separation speed and the default step limit.
    pub time_step: Option<f64>,
}

/// Resolves collisions between a state and a target; keeps its workspace between calls.
pub struct Resolver {
    model: CollisionModel,
    params: Params,
}

impl Resolver {
    /// A resolver for vertices with the given rest positions [m] and masses [kg]. Masses of obstacle
    /// vertices are ignored. Rest positions set default lengths, stretch limits, and the desired distance of
    /// neighbours.
    ///
    /// # Errors
    /// Wrong lengths, non-finite numbers, massless vertices, parameters out of range.
    pub fn new(
        model: CollisionModel,
        rest: &[Point],
        masses: &[f64],
        params: Params,
    ) -> Result<Self, ResolveError> {
        let _ = (rest, masses);
        params.validate().map_err(ResolveError::Params)?;
        Ok(Self { model, params })
    }

    /// The parameters in use, every default length filled in.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// The collision model.
    pub fn model(&self) -> &CollisionModel {
        &self.model
    }

    /// Moves `positions` from an intersection-free state toward `target`. Every accepted state and the straight
    /// path to it is free of intersections, however far the target; stopping early is always valid.
    ///
    /// # Errors
    /// The call is refused, and `positions` left as they were, on wrong lengths, non-finite numbers and
    /// coordinates too large for the floor.
    pub fn resolve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        call: &Call<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Statistics, ResolveError> {
        let _ = (positions, target, call, observer);
        todo!()
    }
}
