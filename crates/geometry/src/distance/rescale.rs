//! Rescaling of pairs whose differences are so small or so large that their powers leave the range of `f64`:
//! such a pair is moved to its first vertex and scaled by a power of two.

use super::closest_points::Closest;
use crate::pair::PairKind;
use crate::point::{Point, Vector};

/// Largest difference below which a pair is scaled up [m]: fourth powers stay normal above it.
pub(crate) const MIN_SCALE: f64 = 1e-70;
/// Largest difference above which a pair is scaled down [m].
pub(crate) const MAX_SCALE: f64 = 1e70;

/// A pair relative to its first vertex, scaled by a power of two to a largest difference near 1.
pub(crate) struct Local<const N: usize> {
    /// The scaled points; unused ones are zero.
    pub(crate) points: [Point; N],
    /// Factors from lengths in `points` to lengths of the input. There are two, because their product may
    /// leave the range of `f64`.
    unscale: [f64; 2],
}

impl<const N: usize> Local<N> {
    /// The first `used` of the points; `None` where all of them coincide.
    pub(crate) fn new(points: &[Point; N], used: usize) -> Option<Self> {
        let used = &points[..used];
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
        // Coordinates are divided by four if differences might overflow.
        let shrink = if largest(&mut used.iter().flat_map(|p| [p.x, p.y, p.z])) > 1e300 { 0.25 } else { 1.0 };
        let first = points[0].coords * shrink;
        let differences = used.iter().map(|p| p.coords * shrink - first);
        let scale = largest(&mut differences.clone().flat_map(|d| [d.x, d.y, d.z]));
        if scale == 0.0 {
            return None;
        }
        // 2^k and 2^-k are both normal numbers for these k.
        let k = -exponent(scale).clamp(-1000, 1000);
        let mut local = [Point::origin(); N];
        for (slot, d) in local.iter_mut().zip(differences) {
            slot.coords = d * power_of_two(k);
        }
        Some(Self { points: local, unscale: [power_of_two(-k), 1.0 / shrink] })
    }

    /// A length of the scaled pair as a length of the input.
    pub(crate) fn unscale(&self, length: f64) -> f64 {
        length * self.unscale[0] * self.unscale[1]
    }
}

/// Exponent of a finite x >= 0: x < 2^(exponent + 1).
fn exponent(x: f64) -> i32 {
    ((x.to_bits() >> 52) as i32 & 0x7ff) - 1023
}

/// 2^k for -1022 <= k <= 1023.
fn power_of_two(k: i32) -> f64 {
    f64::from_bits(((k + 1023) as u64) << 52)
}

/// `closest` by `core` on the scaled pair. `core` must not fall back to this function.
#[cold]
#[inline(never)]
pub(super) fn closest_rescaled(
    kind: PairKind,
    points: &[Point; 4],
    core: impl Fn(&[Point; 4]) -> Closest,
) -> Closest {
    let mut weights = [1.0, 0.0, 0.0, 0.0];
    weights[kind.side_a()] = 1.0;
    let used = &points[..kind.vertex_count()];
    if !used.iter().all(|p| p.iter().all(|x| x.is_finite())) {
        return Closest { weights, offset: Vector::repeat(f64::NAN), distance: f64::NAN };
    }
    let Some(local) = Local::new(points, kind.vertex_count()) else {
        return Closest { weights, offset: Vector::zeros(), distance: 0.0 };
    };
    let closest = core(&local.points);
    Closest {
        weights: closest.weights,
        offset: closest.offset.map(|x| local.unscale(x)),
        distance: local.unscale(closest.distance),
    }
}

/// Length of a vector with components of any size.
#[cold]
#[inline(never)]
pub(crate) fn norm_of_tiny(v: &Vector) -> f64 {
    if v.iter().any(|x| x.is_nan()) {
        return f64::NAN;
    }
    let largest = v.amax();
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let k = -exponent(largest).clamp(-1000, 1000);
    (v * power_of_two(k)).norm() * power_of_two(-k)
}
