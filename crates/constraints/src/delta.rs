//! The contact distance of each pair.

use bowknot_geometry::{PairKind, Point, distance};
use bowknot_proximity::{CollisionModel, Pair};

/// How the contact distance of pairs is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaRule {
    /// Largest contact distance, delta [m].
    pub delta: f64,
    /// By how much, at most, the rows of a call ask a gap below `delta` to grow [m].
    pub growth: f64,
}

impl DeltaRule {
    /// The contact distance [m] of a pair that has the distance `gap` when it first becomes a candidate in a
    /// call, and whether it was lowered because the pair are neighbors in a fine mesh.
    ///
    /// The contact distance of neighbors, pairs of one connected component, is at most half of their rest
    /// distance: otherwise `delta` would tear a fine mesh apart. A pair that starts closer than its contact
    /// distance opens by at most `growth` per call.
    pub fn of(
        &self,
        model: &CollisionModel,
        kind: PairKind,
        pair: &Pair,
        rest: &[Point],
        gap: f64,
    ) -> (f64, bool) {
        let (delta, lowered) = self.without_growth_limit(model, kind, pair, rest);
        (delta.min(gap.max(0.0) + self.growth), lowered)
    }

    /// The contact distance [m] that a pair reaches in the end, however close it starts, and whether it was
    /// lowered because the pair are neighbors in a fine mesh.
    pub fn without_growth_limit(
        &self,
        model: &CollisionModel,
        kind: PairKind,
        pair: &Pair,
        rest: &[Point],
    ) -> (f64, bool) {
        let mut delta = self.delta;
        let mut lowered = false;
        if kind != PairKind::VertexHalfSpace {
            let component = |side: usize| model.vertex_component()[pair.vertices[side] as usize];
            if component(0) == component(kind.side_a()) {
                let rest = distance::closest(kind, &pair.vertices.map(|v| rest[v as usize])).distance;
                if 0.5 * rest < delta {
                    delta = 0.5 * rest;
                    lowered = true;
                }
            }
        }
        (delta, lowered)
    }
}
