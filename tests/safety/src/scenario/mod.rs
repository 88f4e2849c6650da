//! Collision problems as data: they are drawn, shrunk and printed, and built the same way each time.

mod motion;
mod piece;
mod setup;
mod shape;
mod strategy;

pub use motion::{Drive, Motion};
pub use piece::{Piece, Role, Seat, Turn};
pub use setup::{Preset, Setup};
pub use shape::{Elements, Shape};
pub use strategy::{any, generated, plain};

use crate::states::{Draft, GENERATORS};
use crate::{Case, Random};
use bowknot_check::{Judge, StateOptions};
use bowknot_geometry::{HalfSpace, Point, Vector};

/// A collision problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// What starts where.
    pub start: Start,
    /// Masses of the vertices.
    pub masses: Masses,
    /// Vertices that follow their targets.
    pub pins: Pins,
    /// Rest lengths, in units of the lengths at the start [1].
    pub rest: f64,
    /// The calls, one after the other, by the same resolver.
    pub calls: Vec<Motion>,
    /// Parameters.
    pub setup: Setup,
}

/// What starts where.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// A state of [`GENERATORS`]; its unit is the meter.
    Generated {
        /// Which generator.
        generator: usize,
        /// Its seed.
        seed: u32,
    },
    /// Small pieces, each set over the one before.
    Pieces {
        /// The pieces.
        pieces: Vec<Piece>,
        /// A half-space below all of them.
        ground: Option<Ground>,
        /// Length of the unit [m].
        scale: f64,
        /// The place of the origin, in units [1].
        offset: [f64; 3],
    },
}

/// A half-space below all pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// How far below the lowest of them [1].
    pub gap: f64,
    /// Its slope along x [1].
    pub slope: f64,
}

/// Masses of the vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Masses {
    /// Decades between the smallest and the largest.
    pub decades: f64,
    /// Seed of which vertex has which.
    pub seed: u32,
}

/// Vertices that follow their targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Pins {
    /// Every how many-th deformable vertex is pinned; 0: none.
    pub every: u32,
    /// Number of groups that move and wait together; 0: each vertex by itself.
    pub groups: u32,
}

impl Scenario {
    /// Elements and positions at the start; none if they intersect even with the pieces one above the other.
    pub fn case(&self) -> Option<Case> {
        match &self.start {
            Start::Generated { generator, seed } => {
                Some(GENERATORS[generator % GENERATORS.len()](u64::from(*seed)))
            }
            Start::Pieces { pieces, ground, scale, offset } => {
                let offset = Vector::from(*offset);
                let transform = |p: &Point| Point::from((p.coords + offset) * *scale);
                [false, true]
                    .into_iter()
                    .map(|raised| build(pieces, ground, *scale, raised, transform))
                    .find(is_clear)
            }
        }
    }

    /// Length of the unit [m].
    pub fn scale(&self) -> f64 {
        match &self.start {
            Start::Generated { .. } => 1.0,
            Start::Pieces { scale, .. } => *scale,
        }
    }

    /// Mass of each of `count` vertices [kg].
    pub fn masses(&self, count: usize) -> Vec<f64> {
        let mut random = Random::new(u64::from(self.masses.seed));
        let half = 0.5 * self.masses.decades;
        (0..count).map(|_| 10f64.powf(random.between(-half, half))).collect()
    }

    /// Which vertices of a case are pinned, and the group of each vertex.
    pub fn pins(&self, case: &Case) -> (Vec<bool>, Vec<u32>) {
        let Pins { every, groups } = self.pins;
        let count = case.positions.len() as u32;
        let is_pinned = |v: u32| every > 0 && v.is_multiple_of(every) && !case.model.is_obstacle(v);
        let group = |v: u32| {
            let is_grouped = groups > 0 && is_pinned(v);
            if is_grouped { v / every.max(1) % groups } else { bowknot_twoway::ResolveInput::NO_GROUP }
        };
        ((0..count).map(is_pinned).collect(), (0..count).map(group).collect())
    }
}

fn build(
    pieces: &[Piece],
    ground: &Option<Ground>,
    scale: f64,
    raised: bool,
    transform: impl Fn(&Point) -> Point,
) -> Case {
    let mut draft = Draft::default();
    piece::add_pieces(&mut draft, pieces, raised, transform);
    if let Some(ground) = ground {
        let normal = Vector::new(-ground.slope, 0.0, 1.0).normalize();
        let foot =
            draft.positions.iter().copied().reduce(|a, b| if normal.dot(&(b - a)) < 0.0 { b } else { a });
        let foot = foot.unwrap_or_else(Point::origin) - normal * (ground.gap * scale);
        draft.half_spaces.extend(HalfSpace::new(foot, normal));
    }
    draft.finish("pieces", 0)
}

fn is_clear(case: &Case) -> bool {
    let options = StateOptions { limit: 1, distance: false };
    let report = Judge::from_model(&case.model).check_state(&case.positions, &options);
    report.is_ok_and(|report| report.is_clear())
}
