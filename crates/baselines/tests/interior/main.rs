//! Interior point methods other than the two-way one.
#![allow(clippy::unwrap_used)] // helpers of tests are outside the functions that the lint knows as tests

mod common;
mod descent;
mod forms;
mod impacts;
mod newton;
mod objective;
