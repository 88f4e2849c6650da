//! Twin of `shader/multiply.wgsl`.

use super::newton::xyz;
use super::sum::{THREADS, sum_of_threads};
use super::{added, dot, scaled, subtracted};
use crate::bound::Bound;
use crate::linear::{BLOCK_WORDS, Progress, SLICE, Spring};
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub nodes: u32,
    pub springs: u32,
    pub workgroups: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let matrix = Matrix {
        slices: &buffers.read(0),
        words: &buffers.read(1),
        spring_words: &buffers.read(2),
        springs: &buffers.read(3),
    };
    multiply(
        buffers.params(),
        &matrix,
        &buffers.read(4),
        &mut buffers.write(5),
        &mut buffers.write(6),
        &buffers.write::<Progress>(7)[0],
    );
}

/// H, see `linear/matrix.rs`.
pub struct Matrix<'a> {
    pub slices: &'a [[u32; 4]],
    pub words: &'a [u32],
    pub spring_words: &'a [u32],
    pub springs: &'a [Spring],
}

impl Matrix<'_> {
    fn column_of_block(&self, at: usize) -> [f32; 3] {
        [0, 1, 2].map(|k| f32::from_bits(self.words[at + k * SLICE]))
    }

    /// Row `i` times the direction, where `image` is the product of strands.
    fn row(&self, has_springs: bool, i: usize, direction: &[[f32; 4]], image: &[[f32; 4]]) -> [f32; 3] {
        let at_node = |j: u32| {
            let [x, y, z, _] = direction[j as usize];
            [x, y, z]
        };
        let [start, blocks, scalars, strands] = self.slices[i / SLICE];
        let own = at_node(i as u32);
        let has_strands = strands >> (i % SLICE) & 1 == 1;
        let mut sum = [0.0; 3];
        if has_strands {
            let [x, y, z, _] = image[i];
            sum = [x, y, z];
        }
        let mut at = start as usize + i % SLICE;
        for k in 0..if has_strands { 1 } else { blocks } {
            let x = if k > 0 { subtracted(at_node(self.words[at]), own) } else { own };
            sum = added(sum, scaled(self.column_of_block(at + SLICE), x[0]));
            sum = added(sum, scaled(self.column_of_block(at + 4 * SLICE), x[1]));
            sum = added(sum, scaled(self.column_of_block(at + 7 * SLICE), x[2]));
            at += BLOCK_WORDS * SLICE;
        }
        at = start as usize + i % SLICE + BLOCK_WORDS * SLICE * blocks as usize;
        for _ in 0..scalars {
            let value = f32::from_bits(self.words[at + SLICE]);
            sum = added(sum, scaled(subtracted(at_node(self.words[at]), own), value));
            at += 2 * SLICE;
        }
        if has_springs {
            let entries = self.spring_words[i] as usize..self.spring_words[i + 1] as usize;
            for entry in self.spring_words[entries].chunks_exact(2) {
                let reaction = reaction(&self.springs[entry[0] as usize], direction);
                sum = added(sum, scaled(reaction, f32::from_bits(entry[1])));
            }
        }
        sum
    }
}

/// The reaction of a spring to the direction.
fn reaction(spring: &Spring, direction: &[[f32; 4]]) -> [f32; 3] {
    let mut sum = [0.0; 3];
    for (node, weight) in spring.nodes.into_iter().zip(spring.weights) {
        sum = added(sum, scaled(xyz(direction[node as usize]), weight));
    }
    let column = |k: usize| scaled(xyz(spring.hessian[k]), sum[k]);
    added(added(column(0), column(1)), column(2))
}

pub fn multiply(
    params: Params,
    matrix: &Matrix<'_>,
    direction: &[[f32; 4]],
    image: &mut [[f32; 4]],
    sums: &mut [f32],
    progress: &Progress,
) {
    if progress.moving == 0 {
        return;
    }
    let workgroups = params.workgroups as usize;
    for (group, sum) in sums.iter_mut().take(workgroups).enumerate() {
        *sum = sum_of_threads(std::array::from_fn(|t| {
            let mut curvature = 0.0;
            for i in (THREADS * group + t..params.nodes as usize).step_by(THREADS * workgroups) {
                let product = matrix.row(params.springs > 0, i, direction, image);
                let [x, y, z] = product;
                image[i] = [x, y, z, 0.0];
                let [px, py, pz, _] = direction[i];
                curvature += dot([px, py, pz], product);
            }
            curvature
        }));
    }
}
