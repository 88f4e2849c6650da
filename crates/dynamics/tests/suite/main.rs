//! Bodies against closed forms.

mod air;
mod common;
mod physics;
mod repulsion;
mod solids;
mod strands;
