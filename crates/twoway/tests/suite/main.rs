//! Tests of the whole two-way loop: bodies, friction, calls.

mod bodies;
mod common;
mod flight;
mod friction;
mod resolve;
mod tutorial;
