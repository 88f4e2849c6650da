//! Twin of `shader/react.wgsl`.

use super::{added, scaled};
use crate::bound::Bound;
use crate::linear::Spring;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub springs: u32,
}

pub fn bound(buffers: Bound<'_>) {
    react(buffers.params(), &buffers.read(0), &buffers.read(1), &mut buffers.write(2));
}

pub fn react(params: Params, springs: &[Spring], direction: &[[f32; 4]], reactions: &mut [[f32; 4]]) {
    for (spring, reaction) in springs.iter().zip(reactions).take(params.springs as usize) {
        let mut sum = [0.0; 3];
        for (node, weight) in spring.nodes.into_iter().zip(spring.weights) {
            let [x, y, z, _] = direction[node as usize];
            sum = added(sum, scaled([x, y, z], weight));
        }
        let [a, b, c] = spring.hessian;
        *reaction = std::array::from_fn(|k| a[k] * sum[0] + b[k] * sum[1] + c[k] * sum[2]);
    }
}
