//! Greedy coloring of rows: rows of one color share no movable vertex, so a sweep may treat
//! them in any order, or in parallel, with the same result.
//!
//! The paper colors randomly (section 4.2); first-fit over rows in their listed order needs fewer
//! colors, is deterministic, and costs tens of nanoseconds per row.

use std::ops::Range;

/// Words of the mask of the colors in use at a vertex. Rows that find no free color get a color of their
/// own.
const WORDS: usize = 4;
const COLORS: usize = WORDS * 64;
const NONE: u32 = u32::MAX;

/// Scratch of [`Coloring::first_fit`]; may be dropped at any time.
#[derive(Clone, Debug, Default)]
pub struct Coloring {
    /// Colors in use at each vertex.
    used: Vec<[u64; WORDS]>,
    /// Color of each row.
    colors: Vec<u32>,
    /// Rows in color order.
    order: Vec<u32>,
    /// Where each color starts in `order`, and the end.
    starts: Vec<u32>,
    /// Where the next row of each color goes.
    next: Vec<u32>,
}

impl Coloring {
    /// Colors `row_count` rows. `vertices(r)` lists the movable vertices of row r; rows that share one
    /// get different colors.
    pub fn first_fit<I: IntoIterator<Item = u32>>(
        &mut self,
        vertex_count: usize,
        row_count: usize,
        vertices: impl Fn(usize) -> I,
    ) {
        self.used.resize(vertex_count, [0; WORDS]);
        self.colors.clear();
        self.starts.clear();
        self.starts.resize(COLORS + 1, 0);
        let mut overflow = 0;
        for row in 0..row_count {
            let mut taken = [0u64; WORDS];
            for v in vertices(row) {
                for (t, u) in taken.iter_mut().zip(&self.used[v as usize]) {
                    *t |= u;
                }
            }
            let Some(word) = taken.iter().position(|t| *t != u64::MAX) else {
                self.colors.push(NONE);
                overflow += 1;
                continue;
            };
            let bit = taken[word].trailing_ones() as usize;
            for v in vertices(row) {
                self.used[v as usize][word] |= 1 << bit;
            }
            let color = word * 64 + bit;
            self.colors.push(color as u32);
            self.starts[color + 1] += 1;
        }
        // Clears only the touched entries: most vertices of a scene are in no contact.
        for row in 0..row_count {
            for v in vertices(row) {
                self.used[v as usize] = [0; WORDS];
            }
        }

        let colors = self.starts.iter().rposition(|count| *count > 0).unwrap_or(0);
        self.starts.truncate(colors + 1);
        for c in 1..self.starts.len() {
            self.starts[c] += self.starts[c - 1];
        }
        self.next.clone_from(&self.starts);
        self.order.clear();
        self.order.resize(row_count, 0);
        let mut tail = (row_count - overflow) as u32;
        for (row, &color) in self.colors.iter().enumerate() {
            let place = if color == NONE { &mut tail } else { &mut self.next[color as usize] };
            self.order[*place as usize] = row as u32;
            *place += 1;
        }
        for end in row_count - overflow..row_count {
            self.starts.push(end as u32 + 1);
        }
    }

    /// Rows in color order.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Where each color starts in [`Self::order`], and the end: one entry more than there are colors.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Number of colors.
    pub fn color_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The range of each color in [`Self::order`].
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.starts.windows(2).map(|w| w[0] as usize..w[1] as usize)
    }
}

#[cfg(test)]
mod tests;
