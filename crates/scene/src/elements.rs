//! The elements of solids.

use serde::{Deserialize, Serialize};

/// What the tetrahedra of a solid are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum SolidElements {
    /// Of constant strain, over the vertices of the mesh. Right where a body is many elements thick or hardly
    /// bends; four elements thick it bends by three fifths of what it should, one element thick by a tenth to
    /// a third.
    #[default]
    Linear,
    /// Of linear strain: each edge gets a vertex in its middle, and each tetrahedron of the mesh becomes
    /// eight small ones in frames and for contact. One element thick a body bends by nine tenths of what it
    /// should.
    Quadratic,
}
