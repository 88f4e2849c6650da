//! What all methods have in common.

use bowknot_twoway::geometry::Point;
use bowknot_twoway::{
    BackwardStep, ForwardStep, ResolveError, ResolveInput, Resolver, Search, StageSeconds, Statistics,
};

/// A way to move positions from an intersection-free state toward a target.
pub trait Method: Send {
    /// The name that tables show.
    fn name(&self) -> &str;

    /// Moves `positions` toward `target`, one entry a vertex [m].
    ///
    /// # Errors
    /// As [`Resolver::resolve`].
    fn solve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<Outcome, ResolveError>;
}

/// What a solve did. How good the positions are that it ended with is measured from outside, alike for all methods.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Steps taken: two-way steps, descent steps, zone iterations.
    pub steps: usize,
    /// Searches for pairs or impacts.
    pub searches: usize,
    /// Whether the method's own stopping rule was met.
    pub converged: bool,
    /// Whether the method gave up: it found no way to go on that is free of intersections.
    pub failed: bool,
    /// Wall seconds by stage; stages that a method lacks are 0.
    pub seconds: StageSeconds,
}

impl From<Statistics> for Outcome {
    fn from(statistics: Statistics) -> Self {
        Self {
            steps: statistics.steps,
            searches: statistics.searches,
            converged: statistics.converged,
            failed: false,
            seconds: statistics.seconds,
        }
    }
}

/// The two-way loop with stages of one's choice.
#[derive(Debug)]
pub struct Composed<S, B, F> {
    name: String,
    resolver: Resolver<S, B, F>,
}

impl<S: Search, B: BackwardStep, F: ForwardStep> Composed<S, B, F> {
    /// A method of that name.
    pub fn new(name: impl Into<String>, resolver: Resolver<S, B, F>) -> Self {
        Self { name: name.into(), resolver }
    }
}

impl<S: Search, B: BackwardStep, F: ForwardStep> Method for Composed<S, B, F> {
    fn name(&self) -> &str {
        &self.name
    }

    fn solve(
        &mut self,
        positions: &mut [Point],
        target: &[Point],
        input: &ResolveInput<'_>,
    ) -> Result<Outcome, ResolveError> {
        Ok(self.resolver.resolve_with(positions, target, input, &mut ())?.into())
    }
}
