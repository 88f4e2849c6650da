//! What [`Forward`](crate::Forward) refuses.

use bowknot_errors::{Errors, ParamError};

/// Why [`Forward`](crate::Forward) cannot do what it is asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForwardError {
    /// Options out of range.
    #[error("{0}")]
    Options(Errors<ParamError>),
    /// A wrong number of entries.
    #[error("there are {given} {what} for {vertices} vertices")]
    Length {
        /// "positions", "radii" or "targets".
        what: &'static str,
        /// Entries given.
        given: usize,
        /// Vertices of the model.
        vertices: usize,
    },
    /// A position that is not finite or too far.
    #[error("vertex {vertex} is at {position:?} m: coordinates must be finite and at most 1e14")]
    Position {
        /// The vertex.
        vertex: usize,
        /// Its position [m].
        position: [f64; 3],
    },
    /// A radius out of range.
    #[error("the radius of vertex {vertex} is {radius} m: it must be 0, or 1e-100 to 1e14")]
    Radius {
        /// The vertex.
        vertex: usize,
        /// Its radius [m].
        radius: f64,
    },
    /// A minimum separation out of range.
    #[error("the minimum separation of pair {pair} is {min_separation} m: it must be at least 0")]
    MinSeparation {
        /// The pair.
        pair: usize,
        /// Its minimum separation [m].
        min_separation: f64,
    },
    /// A half-space whose normal has another length than 1, or whose offset is not a number or infinite.
    #[error("half-space {half_space} needs a normal of length 1 and a finite offset")]
    HalfSpace {
        /// The half-space.
        half_space: usize,
    },
    /// A topology whose lists do not belong together, so that a search would miss pairs.
    #[error(
        "the topology is not as its builder makes it: its lists of edges and vertices do not fit its elements"
    )]
    Topology,
}
