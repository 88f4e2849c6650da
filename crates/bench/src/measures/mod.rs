//! The quality of a result x of a collision problem, measured alike for every method. Its code shares with the methods
//! only the lengths that define the problem: masses, contact distances and limits of edges.
//!
//! | file | holds |
//! |---|---|
//! | `statement` | the problem as it is stated; pairs, distances and gradients are those of the judge |
//! | `augmented`, `model` | a separate, slow solver of it |
//! | `reference` | the reference solution: the best that this solver finds |
//! | `nonnegative` | the multipliers of a result |
//! | `evaluator` | objective, violations, stationarity residual, intersections, and the distance to the reference |

mod augmented;
mod evaluator;
mod model;
mod nonnegative;
mod reference;
mod statement;

pub use evaluator::{CaseEvaluator, Quality};
pub use reference::with_reference;

#[cfg(test)]
mod tests;
