//! Pairs of primitives by their bodies.

use crate::report::BodyPair;
use bowknot_geometry::Point;
use std::collections::BTreeMap;

/// Counts pairs of primitives by their bodies. Of each the deepest place is kept, of equal ones the first.
pub(super) fn by_bodies(
    pairs: impl Iterator<Item = ([Option<u32>; 2], Option<f64>, Point)>,
) -> Vec<BodyPair> {
    // Half-spaces have no number and come last.
    let key = |body: Option<u32>| (body.is_none(), body);
    let mut counted = BTreeMap::new();
    for (mut bodies, depth, place) in pairs {
        bodies.sort_by_key(|body| key(*body));
        let pair = counted.entry(bodies.map(key)).or_insert(BodyPair { bodies, count: 0, depth, place });
        pair.count += 1;
        if depth > pair.depth {
            (pair.depth, pair.place) = (depth, place);
        }
    }
    counted.into_values().collect()
}
