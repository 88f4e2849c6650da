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

/// Vertices out of range and repeated vertices, element by element. `element` names their type in messages.
pub fn check_elements<const N: usize>(
    element: &'static str,
    elements: &[[u32; N]],
    vertex_count: usize,
) -> impl Iterator<Item = TopologyError> {
    elements.iter().enumerate().flat_map(move |(index, vertices)| {
        vertices.iter().enumerate().flat_map(move |(k, &vertex)| {
            let missing = VertexOutOfRange::of(element, index, &vertices[k..=k], vertex_count);
            let repeated = vertices[..k].contains(&vertex);
            let repeated = repeated.then_some(TopologyError::RepeatedVertex { element, index, vertex });
            missing.map(TopologyError::from).chain(repeated)
        })
    })
}
