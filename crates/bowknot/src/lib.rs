//! Simulation of deformable bodies that never intersect: scenes, the time-step loop, checkpoints, files.
//!
//! ```no_run
//! use bowknot::{Scene, Simulator};
//!
//! let scene = Scene::builtin("drape", 0.5)?; // or Scene::load("my.toml", &["contact.delta=0.001"])
//! let mut simulator = Simulator::new(&scene)?;
//! for _ in 0..scene.simulation.frames {
//!     let statistics = simulator.step()?;
//!     assert!(statistics.max_stretch < 2.0);
//! }
//! let highest = simulator.positions().iter().map(|p| p.z).fold(f64::MIN, f64::max);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | holds |
//! |---|---|
//! | [`simulator`] | the time-step loop, its statistics, changes by code between steps, checkpoints |
//! | `run` | whole runs: the output folder, resuming, checking as it goes (feature `files`) |
//! | `recording` | collision problems, recorded and solved again (feature `files`) |
//! | `gpu` | collisions on a GPU (feature `gpu`) |
//! | `repair` | cleaning of meshes whose seams intersect (feature `files`) |
//! | [`scene`], [`shapes`], [`world`] | scene files, built-in scenes, generated meshes, the assembled world |
//! | [`io`] | mesh files, archives, atomic writes |
//! | [`check`] | the exact judge of states and paths |
//! | `report` | one HTML page of a run (feature `report`) |
//!
//! | feature | adds | costs |
//! |---|---|---|
//! | `files` | NumPy archives, checkpoint files, runs, recordings, repair | ndarray, zip, flate2 |
//! | `report` | the HTML page | `files`, and 1 MB of scripts |
//! | `gpu` | collisions on a GPU | wgpu |
//!
//! None is on by default; the command has all. A feature never changes a result.
//!
//! The crates below are re-exported under short names. This crate does not know terminals: it never
//! prints, it logs through `tracing`.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

#[cfg(feature = "gpu")]
pub mod gpu;
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

/// The README's examples are tested with the documentation.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeDoctests;
