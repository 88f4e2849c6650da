//! Tests of the whole two-way loop: bodies, friction, obstacles, calls.

/// The end of a call that something else has made.
mod adopt;
mod backward;
mod bodies;
mod common;
mod fingers;
mod flight;
mod friction;
mod obstacles;
mod resolve;
mod scenes;
mod tutorial;
/// What a call says that it waits for.
mod waits;
