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
    /// More elements of a kind than indices can count.
    #[error(
        "{count} {elements}; at most {} are possible: leave bodies out, or make meshes coarser",
        u32::MAX
    )]
    TooMany {
        /// "vertices", "triangles", "edges" or "particles".
        elements: &'static str,
        /// How many there are.
        count: usize,
    },
}

/// Refuses numbers of elements that an index of 32 bits cannot count: larger ones would wrap around, and
/// elements would be taken for others. The largest index means "none" in many tables.
pub fn check_count(elements: &'static str, count: usize) -> Option<TopologyError> {
    (count > u32::MAX as usize).then_some(TopologyError::TooMany { elements, count })
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
