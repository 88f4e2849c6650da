//! Why something cannot be judged.

use bowknot_geometry::TopologyError;

/// Why something cannot be judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// An element names a vertex that does not exist, or a vertex twice.
    #[error(transparent)]
    Topology(#[from] TopologyError),
    /// An array has another length than there are vertices.
    #[error("{what} has {given} entries for {vertex_count} vertices")]
    WrongLength {
        /// Which array.
        what: &'static str,
        /// Its length.
        given: usize,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// A coordinate is not a number, infinite, or too large for the arithmetic to be exact.
    #[error("vertex {vertex} is at ({}, {}, {}); coordinates must be finite and below \
             {limit:e}", position[0], position[1], position[2])]
    BadCoordinate {
        /// The vertex.
        vertex: usize,
        /// Where it is [m].
        position: [f64; 3],
        /// Largest magnitude that can be judged [m].
        limit: f64,
    },
}
