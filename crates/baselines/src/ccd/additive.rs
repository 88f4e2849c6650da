//! Additive continuous collision detection (Li, Kaufman, Jiang 2021, "Codimensional Incremental Potential
//! Contact", Algorithm 1): how far along linear paths a pair is certain not to meet.
//!
//! If the gap is g and c bounds the speed at which it closes, the pair cannot meet for another g/c. So time
//! is advanced by 0.9 g/c again and again, until the gap falls below a share of the gap at the start. No
//! roots are computed: the result is never too late, also in parallel and degenerate cases.
//!
//! **Rounding.** Distances are certified lower bounds, the slab widths of `separation`. Positions x + t p are
//! rounded, by less than 1.74 ulp(C) along any direction for coordinates up to C (see [`Rounding`]), and so
//! is the update of a step: 4 ulp(C) per pair for each of the two. Speeds are rounded up.

use bowknot_errors::{Checks, Parameters};
use bowknot_twoway::geometry::{HalfSpace, PairKind, Point, Separation, Vector, separation};
use bowknot_twoway::stepper::Rounding;
use serde::{Deserialize, Serialize};

/// Share of the time without impact that one iteration advances (the 0.9 of Li et al.).
const ADVANCE: f64 = 0.9;
/// Factor that covers the rounding of a speed: some ten operations.
const SPEED_ROUNDING: f64 = 1.0 + 16.0 * f64::EPSILON;

/// Additive CCD with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AdditiveCcd {
    /// A pair counts as meeting below this share of its gap at the start. A smaller share makes times of
    /// impact later and false impacts of pairs that nearly meet rarer, and takes more iterations. Default
    /// 0.1, that of Li et al.
    pub slackness: f64,
    /// The bound of the speed at which a pair closes. Default travel, that of Li et al.
    pub speed: ClosingSpeed,
    /// Largest number of iterations; then the time so far is returned, which is safe. Default 1000.
    pub max_iterations: u32,
}

/// A bound of the speed at which a pair closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClosingSpeed {
    /// The largest speeds of both sides relative to their mean motion, whatever the direction.
    Travel,
    /// The smaller of that and the speed at which the slab between the sides closes along its normal (Mirtich
    /// 1996). Pairs that move apart or side by side take one distance computation.
    Slab,
}

impl Default for AdditiveCcd {
    fn default() -> Self {
        Self { slackness: 0.1, speed: ClosingSpeed::Travel, max_iterations: 1000 }
    }
}

impl Parameters for AdditiveCcd {
    fn check(&self, checks: &mut Checks) {
        let Self { slackness, speed: _, max_iterations } = self;
        checks.between("slackness", *slackness, 0.0, 1.0);
        checks.count_at_least("max_iterations", *max_iterations as usize, 1);
    }
}

/// How far a pair is certain not to meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Until this time in [0, 1] the pair stays farther apart than its minimum separation; 1: all the way.
    pub time: f64,
    /// Number of distances computed.
    pub iterations: u32,
}

