//! Additive continuous collision detection (Li, Kaufman, Jiang 2021, "Codimensional Incremental Potential Contact",
//! Algorithm 1): how far along linear paths a pair surely does not meet.
//!
//! From a time at which the gap is g a pair cannot meet for another g/c, c a bound of the speed at which it closes; so time is
//! advanced by 0.9 g/c again and again, until the gap falls below a share of what it was at first. No root is sought: the
//! result is never late, in parallel and degenerate cases either.
//!
//! **Rounding.** Distances are certified lower bounds, the slab widths of `separation`. Positions x + t p are rounded, by less
//! than 1.74 ulp(C) along any direction for coordinates up to C (see [`Rounding`]), and so is the update that a step makes in
//! the end: 4 ulp(C) a pair for each of both. Speeds are rounded up.

use bowknot_twoway::geometry::{HalfSpace, PairKind, Point, Separation, Vector, separation};
use bowknot_twoway::stepper::Rounding;
use serde::{Deserialize, Serialize};

/// Share of the time that is surely free which one iteration goes (the 0.9 of Li et al.).
const ADVANCE: f64 = 0.9;
/// Factor that covers the rounding of a speed: some ten operations.
const SPEED_ROUNDING: f64 = 1.0 + 16.0 * f64::EPSILON;

/// Additive CCD with its settings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AdditiveCcd {
    /// Share of the first gap at which a pair counts as meeting, s. Smaller: later times of impact, fewer pairs that nearly
    /// meet taken for such that do, more iterations. Default 0.1, that of Li et al.
    pub slackness: f64,
    /// What bounds the speed at which a pair closes. Default travel, that of Li et al.
    pub speed: ClosingSpeed,
    /// Iterations after which the time reached so far is returned, which is safe. Default 1000.
    pub max_iterations: u32,
}

/// A bound of the speed at which a pair closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClosingSpeed {
    /// The largest speeds of both sides relative to their mean motion, whatever the direction.
    Travel,
    /// The smaller of that and the speed at which the slab between the sides closes along its normal (Mirtich 1996).
    /// Pairs that move apart or side by side take one distance.
    Slab,
}

impl Default for AdditiveCcd {
    fn default() -> Self {
        Self { slackness: 0.1, speed: ClosingSpeed::Travel, max_iterations: 1000 }
    }
}

/// How far a pair surely does not meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Until this time in [0, 1] the pair stays farther apart than its floor; 1: all the way.
    pub time: f64,
    /// Distances measured.
    pub iterations: u32,
}

impl AdditiveCcd {
    /// How far the pair at `x` stays farther apart than `floor` >= 0 [m] while its vertices move along `paths` [m] on a
    /// common clock from 0 to 1; unused places are ignored. A result that would be `until` or later is 1: who asks for the
    /// smallest of many passes the smallest so far.
    pub fn clearance(
        &self,
        kind: PairKind,
        x: &[Point; 4],
        paths: &[Vector; 4],
        floor: f64,
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
        let gap_of = |separation: &Separation| separation.width - floor - rounding;
        let first = gap_of(&start);
        let done = |time: f64, iterations: u32| Clearance { time, iterations };
        if first.is_nan() || first <= 0.0 {
            // At its floor already: it may move as long as its slab does not close, but for rounding.
            let closing = closing_slab(kind, &start.normal, paths);
            let opening = start.width > 4.0 * rounding && closing <= 2.0 * rounding;
            return done(if opening { 1.0 } else { 0.0 }, 1);
        }
        let enough = self.slackness * first;
        let mut free = (1.0 - self.slackness) * first / speed(&start);
        let mut time = 0.0;
        for iteration in 1..=self.max_iterations {
            // The end would be no earlier than this: where the smallest of many is asked for, it does not matter in
            // which order they are looked at.
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

    /// As [`Self::clearance`], for a vertex above a half-space that rests.
    pub fn half_space_clearance(
        &self,
        half_space: &HalfSpace,
        x: &Point,
        path: &Vector,
        floor: f64,
    ) -> Clearance {
        let separation = separation::separate_half_space(x, half_space);
        let rounding = rounding(&[*x], &[*path]);
        let gap = separation.width - floor - rounding;
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

/// What rounding may take from a gap: of positions on the way, and of the update that is made in the end.
fn rounding(x: &[Point], paths: &[Vector]) -> f64 {
    let largest = x.iter().zip(paths).map(|(x, p)| x.coords.amax() + p.amax()).fold(0.0, f64::max);
    2.0 * Rounding::new(largest).step
}

/// Largest speed of side *a* plus that of side *b*, relative to the mean motion of all vertices.
fn closing_travel(kind: PairKind, paths: &[Vector; 4]) -> f64 {
    let (count, side_a) = (kind.vertex_count(), kind.side_a());
    let mean = paths[..count].iter().sum::<Vector>() / count as f64;
    let largest = |side: &[Vector]| side.iter().map(|p| (p - mean).norm()).fold(0.0, f64::max);
    // The mean is the same for all, however rounded; the differences from it lose digits of the motion in common.
    let common = paths[..count].iter().map(|p| p.amax()).fold(mean.amax(), f64::max);
    let speed = largest(&paths[..side_a]) + largest(&paths[side_a..count]);
    if speed == 0.0 { 0.0 } else { speed * SPEED_ROUNDING + 4.0 * f64::EPSILON * common }
}

/// Speed at which the slab along `normal` closes when it is carried along: negative where it opens.
fn closing_slab(kind: PairKind, normal: &Vector, paths: &[Vector; 4]) -> f64 {
    let (count, side_a) = (kind.vertex_count(), kind.side_a());
    let most = |side: &[Vector], sign: f64| {
        side.iter().map(|p| sign * normal.dot(p)).fold(f64::NEG_INFINITY, f64::max)
    };
    let largest = paths[..count].iter().map(|p| p.amax()).fold(0.0, f64::max);
    most(&paths[..side_a], -1.0) + most(&paths[side_a..count], 1.0) + 16.0 * f64::EPSILON * largest
}

#[cfg(test)]
mod tests;
