//! Stability: small scenes at the ends of what users ask for, and what became of each.
//!
//! | module | holds |
//! |---|---|
//! | `case` | a case: scene, start, goals |
//! | `scenes` | the scenes that the sweeps change |
//! | `sweeps` | one quantity over decades: time step, stiffness, density, size, origin, speed |
//! | `trials` | scenes that are hard by themselves: presses, pins out of reach, inverted tetrahedra |
//! | `outcome` | running a case under the judge; its counts and the goals that it missed |
//!
//! Counts are what matters here, so that cases may run beside other programs.

mod case;
mod outcome;
mod scenes;
mod sweeps;
mod trials;

pub use case::Case;
pub use outcome::{Outcome, run};

use crate::bench::Size;

/// All cases of a size, in the order of the table.
pub fn cases(size: Size) -> Vec<Case> {
    let mut cases = sweeps::all(size);
    cases.extend(trials::all(size));
    cases
}
