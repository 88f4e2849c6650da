//! Linear solves: preconditioned conjugate gradients whose vectors and scalars stay on the device.
//!
//! | module | holds |
//! |---|---|
//! | `layout` | data that host, kernels and twins share |
//! | `matrix` | the matrix as it lies on the device |
//! | `patches` | patches and groups of nodes, for the preconditioner |
//! | `buffers` | the buffers of a system |
//! | `record` | the dispatches of an iteration |
//! | `solver` | the backend of the dynamics |
//! | `assembled`, `assembly` | the model and the matrix that the device assembles of it |

mod assembled;
mod assembly;
mod buffers;
pub(crate) mod layout;
mod matrix;
mod patches;
mod record;
mod solver;

pub(crate) use assembled::symmetric_blocks;
pub(crate) use buffers::Buffers;
pub(crate) use layout::{CHILDREN, DOMAIN_WORDS, MOST_WORKGROUPS, PATCH_SLOTS, Progress, THREADS};
pub(crate) use matrix::{Columns, PackedMatrix, SLICE};
pub(crate) use patches::Patches;
pub(crate) use record::{Recorder, StrandHessian};
pub use solver::ConjugateGradients;
