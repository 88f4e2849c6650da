#![doc = include_str!("../README.md")]
//!
//! ## Features
//!
//! | feature | adds | costs |
//! |---|---|---|
//! | `files` | NumPy archives, checkpoint files, `run`, `recording`, `repair`, `judging` | ndarray, zip, flate2 |
//! | `report` | `report`, the HTML page of a run | `files`, and 1 MB of scripts |
//! | `gpu` | `gpu`, collisions and dynamics on a GPU | wgpu |
//!
//! None is on by default; the command has all. A feature never changes a result.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "files")]
pub mod judging;
pub mod messages;
#[cfg(feature = "files")]
pub mod recording;
#[cfg(feature = "files")]
pub mod repair;
#[cfg(feature = "files")]
pub mod run;
pub mod simulator;

pub use bowknot_check as check;
pub use bowknot_constraints as constraints;
pub use bowknot_dynamics as dynamics;
pub use bowknot_geometry as geometry;
pub use bowknot_io as io;
pub use bowknot_lcp as lcp;
pub use bowknot_proximity as proximity;
#[cfg(feature = "report")]
pub use bowknot_report as report;
pub use bowknot_scene as scene;
pub use bowknot_scene::{shapes, world};
pub use bowknot_stepper as stepper;
pub use bowknot_twoway as twoway;

pub use scene::{BUILTIN, Scene, SceneError};
pub use simulator::{DriveError, SimulationError, SimulationObserver, Simulator, StepStatistics};
pub use world::{SceneInfo, World};
