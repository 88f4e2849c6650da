//! Bodies against closed forms.

mod air;
mod backend;
mod common;
mod physics;
mod potential;
mod repulsion;
mod solids;
mod strands;
