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
//! | [`scene`] | the description of a scene, TOML files, built-in scenes |
//! | [`shapes`] | generated meshes |
//! | [`world`] | a scene's meshes, loaded and put together |
//! | [`simulator`] | the time-step loop, its statistics, checkpoints |
//! | [`run`] | whole runs: the output folder, resuming, checking as it goes |
//! | [`recording`] | collision problems, recorded and solved again |
//! | [`report`] | one HTML page of a run |
//! | [`check`] | the exact judge of states and paths |
//! | [`io`] | mesh files, archives, atomic writes |
//! | [`repair`] | cleaning of meshes whose seams intersect |
//!
//! The crates below are re-exported under short names. This crate does not know terminals: it never
//! prints, it logs through `tracing`.

pub mod check;
pub mod io;
pub mod recording;
pub mod repair;
pub mod report;
pub mod run;
pub mod scene;
pub mod shapes;
pub mod simulator;
pub mod world;

pub use bowknot_constraints as constraints;
pub use bowknot_dynamics as dynamics;
pub use bowknot_geometry as geometry;
pub use bowknot_lcp as lcp;
pub use bowknot_proximity as proximity;
pub use bowknot_stepper as stepper;
pub use bowknot_twoway as twoway;

pub use scene::{BUILTIN, Scene, SceneError};
pub use simulator::{SimulationError, Simulator, StepStatistics, Watcher};
pub use world::{SceneInfo, World};
