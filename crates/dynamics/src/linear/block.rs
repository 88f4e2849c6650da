//! Sparse symmetric matrices of 3 x 3 blocks: full rows, the diagonal stored separately.
//!
//! Both triangles are stored. A product then reads each row once and writes only the result of that row, so
//! it is parallel and deterministic without scattering.

use nalgebra::Matrix3;

/// The off-diagonal blocks that exist: compressed rows, columns ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockPattern {
    /// Columns of row r: `columns[starts[r]..starts[r + 1]]`.
    pub starts: Vec<u32>,
    pub columns: Vec<u32>,
}

impl BlockPattern {
    /// The union of cliques. `visit_all` calls its argument with the nodes of every element.
    pub fn from_cliques(node_count: usize, visit_all: impl FnOnce(&mut dyn FnMut(&[u32]))) -> Self {
        let mut rows: Vec<Vec<u32>> = vec![Vec::new(); node_count];
        visit_all(&mut |nodes| {
            for &a in nodes {
                for &b in nodes {
                    let row = &mut rows[a as usize];
                    if a != b && !row.contains(&b) {
                        row.push(b);
                    }
                }
            }
        });
        let mut pattern = Self { starts: vec![0], columns: Vec::new() };
        for row in &mut rows {
            row.sort_unstable();
            pattern.columns.extend_from_slice(row);
            pattern.starts.push(pattern.columns.len() as u32);
        }
        pattern
    }

    /// Index of block (row, column), which must exist.
    pub fn slot(&self, row: u32, column: u32) -> u32 {
        let range = self.row(row as usize);
        let found = self.columns[range.clone()].binary_search(&column);
        debug_assert!(found.is_ok(), "block ({row}, {column}) is not in the pattern");
        found.map_or(u32::MAX, |k| (range.start + k) as u32)
    }

    #[inline]
    pub fn row(&self, row: usize) -> std::ops::Range<usize> {
        self.starts[row] as usize..self.starts[row + 1] as usize
    }

    pub fn node_count(&self) -> usize {
        self.starts.len() - 1
    }
}

/// Values of a block matrix.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockValues {
    pub diagonal: Vec<Matrix3<f64>>,
    /// Off-diagonal blocks in the order of the pattern.
    pub blocks: Vec<Matrix3<f64>>,
}

impl BlockValues {
    pub fn zeros(pattern: &BlockPattern) -> Self {
        Self {
            diagonal: vec![Matrix3::zeros(); pattern.node_count()],
            blocks: vec![Matrix3::zeros(); pattern.columns.len()],
        }
    }
}
