//! Collision problems: recorded from a simulation, solved again outside of it.

mod columns;
mod filters;
mod recorder;
mod resolve;
mod states;
#[cfg(test)]
mod tests;

pub use recorder::Recorder;
pub use states::{States, write_result};
