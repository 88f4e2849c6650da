//! Certifies that two primitives stay apart while their vertices move linearly in one path time.
//!
//! For a fixed direction n and vertices i of side a and j of side b, n . (x_i(t) - x_j(t)) is linear in
//! t. So if it is positive for all i and j at t0 and at t1, then at every t between a plane with normal
//! n, moving along with the sides, lies between them: they are apart all the way. Nothing else is
//! needed of n, so it may be found by any means, and nothing is certified but by [`Sweep::separates`].
//! Time is advanced by intervals that are certified one after the other, halved while they fail and
//! doubled when they succeed; a pair that fails at the shortest interval counts as a hit.
//!
//! **Rounding.** Let u = 2^-53 and a, b the coordinates of two vertices at both ends. The differences
//! D0 = fl(a0 - b0) and D1 = fl(a1 - b1) have a relative error of u. Times are multiples of 2^-40 in
//! [0, 1], so t and 1 - t are exact. fl(fl((1 - t) D0) + fl(t D1)) adds two more roundings, its dot
//! product with n three more per term: 6u to first order, against m = max(|D0|, |D1|) per coordinate.
//! [`ROUNDING`] = 8u covers the terms of higher order and the rounding of the bound itself.

use crate::closest::{across_edges, closest, common_normal};
use bowknot_geometry::{PairKind, Point, Vector};

/// Number of times the path is halved at most.
const HALVINGS: i32 = 40;
/// Intervals looked at for one pair at most; one that needs more counts as a hit.
const MAX_INTERVALS: usize = 20_000;
/// Relative bound of rounding in [`Sweep::separates`]: 8u.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Covers underflow, which relative bounds do not.
const SMALLEST: f64 = 1e-280;
/// Directions tried by correction before an interval is halved.
const CORRECTIONS: usize = 12;

/// Two primitives on a straight path.
pub(super) struct Sweep<'a> {
    kind: PairKind,
    /// Vertices in [`PairKind`] order at both ends.
    ends: [&'a [Point; 4]; 2],
    /// Vertices of side a minus vertices of side b, at both ends, and the larger magnitude.
    differences: [[Vector; 3]; 4],
    count: usize,
}

impl<'a> Sweep<'a> {
    pub fn new(kind: PairKind, x0: &'a [Point; 4], x1: &'a [Point; 4]) -> Self {
        let mut differences = [[Vector::zeros(); 3]; 4];
        let mut count = 0;
        for a in 0..kind.side_a() {
            for b in kind.side_a()..kind.vertex_count() {
                let (d0, d1) = (x0[a] - x0[b], x1[a] - x1[b]);
                differences[count] = [d0, d1, d0.abs().sup(&d1.abs())];
                count += 1;
            }
        }
        Self { kind, ends: [x0, x1], differences, count }
    }

    /// `None` if the sides are apart all the way, else until when they are certified to be.
    pub fn hit(&self) -> Option<f64> {
        if self.separated_easily() {
            return None;
        }
        let shortest = 0.5f64.powi(HALVINGS);
        let (mut start, mut length) = (0.0, 1.0);
        // What separates the sides at the start often does so all the way; and from a gap that is tiny
        // against the elements or the path, hardly any other guess does.
        let mut direction = self.widest(self.ends[0], 0.0);
        for _ in 0..MAX_INTERVALS {
            let end = f64::min(start + length, 1.0);
            if self.certify(start, end, &mut direction) {
                if end == 1.0 {
                    return None;
                }
                start = end;
                length = f64::min(2.0 * length, 1.0);
            } else {
                length *= 0.5;
                if length < shortest {
                    break;
                }
            }
        }
        Some(start)
    }

    /// Whether a direction that costs next to nothing separates the sides all the way: that from one
    /// side's center to the other's, midway. Most pairs whose boxes meet are neighbors in one mesh, for
    /// which it does.
    fn separated_easily(&self) -> bool {
        let toward =
            self.differences[..self.count].iter().fold(Vector::zeros(), |n, [d0, d1, _]| n + d0 + d1);
        self.separates(&toward, 0.0, 1.0)
    }

