//! Conjugate gradients on an engine, as a backend of the dynamics.

use super::assembly::Assembly;
use super::buffers::Pool;
use super::record::Recorder;
use crate::engine::Engine;
use crate::newton::Newton;

/// Newton's method of the dynamics on an engine: linear systems are assembled and solved there, with
/// block-Jacobi, or with rigid motions on several levels of groups of nodes (`docs/gpu/dynamics.md`).
#[derive(Debug)]
pub struct ConjugateGradients<E> {
    pub(crate) name: String,
    pub(crate) engine: E,
    pub(crate) pool: Pool,
    pub(crate) recorder: Option<Recorder>,
    /// The elements of the model.
    pub(crate) assembly: Option<Assembly>,
    /// The vectors of Newton's method over that model.
    pub(crate) newton: Option<Newton>,
}

impl<E: Engine> ConjugateGradients<E> {
    /// Solves on that engine, which nothing else may use.
    pub fn new(name: String, engine: E) -> Self {
        Self { name, engine, pool: Pool::default(), recorder: None, assembly: None, newton: None }
    }

    /// What runs the stages.
    pub fn engine(&self) -> &E {
        &self.engine
    }
}
