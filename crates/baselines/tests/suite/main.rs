//! Other methods: alone on small systems with known answers, and as a whole on scenes.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

mod backward;
mod common;
mod interior;
mod parameters;
mod zones;
