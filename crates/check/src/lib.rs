#![doc = include_str!("../README.md")]
//!
//! ## Calls, and what is judged
//!
//! ```text
//! Judge::new(&Parts) -> Result<Judge, CheckError>                       loose meshes
//! Judge::from_model(&CollisionModel) -> Judge                           a scene
//! judge.check_state(&x, &StateOptions)  -> Result<StateReport, CheckError>
//! judge.check_path(&x0, &x1, &PathOptions) -> Result<PathReport, CheckError>
//! judge.pairs_within(&x, distance)      -> Result<Vec<NearPair>, CheckError>
//! MotionJudge::new(judge)                                               many states and paths, one after another
//! judge.offending_mesh(&x, &[Intersection]) -> OffendingMesh            for a dump
//! ```
//!
//! **What is judged.** In a state: every edge against every triangle (closed, so touching and coplanar
//! overlap count), every two edges, every vertex against every triangle, every particle against every
//! strand edge and particle, every vertex against every half-space. On a path: the same kinds but
//! edge-triangle, at every time; a path that starts free of intersections cannot come to have an edge
//! through a triangle without a vertex meeting a triangle or an edge an edge first. Left out are pairs
//! that share a vertex, pairs of two obstacle primitives, and pairs that the bodies' filters exclude.
//!
//! **What is not judged:** two edges that share a vertex folded exactly onto each other, as no pair
//! kind covers them; and which side of a surface a body is on.

// Results have the same bits on every machine; tests may use the system's functions.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod body_pairs;
mod closest;
mod dump;
mod error;
mod exceptions;
mod intersections;
mod judge;
mod motion;
mod near;
mod nearest;
mod path;
mod primitives;
mod report;
mod sweep;
mod tree;
mod walk;

#[cfg(test)]
mod tests;

/// Points and half-spaces: what states are made of.
pub use bowknot_geometry as geometry;
pub use dump::OffendingMesh;
pub use error::CheckError;
pub use judge::{Judge, Parts};
pub use motion::MotionJudge;
pub use report::{
    BodyPair, Intersection, NearPair, Nearest, PairClass, PathHit, PathOptions, PathReport, StateOptions,
    StateReport,
};
