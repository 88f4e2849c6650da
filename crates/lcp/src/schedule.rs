//! The order in which constraints are swept, and which of them are swept in parallel.

use std::ops::Range;

/// Which rows are swept, in which order, and which of them are independent.
///
/// Color c holds the places `starts[c]..starts[c + 1]` of `order`, or of the rows themselves if `order` is
/// `None`. The rows of a color are swept in parallel, so no two of them may share a node that can move
/// ([`crate::validate_colors`] checks it). Rows that are not in `order` are not swept: inactive rows cost
/// nothing. A sweep is fastest if rows are stored by color, in spatial order within each color, and `order`
/// rises: rows are then read in order, and each thread stays in its part of the nodes.
///
/// With `clusters`, color c holds the clusters `starts[c]..starts[c + 1]`, and cluster k the places
/// `clusters[k]..clusters[k + 1]`. One thread sweeps the rows of a cluster, one after the other, so they may
/// share nodes; rows of different clusters of a color may not. Threads wait for each other after each color.
/// There are far fewer colors of clusters than of rows where nodes have many rows, and the nodes of a cluster
/// stay in the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Schedule<'a> {
    /// Indices of the rows to sweep; `None`: all, as stored.
    pub order: Option<&'a [u32]>,
    /// Where each color starts, and the end. If it is empty, there are no colors, and rows are swept one
    /// after the other.
    pub starts: &'a [u32],
    /// Where each cluster starts, and the end. Empty: each place is a cluster of its own.
    pub clusters: &'a [u32],
}

impl<'a> Schedule<'a> {
    /// All rows, as stored, one after the other.
    pub const SERIAL: Schedule<'static> = Schedule { order: None, starts: &[], clusters: &[] };

    /// All rows, stored by color.
    pub fn colored(starts: &'a [u32]) -> Self {
        Self { order: None, starts, clusters: &[] }
    }

    /// The rows of `order`, color c in `order[starts[c]..starts[c + 1]]`.
    pub fn active(order: &'a [u32], starts: &'a [u32]) -> Self {
        Self { order: Some(order), starts, clusters: &[] }
    }

    /// All rows, stored by cluster, and the clusters by color: color c is the clusters
    /// `starts[c]..starts[c + 1]`, cluster k the rows `clusters[k]..clusters[k + 1]`.
    pub fn clustered(starts: &'a [u32], clusters: &'a [u32]) -> Self {
        Self { order: None, starts, clusters }
    }

    /// The places of a range of units: of clusters, or of places where there are none.
    #[inline]
    pub(crate) fn places(&self, units: Range<usize>) -> Range<usize> {
        match self.clusters {
            [] => units,
            clusters => clusters[units.start] as usize..clusters[units.end] as usize,
        }
    }

    /// Row at a place of the order.
    #[inline]
    pub(crate) fn row(&self, place: usize) -> usize {
        match self.order {
            Some(order) => order[place] as usize,
            None => place,
        }
    }
}

/// Constraints of one type with their schedule.
#[derive(Clone, Copy, Debug)]
pub struct ConstraintSet<'a, T> {
    /// The constraints.
    pub rows: &'a [T],
    /// How they are swept.
    pub schedule: Schedule<'a>,
}

impl<'a, T> ConstraintSet<'a, T> {
    /// Constraints with their schedule.
    pub fn new(rows: &'a [T], schedule: Schedule<'a>) -> Self {
        Self { rows, schedule }
    }

    /// Constraints that are swept one after the other.
    pub fn serial(rows: &'a [T]) -> Self {
        Self { rows, schedule: Schedule::SERIAL }
    }

    /// How many constraints a sweep visits.
    pub fn swept(&self) -> usize {
        self.schedule.order.map_or(self.rows.len(), <[u32]>::len)
    }
}

impl<T> Default for ConstraintSet<'_, T> {
    fn default() -> Self {
        Self { rows: &[], schedule: Schedule::SERIAL }
    }
}
