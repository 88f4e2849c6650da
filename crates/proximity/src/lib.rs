//! Broad and narrow phase: every pair of non-adjacent primitives nearer than their radii.
//!
//! It knows positions, radii and who may meet whom; it does not know forces or constraints.
//!
//! One search goes through these stages, each in its own module:
//! 1. `frame`: positions relative to a local origin, in `f32`, with their radii;
//! 2. `layer`, `tree`, `order`: packed 16-ary trees of the deformable primitives (refitted), of
//!    obstacles that move (refitted) and of obstacles at rest (kept);
//! 3. `traverse`, `kinds`: every element against the trees; a certified `f32` test decides all but
//!    a few pairs, those few by [`bowknot_geometry::separation::separate`];
//! 4. `assemble`: the pairs in order, with their contact geometry.

mod assemble;
mod bits;
mod frame;
mod half_spaces;
mod kinds;
mod layer;
mod narrow;
mod obstacles;
mod order;
mod pairs;
mod search;
mod statistics;
mod traverse;
mod tree;

/// Points, topology and separations: the types of this crate's arguments and results.
pub use bowknot_geometry as geometry;

pub use bowknot_geometry::{BodyFilter, CollisionModel, ModelError};
pub use pairs::{Pair, PairList};
pub use search::ProximitySearch;
pub use statistics::SearchStatistics;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
struct Readme;
