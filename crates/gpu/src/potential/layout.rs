//! The data of the potential that host, kernels and twins share. A test compares every struct with what the
//! shaders declare (`stages/tests.rs`). Units are SI; positions are integers, multiples of a quantum.

use crate::kernels;
use bytemuck::{Pod, Zeroable};

/// Threads of a workgroup that adds up energies.
pub const THREADS: usize = kernels::node_energy::THREADS as usize;

/// Most workgroups that write partial sums of energies.
pub const MOST_WORKGROUPS: usize = 1024;

/// The quadratic terms of a node.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Terms {
    /// The block of R: xx, xy, xz, yy, yz, zz [N/m].
    pub row_sum: [f32; 6],
    /// The gradient c at the start [N].
    pub linear: [f32; 3],
}

/// An entry of K beside its diagonal.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Pair {
    pub node: u32,
    /// In N/m.
    pub value: f32,
}

/// The parameters of the kernels of elements' gradients.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct GradientParams {
    pub elements: u32,
    /// The first gradient that these elements write.
    pub first: u32,
    /// 1 / dt.
    pub rate: f32,
    /// Of positions.
    pub quantum: f32,
}

/// The parameters of the kernel that sums gradients.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct NodeParams {
    pub nodes: u32,
    pub quantum: f32,
}

/// The parameters of the kernels of energies.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct EnergyParams {
    /// Elements or nodes.
    pub count: u32,
    /// The first part that is written.
    pub first: u32,
    pub workgroups: u32,
    pub rate: f32,
    pub quantum: f32,
}
