//! Tests that no step of the collision stage intersects.

// The generators of hard states draw what they claim.
mod generators;
// No step of the forward stage alone intersects.
mod forward;
// Long steps that random problems hardly ever make dangerous are safe.
mod long_steps;
// Faults that searches have found stay repaired.
mod regressions;
// No step of the whole method intersects, whatever the problem.
mod steps;
