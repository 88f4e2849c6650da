//! What the kernels of elements' gradients share: twin of `shader/shared/gradients.wgsl`.

use super::elements::way;
use super::{scaled, to_f32};
use crate::bound::Bound;
use crate::potential::GradientParams;
use bytemuck::Pod;

type V3 = [f32; 3];

/// Where the elements are.
pub struct Places<'a> {
    pub params: GradientParams,
    pub positions: &'a [[i32; 4]],
    pub start: &'a [[i32; 4]],
}

impl Places<'_> {
    pub fn way(&self, a: u32, b: u32) -> V3 {
        scaled(to_f32(way(self.positions, a, b)), self.params.quantum)
    }

    /// How much the way from node a to node b has changed since the start of the time step.
    pub fn moved(&self, a: u32, b: u32) -> V3 {
        let [x, x0] = [self.positions, self.start].map(|at| way(at, a, b));
        scaled(to_f32([0, 1, 2].map(|k| x[k].wrapping_sub(x0[k]))), self.params.quantum)
    }
}

/// Writes the gradients of the elements by each of their N nodes.
pub fn write<T: Pod, const N: usize>(buffers: Bound<'_>, gradient: impl Fn(&T, &Places<'_>) -> [V3; N]) {
    let params: GradientParams = buffers.params();
    let places = Places { params, positions: &buffers.read(1), start: &buffers.read(2) };
    let mut gradients = buffers.write::<V3>(3);
    let mine = gradients[params.first as usize..].chunks_exact_mut(N);
    for (element, out) in buffers.read(0).iter().zip(mine).take(params.elements as usize) {
        out.copy_from_slice(&gradient(element, &places));
    }
}
