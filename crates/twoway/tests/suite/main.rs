//! Tests of the whole two-way loop: bodies, friction, calls.

mod backward;
mod bodies;
mod common;
mod friction;
mod resolve;
mod tutorial;
