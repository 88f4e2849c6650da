//! The begin of a line search.

use bowknot_dynamics::{Trial, Watched};

/// The begin of a search along a step: watched nodes at the reference, the trial at full length, and, if it
/// was read, where its nodes are.
#[derive(Debug)]
pub struct Search {
    pub at_reference: Watched,
    pub trial: Trial,
    pub words: Option<Vec<u32>>,
}
