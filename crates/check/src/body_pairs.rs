//! Pairs of primitives by their bodies.

use crate::report::BodyPair;
use bowknot_geometry::Point;
use std::collections::BTreeMap;

/// Counts pairs of primitives by their bodies. Of each the deepest one is kept, of equal ones the first;
/// `place` says where a pair is, by its number.
pub(super) fn by_bodies(
    pairs: impl Iterator<Item = ([Option<u32>; 2], Option<f64>)>,
    place: impl Fn(usize) -> Point,
) -> Vec<BodyPair> {
    // Half-spaces have no number and come last.
    let key = |body: Option<u32>| (body.is_none(), body);
    let mut counted = BTreeMap::new();
    for (number, (mut bodies, depth)) in pairs.enumerate() {
        bodies.sort_by_key(|body| key(*body));
        let (_, count, deepest, kept) =
            counted.entry(bodies.map(key)).or_insert((bodies, 0_usize, depth, number));
        *count += 1;
        if depth > *deepest {
            (*deepest, *kept) = (depth, number);
        }
    }
    let pair = |(bodies, count, depth, kept)| BodyPair { bodies, count, depth, place: place(kept) };
    counted.into_values().map(pair).collect()
}
