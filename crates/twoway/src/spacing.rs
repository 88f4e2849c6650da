//! Contact distances and minimum separations of pairs, from the contact data of their bodies.

use crate::bodies::ContactTable;
use bowknot_geometry::PairKind;
use bowknot_proximity::{CollisionModel, Pair};

/// Smallest ratio of a pair's contact distance to its minimum separation, where bodies have a thickness.
/// Contacts move in the gap above the minimum separation. A step uses up at most 0.9 of it, so a small gap
/// means small steps. The value was chosen, not tuned: a body of thickness t rests at 1.5 t where delta is
/// smaller.
pub const MIN_SEPARATION_MARGIN: f64 = 1.5;

/// Contact distances and guaranteed minimum separations of all pairs of bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spacing {
    bodies: Vec<Side>,
    half_spaces: Vec<f64>,
    /// The scene's delta, its minimum separation, and the range of rows in deltas.
    delta: f64,
    min_separation: f64,
    range: f64,
    /// All pairs have the values of the scene.
    uniform: bool,
    /// Search margin of each body's vertices, and the part of it that guarantees minimum separations [m].
    margins: Vec<(f64, f64)>,
    largest_delta: f64,
    largest_min_separation: f64,
}

/// A body's part in its pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    delta: f64,
    own_delta: bool,
    thickness: Option<f64>,
}

/// Contact distance and minimum separation of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSpacing {
    /// Contact distance delta_p [m], before it is lowered for neighbors and for pairs that start close.
    pub delta: f64,
    /// Guaranteed minimum separation xi_p [m] of bodies with a thickness, before it is lowered likewise.
    /// None: that of the scene, which is no guarantee: it is lowered with the contact distance.
    pub min_separation: Option<f64>,
}

impl Spacing {
    /// The spacing of the bodies in `table`. The scene's `delta` and `min_separation` [m] apply where they
    /// have none.
    pub(crate) fn new(
        model: &CollisionModel,
        table: &ContactTable,
        range: f64,
        delta: f64,
        min_separation: f64,
    ) -> Self {
        let bodies: Vec<Side> = table
            .bodies()
            .iter()
            .map(|body| Side {
                delta: body.delta.unwrap_or(delta).max(MIN_SEPARATION_MARGIN * body.thickness.unwrap_or(0.0)),
                own_delta: body.delta.is_some(),
                thickness: body.thickness,
            })
            .collect();
        let uniform = table.bodies().iter().all(|b| b.delta.is_none() && b.thickness.is_none())
            && table.half_spaces().iter().all(|h| h.thickness.is_none());
        let half_spaces = table.half_spaces().iter().map(|h| h.thickness.unwrap_or(f64::NAN)).collect();
        let mut spacing = Self {
            bodies,
            half_spaces,
            delta,
            min_separation,
            range,
            uniform,
            margins: Vec::new(),
            largest_delta: delta,
            largest_min_separation: 0.0,
        };
        if !uniform {
            spacing.fill_margins(model.half_spaces().len());
        }
        spacing
    }

    /// Half of the distance within which pairs are candidates, for each side. Against half-spaces the search
    /// counts it twice, and it is more than needed.
    fn fill_margins(&mut self, half_spaces: usize) {
        let mut margins = Vec::with_capacity(self.bodies.len());
        for side in &self.bodies {
            let own = side.thickness.unwrap_or(self.min_separation);
            let mut keep = 0.5 * own;
            let mut margin = 0.5 * (self.range * side.delta).max(own);
            for h in 0..half_spaces {
                let pair = self.against_half_space(side, h);
                let min_separation = pair.min_separation.unwrap_or(self.min_separation);
                keep = keep.max(min_separation);
                margin = margin.max(min_separation.max(pair.delta));
            }
            self.largest_delta = self.largest_delta.max(side.delta);
            self.largest_min_separation = self.largest_min_separation.max(2.0 * keep);
            margins.push((margin, keep));
        }
        self.margins = margins;
    }

