//! Implicit Euler dynamics of deformable bodies.
//!
//! What it knows: materials in physical units, lumped masses, cloth, solids, strands and particles,
//! damping, wind, gravity, prescribed vertices, and how to make **one Newton iteration**
//! `x -> y` of the implicit Euler step. It does not know how contact is resolved: a collision stage
//! moves x towards y as far as it can and asks for the next y.
//!
//! One step minimises the incremental potential
//!
//! ```text
//! E(x) = |x - x~|^2_M / (2 dt^2) + V(x) + D(x; x0),   x~ = x0 + dt v0 + dt^2 (g + f/m)
//! ```
//!
//! over the free vertices, V the elastic energy and D the dissipation ([`Dynamics`]).
//!
//! | module | holds |
//! |---|---|
//! | [`material`] | [`ClothMaterial`], [`SolidMaterial`], [`StrandMaterial`], [`ParticleMaterial`] with named presets |
//! | [`body`] | [`Body`]: elements, material and gravity of a body |
//! | [`model`] | [`DynamicsModel`]: masses, elements, patterns; fixed during a run |
//! | [`params`] | [`DynamicsParams`] |
//! | [`dynamics`] | [`Dynamics`]: the step, one Newton iteration, the line search |
//! | [`repulsion`] | [`RepulsionSpring`] |
//! | [`observe`] | [`Energies`], momenta, stretch |

pub mod body;
mod drag;
pub mod dynamics;
mod elements;
mod error;
mod groups;
mod linear;
pub mod material;
pub mod model;
mod momentum;
pub mod observe;
pub mod params;
pub mod repulsion;
mod volume;

/// Points and vectors: the types of states.
pub use bowknot_geometry as geometry;

pub use body::{Body, BodyShape};
pub use dynamics::{Dynamics, NewtonInfo, Residual, Touching};
pub use error::{MaterialError, ModelError, ParamsError, StepError};
pub use linear::cg::CgInfo;
pub use material::{ClothMaterial, ParticleMaterial, RestShape, SolidMaterial, SolidModel, StrandMaterial};
pub use model::DynamicsModel;
pub use observe::{ElasticEnergies, Energies};
pub use params::{DynamicsParams, HessianFilter, Preconditioner};
pub use repulsion::RepulsionSpring;

/// The README's example runs as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
