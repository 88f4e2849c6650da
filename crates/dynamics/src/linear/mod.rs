//! The linear system of a Newton iteration: storage, products, preconditioners, conjugate gradients.

pub(crate) mod accuracy;
pub(crate) mod assembly;
pub(crate) mod block;
pub(crate) mod cg;
pub(crate) mod cholesky;
pub(crate) mod coarse;
pub(crate) mod direct;
mod guesses;
pub(crate) mod lane;
pub(crate) mod operator;
pub(crate) mod ordering;
pub(crate) mod parts;
pub(crate) mod preconditioner;
pub(crate) mod scalar;
pub(crate) mod solver;
pub(crate) mod springs;
pub(crate) mod system;
pub(crate) mod vectors;
