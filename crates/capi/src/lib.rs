//! Bowknot for C, and for everything that calls C. `include/bowknot.h`, which is made from this crate, is the interface;
//! `examples/drape.c` shows it.
//!
//! - Every function returns a [`BowknotStatus`] or a number that cannot fail. [`bowknot_error`] has the words.
//! - What `_new` makes `_free` ends. A handle is used by one thread at a time; different ones are independent.
//! - Positions are x y z of each vertex, in m; counts of arrays are counts of their entries, so three per vertex.
//! - A panic, which is a fault of the library, is caught and returns [`BowknotStatus::Internal`]; then free the handle.

// Pointers from C are read and written here, each time by the contract of its function.
#![allow(unsafe_code)]

mod error;
mod memory;
mod resolver;
mod simulator;

pub use error::{BowknotStatus, bowknot_error};
pub use resolver::{
    BowknotMesh, BowknotResolved, BowknotResolver, bowknot_resolver_delta, bowknot_resolver_free,
    bowknot_resolver_intersections, bowknot_resolver_new, bowknot_resolver_resolve,
};
pub use simulator::{
    BowknotBody, BowknotSimulator, BowknotStep, bowknot_simulator_add_pin, bowknot_simulator_bodies,
    bowknot_simulator_body, bowknot_simulator_edges, bowknot_simulator_free, bowknot_simulator_intersections,
    bowknot_simulator_new, bowknot_simulator_positions, bowknot_simulator_remove_pin,
    bowknot_simulator_set_gravity, bowknot_simulator_set_obstacle_targets, bowknot_simulator_set_pin_targets,
    bowknot_simulator_step, bowknot_simulator_triangles, bowknot_simulator_velocities,
    bowknot_simulator_vertices,
};
