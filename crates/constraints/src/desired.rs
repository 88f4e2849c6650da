//! The desired distance of each pair.

use bowknot_geometry::{PairKind, Point, distance};
use bowknot_proximity::{CollisionModel, Pair};

/// How the desired distance of pairs is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesiredDistance {
    /// Largest desired distance, delta [m].
    pub delta: f64,
    /// How much a gap below `delta` may be asked to grow during the call [m].
    pub growth: f64,
}

impl DesiredDistance {
    /// The desired distance [m] of a pair whose distance is `gap` where it is first listed in a call, and
    /// whether it was lowered because the pair are neighbours in a fine mesh.
    ///
    /// Neighbours keep at most half of their rest distance, or a fine mesh would be torn apart by its own
    /// `delta`; and a tight start opens by `growth` a call instead of exploding.
    pub fn of(
        &self,
        model: &CollisionModel,
        kind: PairKind,
        pair: &Pair,
        rest: &[Point],
        gap: f64,
    ) -> (f64, bool) {
        let (desired, lowered) = self.at_ease(model, kind, pair, rest);
        (desired.min(gap.max(0.0) + self.growth), lowered)
    }

    /// The desired distance [m] that a pair comes to in the end, however tight it starts; and whether it was lowered
    /// because the pair are neighbours in a fine mesh.
    pub fn at_ease(
        &self,
        model: &CollisionModel,
        kind: PairKind,
        pair: &Pair,
        rest: &[Point],
    ) -> (f64, bool) {
        let mut desired = self.delta;
        let mut lowered = false;
        if kind != PairKind::VertexHalfSpace {
            let body = |side: usize| model.vertex_body()[pair.vertices[side] as usize];
            if body(0) == body(kind.side_a()) {
                let rest = distance::closest(kind, &pair.vertices.map(|v| rest[v as usize])).distance;
                if 0.5 * rest < desired {
                    desired = 0.5 * rest;
                    lowered = true;
                }
            }
        }
        (desired, lowered)
    }
}
