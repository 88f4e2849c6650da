//! Where vertices are asked to go: from a micrometre to a kilometre away, mostly into one another.

use crate::{Case, Random};
use bowknot_geometry::{Point, Vector};

/// A rule for targets; distances are about the `magnitude` it is used with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Every vertex its own way.
    Scattered,
    /// All the same way, but for a thousandth.
    Together,
    /// Through the center and out on the other side.
    Inverted,
    /// Through a plane, mirrored.
    Mirrored,
    /// Toward another vertex's place, and beyond.
    Swapped,
    /// Half of the vertices go, the others stay.
    Halved,
}

impl Rule {
    /// All rules.
    pub const ALL: [Rule; 6] =
        [Rule::Scattered, Rule::Together, Rule::Inverted, Rule::Mirrored, Rule::Swapped, Rule::Halved];

    /// Targets of a case's vertices, `magnitude` [m] away; obstacles move as a whole.
    pub fn targets(self, case: &Case, magnitude: f64, random: &mut Random) -> Vec<Point> {
        let x = &case.positions;
        let center = Point::from(x.iter().map(|p| p.coords).sum::<Vector>() / x.len().max(1) as f64);
        let direction = random.direction();
        let away = |v: Vector| v.try_normalize(0.0).unwrap_or_else(Vector::z) * magnitude;
        let mut targets: Vec<Point> = x
            .iter()
            .map(|p| match self {
                Rule::Scattered => p + random.vector(magnitude),
                Rule::Together => p + direction * magnitude + random.vector(1e-3 * magnitude),
                Rule::Inverted => p + away(center - p),
                Rule::Mirrored => {
                    let height = direction.dot(&(p - center));
                    p - direction * (height.signum() * magnitude)
                }
                Rule::Swapped => p + away(x[random.below(x.len())] - p),
                Rule::Halved if random.below(2) == 0 => p + direction * magnitude,
                Rule::Halved => *p,
            })
            .collect();
        for v in 0..x.len() {
            if case.model.is_obstacle(v as u32) {
                targets[v] = x[v] + direction * magnitude;
            }
        }
        targets
    }
}
