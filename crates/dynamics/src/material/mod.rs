//! Materials in physical units, with named presets.
//!
//! Every field of a material is checked ([`crate::Parameters`]). Unknown keys are refused when a material is
//! read.

mod checks;
pub(crate) mod cloth;
pub(crate) mod particle;
pub(crate) mod rest_shape;
pub(crate) mod solid;
pub(crate) mod strand;

pub use cloth::ClothMaterial;
pub use particle::ParticleMaterial;
pub use rest_shape::RestShape;
pub use solid::{SolidMaterial, SolidModel};
pub use strand::StrandMaterial;
