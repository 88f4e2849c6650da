//! Other solvers of the backward step's rows: alone on small systems with known answers, and within the
//! two-way method.

mod augmented_lagrangian;
mod composed;
mod jacobi;
mod linear_system;
mod systems;
