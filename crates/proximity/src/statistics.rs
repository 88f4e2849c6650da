//! Counts of a search.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// Counts of the last search.
///
/// All but `pairs` measure effort, and may differ between two searches of the same state after different
/// earlier searches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SearchStatistics {
    /// Pairs that share no vertex, may collide, and whose inflated boxes overlap.
    pub candidates: u64,
    /// Candidates that the certified `f32` test left to the `f64` one.
    pub undecided: u64,
    /// Pairs listed.
    pub pairs: u64,
    /// Trees whose boxes were refitted.
    pub refits: u32,
    /// Trees that were rebuilt with a new spatial order.
    pub rebuilds: u32,
}
