//! Step sizes by continuous collision detection in place of distances (paper, sections 5.1 and 5.2).
//!
//! [`AdditiveCcd`] computes how far a pair is certain not to meet. Two forward steps use it: all vertices
//! move up to the earliest impact ([`EarliestImpact`]), or each vertex up to its own ([`PerVertexImpact`]).
//! Both work with every backward step, and with [`SweptSearch`] alone.

mod additive;
mod earliest;
mod pairs;
mod per_vertex;
mod swept;

pub use additive::{AdditiveCcd, Clearance, ClosingSpeed};
pub use earliest::EarliestImpact;
pub(crate) use earliest::earliest;
pub(crate) use pairs::clearance;
pub use per_vertex::PerVertexImpact;
pub(crate) use swept::PathTime;
pub use swept::SweptSearch;
