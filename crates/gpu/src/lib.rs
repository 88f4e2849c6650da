#![doc = include_str!("../README.md")]
//!
//! ## Modules
//!
//! | module | holds |
//! |---|---|
//! | `grid` | the grid of integers on which positions lie |
//! | `layout` | data that host, kernels and twins share |
//! | `stages`, `shader/`, `kernels` | kernels; their table and twins, which `cargo xtask twins` writes from them |
//! | `wgsl` | what twins are written with: values of the shaders' language in Rust |
//! | `bound` | what a twin sees of a dispatch |
//! | `recording`, `engine` | lists of dispatches; a device or the twins run them |
//! | `adapter` | the devices of this machine |
//! | `tree`, `model`, `edges`, `bricks`, `adjacency` | what the host prepares for a scene |
//! | `collision` | steps toward a target that nothing passes through |
//! | `two_way` | scenes of `bowknot-twoway`: a processor of the two-way loop |
//! | `linear`, `assembly` | linear solves of the dynamics, and their matrices |
//! | `newton` | Newton's method of the dynamics with its vectors on a device |
//! | `potential` | the potential of the bodies and its gradient |
#![allow(clippy::too_many_arguments, reason = "a kernel has as many arguments as bindings")]

mod adapter;
mod adjacency;
mod assembly;
#[cfg(feature = "twins")]
mod bound;
mod bricks;
mod collision;
mod edges;
mod engine;
mod error;
mod grid;
mod layout;
mod linear;
mod model;
mod newton;
mod parallel;
mod potential;
mod recording;
mod stages;
mod tree;
#[rustfmt::skip]
#[allow(warnings, clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction)]
mod kernels;
mod two_way;
#[cfg(feature = "twins")]
mod wgsl;

pub use bowknot_dynamics as dynamics;
pub use bowknot_geometry as geometry;

pub use adapter::Adapter;
pub use collision::{Call, Carried, Collision, CollisionError, ContactRow, End, Settings, StepReport, Stop};
#[cfg(feature = "twins")]
pub use engine::{ComparingEngine, Difference, TwinEngine};
pub use engine::{DeviceEngine, Engine, PhaseSeconds, Profile, StageTime};
pub use error::GpuError;
pub use grid::{Grid, GridError, GridPoint};
pub use layout::{Candidate, Kind, NONE};
pub use linear::ConjugateGradients;
pub use model::{Constraints, Lengths};
pub use recording::{BufferId, DispatchView, Phase, Recording};
pub use two_way::{Device, GpuResolveError, resolve_on};
