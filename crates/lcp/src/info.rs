//! What an iterative solver reports.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// What an iterative solver did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct LcpInfo {
    /// Sweeps done.
    pub sweeps: u32,
    /// Largest correction of a row value in the last sweep: |change of the multiplier| times the row's
    /// diagonal [unit of the row values]. A sweep computes it on the way, from the state as it is when each
    /// row's turn comes. [`crate::residuals`] evaluates the state after the sweep.
    pub residual: f64,
}
