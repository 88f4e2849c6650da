//! Other solvers of the backward step's rows: alone on small systems with known answers, and within the two-way method.
#![allow(clippy::unwrap_used)] // helpers outside the test functions

mod augmented_lagrangian;
#[path = "../interior/common.rs"]
#[allow(dead_code)] // the other suite takes more
mod common;
mod composed;
mod jacobi;
mod linear_system;
mod systems;
