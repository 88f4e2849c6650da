//! Impact zones: collisions found by continuous detection between a state x and its target y, and vertices that collide
//! handled together.
//!
//! - [`ImpactZones`]: the target alone is optimised until the straight path to it is free of impacts (Harmon et al. 2008,
//!   Tang et al. 2018); where that fails, nothing moves and the failure counts (paper, section 3.3);
//! - [`RigidZones`]: what collides goes on as one rigid body (Provot 1997, Bridson et al. 2002), which never fails;
//! - [`TwoPhase`]: zones first, an interior point method for what they leave (Wu et al. 2020).

mod impacts;
mod optimiser;
mod rigid;
mod rigid_motion;
mod rows;
mod two_phase;

pub use impacts::{Impact, ImpactSearch};
pub use optimiser::{ImpactZones, ZoneParams, ZoneSolver};
pub use rigid::RigidZones;
pub use two_phase::TwoPhase;
