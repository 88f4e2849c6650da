//! The search against all pairs.

mod brute_force;
mod candidates;
mod determinism;
mod scenes;
mod swept;
