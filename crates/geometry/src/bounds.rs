//! Axis-aligned boxes rounded outward, and certified lower bounds of distances from them.
//!
//! Every operation rounds so that its guarantee holds in exact arithmetic: inflated boxes contain the exact
//! ones, and distances never exceed the exact ones.

use crate::point::Point;

/// An axis-aligned box [m]; empty where any `min` exceeds its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Point,
    /// Largest coordinates.
    pub max: Point,
}

impl Default for Aabb {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Aabb {
    /// The box that contains nothing: the neutral element of [`Self::union`].
    pub const EMPTY: Self = Self {
        min: Point::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        max: Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The smallest box around points.
    #[inline]
    pub fn of_points<'a>(points: impl IntoIterator<Item = &'a Point>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| bounds.union(&Self { min: *p, max: *p }))
    }

    /// The smallest box around two boxes.
    #[inline]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// A box that contains every point within `radius` >= 0 [m] of this box along each axis. It is at most
    /// one rounding unit larger than necessary.
    #[inline]
    pub fn inflated(&self, radius: f64) -> Self {
        Self {
            min: self.min.map(|x| (x - radius).next_down()),
            max: self.max.map(|x| (x + radius).next_up()),
        }
    }

    /// Whether the closed boxes share a point.
    #[inline]
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }

    /// Whether the closed box contains the point.
    #[inline]
    pub fn contains(&self, point: &Point) -> bool {
        (0..3).all(|k| self.min[k] <= point[k] && point[k] <= self.max[k])
    }

    /// A lower bound of the distance between two boxes that are not empty [m]. It is zero if they overlap;
    /// otherwise it is below the distance by at most a few rounding units.
    #[inline]
    pub fn distance_lower_bound(&self, other: &Self) -> f64 {
        let gap = |k: usize| (self.min[k] - other.max[k]).max(other.min[k] - self.max[k]).max(0.0);
        let (x, y, z) = (gap(0), gap(1), gap(2));
        let squared = x * x + y * y + z * z;
        // Relative errors with u = 2^-53: differences u, so squares 2 u + u, sums 2 u more; the root halves
        // these 5 u and adds u, the product below adds u. Altogether 4.5 u (and squares of u).
        const SHRINK: f64 = 1.0 - 4.0 * f64::EPSILON;
        if squared > 1e-280 && squared < f64::INFINITY {
            squared.sqrt() * SHRINK
        } else {
            // Squares have left the range of f64. The largest gap alone is also a bound.
            (x.max(y).max(z) * SHRINK).next_down().clamp(0.0, f64::MAX)
        }
    }
}

/// The largest `f32` that is at most x; minus infinity below the range of `f32`.
#[inline]
pub fn round_down_f32(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// The smallest `f32` that is at least x; infinity above the range of `f32`.
#[inline]
pub fn round_up_f32(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests;
