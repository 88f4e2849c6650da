//! Broad and narrow phase: every pair of non-adjacent primitives nearer than their radii.
//!
//! It knows positions, radii and who may meet whom; it does not know forces or constraints.

mod model;
mod pairs;
mod search;

pub use model::{BodyFilter, CollisionModel, ModelError};
pub use pairs::{Pair, PairList};
pub use search::ProximitySearch;
