//! Assembly of the matrices of the dynamics on the device, and of their preconditioner: each element writes
//! its blocks, then each block of the matrix sums its share in a fixed order.
//!
//! | module | holds |
//! |---|---|
//! | `layout` | data that host, kernels and twins share |
//! | `plan` | what the host prepares once for a model |
//! | `grid` | positions as integers |
//! | `buffers` | the buffers of a model and the dispatches of an assembly |
//! | `hierarchy`, `groups` | the same of the preconditioner's groups |

mod buffers;
mod grid;
mod groups;
mod hierarchy;
pub(crate) mod layout;
mod plan;

pub(crate) use buffers::{AssemblyBuffers, AssemblyPlace, ElementBuffers, Written};
pub(crate) use grid::StateGrid;
pub(crate) use groups::GroupBuffers;
pub(crate) use hierarchy::Hierarchy;
pub(crate) use plan::Plan;
