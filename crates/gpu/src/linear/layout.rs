//! The data of a linear solve that host, kernels and twins share. A test compares every struct with what the
//! shaders declare (`stages/tests.rs`).

use crate::kernels;
use bytemuck::{Pod, Zeroable};

/// Threads of a workgroup that adds up sums.
pub const THREADS: usize = kernels::cg_step::THREADS as usize;

/// Most workgroups that write partial sums: the workgroups of the next stage each add them all, one per
/// thread.
pub const MOST_WORKGROUPS: usize = THREADS;

/// Slots of a patch, each for a node: eight groups of eight slots.
pub const PATCH_SLOTS: usize = 64;

/// Groups of a patch, children of a domain, slots of a group.
pub const CHILDREN: usize = 8;

/// Unknowns of a domain: the six rigid motions of eight children.
pub const DOMAIN_UNKNOWNS: usize = 6 * CHILDREN;

/// Numbers of the inverse of a domain's matrix; zero for motions that move nothing.
pub const DOMAIN_WORDS: usize = DOMAIN_UNKNOWNS * DOMAIN_UNKNOWNS;

/// Most coarse levels: 8^8 patches are more than a buffer holds.
pub const MOST_LEVELS: usize = 8;

/// A node of a patch, with its part of the preconditioner.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PatchSlot {
    /// [`crate::NONE`] for an empty slot.
    pub node: u32,
    /// The diagonal block as a product L D L^T: L_21, L_31, L_32, then the inverses of D.
    pub factors: [f32; 6],
    /// From the center of the group to the node, over the size of the group.
    pub arm: [f32; 3],
    /// Half of the link of the group to the patch, of the first two slots of a group: the way from the center
    /// of the patch to that of the group, over the size of the patch, and the ratio of the sizes.
    pub link: [f32; 2],
}

impl PatchSlot {
    pub const EMPTY: Self = Self { node: u32::MAX, factors: [0.0; 6], arm: [0.0; 3], link: [0.0; 2] };
}

/// A spring over the weighted sum of four nodes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Spring {
    pub nodes: [u32; 4],
    /// 0 for places without a node.
    pub weights: [f32; 4],
    /// By columns; the fourth numbers are the components of the force.
    pub hessian: [[f32; 4]; 3],
}

/// How far the iterations are.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Progress {
    /// 1 until the residual is small enough or numbers are no longer positive.
    pub moving: u32,
    pub iterations: u32,
    /// Squared norm of a residual that is small enough.
    pub goal: f32,
}
