//! The structure of a Cholesky factor.

use bowknot_geometry::Vector;
use std::ops::Range;

/// Smallest number of columns that are divided in two. Smaller: more parallel work. Larger: less overhead.
const MIN_COLUMNS: usize = 128;

/// The part of a factorization that depends on the graph alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbolic {
    /// Old index of each new index, and the inverse.
    pub order: Vec<u32>,
    pub place: Vec<u32>,
    /// All columns, and how they divide.
    pub(super) whole: Part,
    /// Rows below the diagonal of each column of L, ascending: `rows[starts[k]..starts[k + 1]]`.
    starts: Vec<u32>,
    pub(super) rows: Vec<u32>,
    /// For each row j: the columns k < j with L_jk, and the slot of L_jk.
    row_starts: Vec<u32>,
    row_entries: Vec<(u32, u32)>,
}

/// A range of columns: two halves without an entry of L between them, then the separator, which depends on
/// both. The halves may be computed at the same time.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    pub columns: Range<usize>,
    pub halves: Option<Box<[Part; 2]>>,
}

impl Part {
    /// The columns that are in no half.
    pub fn separator(&self) -> Range<usize> {
        let first = self.halves.as_ref().map_or(self.columns.start, |halves| halves[1].columns.end);
        first..self.columns.end
    }
}

impl Symbolic {
    /// Analyses the graph in which node i has the `neighbors(i)` (in any order, i itself allowed), in the
    /// order of nested dissection by `positions`.
    pub fn new<'a>(positions: &[Vector], neighbors: impl Fn(usize) -> &'a [u32]) -> Self {
        let count = positions.len();
        let mut order: Vec<u32> = (0..count as u32).collect();
        let mut side = vec![0u8; count];
        let whole = dissect(&mut order, 0, positions, &neighbors, &mut side);
        Self { whole, ..Self::in_order(order, neighbors) }
    }

    /// Analyses the graph for elimination in the given order.
    pub fn in_order<'a>(order: Vec<u32>, neighbors: impl Fn(usize) -> &'a [u32]) -> Self {
        let count = order.len();
        let mut place = vec![0; count];
        order.iter().enumerate().for_each(|(new, &old)| place[old as usize] = new as u32);

        // The structure of a column is that of the matrix united with those of its children in the
        // elimination tree.
        let mut structures: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut seen = vec![u32::MAX; count];
        for k in 0..count {
            let mut rows = Vec::new();
            seen[k] = k as u32;
            let own = neighbors(order[k] as usize).iter().map(|&n| place[n as usize]);
            let inherited = children[k].iter().flat_map(|&c| structures[c as usize].iter().copied());
            for row in own.chain(inherited) {
                if row as usize > k && seen[row as usize] != k as u32 {
                    seen[row as usize] = k as u32;
                    rows.push(row);
                }
            }
            rows.sort_unstable();
            if let Some(&parent) = rows.first() {
                children[parent as usize].push(k as u32);
            }
            structures[k] = rows;
        }
        let whole = Part { columns: 0..count, halves: None };
        let mut symbolic = Self { order, place, whole, starts: vec![0], ..Self::default() };
        let mut by_row: Vec<Vec<(u32, u32)>> = vec![Vec::new(); count];
        for (k, rows) in structures.iter().enumerate() {
            for &row in rows {
                by_row[row as usize].push((k as u32, symbolic.rows.len() as u32));
                symbolic.rows.push(row);
            }
            symbolic.starts.push(symbolic.rows.len() as u32);
        }
        symbolic.row_starts.push(0);
        for row in by_row {
            symbolic.row_entries.extend(row);
            symbolic.row_starts.push(symbolic.row_entries.len() as u32);
        }
        symbolic
    }

    /// Where the blocks below the diagonal of a column stand.
    #[inline(always)]
    pub(super) fn column(&self, k: usize) -> Range<usize> {
        self.starts[k] as usize..self.starts[k + 1] as usize
    }

    /// Where the blocks of column k begin; for the number of columns, where those of the last one end.
    pub(super) fn start(&self, k: usize) -> usize {
        self.starts[k] as usize
    }

    /// The columns k < j with L_jk, and the slot of L_jk.
    #[inline(always)]
    pub(super) fn row(&self, j: usize) -> &[(u32, u32)] {
        &self.row_entries[self.row_starts[j] as usize..self.row_starts[j + 1] as usize]
    }

    /// Number of blocks of L below the diagonal.
    pub fn fill(&self) -> usize {
        self.rows.len()
    }
}

/// Orders `nodes` in place, which are the columns from `first` on: both halves, then the separator.
fn dissect<'a>(
    nodes: &mut [u32],
    first: usize,
    positions: &[Vector],
    neighbors: &impl Fn(usize) -> &'a [u32],
    side: &mut [u8],
) -> Part {
    let columns = first..first + nodes.len();
    if nodes.len() <= 3 {
        nodes.sort_unstable();
        return Part { columns, halves: None };
    }
    let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    for &n in nodes.iter() {
        low = low.inf(&positions[n as usize]);
        high = high.sup(&positions[n as usize]);
    }
    let axis = (high - low).imax();
    nodes.sort_unstable_by(|&a, &b| {
        positions[a as usize][axis].total_cmp(&positions[b as usize][axis]).then(a.cmp(&b))
    });
    let middle = nodes.len() / 2;
    nodes[..middle].iter().for_each(|&n| side[n as usize] = 1);
    let (mut right, separator): (Vec<u32>, Vec<u32>) = nodes[middle..]
        .iter()
        .partition(|&&n| neighbors(n as usize).iter().all(|&other| side[other as usize] != 1));
    nodes[..middle].iter().for_each(|&n| side[n as usize] = 0);
    let split = middle + right.len();
    nodes[middle..split].copy_from_slice(&right);
    right.clear();
    nodes[split..].copy_from_slice(&separator);
    let left = dissect(&mut nodes[..middle], first, positions, neighbors, side);
    let right = dissect(&mut nodes[middle..split], first + middle, positions, neighbors, side);
    let halves = (columns.len() >= MIN_COLUMNS).then(|| Box::new([left, right]));
    Part { columns, halves }
}
