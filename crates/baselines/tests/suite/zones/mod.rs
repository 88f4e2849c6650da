//! Impact zones: what they keep, and where they fail.

mod determinism;
mod impacts;
mod optimizer;
mod rigid;
mod support;
mod two_phase;
