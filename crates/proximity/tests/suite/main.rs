//! The search against all pairs.

mod brute_force;
mod determinism;
mod scenes;
mod swept;
