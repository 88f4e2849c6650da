//! Edges at their stretch limits: their forces, and the larger limits of those that pins hold apart.

mod held_apart;
mod held_edges;
mod least_excess;
mod limited_edges;

pub(crate) use held_apart::OverLimit;
pub use held_apart::{HeldApart, HeldPair};
pub(crate) use held_edges::HeldEdges;
pub(crate) use limited_edges::LimitedEdges;
