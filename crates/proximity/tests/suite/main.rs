//! The search against all pairs.

mod brute_force;
mod candidates;
mod determinism;
mod models;
mod scenes;
mod swept;
