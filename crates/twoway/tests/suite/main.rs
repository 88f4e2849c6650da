//! The two-way loop as a whole: bodies, friction, calls.

mod bodies;
mod common;
mod friction;
mod resolve;
