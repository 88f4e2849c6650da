//! Solvers against closed forms, optimality conditions and each other.

mod closed_forms;
mod common;
mod complementarity;
mod determinism;
mod refusals;
