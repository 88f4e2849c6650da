#![doc = include_str!("../README.md")]
//!
//! ## A time step
//!
//! A time step minimizes the incremental potential
//!
//! ```text
//! E(x) = |x - x~|^2_M / (2 dt^2) + V(x) + D(x; x0),   x~ = x0 + dt v0 + dt^2 (g + f/m)
//! ```
//!
//! over the free vertices, with V the elastic energy and D the dissipation ([`Dynamics`]).
//!
//! ## Modules
//!
//! | module | holds |
//! |---|---|
//! | [`material`] | [`ClothMaterial`], [`SolidMaterial`], [`StrandMaterial`], [`ParticleMaterial`] with named presets |
//! | [`body`] | [`Body`]: elements, material and gravity of a body |
//! | [`custom`] | [`CustomElement`]: energies of your own |
//! | [`model`] | [`DynamicsModel`]: masses, elements, patterns; fixed during a run |
//! | [`params`] | [`DynamicsParams`] |
//! | [`dynamics`] | [`Dynamics`]: the time step, Newton iterations, the line search |
//! | [`repulsion`] | [`RepulsionSpring`], [`ContactPotential`] |
//! | [`observe`] | [`Energies`], momenta, stretch, volumes |

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod body;
pub mod custom;
mod device_work;
mod drag;
pub mod dynamics;
mod elements;
mod error;
mod groups;
mod linear;
pub mod material;
pub mod model;
mod nodes;
pub mod observe;
pub mod params;
pub mod repulsion;
#[cfg(test)]
mod test_support;

/// Points and vectors: the types of states.
pub use bowknot_geometry as geometry;
/// The blocks of matrices.
pub use nalgebra::Matrix3;

pub use body::{Body, BodyShape};
pub use bowknot_errors::{Errors, ParamError, Parameters};
pub use custom::{
    CustomElement, DerivativeErrors, DerivativeProblem, ElementGroup, ElementMatrix, MAX_ELEMENT_VERTICES,
    check_derivatives,
};
pub use device_work::DeviceWork;
pub use dynamics::{
    BodiesPotential, Dynamics, Held, MatrixBlocks, NewtonBackend, NewtonBackendError, NewtonInfo,
    NewtonSolve, NewtonStep, NewtonTarget, OutOfBalance, Residual, SolveLimits, StepTerms, Touching, Trial,
    Watched,
};
pub use error::{ElementProblem, ModelError, StepError};
pub use linear::accuracy::CgInfo;
pub use linear::assembly::{
    AssemblySprings, BendElement, ElementModel, MembraneElement, SolidKind, StrandElement, TetrahedronElement,
};
pub use linear::springs::LinearSpring;
pub use material::{ClothMaterial, ParticleMaterial, RestShape, SolidMaterial, SolidModel, StrandMaterial};
pub use model::DynamicsModel;
pub use observe::{ElasticEnergies, Energies};
pub use params::{DynamicsParams, Environment, HessianFilter, Integrator, NewtonParams, PreconditionerKind};
pub use repulsion::{ContactForces, ContactLaw, ContactPotential, RepulsionSpring, SpringKind};
