//! Simulation of deformable bodies that never intersect.
