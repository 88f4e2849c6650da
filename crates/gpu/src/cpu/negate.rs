//! Twin of `shader/negate.wgsl`.

use super::newton::{is_free, nodes_of, xyz};
use super::sum::THREADS;
use super::{added, largest, scaled, subtracted};
use crate::bound::Bound;
use crate::linear::Spring;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub springs: u32,
    pub imposed: u32,
    pub workgroups: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let forces = Forces {
        gradient: &buffers.read(0),
        image: &buffers.read(1),
        springs: &buffers.read(2),
        spring_words: &buffers.read(3),
        free: &buffers.read(4),
    };
    negate(buffers.params(), &forces, &mut buffers.write(5), &mut buffers.write(6));
}

pub struct Forces<'a> {
    pub gradient: &'a [[f32; 4]],
    pub image: &'a [[f32; 4]],
    pub springs: &'a [Spring],
    pub spring_words: &'a [u32],
    pub free: &'a [u32],
}

impl Forces<'_> {
    fn right_side(&self, params: &Params, i: usize) -> [f32; 4] {
        if !is_free(self.free, i) {
            return [0.0; 4];
        }
        let mut sum = xyz(self.gradient[i]);
        if params.imposed == 1 {
            sum = added(sum, xyz(self.image[i]));
        }
        if params.springs > 0 {
            let entries = self.spring_words[i] as usize..self.spring_words[i + 1] as usize;
            for entry in self.spring_words[entries].chunks_exact(2) {
                let force = self.springs[entry[0] as usize].hessian.map(|column| column[3]);
                sum = subtracted(sum, scaled(force, f32::from_bits(entry[1])));
            }
        }
        [-sum[0], -sum[1], -sum[2], 1.0]
    }
}

pub fn negate(params: Params, forces: &Forces<'_>, right_side: &mut [[f32; 4]], sums: &mut [f32]) {
    let workgroups = params.workgroups as usize;
    for (group, sum) in sums.iter_mut().take(workgroups).enumerate() {
        let mut found: f32 = 0.0;
        for t in 0..THREADS {
            for i in nodes_of(group, t, workgroups, params.nodes as usize) {
                right_side[i] = forces.right_side(&params, i);
                found = found.max(largest(xyz(right_side[i])));
            }
        }
        *sum = found;
    }
}
