//! The data of assembly that host, kernels and twins share. A test compares every struct with what the
//! shaders declare (`stages/tests.rs`).
//!
//! Positions are integers, multiples of a quantum, so that differences of near positions keep 24 bits of
//! their own. Units are SI.

use bytemuck::{Pod, Zeroable};

/// Springs of a domain: their places in the list, the slots of a group of its level, its first group and the
/// frame of that.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Chunk {
    pub begin: u32,
    pub end: u32,
    pub width: u32,
    pub group: u32,
    pub frame: u32,
}

/// A triangle of constant strain.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Membrane {
    pub nodes: [u32; 3],
    pub area: f32,
    /// Gradients of the shape functions of nodes 1 and 2.
    pub gradients: [f32; 4],
    /// c11, c12, c22, shear.
    pub stiffness: [f32; 4],
    pub damping: f32,
    pub padding: [u32; 3],
}

/// Bending around a triangle that is curved at rest.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Bend {
    /// [`crate::NONE`] for places without a node.
    pub nodes: [u32; 6],
    /// Weights of the nodes, edge by edge.
    pub jumps: [f32; 18],
    pub gram: [f32; 9],
    /// Gradients of the shape functions of nodes 1 and 2.
    pub gradients: [f32; 4],
    /// Components along both columns of F and the normal, edge by edge.
    pub rest: [f32; 9],
    pub crushed: f32,
    pub padding: u32,
}

/// A tetrahedron of constant strain.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Tetrahedron {
    pub nodes: [u32; 4],
    /// Gradients of the shape functions of nodes 1, 2, 3.
    pub gradients: [f32; 9],
    pub volume: f32,
    pub lambda: f32,
    pub mu: f32,
    /// 0: St. Venant-Kirchhoff, 1: stable neo-Hookean.
    pub law: u32,
    /// Lame parameters of small strain times the damping time; 0 without damping.
    pub viscous_lambda: f32,
    pub viscous_mu: f32,
    pub padding: u32,
}

/// An edge or a turn of a strand, see [`bowknot_dynamics::StrandElement`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Strand {
    /// The first two are the same for an edge.
    pub nodes: [u32; 3],
    pub rest: f32,
    pub inverse_lengths: [f32; 2],
    pub stiffness: f32,
    pub damping: f32,
}

/// The second derivative of a [`Strand`] by w: across I + axial along along^T.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Curvature {
    pub along: [f32; 3],
    pub axial: f32,
    pub across: f32,
}

/// A block of the matrix beside its diagonal: where it stands and what is summed to it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Entry {
    /// The word of its column.
    pub at: u32,
    /// Its sources: twice the number of a block of an element, plus 1 if that is transposed.
    pub first: u32,
    pub count: u32,
    /// Flat bending, a multiple of the identity.
    pub bending: f32,
}

/// The parameters of the kernels of elements.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct ElementParams {
    pub elements: u32,
    /// The first block that these elements write.
    pub first_block: u32,
    /// 1: negative curvatures change their sign; 0: they become zero.
    pub absolute: u32,
    /// 1 / dt.
    pub rate: f32,
    /// Of positions.
    pub quantum: f32,
}

/// Center and size of a group of the preconditioner.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Frame {
    pub center: [i32; 3],
    /// 0 for an empty group.
    pub size: f32,
    /// The mean of o o^T over the arms o of its nodes: xx, xy, xz, yy, yz, zz.
    pub moment: [f32; 6],
    /// The sum of a a^T over the axes a about which spins move next to nothing, and are held.
    pub held: [f32; 6],
}

/// A block of a pair of groups as a part of that of their parents.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Part {
    pub block: u32,
    /// Frames of both groups.
    pub a: u32,
    pub b: u32,
    /// 1 if the transpose counts as well.
    pub both: u32,
}
