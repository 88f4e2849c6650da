//! The two-way interior point method: `resolve(x, y)` without intersections.
//!
//! Given an intersection-free state x and a target y that some dynamics wants, [`Resolver::resolve`] moves x
//! toward y. Each two-way step lists the pairs that could meet ([`Search`]), modifies the target so that
//! it does not want to intersect ([`BackwardStep`]), and moves the vertices toward it along paths that are
//! certified free of intersections ([`ForwardStep`]). Friction changes the target alone, so it cannot touch that
//! certificate. The stages are traits; other methods plug in.

mod backward;
mod bodies;
mod coarse;
mod error;
mod filter;
mod forward;
mod injection;
mod observer;
mod params;
mod problem;
mod proximal;
mod resolver;
mod row_solver;
mod search;
mod spacing;
mod stages;
mod state;
mod statistics;
mod waiting;

/// Contact rows and edge limits, and their part of the parameters.
pub use bowknot_constraints as constraints;
/// Points, topology and separations.
pub use bowknot_geometry as geometry;
/// Rows and solvers, for backward steps of one's own.
pub use bowknot_lcp as lcp;
/// Pairs and the model of who collides with whom.
pub use bowknot_proximity as proximity;
/// The certified forward step, and its part of the parameters.
pub use bowknot_stepper as stepper;

pub use backward::LcpBackward;
pub use bodies::{BodyContact, ContactSide, ContactTable, HalfSpaceContact, PairFriction};
pub use error::ResolveError;
pub use forward::CertifiedForward;
pub use observer::{AcceptedState, Observer};
pub use params::{BackwardParams, Params, StopParams, StopRule};
pub use problem::{Lengths, Problem};
pub use resolver::{Call, Resolver};
pub use row_solver::{ColouredSweeps, RowSolver, RowSystem};
pub use search::BudgetedSearch;
pub use spacing::{FLOOR_MARGIN, PairSpacing, Spacing};
pub use stages::{BackwardStep, ForwardStep, Reach, Search};
pub use state::{ContactSet, State};
pub use statistics::{Behind, Follower, Skipped, StageSeconds, Statistics};

/// The README's example is tested with the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDoctests;
