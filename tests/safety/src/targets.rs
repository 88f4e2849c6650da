//! Targets of vertices, from a micrometer to a million kilometers away. Most lead through other elements.

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
    /// Every body goes as a whole toward the center of another one, or beyond it.
    Bodies,
    /// Every vertex goes to the same point.
    Collapsed,
    /// Every vertex goes to the same plane.
    Flattened,
}

impl Rule {
    /// All rules.
    pub const ALL: [Rule; 9] = [
        Rule::Scattered,
        Rule::Together,
        Rule::Inverted,
        Rule::Mirrored,
        Rule::Swapped,
        Rule::Halved,
        Rule::Bodies,
        Rule::Collapsed,
        Rule::Flattened,
    ];

    /// Targets of a case's vertices, `magnitude` [m] away; obstacles move as a whole.
    pub fn targets(self, case: &Case, magnitude: f64, random: &mut Random) -> Vec<Point> {
        let mut targets = self.targets_of_all(case, magnitude, random);
        let way = random.direction() * magnitude;
        for (v, x) in case.positions.iter().enumerate() {
            if case.model.is_obstacle(v as u32) {
                targets[v] = x + way;
            }
        }
        targets
    }

    /// The same by the rule alone, for obstacles as well.
    pub fn targets_of_all(self, case: &Case, magnitude: f64, random: &mut Random) -> Vec<Point> {
        let x = &case.positions;
        let center = Point::from(x.iter().map(|p| p.coords).sum::<Vector>() / x.len().max(1) as f64);
        let direction = random.direction();
        let away = |v: Vector| v.try_normalize(0.0).unwrap_or_else(Vector::z) * magnitude;
        let ways = body_ways(case, random);
        x.iter()
            .zip(case.model.vertex_body())
            .map(|(p, body)| match self {
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
                Rule::Bodies => p + away(ways[*body as usize]),
                Rule::Collapsed => center + direction * magnitude,
                Rule::Flattened => p - direction * (direction.dot(&(p - center)) + magnitude),
            })
            .collect()
    }
}

/// The way from the center of each body to that of another one; zero if there is no other.
fn body_ways(case: &Case, random: &mut Random) -> Vec<Vector> {
    let count = case.model.bodies().len();
    let mut sums = vec![(Vector::zeros(), 0.0f64); count];
    for (p, &body) in case.positions.iter().zip(case.model.vertex_body()) {
        let sum = &mut sums[body as usize];
        *sum = (sum.0 + p.coords, sum.1 + 1.0);
    }
    let center = |body: usize| sums[body].0 / sums[body].1.max(1.0);
    (0..count)
        .map(|body| center((body + 1 + random.below(count.max(2) - 1)) % count) - center(body))
        .collect()
}
