//! The layouts of a Gmsh file.

/// The two layouts that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    /// One list of nodes and one of elements, each element with its own tags.
    V2,
    /// Blocks of nodes and elements, one for each geometrical entity.
    V4,
}
