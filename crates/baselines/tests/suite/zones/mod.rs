//! Impact zones: what they keep, and where they fail.

mod determinism;
mod impacts;
mod optimiser;
mod rigid;
mod support;
mod two_phase;
