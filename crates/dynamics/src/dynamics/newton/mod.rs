//! Newton's method from a state to the target.
//!
//! | file | holds |
//! |---|---|
//! | [`state`] | what an iteration works on: [`state::Step`], [`state::Workspace`], [`state::Newton`] |
//! | [`backend`] | what a device does |
//! | [`linearize`], [`assemble`] | gradient and matrix, on the CPU or by a backend |
//! | [`potential`] | the incremental potential |
//! | [`line_search`] | backtracking along a Newton step |
//! | [`momentum`] | exact linear momentum in spite of inexact linear solves |
//! | [`iteration`] | one Newton iteration |
//! | [`corrections`] | iterations that correct an inaccurate step |
//! | [`solve`], [`contacts`] | the sequence of iterations to a target, without and with contacts |
//! | [`residual`] | forces out of balance |

mod assemble;
pub mod backend;
mod contacts;
mod corrections;
mod iteration;
mod line_search;
mod linearize;
mod momentum;
mod potential;
mod residual;
mod solve;
pub(super) mod state;