    /// The pair's vertices at a time, to rounding.
    pub fn points(&self, time: f64) -> [Point; 4] {
        std::array::from_fn(|i| {
            Point::from(self.ends[0][i].coords * (1.0 - time) + self.ends[1][i].coords * time)
        })
    }

    /// Whether some direction separates the sides from `start` to `end`; keeps the one that does.
    fn certify(&self, start: f64, end: f64, last: &mut Option<Vector>) -> bool {
        if let Some(direction) = last
            && self.separates(direction, start, end)
        {
            return true;
        }
        let points = self.points(0.5 * (start + end));
        let closest = closest(self.kind, &points).offset;
        let near = [Some(closest), common_normal(self.kind, &points)].into_iter().flatten();
        let corrected = std::iter::once_with(|| self.correct(&closest, start, end)).flatten();
        // Units to rounding; their lengths are of no matter to the certificate.
        let found = near
            .chain(corrected)
            .chain(across_edges(self.kind, &points))
            .filter_map(|candidate| candidate.try_normalize(0.0))
            .find(|direction| self.separates(direction, start, end));
        *last = found.or(*last);
        found.is_some()
    }

    /// Whether n . (a - b) > 0 for all vertices a and b of the sides, from `start` to `end`: certain if
    /// true.
    fn separates(&self, n: &Vector, start: f64, end: f64) -> bool {
        let n_abs = n.abs();
        self.differences[..self.count].iter().all(|[d0, d1, magnitude]| {
            let bound = ROUNDING * n_abs.dot(magnitude) + SMALLEST;
            let at = |time: f64| n.dot(&(d0 * (1.0 - time) + d1 * time));
            at(start) > bound && at(end) > bound
        })
    }

    /// Of the directions that the vertices `points` at `time` suggest, that along which the sides are
    /// farthest apart then: the offset of the closest points, the common normal, and those across edges.
    fn widest(&self, points: &[Point; 4], time: f64) -> Option<Vector> {
        let suggested = [Some(closest(self.kind, points).offset), common_normal(self.kind, points)];
        let width = |n: &Vector| {
            let along = |[d0, d1, _]: &[Vector; 3]| n.dot(&(d0 * (1.0 - time) + d1 * time));
            self.differences[..self.count].iter().map(along).fold(f64::INFINITY, f64::min)
        };
        let suggested = suggested.into_iter().flatten().chain(across_edges(self.kind, points));
        let units = suggested.filter_map(|direction| direction.try_normalize(0.0));
        units.max_by(|a, b| width(a).total_cmp(&width(b)))
    }

    /// A direction within 90 degrees of all differences at `start` and `end`, if a few of Gilbert's
    /// steps lead there: the point nearest the origin on the segment from the last guess to the
    /// difference that contradicts it most (Gilbert 1966).
    fn correct(&self, guess: &Vector, start: f64, end: f64) -> Option<Vector> {
        let mut units = [Vector::zeros(); 8];
        let mut count = 0;
        for [d0, d1, _] in &self.differences[..self.count] {
            for time in [start, end] {
                units[count] = (d0 * (1.0 - time) + d1 * time).try_normalize(0.0)?;
                count += 1;
            }
        }
        let units = &units[..count];
        let mut n = guess.try_normalize(0.0).unwrap_or(units[0]);
        for _ in 0..CORRECTIONS {
            let (worst, value) = units
                .iter()
                .map(|unit| (unit, n.dot(unit)))
                .fold((&units[0], f64::INFINITY), |best, next| if next.1 < best.1 { next } else { best });
            if value > 1e-14 {
                return Some(n);
            }
            let along = worst - n;
            let step = (-n.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            n = (n + along * step).try_normalize(0.0)?;
        }
        None
    }
}
