//! Faults of elements.

use crate::vertex_range::VertexOutOfRange;

/// Why a topology cannot be built from some elements.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TopologyError {
    /// An element names a vertex that does not exist.
    #[error(transparent)]
    VertexOutOfRange(#[from] VertexOutOfRange),
    /// An element names the same vertex twice.
    #[error("{element} {index} names vertex {vertex} twice")]
    RepeatedVertex {
        /// "triangle" or "strand edge".
        element: &'static str,
        /// Index of the element.
        index: usize,
        /// The vertex that it repeats.
        vertex: u32,
    },
}
