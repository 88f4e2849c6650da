//! The shape in which a body stores no bending energy.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Shape in which a body stores no bending energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum RestShape {
    /// Flat or straight, whatever the initial shape is.
    Flat,
    /// The initial shape with its curvature.
    Initial,
}