impl AdditiveCcd {
    /// How far the pair at `x` stays farther apart than `min_separation` >= 0 [m] while its vertices move
    /// along `paths` [m] with a common path time from 0 to 1; unused places are ignored. A result of `until`
    /// or later is returned as 1: to find the smallest of many, pass the smallest so far.
    pub fn clearance(
        &self,
        kind: PairKind,
        x: &[Point; 4],
        paths: &[Vector; 4],
        min_separation: f64,
        until: f64,
    ) -> Clearance {
        let count = kind.vertex_count();
        let along = |t: f64| -> [Point; 4] { std::array::from_fn(|k| x[k] + t * paths[k]) };
        let start = separation::separate(kind, x);
        let rounding = rounding(&x[..count], &paths[..count]);
        let travel = closing_travel(kind, paths);
        let speed = |separation: &Separation| match self.speed {
            ClosingSpeed::Travel => travel,
            ClosingSpeed::Slab => travel.min(closing_slab(kind, &separation.normal, paths)).max(0.0),
        };
        let gap_of = |separation: &Separation| separation.width - min_separation - rounding;
        let first = gap_of(&start);
        let done = |time: f64, iterations: u32| Clearance { time, iterations };
        if first.is_nan() || first <= 0.0 {
            // The pair is at its minimum separation: it may move if its slab does not close, up to rounding.
            let closing = closing_slab(kind, &start.normal, paths);
            let opening = start.width > 4.0 * rounding && closing <= 2.0 * rounding;
            return done(if opening { 1.0 } else { 0.0 }, 1);
        }
        let enough = self.slackness * first;
        let mut free = (1.0 - self.slackness) * first / speed(&start);
        let mut time = 0.0;
        for iteration in 1..=self.max_iterations {
            // The result would be no earlier than `until`. So the smallest of many does not depend on their
            // order.
            if time + free > 1.0 || time >= until {
                return done(1.0, iteration);
            }
            let next = separation::separate(kind, &along(time + free));
            let gap = gap_of(&next);
            if time > 0.0 && gap < enough {
                return done(time, iteration + 1);
            }
            time += free;
            free = ADVANCE * gap / speed(&next);
            if free.is_nan() || free <= 0.0 {
                return done(time, iteration + 1);
            }
        }
        done(time, self.max_iterations)
    }

    /// As [`Self::clearance`], for a vertex above a half-space at rest.
    pub fn half_space_clearance(
        &self,
        half_space: &HalfSpace,
        x: &Point,
        path: &Vector,
        min_separation: f64,
    ) -> Clearance {
        let separation = separation::separate_half_space(x, half_space);
        let rounding = rounding(&[*x], &[*path]);
        let gap = separation.width - min_separation - rounding;
        let approach = -separation.normal.dot(path);
        let closing = approach + path.norm() * (SPEED_ROUNDING - 1.0);
        let time = if approach <= 0.0 && separation.width > rounding {
            1.0
        } else if gap > 0.0 && closing > 0.0 {
            ((1.0 - self.slackness) * gap / closing).min(1.0)
        } else {
            0.0
        };
        Clearance { time, iterations: 1 }
    }
}

/// Largest loss of a gap by rounding: of positions on the way, and of the final update.
fn rounding(x: &[Point], paths: &[Vector]) -> f64 {
    let largest = x.iter().zip(paths).map(|(x, p)| x.coords.amax() + p.amax()).fold(0.0, f64::max);
    2.0 * Rounding::new(largest).step
}

/// Largest speed of side *a* plus that of side *b*, relative to the mean motion of all vertices.
fn closing_travel(kind: PairKind, paths: &[Vector; 4]) -> f64 {
    let (count, side_a) = (kind.vertex_count(), kind.side_a());
    let mean = paths[..count].iter().sum::<Vector>() / count as f64;
    let largest = |side: &[Vector]| side.iter().map(|p| (p - mean).norm()).fold(0.0, f64::max);
    // The mean is the same for all vertices, however it is rounded; differences from it lose digits of the
    // common motion.
    let common = paths[..count].iter().map(|p| p.amax()).fold(mean.amax(), f64::max);
    let speed = largest(&paths[..side_a]) + largest(&paths[side_a..count]);
    if speed == 0.0 { 0.0 } else { speed * SPEED_ROUNDING + 4.0 * f64::EPSILON * common }
}

/// Speed at which the moving slab along `normal` closes; negative if it opens.
fn closing_slab(kind: PairKind, normal: &Vector, paths: &[Vector; 4]) -> f64 {
    let (count, side_a) = (kind.vertex_count(), kind.side_a());
    let largest_along = |side: &[Vector], sign: f64| {
        side.iter().map(|p| sign * normal.dot(p)).fold(f64::NEG_INFINITY, f64::max)
    };
    let largest = paths[..count].iter().map(|p| p.amax()).fold(0.0, f64::max);
    largest_along(&paths[..side_a], -1.0)
        + largest_along(&paths[side_a..count], 1.0)
        + 16.0 * f64::EPSILON * largest
}

#[cfg(test)]
mod tests;
