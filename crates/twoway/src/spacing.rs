//! The distances that pairs are held to, from what their bodies were given.

use crate::{ContactTable, Params};
use bowknot_geometry::PairKind;
use bowknot_proximity::{CollisionModel, Pair};

/// Smallest ratio of a pair's desired distance to its floor, where bodies have thickness. The gap above the floor is
/// the room in which contacts move: a step uses up at most 0.9 of it, so little room means small steps.
/// Chosen, not tuned: a body of thickness t rests at 1.5 t where delta is smaller.
pub const FLOOR_MARGIN: f64 = 1.5;

/// Desired distances and guaranteed floors of all pairs of bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spacing {
    bodies: Vec<Side>,
    half_spaces: Vec<f64>,
    /// The scene's delta, its floor, and the range of rows in deltas.
    delta: f64,
    floor: f64,
    range: f64,
    /// Nothing differs from the scene's.
    uniform: bool,
    /// Search margin of each body's vertices, and the part of it that keeps floors [m].
    margins: Vec<(f64, f64)>,
    largest: (f64, f64),
}

/// A body's part in its pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    delta: f64,
    own_delta: bool,
    thickness: Option<f64>,
}

/// What one pair is held to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSpacing {
    /// Desired distance delta_p before neighbourhood and tight starts lower it [m].
    pub delta: f64,
    /// Guaranteed floor xi_p [m] of bodies with a thickness, before the same lower it; None: the scene's floor
    /// applies, in its softer form.
    pub floor: Option<f64>,
}

impl Spacing {
    /// The spacing of the bodies in `table`, with the scene's `delta` and `floor` [m] for what they leave open.
    pub(crate) fn new(
        model: &CollisionModel,
        table: &ContactTable,
        params: &Params,
        delta: f64,
        floor: f64,
    ) -> Self {
        let bodies: Vec<Side> = table
            .bodies()
            .iter()
            .map(|body| Side {
                delta: body.delta.unwrap_or(delta).max(FLOOR_MARGIN * body.thickness.unwrap_or(0.0)),
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
            floor,
            range: params.constraints.range,
            uniform,
            margins: Vec::new(),
            largest: (delta, 0.0),
        };
        if !uniform {
            spacing.fill_margins(model.half_spaces().len());
        }
        spacing
    }

    /// Half of what pairs are listed within for each side. Against half-spaces, where the search counts it twice, it is more than
    /// needed.
    fn fill_margins(&mut self, half_spaces: usize) {
        let mut margins = Vec::with_capacity(self.bodies.len());
        for side in &self.bodies {
            let floor = side.thickness.unwrap_or(self.floor);
            let mut keep = 0.5 * floor;
            let mut reach = 0.5 * (self.range * side.delta).max(floor);
            for h in 0..half_spaces {
                let pair = self.against_half_space(side, h);
                let floor = pair.floor.unwrap_or(self.floor);
                keep = keep.max(floor);
                reach = reach.max(floor.max(pair.delta));
            }
            self.largest.0 = self.largest.0.max(side.delta);
            self.largest.1 = self.largest.1.max(2.0 * keep);
            margins.push((reach, keep));
        }
        self.margins = margins;
    }

    fn against_half_space(&self, side: &Side, half_space: usize) -> PairSpacing {
        let other = Some(self.half_spaces[half_space]).filter(|t| !t.is_nan());
        let own = if side.own_delta { 0.0 } else { self.delta };
        PairSpacing {
            delta: 0.5 * (side.delta + own.max(FLOOR_MARGIN * other.unwrap_or(0.0))),
            floor: match (side.thickness, other) {
                (None, None) => None,
                (Some(a), b) => Some(0.5 * (a + b.unwrap_or(0.0))),
                (None, Some(b)) => Some(0.5 * (self.floor + b)),
            },
        }
    }

    /// What a pair is held to.
    #[inline]
    pub fn of(&self, model: &CollisionModel, kind: PairKind, pair: &Pair) -> PairSpacing {
        if self.uniform {
            return PairSpacing { delta: self.delta, floor: None };
        }
        let side = |place: usize| &self.bodies[model.vertex_body()[pair.vertices[place] as usize] as usize];
        if kind == PairKind::VertexHalfSpace {
            return self.against_half_space(side(0), pair.elements[1] as usize);
        }
        let (a, b) = (side(0), side(kind.side_a()));
        PairSpacing {
            delta: 0.5 * (a.delta + b.delta),
            floor: match (a.thickness, b.thickness) {
                (None, None) => None,
                (a, b) => Some(0.5 * (a.unwrap_or(self.floor) + b.unwrap_or(self.floor))),
            },
        }
    }

    /// Distance within which a pair becomes a row [m].
    #[inline]
    pub fn contact_range(&self, model: &CollisionModel, kind: PairKind, pair: &Pair) -> f64 {
        self.range * if self.uniform { self.delta } else { self.of(model, kind, pair).delta }
    }

    /// Whether nothing differs from the scene's delta and floor.
    pub fn is_uniform(&self) -> bool {
        self.uniform
    }

    /// What a vertex of `body` adds to its search radius [m]: pairs are listed while nearer than range or floor.
    #[inline]
    pub fn margin(&self, body: u32) -> f64 {
        match self.uniform {
            true => 0.5 * (self.range * self.delta).max(self.floor),
            false => self.margins[body as usize].0,
        }
    }

    /// The part of [`Self::margin`] without which unlisted pairs could fall below a guaranteed floor [m].
    #[inline]
    pub fn floor_margin(&self, body: u32) -> f64 {
        if self.uniform { 0.0 } else { self.margins[body as usize].1 }
    }

    /// Largest desired distance of a body with itself [m].
    pub fn largest_delta(&self) -> f64 {
        self.largest.0
    }

    /// Distance that unlisted pairs must keep for the guaranteed floors [m]; 0 where there are none.
    pub fn largest_floor(&self) -> f64 {
        self.largest.1
    }
}
