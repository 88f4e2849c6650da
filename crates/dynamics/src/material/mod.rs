//! Materials in physical units, with named presets.
//!
//! Each validates all of its values and (de)serialises with unknown keys refused.

mod cloth;
mod particle;
mod solid;
mod strand;

pub use cloth::ClothMaterial;
pub use particle::ParticleMaterial;
pub use solid::{SolidMaterial, SolidModel};
pub use strand::StrandMaterial;

use crate::MaterialError;
use serde::{Deserialize, Serialize};

/// Shape in which a body is free of bending.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RestShape {
    /// Flat, straight: whatever the initial shape.
    Flat,
    /// The initial shape, with its curvature.
    Initial,
}

/// A field with its value and its unit.
type Field = (&'static str, f64, &'static str);

/// Refuses what is not a finite number above 0, then what is not a finite number from 0 on.
fn check(positive: &[Field], not_negative: &[Field]) -> Vec<MaterialError> {
    let mut errors = Vec::new();
    for &(field, value, unit) in positive {
        if !(value > 0.0 && value.is_finite()) {
            errors.push(MaterialError::NotPositive { field, value, unit });
        }
    }
    for &(field, value, unit) in not_negative {
        if !(value >= 0.0 && value.is_finite()) {
            errors.push(MaterialError::Negative { field, value, unit });
        }
    }
    errors
}
