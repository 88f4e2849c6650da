//! Vertices by the numbers that a file gives them.

/// Finds the index of a vertex by its number in the file.
#[derive(Clone, Debug)]
pub(super) struct Numbering {
    /// The first number, if vertex k has number `first + k`: the usual case, which needs no search.
    first: Option<i64>,
    /// Number and index, ascending.
    sorted: Vec<(i64, u32)>,
}

impl Numbering {
    /// From the number of each vertex.
    ///
    /// # Errors
    /// The smallest number that is given twice.
    pub(super) fn new(numbers: Vec<i64>) -> Result<Self, i64> {
        let first = numbers.first().copied().unwrap_or(0);
        let consecutive = numbers.iter().enumerate().all(|(k, n)| first.checked_add(k as i64) == Some(*n));
        let mut sorted: Vec<(i64, u32)> = numbers.into_iter().zip(0..).collect();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(pair[0].0),
            None => Ok(Self { first: consecutive.then_some(first), sorted }),
        }
    }

    /// The index of the vertex of this number; none if no vertex has it.
    pub(super) fn index(&self, number: i64) -> Option<u32> {
        if let Some(first) = self.first {
            let index = number.checked_sub(first).filter(|k| (0..self.sorted.len() as i64).contains(k))?;
            return Some(index as u32);
        }
        let place = self.sorted.binary_search_by_key(&number, |entry| entry.0).ok()?;
        Some(self.sorted[place].1)
    }
}
