//! Collision problems: recorded from a simulation, solved again outside of it.

mod assignments;
mod columns;
mod filters;
mod recorder;
mod reduction;
mod resolve;
mod states;
#[cfg(test)]
mod tests;

pub use assignments::assignments;
pub use recorder::Recorder;
pub use reduction::{Failure, Limits, Reduction};
pub use states::{States, write_result};
