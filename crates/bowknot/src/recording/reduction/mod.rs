//! The smallest part of a collision problem that still shows a failure.

mod ddmin;
mod failure;
mod part;
#[cfg(test)]
mod tests;

pub use ddmin::Limits;
pub use failure::Failure;

use crate::recording::states::States;
use bowknot_twoway::Params;
use ddmin::{Tries, joined};
use std::collections::BTreeMap;

/// Elements in the first try around the place of a failure; each further try takes four times as many.
const FIRST_TRY: usize = 4;

/// A part of a problem that shows the same failure as the whole.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// The part, a valid problem.
    pub states: States,
    /// Elements of the whole problem, see [`States::element_count`].
    pub of: usize,
    /// Parts that were tried.
    pub tries: usize,
    /// Whether no single element of the part can be left out. False if a limit ended the search.
    pub minimal: bool,
}

impl States {
    /// The smallest part found that shows the failure; none if the whole problem does not show it.
    ///
    /// Tries the elements around the failing place first, then leaves out whole bodies and half-spaces, then
    /// elements. `params` are those that the problem is resolved with.
    pub fn reduce(&self, params: &Params, failure: Failure, limits: Limits<'_>) -> Option<Reduction> {
        let (found, place) = self.failure(params, failure == Failure::Unsafe, limits.stop)?;
        if found != failure {
            return None;
        }
        let count = self.element_count() as u32;
        let mut shows = |part: &[u32]| {
            let found = self.part(part).failure(params, failure == Failure::Unsafe, limits.stop);
            found.is_some_and(|(found, _)| found == failure)
        };
        let mut tries = Tries::new(limits, &mut shows);
        let mut kept: Vec<u32> = (0..count).collect();
        if let Some(place) = place {
            kept.sort_by(|&a, &b| self.distance(a, &place).total_cmp(&self.distance(b, &place)));
            let sizes = std::iter::successors(Some(FIRST_TRY), |size| size.checked_mul(4));
            for size in sizes.take_while(|&size| size < count as usize) {
                let part = joined(&[kept[..size].to_vec()]);
                if tries.shows(&part) {
                    kept = part;
                    break;
                }
            }
        }
        let mut owners: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        kept.iter().for_each(|&element| owners.entry(self.owner(element)).or_default().push(element));
        let kept = joined(&tries.minimize(owners.into_values().collect()));
        let kept = joined(&tries.minimize(kept.into_iter().map(|element| vec![element]).collect()));
        let (tried, minimal) = (tries.count, !tries.is_over());
        Some(Reduction { states: self.part(&kept), of: count as usize, tries: tried, minimal })
    }
}
