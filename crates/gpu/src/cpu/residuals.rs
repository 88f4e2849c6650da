//! Twin of `shader/residuals.wgsl`.

use super::{added, difference, dot, scaled};
use crate::bound::Bound;
use crate::layout::{Block, BlockSum, Vertex};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub blocks: u32,
}

pub fn bound(buffers: Bound<'_>) {
    residuals(
        buffers.params(),
        &buffers.read(0),
        &buffers.read(1),
        &buffers.read(2),
        &buffers.read(3),
        &buffers.read(4),
        &mut buffers.write(5),
    );
}

pub fn residuals(
    params: Params,
    blocks: &[Block],
    positions: &[[i32; 4]],
    aims: &[[i32; 4]],
    displacements: &[[f32; 4]],
    vertices: &[Vertex],
    sums: &mut [BlockSum],
) {
    let of_vertex = |v: usize| {
        let [x, y, z, weight] = displacements[v];
        if weight == 0.0 {
            return BlockSum::default();
        }
        let mass = vertices[v].mass;
        let share = (1.0 / (weight * mass) - 1.0).max(0.0);
        let residual = added(scaled([x, y, z], share), difference(aims[v], positions[v]));
        let length = dot(residual, residual).sqrt();
        BlockSum { residual: scaled(residual, mass), mass, lengths: mass * length, padding: [0; 3] }
    };
    for (block, sum) in blocks.iter().zip(sums).take(params.blocks as usize) {
        let mut shared = [BlockSum::default(); Block::MOST];
        for (k, place) in shared.iter_mut().enumerate().take(block.count as usize) {
            *place = of_vertex(block.first as usize + k);
        }
        let mut reach = Block::MOST / 2;
        while reach > 0 {
            for k in 0..reach {
                let other = shared[k + reach];
                shared[k].residual = added(shared[k].residual, other.residual);
                shared[k].mass += other.mass;
                shared[k].lengths += other.lengths;
            }
            reach /= 2;
        }
        *sum = shared[0];
    }
}
