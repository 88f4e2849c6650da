//! The quality of a result x of a collision problem, measured alike for every method.
//!
//! Every result is measured with one set of rows, whatever the parameters of its method: contacts within
//! range and edge limits, linearized at x (`rows`) under the parameters of `fast`
//! ([`crate::case::CollisionCase::reference`]).
//!
//! - Distance to the reference solution: the reference is made by `fast` itself with 200 sweeps, iterated to
//!   rest (`reference`).
//! - Stationarity residual and violations: pairs come from the proximity search and rows from
//!   `bowknot-constraints`, as in the backward step; the multipliers come from a solver of their own
//!   (`nonnegative`).
//! - Intersections: the independent judge, `bowknot::check`.
//!
//! So the residuals share rows with the backward step, but no solver; the reference shares all of it, and is
//! accepted only if its residuals are small.

mod evaluator;
mod nonnegative;
mod reference;
mod rows;

pub use evaluator::{CaseEvaluator, Quality};
pub use reference::with_reference;

#[cfg(test)]
mod tests;
