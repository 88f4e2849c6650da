//! Newton's method from a state to the target.
//!
//! | file | holds |
//! |---|---|
//! | [`bodies`] | what the method asks of the bodies; [`cpu`] and [`device`] answer |
//! | [`state`] | what an iteration works on: [`state::Step`], [`state::Workspace`], [`state::Newton`] |
//! | [`linearize`], [`potential`] | gradient and matrix, and the incremental potential, on the CPU |
//! | [`backend`] | what a device does |
//! | [`line_search`] | backtracking along a Newton step |
//! | [`momentum`] | exact linear momentum in spite of inexact linear solves |
//! | [`iteration`] | one Newton iteration |
//! | [`corrections`] | iterations that correct an inaccurate step |
//! | [`solve`], [`contacts`] | the sequence of iterations to a target, without and with contacts |
//! | [`residual`] | forces out of balance |

pub mod backend;
pub(super) mod bodies;
mod contacts;
mod corrections;
pub(super) mod cpu;
pub(super) mod device;
mod iteration;
mod line_search;
mod linearize;
pub(super) mod momentum;
mod potential;
mod residual;
mod solve;
pub(super) mod state;
