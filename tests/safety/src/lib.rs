//! Hard collision problems, and a check of every step that moves them.
//!
//! - [`scenario`]: problems that proptest draws and shrinks, built from small pieces or by the generators;
//! - [`trial`]: runs a problem and judges each accepted step by code that the stepper does not share;
//! - [`search`]: any number of problems from a seed, with the smallest one that fails, for tests and soaks;
//! - [`states`]: seeded generators of states that are nearly intersecting;
//! - [`targets`]: targets of their vertices, from a micrometer to a million kilometers away;
//! - [`step_checker`]: judges the steps of one state.

pub mod random;
pub mod scenario;
pub mod search;
pub mod states;
pub mod step_checker;
pub mod targets;
pub mod trial;

pub use random::Random;
pub use scenario::Scenario;
pub use states::Case;
pub use step_checker::StepChecker;
pub use trial::{Tally, check};
