//! The matrix of a linear solve as it lies on the device.
//!
//! Rows multiply as `(H p)_i = S_i p_i + sum_j H_ij (p_j - p_i)` with the row sums S, plus the reactions of
//! springs. Rounding of H_ij to single precision then acts on deformations alone and not on bodies that move
//! as a whole.
//!
//! Blocks and scalar entries are stored in slices of 32 rows (sliced ELLPACK; A. Monakov, A. Lokhmotov and A.
//! Avetisyan, "Automatically Tuning Sparse Matrix-Vector Multiplication for GPU Architectures", HiPEAC 2010):
//! word w of block k of row r stands at `start + (10 k + w) 32 + r % 32`, so that neighboring threads read
//! neighboring words. A block is its column and nine numbers by columns; the first block of a row is its sum.
//! Scalar entries follow, each its column and its number. Rows that are shorter than the longest of their
//! slice end with zeros.

use super::layout::Spring;
use bowknot_dynamics::LinearSpring;

/// Rows of a slice.
pub const SLICE: usize = 32;

/// Words of a block with its column.
pub const BLOCK_WORDS: usize = 10;

/// Columns of the entries of a matrix, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    pub starts: &'a [u32],
    pub columns: &'a [u32],
}

impl<'a> Columns<'a> {
    fn row(&self, i: usize) -> &'a [u32] {
        &self.columns[self.starts[i] as usize..self.starts[i + 1] as usize]
    }
}

/// The matrix, packed.
#[derive(Debug, Default)]
pub struct PackedMatrix {
    /// Of each slice: where its words begin, blocks per row, scalar entries per row, and a bit for each row
    /// that is the sum of a row plus the product of strands, with blocks for the preconditioner alone.
    pub slices: Vec<[u32; 4]>,
    pub words: Vec<u32>,
    pub springs: Vec<Spring>,
    /// Where the entries of each node begin and end, then of each entry the spring and the weight; empty if
    /// there are no springs.
    pub spring_words: Vec<u32>,
}

impl PackedMatrix {
    /// The structure of a matrix of so many `nodes`, without numbers: row i has blocks in the columns
    /// `columns[starts[i]..starts[i + 1]]`, and scalar entries likewise.
    pub fn new(nodes: usize, blocks: Columns<'_>, scalars: Columns<'_>) -> Self {
        let mut packed = Self::default();
        for first in (0..nodes).step_by(SLICE) {
            let rows = first..(first + SLICE).min(nodes);
            let longest = |of: Columns<'_>| rows.clone().map(|i| of.row(i).len()).max().unwrap_or(0);
            let (block_count, scalar_count) = (1 + longest(blocks), longest(scalars));
            let start = packed.words.len();
            packed.slices.push([start as u32, block_count as u32, scalar_count as u32, 0]);
            packed.words.resize(start + SLICE * (BLOCK_WORDS * block_count + 2 * scalar_count), 0);
            for (lane, i) in rows.clone().enumerate() {
                let columns = std::iter::once(i as u32).chain(blocks.row(i).iter().copied());
                let (at, scalars_at) = (start + lane, start + lane + SLICE * BLOCK_WORDS * block_count);
                packed.put_columns(i, (at, BLOCK_WORDS, block_count), columns);
                packed.put_columns(i, (scalars_at, 2, scalar_count), scalars.row(i).iter().copied());
            }
        }
        packed
    }

    /// Writes the columns of row `i` as the first words of `count` entries of so many words each.
    fn put_columns(
        &mut self,
        i: usize,
        (at, words, count): (usize, usize, usize),
        columns: impl Iterator<Item = u32>,
    ) {
        // Padding names the row itself: differences to it are zero.
        for (k, column) in columns.chain(std::iter::repeat(i as u32)).take(count).enumerate() {
            self.words[at + SLICE * words * k] = column;
        }
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
