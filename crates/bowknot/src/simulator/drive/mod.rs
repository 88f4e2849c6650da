//! What a program changes between two time steps: a game's loop, a robot's simulator, Python.
//!
//! Bodies, obstacles and pins go by name. Vertices of a body are numbered as in its mesh, from 0. What is set
//! takes effect in the next time step, and bodies asleep on which it acts wake.
//!
//! **No setter makes an intersection.** Pins and obstacles are led: they go to their targets as the two-way
//! step lets them, and wait while something is in the way ([`StepStatistics::waiting`] says so). Only
//! [`Simulator::place`] and added bodies are put somewhere at once; the exact judge refuses what would
//! intersect.
//!
//! | file | sets |
//! |---|---|
//! | `pins.rs` | pins: added, removed, led |
//! | `obstacles.rs` | where obstacles go |
//! | `surroundings.rs` | gravity, wind, forces on vertices |
//! | `state.rs` | velocities, and positions at once |
//! | `elements.rs` | custom elements: added, replaced, removed |
//! | `bodies.rs` | bodies and obstacles added and removed, materials, friction |
//!
//! `forces.rs` tells what acts on bodies, obstacles and pins.
//!
//! `driven.rs` has all that was changed as data: it is part of checkpoints. `rebuild.rs` makes a simulator of
//! a changed scene and renumbers the state for it.
//!
//! [`StepStatistics::waiting`]: crate::simulator::StepStatistics::waiting
//! [`Simulator::place`]: crate::simulator::Simulator::place

mod adopt;
mod bodies;
mod driven;
mod elements;
mod error;
mod forces;
mod names;
mod obstacles;
mod pins;
mod rebuild;
mod renumber;
mod state;
mod surroundings;

pub use driven::{Driven, ObstacleDrive};
pub use error::DriveError;
