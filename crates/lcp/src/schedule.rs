//! The order in which constraints are swept, and which of them are swept in parallel.

/// Which rows are swept, in which order, and which of them are independent.
///
/// Color c holds the places `starts[c]..starts[c + 1]` of `order`, or of the rows themselves if `order` is
/// `None`. The rows of a color are swept in parallel, so no two of them may share a node that can move
/// ([`crate::validate_colors`] checks it). Rows that are not in `order` are not swept: inactive rows cost
/// nothing. A sweep is fastest if rows are stored by color, in spatial order within each color, and `order`
/// rises: rows are then read in order, and each thread stays in its part of the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Schedule<'a> {
    /// Indices of the rows to sweep; `None`: all, as stored.
    pub order: Option<&'a [u32]>,
    /// Where each color starts, and the end. If it is empty, there are no colors, and rows are swept one
    /// after the other.
    pub starts: &'a [u32],
}

impl<'a> Schedule<'a> {
    /// All rows, as stored, one after the other.
    pub const SERIAL: Schedule<'static> = Schedule { order: None, starts: &[] };

    /// All rows, stored by color.
    pub fn colored(starts: &'a [u32]) -> Self {
        Self { order: None, starts }
    }

    /// The rows of `order`, color c in `order[starts[c]..starts[c + 1]]`.
    pub fn active(order: &'a [u32], starts: &'a [u32]) -> Self {
        Self { order: Some(order), starts }
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
