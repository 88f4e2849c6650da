//! Shared helpers of the integration tests: hard states, far targets, and a check of every step.
//!
//! - [`states`]: seeded generators of states that are nearly intersecting;
//! - [`targets`]: targets of their vertices, from a micrometer to a kilometer away;
//! - [`step_checker`]: checks every step that moves them;
//! - [`contact`], [`theory`]: scenes whose outcome is known from theory;
//! - [`fuzz`]: properties that hold for any bytes, for the fuzz targets and a test.

pub mod contact;
pub mod fuzz;
pub mod random;
pub mod states;
pub mod step_checker;
pub mod targets;
pub mod theory;

pub use random::Random;
pub use states::Case;
pub use step_checker::StepChecker;
