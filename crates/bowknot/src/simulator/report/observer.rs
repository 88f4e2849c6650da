//! What a simulation shows of a time step while it makes it.

use super::blocking::WaitingElements;
use bowknot_dynamics::Residual;
use bowknot_geometry::Point;
use bowknot_scene::world::World;
use bowknot_twoway::lcp::DistanceLimit;
use bowknot_twoway::{AcceptedState, Observer, PairMultipliers, ResolveInput, Wait};
use std::ops::ControlFlow;

/// A collision problem on its way to the two-way method. Slices have one entry per vertex that collides.
#[derive(Clone, Copy, Debug)]
pub struct CollisionProblem<'a> {
    /// The time step, from 1.
    pub step: usize,
    /// The Newton iteration in it, from 0.
    pub iteration: usize,
    /// The state, free of intersections [m].
    pub positions: &'a [Point],
    /// Where the dynamics wants to be [m].
    pub target: &'a [Point],
    /// Prescribed vertices: those of obstacles, and pinned ones.
    pub prescribed: &'a [bool],
    /// Time step that the problem stands for [s].
    pub time_step: f64,
    /// Positions at the start of the time step, which friction measures slip from [m].
    pub start: &'a [Point],
    /// Pinned vertices that move as one, see [`ResolveInput::groups`].
    pub groups: &'a [u32],
    /// Vertices whose contacts the dynamics knows, see [`ResolveInput::known`].
    pub known: &'a [bool],
    /// What pairs carry at the start, see [`ResolveInput::carried`].
    pub carried: &'a [PairMultipliers],
    /// Edges with other limits than by the scene [m], see [`ResolveInput::yielding`].
    pub yielding: &'a [DistanceLimit],
}

impl<'a> CollisionProblem<'a> {
    /// That of a call with the `input`, in a time step and an iteration.
    pub(crate) fn new(
        [step, iteration]: [usize; 2],
        positions: &'a [Point],
        target: &'a [Point],
        input: &ResolveInput<'a>,
    ) -> Self {
        let ResolveInput { prescribed, groups, known, carried, yielding, .. } = *input;
        let (time_step, start) = (input.time_step.unwrap_or_default(), input.start.unwrap_or(positions));
        Self {
            step,
            iteration,
            positions,
            target,
            prescribed,
            time_step,
            start,
            groups,
            known,
            carried,
            yielding,
        }
    }
}

/// A state that the two-way method has accepted.
#[derive(Clone, Copy, Debug)]
pub struct AcceptedStep<'a> {
    /// The time step, from 1.
    pub step: usize,
    /// The Newton iteration in it, from 0.
    pub iteration: usize,
    /// The two-way step and its states.
    pub state: AcceptedState<'a>,
}

/// How far a time step is from solved after one of its iterations.
#[derive(Clone, Copy, Debug)]
pub struct Iterated {
    /// The time step, from 1.
    pub step: usize,
    /// The Newton iteration in it, from 0.
    pub iteration: usize,
    /// What is missing to a solution of the time step, contact and friction included.
    pub residual: Residual,
}

/// Sees what happens within a time step, and may stop it.
pub trait SimulationObserver {
    /// Called before each collision problem is resolved; `Break` abandons the time step.
    fn problem(&mut self, problem: &CollisionProblem<'_>) -> ControlFlow<()> {
        let _ = problem;
        ControlFlow::Continue(())
    }

    /// Called after each two-way step; `Break` abandons the time step.
    fn accepted(&mut self, accepted: &AcceptedStep<'_>) -> ControlFlow<()> {
        let _ = accepted;
        ControlFlow::Continue(())
    }

    /// Called after [`Self::accepted`], with what tells why the vertices that have farthest to go wait.
    /// Telling takes about as long as a forward step, and only if it is asked for.
    fn waiting(&mut self, tell: &dyn Fn() -> Vec<WaitingElements>) {
        let _ = tell;
    }

    /// Whether [`Self::accepted`] must see each state. If not, a backend may make several two-way steps at
    /// once and call [`Self::advanced`] in its place.
    fn sees_each_state(&self) -> bool {
        true
    }

    /// Called after so many two-way steps whose states were not shown; `Break` abandons the time step.
    fn advanced(&mut self, steps: usize) -> ControlFlow<()> {
        let _ = steps;
        ControlFlow::Continue(())
    }

    /// Called after the collision stage of each Newton iteration, with the residual of the whole time step.
    fn iterated(&mut self, iterated: &Iterated) {
        let _ = iterated;
    }
}

/// Observes nothing.
impl SimulationObserver for () {
    fn sees_each_state(&self) -> bool {
        false
    }
}

/// Passes accepted states on, with their time step and iteration.
pub(crate) struct Relay<'a> {
    pub observer: &'a mut dyn SimulationObserver,
    pub world: &'a World,
    pub step: usize,
    pub iteration: usize,
    /// Whether the observer has stopped the time step.
    pub stopped: bool,
}

impl Observer for Relay<'_> {
    fn accepted(&mut self, state: &AcceptedState<'_>) -> ControlFlow<()> {
        let flow = self.observer.accepted(&AcceptedStep {
            step: self.step,
            iteration: self.iteration,
            state: *state,
        });
        self.stopped |= flow.is_break();
        flow
    }

    fn sees_each_state(&self) -> bool {
        self.observer.sees_each_state()
    }

    fn advanced(&mut self, steps: usize) -> ControlFlow<()> {
        let flow = self.observer.advanced(steps);
        self.stopped |= flow.is_break();
        flow
    }

    fn waiting(&mut self, tell: &dyn Fn() -> Vec<Wait>) {
        let world = self.world;
        self.observer.waiting(&|| tell().iter().map(|wait| WaitingElements::new(world, wait)).collect());
    }
}
