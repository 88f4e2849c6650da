//! Twin of `shader/correlate.wgsl`.

use super::dot;
use super::newton::{nodes_of, xyz};
use super::sum::{THREADS, sum_of_threads};
use crate::bound::Bound;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub count: u32,
    pub workgroups: u32,
    pub first: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let vectors = Vectors {
        direction: &buffers.read(0),
        image: &buffers.read(1),
        second: &buffers.read(2),
        second_image: &buffers.read(3),
        right_side: &buffers.read(4),
    };
    correlate(buffers.params(), &vectors, &mut buffers.write(5));
}

pub struct Vectors<'a> {
    pub direction: &'a [[f32; 4]],
    pub image: &'a [[f32; 4]],
    pub second: &'a [[f32; 4]],
    pub second_image: &'a [[f32; 4]],
    pub right_side: &'a [[f32; 4]],
}

pub fn correlate(params: Params, vectors: &Vectors<'_>, sums: &mut [f32]) {
    for group in 0..params.workgroups as usize {
        let mut products = [[0.0; THREADS]; 5];
        for t in 0..THREADS {
            for i in nodes_of(group, t, params.workgroups as usize, params.nodes as usize) {
                let at = |vector: &[[f32; 4]]| xyz(vector[i]);
                let (g, q, b) = (at(vectors.direction), at(vectors.image), at(vectors.right_side));
                products[0][t] += dot(g, q);
                products[1][t] += dot(g, b);
                if params.count == 2 {
                    let other = at(vectors.second);
                    products[2][t] += dot(other, q);
                    products[3][t] += dot(other, at(vectors.second_image));
                    products[4][t] += dot(other, b);
                }
            }
        }
        let place = params.first as usize + 8 * group;
        sums[place..place + 5].copy_from_slice(&products.map(sum_of_threads));
    }
}
