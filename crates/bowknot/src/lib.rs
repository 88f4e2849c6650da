//! Simulation of deformable bodies that never intersect.

pub mod io;

pub mod check;
