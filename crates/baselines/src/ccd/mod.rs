//! Step sizes by continuous collision detection in place of distances (paper, sections 5.1 and 5.2).
//!
//! [`AdditiveCcd`] tells how far a pair surely does not meet. Two forward steps are made of it: all vertices go as far as the
//! earliest impact lets them ([`EarliestImpact`]), or each as far as its own does ([`PerVertexImpact`]). Either fits every
//! backward step.

mod additive;
mod earliest;
mod pairs;
mod per_vertex;
mod reach;

pub use additive::{AdditiveCcd, Clearance, ClosingSpeed};
pub use earliest::EarliestImpact;
pub(crate) use earliest::earliest;
pub use per_vertex::PerVertexImpact;
pub(crate) use reach::{Clocks, PathSearch};
