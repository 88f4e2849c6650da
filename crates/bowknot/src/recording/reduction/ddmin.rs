//! Delta debugging: the fewest of some things that still show a failure.

use std::time::Duration;
use web_time::Instant;

/// How long a reduction may look for a smaller problem.
#[derive(Clone, Copy)]
pub struct Limits<'a> {
    /// Largest number of tries; a try solves a problem, or judges a state.
    pub tries: usize,
    /// Largest time [s].
    pub seconds: f64,
    /// Whether to stop at once, with the smallest problem found so far.
    pub stop: &'a (dyn Fn() -> bool + 'a),
}

impl Default for Limits<'_> {
    /// 2000 tries, 30 s.
    fn default() -> Self {
        Self { tries: 2000, seconds: 30.0, stop: &|| false }
    }
}

/// Tries parts of a problem until a limit is met.
pub(super) struct Tries<'a, 'b> {
    limits: Limits<'a>,
    deadline: Option<Instant>,
    shows: &'b mut dyn FnMut(&[u32]) -> bool,
    /// Tries so far.
    pub count: usize,
}

impl<'a, 'b> Tries<'a, 'b> {
    /// `shows` tells whether a part, ascending, shows the failure.
    pub fn new(limits: Limits<'a>, shows: &'b mut dyn FnMut(&[u32]) -> bool) -> Self {
        // A time too long to be added is no limit.
        let allowed = Duration::try_from_secs_f64(limits.seconds).ok();
        let deadline = allowed.and_then(|allowed| Instant::now().checked_add(allowed));
        Self { limits, deadline, shows, count: 0 }
    }

    /// Whether no try is left.
    pub fn is_over(&self) -> bool {
        self.count >= self.limits.tries
            || self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
            || (self.limits.stop)()
    }

    /// Whether the part shows the failure; false if no try is left.
    pub fn shows(&mut self, part: &[u32]) -> bool {
        if part.is_empty() || self.is_over() {
            return false;
        }
        self.count += 1;
        (self.shows)(part)
    }

    /// Drops units as long as the rest shows the failure: the algorithm ddmin of Zeller and Hildebrandt,
    /// *Simplifying and Isolating Failure-Inducing Input* (2002). Each unit is a list of elements, and all
    /// units together show the failure. Unless a limit is met, none of the units that remain can be left out
    /// alone.
    pub fn minimize(&mut self, mut units: Vec<Vec<u32>>) -> Vec<Vec<u32>> {
        let mut parts = 2;
        while units.len() >= 2 && !self.is_over() {
            let length = units.len().div_ceil(parts);
            let chunks: Vec<Vec<Vec<u32>>> = units.chunks(length).map(<[_]>::to_vec).collect();
            let rest = |left_out: usize| {
                let others = chunks.iter().enumerate().filter(|(index, _)| *index != left_out);
                others.flat_map(|(_, chunk)| chunk.clone()).collect::<Vec<_>>()
            };
            if let Some(chunk) = chunks.iter().find(|chunk| self.shows(&joined(chunk))) {
                units.clone_from(chunk);
                parts = 2;
            } else if chunks.len() > 2
                && let Some(smaller) = (0..chunks.len()).map(rest).find(|rest| self.shows(&joined(rest)))
            {
                units = smaller;
                parts = (chunks.len() - 1).max(2);
            } else if length == 1 {
                break;
            } else {
                parts = (2 * chunks.len()).min(units.len());
            }
        }
        units
    }
}

/// The elements of some units, ascending.
pub(super) fn joined(units: &[Vec<u32>]) -> Vec<u32> {
    let mut elements = units.concat();
    elements.sort_unstable();
    elements
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The elements that ddmin leaves of `count` if `shows` tells which parts fail, and the number of tries.
    fn left(count: u32, limits: Limits<'_>, mut shows: impl FnMut(&[u32]) -> bool) -> (Vec<u32>, usize) {
        let mut tries = Tries::new(limits, &mut shows);
        let units = tries.minimize((0..count).map(|e| vec![e]).collect());
        (joined(&units), tries.count)
    }

    #[test]
    fn what_is_left_shows_the_failure_and_nothing_in_it_can_be_dropped() {
        let mut random = fastrand::Rng::with_seed(7);
        for _ in 0..50 {
            let count = random.u32(1..200);
            let mut needed: Vec<u32> = (0..random.u32(1..6)).map(|_| random.u32(0..count)).collect();
            needed.sort_unstable();
            needed.dedup();
            let (kept, tries) =
                left(count, Limits::default(), |part| needed.iter().all(|e| part.binary_search(e).is_ok()));
            assert_eq!(kept, needed);
            assert!(tries < 400, "{tries} tries for {needed:?} of {count}");
        }
        // Not monotone: an odd number of the elements below 5 fails.
        let (kept, _) = left(64, Limits::default(), |part| part.iter().filter(|&&e| e < 5).count() % 2 == 1);
        assert_eq!(kept.len(), 1);
    }

    #[test]
    fn limits_end_the_search_with_what_was_found_so_far() {
        let shows = |part: &[u32]| part.binary_search(&100).is_ok();
        let (kept, tries) = left(1024, Limits { tries: 3, ..Limits::default() }, shows);
        assert_eq!(tries, 3);
        assert!(kept.contains(&100) && kept.len() < 1024 && kept.len() > 1, "{kept:?}");
        let (kept, tries) = left(1024, Limits { seconds: 0.0, ..Limits::default() }, shows);
        assert_eq!((kept.len(), tries), (1024, 0));
        let (kept, tries) = left(1024, Limits { stop: &|| true, ..Limits::default() }, shows);
        assert_eq!((kept.len(), tries), (1024, 0));
    }
}
