//! The data of Newton's method that host, kernels and twins share. A test compares it with what the shaders
//! declare (`stages/tests.rs`).

use crate::kernels;
use crate::linear::MOST_WORKGROUPS;
use bytemuck::{Pod, Zeroable};

/// Nodes of which a workgroup adds up the momenta.
pub const WINDOW: usize = kernels::block_momenta::WINDOW as usize;

/// How far a linear solve is. Norms are squared, and those of vectors times the factor.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Solve {
    /// A power of two that makes the largest force nearly 1, so that squares of forces of any unit are
    /// numbers of single precision, and its inverse.
    pub factor: f32,
    pub inverse: f32,
    /// Of the right-hand side.
    pub scale: f32,
    /// Of the residual at the start of the last round, and at its end.
    pub before: f32,
    pub norm: f32,
    /// Where the solve may end.
    pub goal: f32,
    /// Where the last batch of iterations ended, by the sums of the preconditioner, as all norms.
    pub reached: f32,
    /// Iterations so far.
    pub iterations: u32,
    /// 1 after the last iteration of a round, and before the first one.
    pub ended: u32,
}

impl Solve {
    /// Before a solve.
    pub const BEFORE: Self = Self {
        factor: 1.0,
        inverse: 1.0,
        scale: 0.0,
        before: 0.0,
        norm: 0.0,
        goal: 0.0,
        reached: 0.0,
        iterations: 0,
        ended: 1,
    };

    /// Its words.
    pub const WORDS: usize = size_of::<Self>() / 4;

    /// What a device has written.
    pub fn from_words(words: &[u32]) -> Self {
        bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words[..Self::WORDS]))
    }
}

/// Words of the sums of a trial or of guesses by workgroup, and of a trial over all of them.
pub const SUMS: usize = 8;

/// Where the sums of guesses begin, after a number per workgroup.
pub const FIRST_SUM: usize = MOST_WORKGROUPS;

/// What `reduce_trial` writes: p . b, then what is largest of the components of p, of the squared distances
/// from the iterate and from the start of the target, and of the coordinates.
pub const SUMMARY: usize = 5;
