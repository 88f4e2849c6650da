//! Twin of `shader/assemble.wgsl`.

use crate::assembly::Entry;
use crate::bound::Bound;
use crate::linear::SLICE;
use bytemuck::{Pod, Zeroable};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Params {
    pub entries: u32,
    pub nodes: u32,
}

pub fn bound(buffers: Bound<'_>) {
    let matrix = Matrix {
        entries: &buffers.read(0),
        sources: &buffers.read(1),
        blocks: &buffers.read(2),
        slices: &buffers.read(3),
        row_sums: &buffers.read(4),
    };
    assemble(buffers.params(), &matrix, &mut buffers.write(5));
}

pub struct Matrix<'a> {
    pub entries: &'a [Entry],
    pub sources: &'a [u32],
    pub blocks: &'a [f32],
    pub slices: &'a [[u32; 4]],
    pub row_sums: &'a [f32],
}

/// Writes a block by its columns.
fn write(words: &mut [u32], at: usize, columns: &[[f32; 3]; 3]) {
    for (k, number) in columns.as_flattened().iter().enumerate() {
        words[at + (1 + k) * SLICE] = number.to_bits();
    }
}

pub fn assemble(params: Params, matrix: &Matrix<'_>, words: &mut [u32]) {
    for entry in matrix.entries.iter().take(params.entries as usize) {
        let b = entry.bending;
        let mut sum = [[b, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, b]];
        for &source in &matrix.sources[entry.first as usize..][..entry.count as usize] {
            let block = &matrix.blocks[9 * (source as usize / 2)..][..9];
            for (c, column) in sum.iter_mut().enumerate() {
                for (r, number) in column.iter_mut().enumerate() {
                    *number += block[if source % 2 == 1 { 3 * r + c } else { 3 * c + r }];
                }
            }
        }
        write(words, entry.at as usize, &sum);
    }
    for (i, sum) in matrix.row_sums.chunks_exact(6).enumerate().take(params.nodes as usize) {
        let [xx, xy, xz, yy, yz, zz] = [sum[0], sum[1], sum[2], sum[3], sum[4], sum[5]];
        let at = matrix.slices[i / SLICE][0] as usize + i % SLICE;
        write(words, at, &[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    }
}
