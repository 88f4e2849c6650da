//! Bodies against closed forms.

mod air;
mod backend;
mod common;
mod custom;
mod integrators;
mod physics;
mod potential;
mod repulsion;
mod solids;
mod strands;
