//! Targets of vertices, from a micrometer to a kilometer away. Most lead through other elements.

use crate::{Case, Random};
use bowknot_geometry::{Point, Vector};

/// A rule for targets. Their distances are about the given `magnitude`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// Every vertex goes in its own direction.
    Scattered,
    /// All vertices go in the same direction, up to a thousandth.
    Together,
    /// Every vertex goes through the center to the other side.
    Inverted,
    /// Every vertex goes to the other side of a plane through the center.
    Mirrored,
    /// Every vertex goes toward the position of another one, or beyond it.
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
