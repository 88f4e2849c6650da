//! Step sizes by continuous collision detection in place of distances (paper, sections 5.1 and 5.2).
//!
//! [`AdditiveCcd`] computes how far a pair is certain not to meet. Two forward steps use it: all vertices
//! move up to the earliest impact ([`EarliestImpact`]), or each vertex up to its own ([`PerVertexImpact`]).
//! Both work with every backward step.

mod additive;
mod earliest;
mod pairs;
mod path_search;
mod per_vertex;

pub use additive::{AdditiveCcd, Clearance, ClosingSpeed};
pub use earliest::EarliestImpact;
pub(crate) use earliest::earliest;
pub(crate) use path_search::{PathSearch, PathTime};
pub use per_vertex::PerVertexImpact;
