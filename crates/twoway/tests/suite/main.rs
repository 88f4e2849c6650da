//! Tests of the whole two-way loop: bodies, friction, obstacles, calls.

mod bodies;
mod common;
mod friction;
mod obstacles;
mod resolve;
mod tutorial;
