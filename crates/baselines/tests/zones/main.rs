//! Impact zones: what they keep, and where they fail.
#![allow(clippy::unwrap_used)] // helpers outside the test functions

#[path = "../interior/common.rs"]
#[allow(dead_code)] // the other suite takes more
mod common;
mod determinism;
mod impacts;
mod optimiser;
mod rigid;
mod support;
mod two_phase;
