#![doc = include_str!("../README.md")]
//!
//! ## Stages
//!
//! One search has these stages, each in its own modules:
//! 1. `frame`: positions relative to a local origin, in `f32`, with their radii;
//! 2. `obstacles`, `layer`, `tree`, `order`: packed 16-ary trees of the deformable primitives (refitted), of
//!    obstacles that move (refitted) and of obstacles at rest (kept);
//! 3. `traverse`, `pair_test`: every element against the trees; a certified `f32` test decides all but a few
//!    pairs, and [`bowknot_geometry::separation::separate`] decides those;
//! 4. `assemble`, `narrow`: the pairs in order, with their contact geometry; or `candidates`: a compact list
//!    that takes the pairs of vertices that have changed.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod assemble;
mod bits;
mod candidates;
mod collision_matrix;
mod frame;
mod half_spaces;
mod layer;
mod mesh_query;
mod min_max;
mod narrow;
mod obstacles;
mod order;
mod pair_test;
mod pairs;
mod search;
mod statistics;
mod traverse;
mod tree;

/// Points, topology and separations: the types of this crate's arguments and results.
pub use bowknot_geometry as geometry;

pub use bowknot_geometry::{BodyFilter, CollisionModel, ModelError};
pub use candidates::{CandidateList, Candidates};
pub use half_spaces::near_half_spaces;
pub use mesh_query::{MeshQuery, MeshQueryError, RayHit, SurfacePoint};
pub use narrow::{separate_all, separate_one};
pub use pairs::{Candidate, Pair, PairList, PairLookup};
pub use search::ProximitySearch;
pub use statistics::SearchStatistics;
