//! Shared helpers of the integration tests: hard states, far targets, and a watch over steps.
//!
//! - [`states`]: seeded generators of states that are free of intersections, but only just;
//! - [`targets`]: where their vertices are asked to go, from a micrometre to a kilometre away;
//! - [`watch`]: judges every step of whatever moves them;
//! - [`fuzz`]: what must hold for any bytes, driven by the fuzz targets and by a test.

pub mod contact;
pub mod fuzz;
pub mod random;
pub mod states;
pub mod targets;
pub mod theory;
pub mod watch;

pub use random::Random;
pub use states::Case;
pub use watch::Watch;
