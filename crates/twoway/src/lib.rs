#![doc = include_str!("../README.md")]
//!
//! ## Stages
//!
//! Each two-way step finds the candidate pairs, those that could meet ([`Search`]), removes intersections
//! from the target ([`BackwardStep`]), and moves the vertices toward it on paths that are certified free of
//! intersections ([`ForwardStep`]). Friction changes the target alone, so it does not affect that certificate.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod adopt;
mod algorithm;
mod backward;
mod blocked;
mod bodies;
mod call;
mod chunks;
mod coarse;
mod cpu;
mod error;
mod filter;
mod forward;
mod groups;
mod index_set;
mod injection;
mod input;
mod lag;
mod live;
mod multipliers;
mod observer;
mod oscillation;
mod params;
mod proximal;
mod resolver;
mod row_solver;
mod scene;
mod search;
mod selection;
mod spacing;
mod stages;
mod stall;
mod state;
mod statistics;
mod stop;
mod stretch;
mod validation;
mod waits;

/// The judge of states and paths, which finds intersections by exact predicates.
pub use bowknot_check as check;
/// Contact rows and edge limits, and their part of the parameters.
pub use bowknot_constraints as constraints;
/// Points, topology and separations.
pub use bowknot_geometry as geometry;
/// Rows and solvers, for other backward steps.
pub use bowknot_lcp as lcp;
/// Pairs, and the model of which bodies collide.
pub use bowknot_proximity as proximity;
/// The certified forward step, and its part of the parameters.
pub use bowknot_stepper as stepper;

pub use adopt::CallEnd;
pub use algorithm::{Call, Processor, Progress};
pub use backward::{GUARDED_STRETCH, LcpBackward};
pub use blocked::MIN_PROGRESS;
pub use bodies::{BodyContact, ContactData, ContactSide, ContactTable, HalfSpaceContact, PairFriction};
pub use bowknot_constraints::ContactParams;
pub use bowknot_errors::{Errors, ParamError, Parameters};
pub use bowknot_stepper::ForwardParams;
pub use call::CallInput;
pub use error::ResolveError;
pub use forward::CertifiedForward;
pub use groups::Groups;
pub use input::ResolveInput;
pub use lag::{Lag, PrescribedEntity};
pub use live::{LiveRows, LiveSystem};
pub use multipliers::PairMultipliers;
pub use observer::{AcceptedState, Observer};
pub use params::{BackwardParams, Params, SolverParams};
pub use resolver::Resolver;
pub use row_solver::{ColoredSweeps, RowSolver, RowSystem};
pub use scene::{CollisionScene, Lengths};
pub use search::{AheadVisitor, GUARDED, GUARDED_FLOOR, KNOWN, TrustRegionSearch};
pub use spacing::{MIN_SEPARATION_MARGIN, PairSpacing, Spacing};
pub use stages::{BackwardStep, Coverage, ForwardStep, Search};
pub use stall::StallDetector;
pub use state::{ContactSet, ResolveState};
pub use statistics::{Skipped, StageSeconds, Statistics};
pub use stop::{Residuals, StopParams, StopRule, StopTest, TravelLimits};
pub use stretch::max_stretch;
pub use waits::{Wait, WaitPair, WaitReason};
