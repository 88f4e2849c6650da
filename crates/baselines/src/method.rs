//! The trait of all methods, and its result.

use bowknot_twoway::geometry::Point;
use bowknot_twoway::{
    BackwardStep, ForwardStep, ResolveError, ResolveInput, Resolver, Search, StageSeconds, Statistics,
};

/// A method that moves positions from a state without intersections toward a target.
pub trait Method: Send {
    /// The name that tables show.
    fn name(&self) -> &str;

    /// Moves `positions` toward `target`, one entry per vertex [m].
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

/// Counts and times of a solve. The quality of the result is measured elsewhere, alike for all methods.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Number of steps: two-way steps, descent steps, rounds of zones.
    pub steps: usize,
    /// Number of searches for pairs or impacts.
    pub searches: usize,
    /// Whether the method's own stopping rule was met.
    pub converged: bool,
    /// Whether the method failed: it gave up without a way free of intersections. One that ran out of time is
    /// only not `converged`.
    pub failed: bool,
    /// Wall seconds by stage; 0 for stages that a method does not have.
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

/// The two-way loop with chosen stages.
#[derive(Debug)]
pub struct Composed<S, B, F> {
    name: String,
    resolver: Resolver<S, B, F>,
}

impl<S: Search, B: BackwardStep, F: ForwardStep<S>> Composed<S, B, F> {
    /// A method of that name.
    pub fn new(name: impl Into<String>, resolver: Resolver<S, B, F>) -> Self {
        Self { name: name.into(), resolver }
    }
}

impl<S: Search, B: BackwardStep, F: ForwardStep<S>> Method for Composed<S, B, F> {
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
