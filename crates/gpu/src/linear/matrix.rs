//! The matrix of a linear solve as it lies on the device.
//!
//! Rows multiply as `(H p)_i = S_i p_i + sum_j H_ij (p_j - p_i)` with the row sums S, plus the reactions of springs. Rounding
//! of H_ij to single precision then acts on deformations alone and not on bodies that move as a whole.
//!
//! Blocks and scalar entries are stored in slices of 32 rows (sliced ELLPACK; A. Monakov, A. Lokhmotov and A. Avetisyan,
//! "Automatically Tuning Sparse Matrix-Vector Multiplication for GPU Architectures", HiPEAC 2010): word w of block k of row r
//! stands at `start + (10 k + w) 32 + r % 32`, so that neighboring threads read neighboring words. A block is its column and
//! nine numbers by columns; the first block of a row is its sum. Scalar entries follow, each its column and its number. Rows
//! that are shorter than the longest of their slice end with zeros.

use super::layout::Spring;
use bowknot_dynamics::{LinearSpring, LinearSystem};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of a slice.
pub const SLICE: usize = 32;

/// Words of a block with its column.
pub const BLOCK_WORDS: usize = 10;

/// The matrix, packed.
#[derive(Debug, Default)]
pub struct PackedMatrix {
    /// Of each slice: where its words begin, blocks per row, scalar entries per row, and a bit for each row that is the
    /// sum of a row plus the product of strands, with blocks for the preconditioner alone.
    pub slices: Vec<[u32; 4]>,
    pub words: Vec<u32>,
    pub springs: Vec<Spring>,
    /// Where the entries of each node begin and end, then of each entry the spring and the weight; empty if there are no
    /// springs.
    pub spring_words: Vec<u32>,
}

impl PackedMatrix {
    /// Packs a system.
    pub fn new(system: &LinearSystem<'_>) -> Self {
        let nodes = system.free.len();
        let mut packed = Self::default();
        let row_lengths =
            |starts: &[u32], rows: Range<usize>| rows.map(|i| starts[i + 1] - starts[i]).max().unwrap_or(0);
        let mut end = 0;
        for first in (0..nodes).step_by(SLICE) {
            let rows = first..(first + SLICE).min(nodes);
            let blocks = 1 + row_lengths(system.blocks.starts, rows.clone());
            let scalars = row_lengths(system.scalars.starts, rows);
            packed.slices.push([end as u32, blocks, scalars, 0]);
            end += SLICE * (BLOCK_WORDS * blocks as usize + 2 * scalars as usize);
        }
        packed.words.resize(end, 0);
        let mut slices = Vec::with_capacity(packed.slices.len());
        let mut rest = packed.words.as_mut_slice();
        for (k, slice) in packed.slices.iter().enumerate() {
            let next = packed.slices.get(k + 1).map_or(end, |next| next[0] as usize);
            let (words, others) = rest.split_at_mut(next - slice[0] as usize);
            slices.push((SLICE * k..(SLICE * (k + 1)).min(nodes), slice, words));
            rest = others;
        }
        slices.into_par_iter().for_each(|(rows, slice, words)| fill_slice(system, rows, slice, words));
        packed.set_springs(system.springs, system.spring_starts, system.spring_entries);
        packed
    }

    /// Packs springs in place of those before.
    pub fn set_springs(&mut self, springs: &[LinearSpring], starts: &[u32], entries: &[(u32, f64)]) {
        self.springs.clear();
        self.spring_words.clear();
        if springs.is_empty() {
            return;
        }
        self.springs.extend(springs.iter().map(spring));
        let shift = starts.len() as u32;
        self.spring_words.extend(starts.iter().map(|start| shift + 2 * start));
        for &(spring, weight) in entries {
            self.spring_words.extend([spring, (weight as f32).to_bits()]);
        }
    }

    /// The word of the column of block `k` of row `i`, which is in that slice.
    pub fn block_at(&self, slice: [u32; 4], i: usize, k: u32) -> u32 {
        slice[0] + BLOCK_WORDS as u32 * k * SLICE as u32 + (i % SLICE) as u32
    }
}

/// Packs the rows of a slice.
fn fill_slice(system: &LinearSystem<'_>, rows: Range<usize>, slice: &[u32; 4], words: &mut [u32]) {
    let [_, blocks, scalars, _] = *slice;
    for (lane, i) in rows.enumerate() {
        let mut at = lane;
        let mut put = |word: u32| {
            words[at] = word;
            at += SLICE;
        };
        put(i as u32);
        system.row_sum(i).iter().for_each(|number| put((*number as f32).to_bits()));
        let mut count = 1;
        for (column, block) in system.blocks.row(i) {
            put(column as u32);
            block.iter().for_each(|number| put((*number as f32).to_bits()));
            count += 1;
        }
        // Padding names the row itself: differences to it are zero.
        for _ in count..blocks {
            put(i as u32);
            (1..BLOCK_WORDS).for_each(|_| put(0));
        }
        let mut count = 0;
        for (column, value) in system.scalars.row(i) {
            put(column as u32);
            put((*value as f32).to_bits());
            count += 1;
        }
        for _ in count..scalars {
            put(i as u32);
            put(0);
        }
    }
}

fn spring(spring: &LinearSpring) -> Spring {
    let place = |k: usize| {
        let node = spring.nodes[k];
        if node == u32::MAX { (0, 0.0) } else { (node, spring.weights[k] as f32) }
    };
    let places = [0, 1, 2, 3].map(place);
    let hessian = [0, 1, 2].map(|c| {
        let column = spring.hessian.column(c);
        [column[0] as f32, column[1] as f32, column[2] as f32, spring.force[c] as f32]
    });
    Spring { nodes: places.map(|(node, _)| node), weights: places.map(|(_, weight)| weight), hessian }
}
