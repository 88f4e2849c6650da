//! Observes the loop, and may stop it.

use crate::waits::Wait;
use bowknot_geometry::Point;
use std::ops::ControlFlow;

/// The state after a forward step, as an observer sees it.
#[derive(Clone, Copy, Debug)]
pub struct AcceptedState<'a> {
    /// Index of the two-way step in the call, from 0.
    pub step: usize,
    /// Positions before the step [m].
    pub previous: &'a [Point],
    /// Positions after it [m]. The straight paths from `previous` are free of intersections.
    pub positions: &'a [Point],
    /// The modified target y that the step moved toward [m].
    pub target: &'a [Point],
}

/// Receives each accepted state and may stop the loop.
pub trait Observer {
    /// Called after every forward step; `Break` ends the call with this state.
    fn accepted(&mut self, state: &AcceptedState<'_>) -> ControlFlow<()>;

    /// Called after [`Self::accepted`], with what tells why the vertices that have farthest to go wait.
    /// Telling takes about as long as the forward step, and only if it is asked for.
    fn waiting(&mut self, _tell: &dyn Fn() -> Vec<Wait>) {}

    /// Whether [`Self::accepted`] must see each state. If not, a backend may make several steps at once and
    /// call [`Self::advanced`] in its place.
    fn sees_each_state(&self) -> bool {
        true
    }

    /// Called after so many steps whose states were not shown; `Break` ends the call with the state after
    /// them.
    fn advanced(&mut self, _steps: usize) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Observes nothing.
impl Observer for () {
    fn accepted(&mut self, _: &AcceptedState<'_>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn sees_each_state(&self) -> bool {
        false
    }
}

impl<F: FnMut(&AcceptedState<'_>) -> ControlFlow<()>> Observer for F {
    fn accepted(&mut self, state: &AcceptedState<'_>) -> ControlFlow<()> {
        self(state)
    }
}
