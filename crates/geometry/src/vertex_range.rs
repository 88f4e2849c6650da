//! Elements that name vertices which do not exist.

/// An element names a vertex that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{element} {index} names vertex {vertex}, but there are only {vertex_count} vertices")]
pub struct VertexOutOfRange {
    /// Type of the element: "triangle", "strand edge" or "particle", for example.
    pub element: &'static str,
    /// Index of the element.
    pub index: usize,
    /// The vertex that it names.
    pub vertex: u32,
    /// How many vertices there are.
    pub vertex_count: usize,
}

impl VertexOutOfRange {
    /// One error for each vertex of an element that is not below `vertex_count`, in order.
    pub fn of(
        element: &'static str,
        index: usize,
        vertices: &[u32],
        vertex_count: usize,
    ) -> impl Iterator<Item = Self> {
        let missing = vertices.iter().filter(move |&&vertex| vertex as usize >= vertex_count);
        missing.map(move |&vertex| Self { element, index, vertex, vertex_count })
    }
}
