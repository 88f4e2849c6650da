//! Obstacles and pins: where they are led to, where they end, and which obstacles are there.

mod clearance;
mod ends;
mod keyframes;
mod presence;

pub(crate) use ends::Ends;
