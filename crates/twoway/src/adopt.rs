//! Takes over the end of a call that something else has made, such as a device.

use crate::call::CallInput;
use crate::error::ResolveError;
use crate::multipliers::PairMultipliers;
use crate::resolver::Resolver;
use crate::search::TrustRegionSearch;
use crate::stages::{BackwardStep, ForwardStep, Search};
use crate::statistics::Statistics;
use bowknot_geometry::{Point, Vector};
use bowknot_proximity::PairList;

/// The end of a call.
#[derive(Clone, Copy, Debug)]
pub struct CallEnd<'a> {
    /// Where the call started [m].
    pub start: &'a [Point],
    /// Where it ended, free of intersections [m].
    pub positions: &'a [Point],
    /// Where the dynamics wants to be [m].
    pub target: &'a [Point],
    /// Where the last step wanted to go: y [m].
    pub aims: &'a [Point],
    /// What the contacts carry, in any order. Pairs without an entry carry nothing.
    pub contacts: &'a [PairMultipliers],
    /// Pairs among which are all that are in contact range at `positions`. None: they are searched for.
    pub near: Option<&'a PairList>,
}

impl<B: BackwardStep, F: ForwardStep<TrustRegionSearch>> Resolver<TrustRegionSearch, B, F> {
    /// Makes [`Self::state`] that of a `call` which something else has made: pairs in range at its end, their
    /// contact geometry, and what they carry. Adds to `statistics` what [`Self::resolve_with`] adds at the
    /// end of a call, but for residuals and counts of the stages. Entries of pairs that are out of range are
    /// dropped: nothing presses there.
    ///
    /// # Errors
    /// More pairs than can be numbered.
    ///
    /// # Panics
    /// If a slice or `call` has another length than the scene has vertices.
    pub fn adopt(
        &mut self,
        end: &CallEnd<'_>,
        call: CallInput,
        statistics: &mut Statistics,
    ) -> Result<(), ResolveError> {
        self.begin_search(end.positions, end.target, call);
        let Self { scene, state, search, .. } = self;
        match end.near {
            Some(near) => search.update_among(scene, state, near, &mut Statistics::default()),
            None => search.update(scene, state, &mut Statistics::default()),
        }
        state.check_pairs(scene)?;
        state.start.copy_from_slice(end.start);
        state.y.copy_from_slice(end.aims);
        state.step = statistics.steps;
        let contacts = &mut state.contacts;
        // The search gave pairs what they carried at the start of the call.
        contacts.multipliers.fill(0.0);
        contacts.friction_multipliers.fill(Vector::zeros());
        let mut sorted = end.contacts.to_vec();
        sorted.sort_unstable_by_key(|contact| (contact.kind, contact.elements));
        for of_kind in sorted.chunk_by(|a, b| a.kind == b.kind) {
            let mut lookup = contacts.pairs.lookup(of_kind[0].kind, [0; 2]);
            for contact in of_kind {
                let Some(pair) = lookup.find(contact.elements) else { continue };
                contacts.multipliers[pair as usize] = contact.normal;
                if let Some(friction) = contacts.friction_multipliers.get_mut(pair as usize) {
                    *friction = contact.friction;
                }
            }
        }
        self.describe_end(statistics);
        Ok(())
    }
}
