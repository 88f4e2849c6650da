//! Where the vertices of a problem are to go in one call.

use crate::targets::Rule;
use crate::{Case, Random};
use bowknot_geometry::{Point, Vector};

/// The targets of one call.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// How the targets of deformable vertices are chosen.
    pub rule: Rule,
    /// How far they are away, in units of the scene [1].
    pub magnitude: f64,
    /// How obstacles and pinned vertices move.
    pub drive: Drive,
    /// How far they go [1].
    pub way: f64,
    /// Time step that the call stands for [s].
    pub time_step: Option<f64>,
    /// Seed of the directions.
    pub seed: u32,
}

/// How prescribed vertices move: each obstacle and each group of pins as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// Not at all.
    Still,
    /// All in the same direction.
    Along,
    /// Each obstacle toward the center of the scene and beyond; pins all in the same direction.
    Through,
    /// About the center of the scene.
    Turned,
    /// Each vertex as the rule of the others says: obstacles and groups change their shape.
    Free,
}

impl Motion {
    /// Targets of the vertices at `x` [m]. `prescribed`: pins and vertices of obstacles. `scale`: length of
    /// the unit of the scene [m].
    pub fn targets(&self, case: &Case, x: &[Point], prescribed: &[bool], scale: f64) -> Vec<Point> {
        let mut random = Random::new(u64::from(self.seed));
        let case = Case { name: String::new(), model: case.model.clone(), positions: x.to_vec() };
        let mut targets = self.rule.targets_of_all(&case, self.magnitude * scale, &mut random);
        let center = mean(x.iter());
        let (direction, way) = (random.direction(), self.way * scale);
        let turn = bowknot_geometry::nalgebra::Rotation3::new(direction * self.way.min(3.0));
        for v in (0..x.len()).filter(|&v| prescribed[v]) {
            targets[v] = match self.drive {
                Drive::Still => x[v],
                Drive::Along => x[v] + direction * way,
                Drive::Through if case.model.is_obstacle(v as u32) => {
                    let bodies = case.model.vertex_body();
                    let own = mean(x.iter().zip(bodies).filter(|(_, b)| **b == bodies[v]).map(|(p, _)| p));
                    x[v] + (center - own).try_normalize(0.0).unwrap_or(direction) * way
                }
                Drive::Through => x[v] + direction * way,
                Drive::Turned => center + turn * (x[v] - center),
                Drive::Free => targets[v],
            };
        }
        targets
    }

    /// Whether prescribed vertices that move as one keep their distances.
    pub fn is_translation(&self) -> bool {
        matches!(self.drive, Drive::Still | Drive::Along | Drive::Through)
    }
}

fn mean<'a>(points: impl Iterator<Item = &'a Point>) -> Point {
    let (mut sum, mut count) = (Vector::zeros(), 0.0f64);
    for p in points {
        sum += p.coords;
        count += 1.0;
    }
    Point::from(sum / count.max(1.0))
}
