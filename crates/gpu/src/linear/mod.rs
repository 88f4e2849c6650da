//! Linear solves: preconditioned conjugate gradients whose vectors and scalars stay on the device.
//!
//! | module | holds |
//! |---|---|
//! | `layout` | data that host, kernels and twins share |
//! | `matrix` | the matrix as it lies on the device |
//! | `patches`, `rigid`, `galerkin`, `inverse` | the preconditioner: patches and groups of nodes, their motions, their matrices |
//! | `buffers` | the buffers of a system |
//! | `record` | the dispatches of an iteration |
//! | `solver` | the backend of the dynamics |
//! | `assembled`, `assembly` | the same with matrices that the device assembles |

mod assembled;
mod assembly;
mod buffers;
mod galerkin;
mod inverse;
mod layout;
mod matrix;
mod patches;
mod record;
mod rigid;
mod solver;

pub(crate) use assembled::symmetric_blocks;
pub(crate) use buffers::Buffers;
pub(crate) use layout::{
    CHILDREN, DOMAIN_UNKNOWNS, DOMAIN_WORDS, MOST_LEVELS, PATCH_SLOTS, PatchSlot, Progress, Spring,
};
pub(crate) use matrix::{BLOCK_WORDS, PackedMatrix, SLICE};
pub(crate) use patches::Patches;
pub(crate) use record::{Recorder, StrandHessian};
pub use solver::ConjugateGradients;

#[cfg(test)]
mod tests;
