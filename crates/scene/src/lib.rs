#![doc = include_str!("../README.md")]
//!
//! ## Tables and structs
//!
//! | table | fields of |
//! |---|---|
//! | `[simulation]` | [`SimulationParams`], [`Environment`](bowknot_dynamics::Environment) |
//! | `[contact]` | `preset`, [`ContactParams`](bowknot_constraints::ContactParams), [`FrictionPair`]s |
//! | `[solver]` | [`SceneSolverParams`], one struct per part |
//! | `[output]` | [`OutputParams`] |
//! | `[[body]]`, `[[obstacle]]`, `[[pin]]` | [`BodySpec`], [`ObstacleSpec`], [`PinSpec`] |
//!
//! [`World`] puts the meshes of a scene together; [`shapes`] generates meshes.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body;
mod builtin;
mod description;
mod elements;
mod error;
mod explain;
mod fields;
mod friction;
mod kind;
mod material;
mod motion;
mod obstacle;
mod open;
mod origin;
mod params;
mod pin;
mod read;
pub mod shapes;
mod short;
mod source;
#[cfg(test)]
mod tests;
mod turn;
mod validate;
mod values;
pub mod world;
mod write;

/// Points and vectors, the types of places.
pub use bowknot_geometry as geometry;
/// Mesh files and the frames of sequences.
pub use bowknot_io as io;
/// Parameters of the collision stage.
pub use bowknot_twoway as twoway;

pub use body::BodySpec;
pub use builtin::{BUILTIN, Builtin};
pub use description::Scene;
pub use elements::SolidElements;
pub use error::{SceneError, SceneProblem, nearest};
pub use friction::FrictionPair;
pub use kind::BodyKind;
pub use material::Material;
pub use motion::{Keyframe, Motion, Placement};
pub use obstacle::ObstacleSpec;
pub use open::twoway_params;
pub use origin::{Origin, Origins};
pub use params::{
    CollisionEvery, Format, InteriorFollows, OutputParams, Preset, RepulsionLaw, RepulsionParams,
    SceneSolverParams, SimulationParams, SleepParams,
};
pub use pin::{PinSpec, Region, RootEnd, Side};
pub use world::{SceneInfo, World};
