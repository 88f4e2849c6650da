//! Impact zones: collisions between a state x and its target y are found by continuous detection, and
//! vertices that collide are handled together.
//!
//! - [`ImpactZones`]: the target is optimized until the straight path to it is free of impacts (Harmon et al.
//!   2008, Tang et al. 2018). If that fails, nothing moves and the call counts as failed (paper, section 3.3).
//! - [`RigidZones`]: vertices that collide move as one rigid body (Provot 1997, Bridson et al. 2002). This
//!   never fails.
//! - [`TwoPhase`]: impact zones first, then an interior point method if impacts remain (Wu et al. 2020).

mod impacts;
mod optimizer;
mod params;
mod rigid;
mod rigid_motion;
mod rows;
mod two_phase;

pub use impacts::{Impact, ImpactSearch};
pub use optimizer::ImpactZones;
pub use params::{ZoneGoal, ZoneParams, ZoneSolver};
pub use rigid::RigidZones;
pub use two_phase::TwoPhase;