    fn against_half_space(&self, side: &Side, half_space: usize) -> PairSpacing {
        let other = Some(self.half_spaces[half_space]).filter(|t| !t.is_nan());
        let own = if side.own_delta { 0.0 } else { self.delta };
        PairSpacing {
            delta: 0.5 * (side.delta + own.max(MIN_SEPARATION_MARGIN * other.unwrap_or(0.0))),
            min_separation: match (side.thickness, other) {
                (None, None) => None,
                (Some(a), b) => Some(0.5 * (a + b.unwrap_or(0.0))),
                (None, Some(b)) => Some(0.5 * (self.min_separation + b)),
            },
        }
    }

    /// Contact distance and minimum separation of a pair.
    #[inline]
    pub fn of(&self, model: &CollisionModel, kind: PairKind, pair: &Pair) -> PairSpacing {
        if self.uniform {
            return PairSpacing { delta: self.delta, min_separation: None };
        }
        let side = |place: usize| &self.bodies[model.vertex_body()[pair.vertices[place] as usize] as usize];
        if kind == PairKind::VertexHalfSpace {
            return self.against_half_space(side(0), pair.elements[1] as usize);
        }
        let (a, b) = (side(0), side(kind.side_a()));
        PairSpacing {
            delta: 0.5 * (a.delta + b.delta),
            min_separation: match (a.thickness, b.thickness) {
                (None, None) => None,
                (a, b) => Some(0.5 * (a.unwrap_or(self.min_separation) + b.unwrap_or(self.min_separation))),
            },
        }
    }

    /// Distance within which a pair becomes a row [m].
    #[inline]
    pub fn contact_range(&self, model: &CollisionModel, kind: PairKind, pair: &Pair) -> f64 {
        self.range * if self.uniform { self.delta } else { self.of(model, kind, pair).delta }
    }

    /// Whether all pairs have the scene's delta and minimum separation.
    pub fn is_uniform(&self) -> bool {
        self.uniform
    }

    /// Contact distance of a body's contacts with others like it [m].
    pub fn delta(&self, body: u32) -> f64 {
        self.bodies[body as usize].delta
    }

    /// Contact distance of a body's contacts with half-spaces that have no thickness [m].
    pub fn half_space_delta(&self, body: u32) -> f64 {
        let side = &self.bodies[body as usize];
        0.5 * (side.delta + if side.own_delta { 0.0 } else { self.delta })
    }

    /// What a vertex of `body` adds to its search radius [m]: pairs closer than the range of rows, or than
    /// the minimum separation, are candidates.
    #[inline]
    pub fn margin(&self, body: u32) -> f64 {
        if self.uniform {
            0.5 * (self.range * self.delta).max(self.min_separation)
        } else {
            self.margins[body as usize].0
        }
    }

    /// Distance within which a pair is a candidate, whatever moves [m]: its margins, at least the distance
    /// within which it becomes a row.
    #[inline]
    pub fn reach(&self, model: &CollisionModel, kind: PairKind, pair: &Pair) -> f64 {
        let margin = |place: usize| self.margin(model.vertex_body()[pair.vertices[place] as usize]);
        margin(0) + if kind == PairKind::VertexHalfSpace { margin(0) } else { margin(kind.side_a()) }
    }

    /// The part of [`Self::margin`] without which pairs that are no candidates could come closer than a
    /// guaranteed minimum separation [m].
    #[inline]
    pub fn min_separation_margin(&self, body: u32) -> f64 {
        if self.uniform { 0.0 } else { self.margins[body as usize].1 }
    }

    /// Largest contact distance of a body with itself [m].
    pub fn largest_delta(&self) -> f64 {
        self.largest_delta
    }

    /// Distance that pairs which are no candidates must keep, by the guaranteed minimum separations [m]; 0
    /// without any.
    pub fn largest_min_separation(&self) -> f64 {
        self.largest_min_separation
    }
}
