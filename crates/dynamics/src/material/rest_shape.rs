//! The shape in which a body stores no bending energy.

use serde::{Deserialize, Serialize};

/// Shape in which a body stores no bending energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RestShape {
    /// Flat or straight, whatever the initial shape is.
    Flat,
    /// The initial shape with its curvature.
    Initial,
}
